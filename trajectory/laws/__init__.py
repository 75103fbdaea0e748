"""Timing laws, one room for each, and their registry."""

from trajectory.laws.registry import LAWS, Law, TimingLaw, law_named

__all__ = [
    "LAWS",
    "Law",
    "TimingLaw",
    "law_named",
]
