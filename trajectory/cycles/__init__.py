"""Cycles: pieces from rest to rest, timed, repaired and verified."""

from trajectory.cycles.cycle import Cycle, Piece, periods_of, there_and_back
from trajectory.cycles.least_stretch import Repaired, repair

__all__ = [
    "Cycle",
    "Piece",
    "Repaired",
    "periods_of",
    "repair",
    "there_and_back",
]
