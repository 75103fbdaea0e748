"""Independent verification of a timed motion: densely in time, between the gridpoints and on both sides of each knot,
those of the law and those of the path.

Nothing here uses the coefficients that a law was made from. The pose and its time derivatives come from the path and
the law, the joints from the derivatives of the inverse model, the torque from inverse dynamics. The joints' speed must
also be the integral of their acceleration, and their position the integral of their speed. This finds a cusp between
samples that no sample shows, and wrong derivatives of a path. Peaks are measured on the samples. If these keep the
limits, `limit_proof` bounds the motion between them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from kinematics import Array, Mechanism, Value, from_actuators, rounded_up
from trajectory.limits import Limit, Limits, MeanSquareLimit, Use, mean_squares, uses
from trajectory.motions import Motion, PoseMotion, TimedMotion, motion_of
from trajectory.verification.limit_proof import proved_use
from trajectory.verification.sampling import integrals, settled_parts, way_of

_SMOOTH = 1e-9  # of the largest q'', or of the duration at the jerk limit: a smaller jump of q'' is rounding
_TOLERANCES = {  # relative, to the sizes that `Verification.residuals` names
    "start pose": 1e-9,
    "end pose": 1e-9,
    "start speed": 1e-9,
    "end speed": 1e-8,  # a pace that stops a motion as it starts ends to 1e-9 of the motion's later speed
    "closure": 1e-9,
    "change of assembly mode": 0.5,
    "kink of the path": 2e-8,
    "integral of acceleration": 1e-4,
    "integral of speed": 1e-6,
}


class Peak(NamedTuple):
    """The largest magnitude of one quantity, and where it is; SI units.

    `joint` is None for the tool, `time` for a mean over the way; `limit` and `ratio` are None where nothing limits the
    quantity. Where each joint has a limit of its own, it is the peak of their ratios.
    """

    quantity: str
    unit: str
    joint: str | None
    time: float | None
    value: float
    limit: float | None
    ratio: float | None


@dataclass(frozen=True, eq=False)
class Verification(Value):
    """The measured and the proved figures of a motion.

    Attributes:
        law: name of the law.
        duration: duration of the motion [s].
        peaks: the peak of every limited quantity, and of others that are useful without a limit, such as the torque.
        residuals: of the end poses [rad, or over the robot's size], of the end speeds over the largest, of the loop
            closure [rad, or over the robot's size]; how many samples are in another assembly mode; of the joints'
            integrals, over the largest speed and over the way of the joints.
        reach: the worst limb's margin [m]; negative or NaN fails.
        rms_torque: (m,) over the whole duration [N m or N].
        rms_over_peak: (m,) each joint's RMS torque over its own peak; 0 where it bears none.
        proved: proved upper bounds of each limited quantity over its limit, at every instant; empty if a peak fails.
        notes: checks that were left out, and why.
    """

    law: str
    duration: float
    peaks: tuple[Peak, ...]
    residuals: dict[str, float]
    reach: float
    rms_torque: Array
    rms_over_peak: Array
    proved: dict[str, float]
    notes: tuple[str, ...]

    @property
    def peak_over_limit(self) -> dict[str, float]:
        """Each limited quantity's peak over its limit."""
        return {p.quantity: p.ratio for p in self.peaks if p.ratio is not None}

    @property
    def failures(self) -> dict[str, float]:
        """The checks that fail: peaks, proved bounds and residuals above their limits, a reach margin [m].

        NaN fails.
        """
        failed = {name: ratio for name, ratio in self.peak_over_limit.items() if not ratio <= 1.0}
        failed |= {p.quantity: math.nan for p in self.peaks if math.isnan(p.value)}
        over = {name: value / _TOLERANCES[name] for name, value in self.residuals.items()}
        failed |= {name: ratio for name, ratio in over.items() if not ratio <= 1.0}
        if not self.reach >= 0.0:
            failed["reach margin [m]"] = self.reach
        return failed | {f"{name}, proved": bound for name, bound in self.proved.items() if not bound <= 1.0}

    @property
    def ok(self) -> bool:
        """Whether everything holds."""
        return not self.failures

    def rows(self) -> list[tuple[str, ...]]:
        """A table: quantity, peak, limit, peak over limit, the proved upper bound of that, joint, time [s]."""

        def number(value: float | None) -> str:
            return "" if value is None else f"{value:.6g}"

        def row(p: Peak) -> tuple[str, ...]:
            proved = "" if (most := self.proved.get(p.quantity)) is None else rounded_up(most, 6)
            return (
                f"{p.quantity} [{p.unit}]",
                number(p.value),
                number(p.limit),
                number(p.ratio),
                proved,
                p.joint or "",
                number(p.time),
            )

        return [row(p) for p in self.peaks]


def verify(
    robot: Mechanism, timed: TimedMotion, limits: Limits, payload: float, before: PoseMotion | None = None
) -> Verification:
    """Measure a timed motion against its limits, and prove the limits between the samples.

    Args:
        robot: any mechanism with the motion's kind of pose.
        timed: the motion, to rest.
        limits: limits of joints and tool. If the acceleration jumps, a jerk limit fails with an infinite peak.
        payload: mass at the tool [kg].
        before: (n,) the state that the motion must continue at its start; None is rest at the start that was asked for.

    Raises:
        InvalidShape: the motion has another kind of pose.
    """
    parts = settled_parts(robot, timed, _TOLERANCES["integral of acceleration"], _TOLERANCES["integral of speed"])
    times, motion = parts.times(timed), motion_of(robot, parts.tool(timed), payload)
    if before is None:
        before = PoseMotion(timed.ends[0], *np.zeros((3, timed.ends.shape[1])))
    peaks, notes = _peaks(robot, times, motion, motion_of(robot, before, payload), limits)
    peak = np.abs(motion.torque).max(axis=(0, 1))
    rms = _root_mean_square(timed, times, motion.torque)
    found = Verification(
        law=timed.name,
        duration=timed.duration,
        peaks=(*peaks, *(_rms_peak(robot, timed, times, motion, limits, mean) for mean in mean_squares())),
        residuals=_residuals(robot, timed, motion, before) | _integral_residuals(times, motion),
        reach=_least(robot.margin("reach", motion.tool.pose)),
        rms_torque=rms,
        rms_over_peak=np.divide(rms, peak, out=np.zeros_like(rms), where=rms != 0.0),
        proved={},
        notes=notes,
    )
    return found if found.failures else replace(found, proved=proved_use(robot, timed, limits, payload))


def _peaks(
    robot: Mechanism, times: Array, motion: Motion, before: Motion, limits: Limits
) -> tuple[tuple[Peak, ...], tuple[str, ...]]:
    found = uses(robot, motion, limits)
    jump_time, jump = _jump(times, motion.joints.second, before.joints.second)
    infinite = {limit: use.limit for limit, use in found.items() if limit.jumps}
    least = [float(limit.min()) for limit in infinite.values() if limit is not None]
    if jump <= _SMOOTH * max(np.abs(motion.joints.second).max(), *(times[-1, -1] * limit for limit in least), 0.0):
        infinite = {}
    peaks = [_peak(robot, times, limit, use) for limit, use in found.items() if limit not in infinite]
    for limit, most in infinite.items():
        if most is not None:
            peaks.append(Peak(limit.name, _unit(robot, limit), None, jump_time, math.inf, float(most.min()), math.inf))
    return tuple(peaks), tuple(
        f"{limit.name} left out: a joint acceleration jumps by {jump:.4g}, where the jerk is an impulse"
        for limit in infinite
    )


def _peak(robot: Mechanism, times: Array, limit: Limit, use: Use) -> Peak:
    size = np.abs(use.value) if use.ratio is None else use.ratio
    where = np.unravel_index(int(size.argmax()), size.shape)
    joint = robot.actuator_names[where[-1]] if size.shape[-1] == len(robot.actuator_names) else None
    bound, ratio = (None, None) if use.limit is None else (float(use.limit[where]), float(size[where]))
    return Peak(limit.name, _unit(robot, limit), joint, float(times[where[:-1]]), float(use.value[where]), bound, ratio)


def _unit(robot: Mechanism, limit: Limit) -> str:
    return limit.fields[0].unit_for(robot.actuator_units)


def _root_mean_square(timed: TimedMotion, times: Array, values: Array) -> Array:
    found: Array = np.sqrt(integrals(times, values**2).sum(axis=0) / timed.duration)
    return found


def _rms_peak(
    robot: Mechanism, timed: TimedMotion, times: Array, motion: Motion, limits: Limits, mean: MeanSquareLimit
) -> Peak:
    rms = _root_mean_square(timed, times, mean.quantity(motion))
    limit = mean.most(limits, rms.size)
    size = rms if limit is None else rms / limit
    joint = int(size.argmax())
    bound, ratio = (None, None) if limit is None else (float(limit[joint]), float(size[joint]))
    return Peak(mean.name, _unit(robot, mean), robot.actuator_names[joint], None, float(rms[joint]), bound, ratio)


def _jump(times: Array, acceleration: Array, first: Array) -> tuple[float, float]:
    """Time and size of the joints' largest jump of acceleration at a knot: from `first` at the start, to rest at T."""
    after = np.concatenate([acceleration[:, 0], np.zeros_like(first)[None]])
    before = np.concatenate([first[None], acceleration[:, -1]])
    jumps = np.abs(after - before).max(axis=-1)
    return float(np.append(times[:, 0], times[-1, -1])[jumps.argmax()]), float(jumps.max())


def _residuals(robot: Mechanism, timed: TimedMotion, motion: Motion, before: PoseMotion) -> dict[str, float]:
    pose, joints = motion.tool.pose, from_actuators(robot, motion.joints.position)
    first, units = timed.at(np.array(0.0)), robot.pose_units()
    fastest = _largest(motion.tool.velocity / units)
    return {
        "start pose": _largest((first.pose - before.pose) / units),
        "end pose": _largest((pose[-1, -1] - timed.ends[1]) / units),
        "start speed": _largest((first.velocity - before.velocity) / units) / fastest,
        "end speed": _largest(motion.tool.velocity[-1, -1] / units) / fastest,
        "kink of the path": timed.kink,
        "closure": _largest(robot.closure_gap(pose, joints)),
        "change of assembly mode": _changes(robot.jacobians(pose[:, 0])[1]),
    }


def _changes(j_x: Array) -> float:
    """How many of J_x (k, m, n) lie on another side of the singularities than the first; 0 with redundant joints.

    A pose that moves continuously cannot change its assembly mode without passing a singularity.
    """
    if j_x.shape[-2] != j_x.shape[-1]:
        return 0.0
    sides = np.sign(np.linalg.det(j_x[np.isfinite(j_x).all(axis=(-2, -1))]))
    return float(np.count_nonzero(sides != sides[:1]))


def _integral_residuals(times: Array, motion: Motion) -> dict[str, float]:
    """What the joints' derivatives, integrated from the start, do not explain; a cusp at speed v leaves about 2 v."""
    joints = motion.joints
    jump = joints.first[:, -1] - joints.first[0, 0] - integrals(times, joints.second).cumsum(axis=0)
    gap = joints.position[:, -1] - joints.position[0, 0] - integrals(times, joints.first).cumsum(axis=0)
    return {
        "integral of acceleration": _largest(jump) / _largest(joints.first),
        "integral of speed": _largest(gap) / way_of(joints.position),
    }


def _largest(values: Array) -> float:
    """Of the magnitudes; NaN where there is one."""
    return float(np.abs(values).max())


def _least(values: Array) -> float:
    """NaN where there is one."""
    return float(values.min())
