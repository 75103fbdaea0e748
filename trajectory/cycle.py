"""A cycle: the way there and the way back, each timed from rest to rest.

At the turning point the tangent jumps, and no single law may pass that at speed: each way is a piece of its own.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from kinematics import InvalidValue, Mechanism
from trajectory.errors import LimitsExceeded
from trajectory.limits import Limits
from trajectory.path import Path, Reversed
from trajectory.repair import Repaired, repair
from trajectory.timed import TimedMotion
from trajectory.verification import Verification, verify

Timing = Callable[[Mechanism, Path, Limits, float], TimedMotion]


@dataclass(frozen=True, eq=False)
class Piece:
    """One way, from rest to rest, within its limits.

    Attributes:
        path: that was asked for.
        payload: mass at the tool on this way [kg].
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
        """Of this way [s]."""
        return self.timed.motion.duration


@dataclass(frozen=True, eq=False)
class Cycle:
    """The pieces in order, the limits and the robot for which they are timed.

    Attributes:
        robot, pieces: as named.
        limits: that are kept.
        not_kept: fields of the limits that were asked for too, but that the timing law cannot keep.
    """

    robot: Mechanism
    limits: Limits
    pieces: tuple[Piece, ...]
    not_kept: tuple[str, ...] = ()

    @property
    def duration(self) -> float:
        """Of all pieces [s]."""
        return sum(piece.duration for piece in self.pieces)

    def stretched_to(self, period: float) -> Cycle:
        """Every piece stretched to a whole number of periods, so that each pose at rest is a set-point; verified again.

        Args:
            period: of the drives' bus [s].

        Raises:
            InvalidValue: the period is not finite and positive.
            LimitsExceeded: a stretched piece fails its verification.
        """
        return replace(self, pieces=tuple(self._whole(piece, period) for piece in self.pieces))

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
    timing: Timing,
    payload_back: float | None = None,
    cannot_keep: tuple[str, ...] = (),
) -> Cycle:
    """Time a path and its reverse; each is verified, and repaired by at most 1 %.

    Each way keeps the RMS torque limit by itself, so that the cycle does with any payloads.

    Args:
        robot: any mechanism whose pose is [x, y, z, theta].
        path: the way there.
        limits: of joints and tool.
        payload: mass at the tool on the way there [kg].
        timing: the method, such as `time_optimal`.
        payload_back: mass on the way back [kg]; as on the way there when None.
        cannot_keep: fields of the limits that `timing` refuses: left out, and named by the cycle where they are set.

    Raises:
        LimitsExceeded: a law breaks its limits by more than may be repaired; and what `timing` raises.
    """
    loads = (payload, payload if payload_back is None else payload_back)
    left_out = tuple(name for name in cannot_keep if getattr(limits, name) is not None)
    none: dict[str, Any] = dict.fromkeys(left_out)
    limits = replace(limits, **none)
    pieces = []
    for way, load in zip((path, Reversed(path)), loads, strict=True):
        timed = repair(robot, timing(robot, way, limits, load), limits, load)
        pieces.append(Piece(way, load, timed))
    return Cycle(robot, limits, tuple(pieces), left_out)


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
