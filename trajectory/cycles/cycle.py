"""A cycle: the way there and the way back, in pieces that are timed from rest to rest.

Where the tangent jumps, as at the turning point, no law can pass at speed. A piece ends there and the next one starts.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from kinematics import InvalidValue, Mechanism, Value
from trajectory.cycles.least_stretch import Repaired, repair
from trajectory.errors import LimitsExceeded
from trajectory.laws import TimingLaw
from trajectory.limits import Limits
from trajectory.motions import InTime, PoseSpline, TimedMotion
from trajectory.paths import Path, Reversed, pieces, places
from trajectory.verification import PathCertificate, Verification, Way, certify_path, verify, worst_of

_SAME = 1e-9  # rad, or times the path's length: two poses that are closer are the same


@dataclass(frozen=True, eq=False)
class Piece(Value):
    """One piece of a cycle, from rest to rest, within its limits.

    Attributes:
        path: the path that was asked for.
        payload: mass at the tool on it [kg].
        timed: the motion, its verification and the factor of its repair.
    """

    path: Path
    payload: float
    timed: Repaired

    @property
    def motion(self) -> TimedMotion:
        """The motion of the pose in time."""
        return self.timed.motion

    @property
    def duration(self) -> float:
        """The duration of this piece [s]."""
        return self.timed.motion.duration


@dataclass(frozen=True, eq=False)
class Cycle(Value):
    """A proved path and its timed pieces in order, with their limits and their robot.

    Attributes:
        certificate: proof that every pose is within reach and not singular: of the path, or of motions that leave it.
        limits: the limits that are kept.
        not_kept: fields of other limits that were asked for, but that the timing law cannot keep.
        there, back: the pieces of each way. There is no way back if the path ends at its own start.
    """

    robot: Mechanism
    limits: Limits
    path: Path
    certificate: PathCertificate
    there: tuple[Piece, ...]
    back: tuple[Piece, ...]
    not_kept: tuple[str, ...] = ()

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """The pieces of both ways, in order."""
        return (*self.there, *self.back)

    @property
    def ways(self) -> tuple[Way, ...]:
        """The ways of the poses: the path, or the pieces' own motions if these leave it."""
        own = tuple(InTime(p.motion, self.path.pose_names) for p in self.pieces if isinstance(p.motion, PoseSpline))
        return own or (self.path,)

    @property
    def duration(self) -> float:
        """The duration of all pieces [s]."""
        return sum(piece.duration for piece in self.pieces)

    @property
    def proved(self) -> dict[str, float]:
        """Proved upper bounds of each limited quantity over its limit, at every instant."""
        bounds = [piece.timed.verification.proved for piece in self.pieces]
        return {name: max(bound[name] for bound in bounds) for name in bounds[0]}

    @property
    def half(self) -> float:
        """The duration of the way there [s]."""
        return sum(piece.duration for piece in self.there)

    def stretched_to(self, period: float) -> Cycle:
        """Stretch every piece to a whole number of periods, so that each pose at rest is a set-point; verify it again.

        Args:
            period: period of the drives' bus [s].

        Raises:
            InvalidValue: the period is not finite and positive.
            LimitsExceeded: a stretched piece fails its verification.
        """
        there, back = (tuple(self._whole(piece, period) for piece in way) for way in (self.there, self.back))
        return replace(self, there=there, back=back)

    def _whole(self, piece: Piece, period: float) -> Piece:
        factor = periods_of(piece.duration, period) * period / piece.duration
        motion = piece.motion.stretched(factor)
        found = _within(verify(self.robot, motion, self.limits, piece.payload))
        return Piece(piece.path, piece.payload, Repaired(motion, factor, piece.timed.verification, found))


def there_and_back(
    robot: Mechanism,
    path: Path,
    limits: Limits,
    payload: float,
    timing: TimingLaw,
    payload_back: float | None = None,
    cannot_keep: tuple[str, ...] = (),
) -> Cycle:
    """Prove a path, and time it and its reverse. Each piece is verified, and repaired by at most 1 %.

    A path with corners that are not rounded is timed piece by piece. A path that ends at its own start is not reversed.
    Each piece keeps the RMS torque limit, so the cycle keeps it with any payloads.

    Args:
        robot: any mechanism with the path's kind of pose.
        path: the way there.
        limits: limits of joints and tool.
        payload: mass at the tool on the way there [kg].
        timing: the timing law, such as `time_optimal`.
        payload_back: mass on the way back [kg]; None takes `payload`.
        cannot_keep: fields of the limits that `timing` refuses. They are left out; if set, the cycle names them.

    Raises:
        PathRefused: a pose of the path is out of reach or singular, or it could not be proved that none is.
        LimitsExceeded: a law breaks its limits by more than may be repaired.
        LinkwrightError: any error of `timing`.
    """
    certificate = certify_path(robot, path)
    left_out = tuple(name for name in cannot_keep if getattr(limits, name) is not None)
    none: dict[str, Any] = dict.fromkeys(left_out)
    limits = replace(limits, **none)

    def timed(way: Path, load: float) -> tuple[Piece, ...]:
        parts = pieces(way)
        return tuple(
            Piece(part, load, repair(robot, timing(robot, part, limits, load), limits, load)) for part in parts
        )

    there = timed(path, payload)
    back = () if is_closed(path) else timed(Reversed(path), payload if payload_back is None else payload_back)
    cycle = Cycle(robot, limits, path, certificate, there, back, left_out)
    if cycle.ways != (path,):
        return replace(cycle, certificate=worst_of([certify_path(robot, way) for way in cycle.ways]))
    return cycle


def is_closed(path: Path) -> bool:
    """Whether a path ends in the pose where it starts. An angle that differs by a turn is another pose."""
    start, end = path.evaluate(np.array([0.0, path.length]), 0)[0]
    units = np.where(np.arange(start.size) < places(path.pose_names), path.length, 1.0)
    return bool((np.abs(end - start) <= _SAME * units).all())


def periods_of(duration: float, period: float) -> int:
    """The least whole number of periods that is not shorter than `duration`, except for rounding.

    Raises:
        InvalidValue: the period is not finite and positive.
    """
    if not (math.isfinite(period) and period > 0.0):
        raise InvalidValue("period", period, "a finite time > 0 s")
    return max(1, math.ceil(duration / period * (1 - 1e-12)))


def _within(found: Verification) -> Verification:
    if not found.ok:
        raise LimitsExceeded(found.failures, 1.0)
    return found
