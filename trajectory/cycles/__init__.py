"""Cycles: pieces from rest to rest, timed, repaired and verified."""

from trajectory.cycles.cycle import Cycle, Piece, periods_of, there_and_back
from trajectory.cycles.frame_peaks import FRAME_UNITS, FramePeak, frame_peaks, frame_reaction_text
from trajectory.cycles.least_stretch import Repaired, repair
from trajectory.cycles.member_peaks import MemberPeak, member_peaks

__all__ = [
    "FRAME_UNITS",
    "Cycle",
    "FramePeak",
    "MemberPeak",
    "Piece",
    "Repaired",
    "frame_peaks",
    "frame_reaction_text",
    "member_peaks",
    "periods_of",
    "repair",
    "there_and_back",
]
