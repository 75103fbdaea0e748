"""Timing laws, one room each."""
