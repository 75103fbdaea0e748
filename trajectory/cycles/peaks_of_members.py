"""The largest loads of each member over a cycle, and its smallest safety factor."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from kinematics import member_forces
from trajectory.cycles.cycle import Cycle
from trajectory.cycles.peaks_on_frame import dense_samples


@dataclass(frozen=True)
class MemberPeak:
    """What a member bears over a cycle; SI units. Times count from the cycle's start.

    Attributes:
        member: its name.
        tension: the largest pull along it; 0 if it is only pushed.
        tension_at: when.
        compression: the largest push along it; 0 if it is only pulled.
        compression_at: when.
        bending, torsion: the largest moments across it and about it.
        joint_force: the largest force in a joint of it.
        safety: the smallest safety factor against buckling and yield; 1 is the limit.
        safety_at: when.
        fails_by: by what it would fail there, "buckling" or "yield".
        safety_pose: the pose there.
    """

    member: str
    tension: float
    tension_at: float
    compression: float
    compression_at: float
    bending: float
    torsion: float
    joint_force: float
    safety: float
    safety_at: float
    fails_by: str
    safety_pose: tuple[float, ...]

    @property
    def breaks(self) -> bool:
        """Whether the cycle would break it."""
        return self.safety < 1.0

    def numbers(self) -> list[float]:
        """Its numbers, in the order of its fields."""
        return [value for value in asdict(self).values() if isinstance(value, float)]

    def as_dict(self) -> dict[str, Any]:
        """Plain data."""
        return asdict(self)


def member_peaks(cycle: Cycle) -> tuple[MemberPeak, ...]:
    """Of each member whose strength is known, in the order of the robot's statics; empty if it has none."""
    times, poses, found = [], [], []
    for piece, at, tool in dense_samples(cycle):
        loads = member_forces(cycle.robot, piece.payload, tool.pose, tool.velocity, tool.acceleration)
        names = loads.names
        times.append(at.ravel())
        poses.append(tool.pose.reshape(at.size, -1))
        found.append([part.reshape(at.size, len(names)) for part in loads[1:]])
    whole, pose = np.concatenate(times), np.concatenate(poses)
    columns = [np.concatenate(parts) for parts in zip(*found, strict=True)]
    tension, bending, torsion, joint_force, safety, buckling = columns
    peaks = []
    for k, name in enumerate(names):
        pull, push, least = (
            int(where) for where in (tension[:, k].argmax(), tension[:, k].argmin(), safety[:, k].argmin())
        )
        peaks.append(
            MemberPeak(
                name,
                tension=max(float(tension[pull, k]), 0.0),
                tension_at=float(whole[pull]),
                compression=max(-float(tension[push, k]), 0.0),
                compression_at=float(whole[push]),
                bending=float(bending[:, k].max()),
                torsion=float(torsion[:, k].max()),
                joint_force=float(joint_force[:, k].max()),
                safety=float(safety[least, k]),
                safety_at=float(whole[least]),
                fails_by="buckling" if buckling[least, k] <= safety[least, k] else "yield",
                safety_pose=tuple(pose[least].tolist()),
            )
        )
    return tuple(peaks)
