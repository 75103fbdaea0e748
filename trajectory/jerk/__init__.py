"""The jerk-limited timing law on a fixed path."""

from __future__ import annotations

from trajectory.jerk.law import jerk_limited

__all__ = ["jerk_limited"]
