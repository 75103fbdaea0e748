"""Samples of a motion, as dense as the motion needs: inside its smooth intervals and at both ends of each."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics import Array, JointMotion, Mechanism, actuator_motion
from trajectory.motions import PoseMotion, TimedMotion

LEAST_PARTS = 2500  # of the whole motion, by its time and by its way, about
_INSIDE = np.linspace(0.0, 1.0, 5)  # of each part
_ROUNDS = 16  # of halving; what is smooth is settled long before
_SEEN = 1e-8  # of the joints' largest position: on a shorter way rounding alone is beyond a tolerance of 1e-6
_SETTLED = 0.1  # of a tolerance: what all the integrals together may still move by


class Parts(NamedTuple):
    """Parts of a motion, each inside one of its intervals, in order, (k,) each."""

    interval: Array
    since: Array
    lasting: Array

    def times(self, timed: TimedMotion) -> Array:
        """(k, 5) of the samples [s]."""
        result: Array = timed.times[self.interval, None] + self._since()
        return result

    def tool(self, timed: TimedMotion) -> PoseMotion:
        """(k, 5, n) of the samples, the first and the last from inside."""
        return timed.inside(np.broadcast_to(self.interval[:, None], (self.interval.size, _INSIDE.size)), self._since())

    def _since(self) -> Array:
        return self.since[:, None] + self.lasting[:, None] * _INSIDE

    def halved(self, which: Array) -> tuple[Parts, Array]:
        """Some of the parts halved, in order, and which of the new parts are halves."""
        counts = np.where(which, 2, 1)
        half = self.lasting / counts
        second = np.zeros(counts.sum(), dtype=bool)
        second[np.cumsum(counts)[which] - 1] = True
        found = Parts(*(np.repeat(v, counts) for v in (self.interval, self.since, half)))
        return found._replace(since=found.since + np.where(second, found.lasting, 0.0)), np.repeat(which, counts)


def parts_of(timed: TimedMotion) -> Parts:
    """At least one an interval, and `LEAST_PARTS` of the whole motion, about."""
    lengths = np.diff(timed.times)
    shares = np.maximum(lengths / timed.duration, np.diff(timed.progress))
    counts = np.maximum(1, np.ceil(shares * LEAST_PARTS)).astype(int)
    interval = np.repeat(np.arange(counts.size), counts)
    place = np.arange(interval.size) - np.repeat(np.cumsum(counts) - counts, counts)
    lasting = (lengths / counts)[interval]
    return Parts(interval, place * lasting, lasting)


def settled_parts(robot: Mechanism, timed: TimedMotion, acceleration: float, speed: float) -> Parts:
    """Parts so short that the integrals of the joints' acceleration and speed over them stand.

    Args:
        robot: any mechanism with this kind of pose.
        timed: the motion.
        acceleration, speed: tolerances of their integrals, over the largest speed and over the way of the joints.
    """
    parts = parts_of(timed)
    joints = actuator_motion(robot, *parts.tool(timed))
    scales = [_SETTLED * acceleration * _largest(joints.first), _SETTLED * speed * way_of(joints.position)]
    found = _unsettled(parts, joints, scales, parts.lasting.size)
    for _ in range(_ROUNDS):
        if not found.any():
            break
        parts, halves = parts.halved(found)
        new = Parts(*(v[halves] for v in parts))
        found = np.zeros(parts.lasting.size, dtype=bool)
        found[halves] = _unsettled(new, actuator_motion(robot, *new.tool(timed)), scales, parts.lasting.size)
    return parts


def integrals(times: Array, values: Array) -> Array:
    """(k, j, m) values at equal steps of each part -> (k, m) integrals over its time, by Simpson's rule."""
    steps = values.shape[1] - 1
    weights = np.full(steps + 1, 2.0)
    weights[1::2] = 4.0
    weights[[0, -1]] = 1.0
    result: Array = np.einsum("nkm,k,n->nm", values, weights / (3 * steps), times[:, -1] - times[:, 0])
    return result


def way_of(positions: Array) -> float:
    """The longest way of a joint, from all positions (..., m); not less than rounding lets see."""
    flat = positions.reshape(-1, positions.shape[-1])
    return max(float(np.ptp(flat, axis=0).max()), _SEEN * _largest(flat))


def _unsettled(parts: Parts, joints: JointMotion, scales: list[float], count: int) -> Array:
    """(k,) whether Simpson's rule on every second sample differs by more than this part may."""
    times = np.stack([np.zeros_like(parts.lasting), parts.lasting], axis=-1)
    found = np.zeros(parts.lasting.size, dtype=bool)
    for values, scale in zip((joints.second, joints.first), scales, strict=True):
        apart = np.abs(integrals(times, values) - integrals(times, values[:, ::2])).max(axis=-1) / 15.0
        found |= apart * count > scale
    return found


def _largest(values: Array) -> float:
    return float(np.abs(values).max())
