"""Loads along a cycle: the force and the moment that the machine exerts on its frame."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from kinematics import Array, FrameReaction, Value, frame_reaction
from trajectory.cycles.cycle import Cycle, Piece, periods_of
from trajectory.motions import PoseMotion
from trajectory.verification import integrals, parts_of

FRAME_UNITS = {"force": "N", "moment": "N m"}


@dataclass(frozen=True, eq=False)
class FramePeak(Value):
    """The force or the moment on the frame over a cycle; SI units.

    Attributes:
        peak: the largest magnitude.
        time: when, from the cycle's start [s].
        rms: root mean square of the magnitude over the cycle.
        axes: (3,) the largest magnitude along each of the base's axes.
    """

    peak: float
    time: float
    rms: float
    axes: Array

    def as_dict(self) -> dict[str, Any]:
        """Plain data."""
        return {"peak": self.peak, "at": self.time, "rms": self.rms, "peak_along_axes": self.axes.tolist()}


def frame_peaks(cycle: Cycle) -> dict[str, FramePeak]:
    """The force [N] and the moment about the base's origin [N m] on the frame, by name."""
    times, found = [], []
    for piece, at, tool in dense_samples(cycle):
        times.append(at)
        found.append(_reaction(cycle, piece, tool))
    whole = np.concatenate(times)
    return {name: _peak(whole, np.concatenate([getattr(part, name) for part in found])) for name in FRAME_UNITS}


def dense_samples(cycle: Cycle) -> Iterator[tuple[Piece, Array, PoseMotion]]:
    """Each piece with times (k, j) from the cycle's start [s] and the motion there, on both sides of each knot."""
    start = 0.0
    for piece in cycle.pieces:
        parts = parts_of(piece.motion)
        yield piece, start + parts.times(piece.motion), parts.tool(piece.motion)
        start += piece.duration


def frame_reaction_text(cycle: Cycle, period: float) -> str:
    """A CSV file of the reaction on the frame, one row for each set-point of the cycle.

    Args:
        cycle: timed and verified.
        period: of the set-points [s].
    """
    rows, start = [], 0
    for piece in cycle.pieces:
        count = periods_of(piece.duration, period)
        motion, last = piece.motion.stretched(count * period / piece.duration), piece is cycle.pieces[-1]
        steps = np.arange(count + last)
        found = _reaction(cycle, piece, motion.at(np.minimum(steps * period, motion.duration)))
        rows.append(np.column_stack([np.round((start + steps) * period, 12), *found]))
        start += count
    names = ["t", *(f"{name}_{axis}" for name in FRAME_UNITS for axis in "xyz")]
    lines = [
        "# what the machine exerts on its frame, weights included, in the base's axes; s, N, and N m about its origin",
        f"# mechanism: {type(cycle.robot).__name__}",
        f"# geometry hash: {cycle.robot.geometry.digest}",
        ",".join(names),
        *(",".join(map(repr, row)) for row in np.concatenate(rows).tolist()),
    ]
    return "\n".join(lines) + "\n"


def _reaction(cycle: Cycle, piece: Piece, tool: PoseMotion) -> FrameReaction:
    return frame_reaction(cycle.robot, piece.payload, tool.pose, tool.velocity, tool.acceleration)


def _peak(times: Array, values: Array) -> FramePeak:
    """Of (k, j, 3) values at equal steps of each part."""
    size = np.linalg.norm(values, axis=-1)
    where = np.unravel_index(int(size.argmax()), size.shape)
    lasting = (times[:, -1] - times[:, 0]).sum()
    square = float(integrals(times, size[..., None] ** 2).sum() / lasting)
    return FramePeak(float(size[where]), float(times[where]), square**0.5, np.abs(values).max(axis=(0, 1)))
