"""The largest loads of each member over a cycle, and its smallest safety factor."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from kinematics import member_forces
from trajectory.cycles.cycle import Cycle
from trajectory.cycles.frame_peaks import dense_samples


@dataclass(frozen=True)
class MemberPeak:
    """What a member bears over a cycle; SI units. Times count from the cycle's start.

    Attributes:
        member: its name.
        tension: the largest force along it, below 0 for compression.
        tension_at: when.
        bending, torsion: the largest moments across it and about it.
        joint_force: the largest force in a joint of it.
        safety: the smallest safety factor against buckling and yield; 1 is the limit.
        safety_at: when.
    """

    member: str
    tension: float
    tension_at: float
    bending: float
    torsion: float
    joint_force: float
    safety: float
    safety_at: float

    def as_dict(self) -> dict[str, Any]:
        """Plain data."""
        return asdict(self)


def member_peaks(cycle: Cycle) -> tuple[MemberPeak, ...]:
    """Of each member whose strength is known, in the order of the robot's statics; empty if it has none."""
    times, found = [], []
    for piece, at, tool in dense_samples(cycle):
        loads = member_forces(cycle.robot, piece.payload, tool.pose, tool.velocity, tool.acceleration)
        names = loads.names
        times.append(at.ravel())
        found.append([part.reshape(at.size, len(names)) for part in loads[1:]])
    whole = np.concatenate(times)
    tension, bending, torsion, joint_force, safety = (np.concatenate(parts) for parts in zip(*found, strict=True))
    peaks = []
    for k, name in enumerate(names):
        most, least = int(np.abs(tension[:, k]).argmax()), int(safety[:, k].argmin())
        peaks.append(
            MemberPeak(
                name,
                tension=float(tension[most, k]),
                tension_at=float(whole[most]),
                bending=float(bending[:, k].max()),
                torsion=float(torsion[:, k].max()),
                joint_force=float(joint_force[:, k].max()),
                safety=float(safety[least, k]),
                safety_at=float(whole[least]),
            )
        )
    return tuple(peaks)
