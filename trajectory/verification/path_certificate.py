"""Proof that a robot keeps its margins at every pose of a path (`Margin.holds_on_paths`), over intervals of arc length.

On an interval of s the path gives bounds of the pose and of its derivative. Interval arithmetic, rounded outward,
bounds each margin f over that box. It also bounds the margin's gradient, which together with the path's derivative
bounds the slope f' along the path. So f(s) >= f(m) - max |f'| r, with m the middle and r half of the interval (the
centred form). The better of the two bounds is used. Intervals are halved until their bound is close to the lowest
value seen.

The proof relies on the assumptions of `kinematics/evaluation/interval_interpreter.py`, and on paths that are evaluated
to 1e-12 in double arithmetic; their bounds are widened by that.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import casadi as ca
import numpy as np

from kinematics import Array, BoxProgram, Measure, Mechanism, Program, enclose, rounded_down, sides
from trajectory.errors import PathRefused
from trajectory.motions import InTime
from trajectory.paths import Path, require_poses_of
from trajectory.verification.centred_form import lower_bounds
from trajectory.verification.shown_margin import prove_shown

Way = Path | InTime
_START = 64  # intervals, at least, that the path is cut into first
_SHARE = 0.9  # of the lowest value seen, that a bound must reach
_SMALLEST = 1e-9  # of the length: narrower intervals are not halved
_MOST = 200_000  # intervals


@dataclass(frozen=True)
class PathCertificate:
    """The proved margins of every pose of a path.

    Attributes:
        margins: proved lower bounds, all above 0, of the margins that a path must keep, by name.
        intervals: the number of intervals of s in the proof.
    """

    margins: dict[str, float]
    intervals: int

    def rows(self) -> list[tuple[str, str]]:
        """Each margin and its bound, rounded down, for people."""
        return [(name, rounded_down(bound, 4)) for name, bound in self.margins.items()]


def certify_path(robot: Mechanism, path: Way) -> PathCertificate:
    """Prove that every pose of a path is within reach and the joints' ranges, and away from the singularities.

    Args:
        robot: any mechanism with the path's kind of pose.
        path: any path; it need not be smooth.

    Raises:
        InvalidValue: the path has another kind of pose.
        PathRefused: a margin is not above 0, or it could not be proved; the message has arc length, pose and limb.
    """
    require_poses_of(robot, path)
    claims = _Claims(robot, path)
    edges = np.unique(np.concatenate([path.knots, np.linspace(0.0, path.length, _START + 1)]))
    low, high = edges[:-1], edges[1:]
    proved, seen = np.full(len(claims.names), np.inf), np.full(len(claims.names), np.inf)
    count = 0
    while low.size:
        count += low.size
        middle = 0.5 * low + 0.5 * high
        least, most = claims.bounds(low, high, middle)
        claims.refuse(most <= 0.0, middle, most, proved=True)
        seen = np.minimum(seen, most.min(axis=0))
        done = least >= _SHARE * seen
        proved = np.minimum(proved, least.min(axis=0, where=done, initial=np.inf))
        stuck = (high - low <= _SMALLEST * path.length) | (count > _MOST)
        claims.refuse(stuck[:, None] & ~done, middle, least, proved=False)
        still = ~done.all(axis=1)
        low, high, middle = low[still], high[still], middle[still]
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    margins: dict[str, float] = {}
    for name, bound in zip(claims.names, proved.tolist(), strict=True):
        margins[name] = min(bound, margins.get(name, np.inf))
    for name, margin in robot.margins.items():
        if margin.holds_on_paths and margin.shown_on_paths:
            bound, more = prove_shown(robot, path, name, edges)
            count += more
            if np.isfinite(bound):
                margins[name] = bound
    return PathCertificate(margins, count)


def worst_of(certificates: Sequence[PathCertificate]) -> PathCertificate:
    """The certificate that holds on all of several ways."""
    margins = {name: min(c.margins[name] for c in certificates) for name in certificates[0].margins}
    return PathCertificate(margins, sum(c.intervals for c in certificates))


class _Claims:
    """Margins that must be above 0 all along the path.

    Moduli are left out: a continuous function that is never 0 keeps the sign that it has at the start.
    """

    def __init__(self, robot: Mechanism, path: Way) -> None:
        self.path = path
        model, fixed = robot.model(), robot.geometry.vector().tolist()
        (start,) = path.evaluate(np.array(0.0), 0)
        parts = _margins(robot)
        symbols = [model.pose, model.geometry]
        inner = [part.dep(0) if part.op() == ca.OP_FABS else part for *_, part in parts]
        values = np.array(ca.Function("start", symbols, [ca.vertcat(*inner)])(start, fixed))[:, 0]
        kept = np.flatnonzero(values != np.inf)  # a limit at infinity cannot be met
        self.names = [parts[k][0] for k in kept]
        self.places = [parts[k][1] for k in kept]
        claims = ca.vertcat(*(_without_modulus(parts[k][2], values[k]) for k in kept))
        gradient = ca.jacobian(claims, model.pose)

        def program(*outputs: ca.SX) -> BoxProgram:
            function = ca.Function("claims", symbols, ca.cse([ca.densify(o) for o in outputs]))
            return BoxProgram.of(Program.of(function), fixed)

        self._plain, self._with_gradient = program(claims), program(claims, gradient)

    def bounds(self, low: Array, high: Array, middle: Array) -> tuple[Array, Array]:
        """(k, claims) lower bounds over intervals of s, and upper bounds in their middle."""
        box, centre = self.path.enclose(low, high), self.path.enclose(middle, middle)
        least, most = enclose(self._with_gradient, box.low, box.high)
        point_least, point_most = enclose(self._plain, centre.low, centre.high)
        half = np.nextafter(np.maximum(high - middle, middle - low), np.inf)
        return lower_bounds(least, most, point_least, box, half), point_most

    def refuse(self, where: Array, at: Array, values: Array, proved: bool) -> None:
        """Raise PathRefused for the worst of these (k, claims), of the first margin that has any."""
        for k in np.flatnonzero(where.any(axis=0)):
            row = int(np.argmin(np.where(where[:, k], values[:, k], np.inf)))
            s = float(at[row])
            (pose,) = self.path.evaluate(np.array(s), 0)
            place, near = self.places[k], self.path.waypoint(s)
            raise PathRefused(self.names[k], s, pose.tolist(), place, float(values[row, k]), proved, near)


def _without_modulus(part: ca.SX, at_start: float) -> ca.SX:
    if part.op() != ca.OP_FABS:
        return part
    return -part.dep(0) if at_start < 0.0 else part.dep(0)


def _margins(robot: Mechanism) -> list[tuple[str, str | None, ca.SX]]:
    """Name, place and expression of each margin that a path must keep; a component that is the lower of two counts
    twice."""
    measure = Measure(robot.fvi_bounds, robot.characteristic_length)
    found: list[tuple[str, str | None, ca.SX]] = []
    for name, margin in robot.margins.items():
        if margin.holds_on_paths and not margin.shown_on_paths:
            components = margin.components(robot, measure)
            count = components.numel()
            places: Sequence[str | None] = margin.places(robot) or [None] * count
            for place, component in zip(places, ca.vertsplit(components), strict=True):
                found += [(name, place, side) for side in sides(component)]
    return found
