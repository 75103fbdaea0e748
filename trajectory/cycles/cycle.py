"""A cycle: the way there and the way back, in pieces that are timed from rest to rest.

Where the tangent jumps, as at the turning point, no law may pass at speed: there a piece ends and the next one starts.
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

_SAME = 1e-9  # rad, or of the path's length: no further apart are two poses the same


@dataclass(frozen=True, eq=False)
class Piece(Value):
    """One piece, from rest to rest, within its limits.

    Attributes:
        path: that was asked for.
        payload: mass at the tool on it [kg].
        timed: the motion, its verification and the factor of its repair.
    """

    path: Path
    payload: float
    timed: Repaired

    @property
    def motion(self) -> TimedMotion:
        """Of the pose, in time."""
        return self.timed.motion

    @property
    def duration(self) -> float:
        """Of this piece [s]."""
        return self.timed.motion.duration


@dataclass(frozen=True, eq=False)
class Cycle(Value):
    """A path that was proved, and its pieces in order, with the limits and the robot for which they are timed.

    Attributes:
        certificate: that every pose of the path, or of the motions that left it, is within reach and not singular.
        limits: that are kept.
        not_kept: fields of the limits that were asked for too, but that the timing law cannot keep.
        there, back: the pieces of each way; none back where the path ends in the pose where it starts.
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
        """Of both ways, in order."""
        return (*self.there, *self.back)

    @property
    def ways(self) -> tuple[Way, ...]:
        """What the poses pass: the path, or the pieces' own motions where these left it."""
        own = tuple(InTime(p.motion, self.path.pose_names) for p in self.pieces if isinstance(p.motion, PoseSpline))
        return own or (self.path,)

    @property
    def duration(self) -> float:
        """Of all pieces [s]."""
        return sum(piece.duration for piece in self.pieces)

    @property
    def proved(self) -> dict[str, float]:
        """Each limited quantity over its limit is at most this at every instant."""
        bounds = [piece.timed.verification.proved for piece in self.pieces]
        return {name: max(bound[name] for bound in bounds) for name in bounds[0]}

    @property
    def half(self) -> float:
        """Of the way there [s]."""
        return sum(piece.duration for piece in self.there)

    def stretched_to(self, period: float) -> Cycle:
        """Every piece stretched to a whole number of periods, so that each pose at rest is a set-point; verified again.

        Args:
            period: of the drives' bus [s].

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
    """Prove a path, and time it and its reverse; each piece is verified, and repaired by at most 1 %.

    A path with corners that are not rounded is timed piece by piece, and one that ends where it starts is not reversed.
    Each piece keeps the RMS torque limit by itself, so that the cycle does with any payloads.

    Args:
        robot: any mechanism with the path's kind of pose.
        path: the way there.
        limits: of joints and tool.
        payload: mass at the tool on the way there [kg].
        timing: the method, such as `time_optimal`.
        payload_back: mass on the way back [kg]; as on the way there when None.
        cannot_keep: fields of the limits that `timing` refuses: left out, and named by the cycle where they are set.

    Raises:
        PathRefused: a pose of the path is out of reach or singular, or could not be proved not to be.
        LimitsExceeded: a law breaks its limits by more than may be repaired; and what `timing` raises.
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
    """Whether a path ends in the pose where it starts, an angle a turn on being another one."""
    start, end = path.evaluate(np.array([0.0, path.length]), 0)[0]
    units = np.where(np.arange(start.size) < places(path.pose_names), path.length, 1.0)
    return bool((np.abs(end - start) <= _SAME * units).all())


def periods_of(duration: float, period: float) -> int:
    """The least whole number of periods that is no shorter, but for rounding.

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
