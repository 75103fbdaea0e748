"""Paths, actuator limits, timing laws, verification and set-points."""
