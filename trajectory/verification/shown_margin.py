"""Proof along a path of a margin that is shown by `Margin.to_show`, such as the clearance.

Its own bounds are too wide. So the margin is first sampled, and then a share of the lowest value is proved.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import casadi as ca
import numpy as np

from kinematics import (
    Array,
    BlockProgram,
    BoxProgram,
    ClaimSymbols,
    Mechanism,
    Program,
    ToShow,
    bulk,
    enclose,
    evaluate,
)
from trajectory.errors import PathRefused
from trajectory.motions import InTime
from trajectory.paths import Path
from trajectory.verification.centred_form import lower_bounds

_SHARE = 0.9  # of the lowest value seen, that is proved
_SAMPLES = 16  # of each interval of the first cut
_SMALLEST = 1e-9  # of the length: narrower intervals are not halved
_MOST = 200_000  # intervals


class _Programs(NamedTuple):
    """The claims with and without gradient; both take pose, scaling and bound. `seen` decides the scaling."""

    shown: ToShow
    plain: BoxProgram
    with_gradient: BoxProgram
    seen: BlockProgram | None


def prove_shown(robot: Mechanism, path: Path | InTime, name: str, edges: Array) -> tuple[float, int]:
    """The proved lower bound of a margin along a path, above 0, and the number of intervals of its proof.

    Args:
        edges: (k,) arc lengths from 0 to the path's end, with all knots.

    Raises:
        PathRefused: the margin is not above 0, or it could not be proved.
    """
    shares = np.arange(_SAMPLES) / _SAMPLES
    s = np.append((edges[:-1, None] + np.diff(edges)[:, None] * shares).ravel(), edges[-1])
    (poses,) = path.evaluate(s, 0)
    values = robot.margin(name, poses)
    values = np.where(np.isnan(values), -np.inf, values)
    worst = int(values.argmin())
    bound = _SHARE * float(values[worst])
    if bound == np.inf:  # nothing is near
        return bound, 0
    if bound <= 0.0:
        raise _refused(robot, path, name, float(s[worst]), float(values[worst]), proved=True)
    programs = _programs(robot, name)
    low, high, count = edges[:-1], edges[1:], 0
    while low.size:
        count += low.size
        middle = 0.5 * low + 0.5 * high
        least = _least(programs, path, low, high, bound)
        still = ~(least >= 0.0)
        stuck = still & ((high - low <= _SMALLEST * path.length) | (count > _MOST))
        if stuck.any():
            at = float(middle[np.argmin(np.where(stuck, least, np.inf))])
            raise _refused(robot, path, name, at, -np.inf, proved=False)
        low, high, middle = low[still], high[still], middle[still]
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    return bound, count


def _least(programs: _Programs, path: Path | InTime, low: Array, high: Array, bound: float) -> Array:
    """(k,) lower bound of the smallest claim over intervals of s."""
    middle = 0.5 * low + 0.5 * high
    (poses,) = path.evaluate(middle, 0)
    bounds = np.full((len(low), 1), bound)
    numbers = bounds
    if programs.seen is not None:
        chosen = programs.shown.chosen(evaluate(programs.seen, poses, bounds)[0])
        numbers = np.hstack([np.swapaxes(chosen, -1, -2).reshape(len(low), -1), bounds])
    box, centre = path.enclose(low, high), path.enclose(middle, middle)
    point, _ = enclose(programs.plain, np.hstack([centre.low, numbers]), np.hstack([centre.high, numbers]))
    least, most = enclose(programs.with_gradient, np.hstack([box.low, numbers]), np.hstack([box.high, numbers]))
    half = np.nextafter(np.maximum(high - middle, middle - low), np.inf)
    result: Array = lower_bounds(least, most, point, box, half).min(axis=1)
    return np.where(np.isnan(result), -np.inf, result)


@lru_cache(maxsize=16)
def _programs(robot: Mechanism, name: str) -> _Programs:
    model, claim = robot.model(), ClaimSymbols.fresh()
    shown = robot.margins[name].to_show(robot, claim, robot.home, positive=True)
    others = claim.vector[1:]
    numbers = [*robot.geometry.vector(), *ClaimSymbols.values(0.0, robot.fvi_bounds, robot.characteristic_length)[1:]]
    inputs = [model.pose, ca.vec(shown.scaling), claim.bound, model.geometry, others]

    def program(*outputs: ca.SX) -> BoxProgram:
        function = ca.Function("claims", inputs, [ca.densify(o) for o in outputs])
        return BoxProgram.of(Program.of(function), numbers)

    gradient = ca.jacobian(shown.expressions, model.pose)
    seen = None
    if shown.matrix is not None:
        matrix = ca.substitute(shown.matrix, ca.vertcat(model.geometry, others), ca.SX(numbers))
        seen = bulk(ca.Function("seen", [model.pose, claim.bound], [ca.densify(matrix)]))
    return _Programs(shown, program(shown.expressions), program(shown.expressions, gradient), seen)


def _refused(robot: Mechanism, path: Path | InTime, name: str, s: float, value: float, proved: bool) -> PathRefused:
    (pose,) = path.evaluate(np.array(s), 0)
    return PathRefused(name, s, pose.tolist(), robot.margin_place(name, pose), value, proved, path.waypoint(s))
