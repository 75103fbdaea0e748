"""A nonlinear program (NLP) that makes the worst value as good as possible over a fixed set of poses, solved by IPOPT.

It maximises t under these constraints. Every component of the objective margin (with the opposite sign if a smaller
margin is better) is at least t at every pose. Every requirement holds at every pose with a small reserve. Every limb
can reach. The geometry stays within its bounds and sums. Gradients and Hessians come from the mechanism's own
expressions by automatic differentiation.

Margins are divided by their size and variables by their range, so that a larger robot gives the same problem.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import casadi as ca
import numpy as np

from design.claims import reach_rows
from design.requirement import Bounds, Requirement, SumLimit
from design.sampling import WorstPoses
from design.synthesis.near_components import NearComponents
from kinematics import Array, FviBounds, Mechanism, Value

_DECADES = 10.0  # if a variable's bounds differ by this factor, a logarithmic scale is used
_TIE = 1e-7  # times the objective's size: chooses, of equal optima, the one nearest to the start
_SUM_SPARE = 1e-7  # relative reserve of a sum below its limit, for the rounding of the result
_REACH = "every limb reaches"


@dataclass(frozen=True)
class Problem:
    """The optimisation problem, for any set of poses.

    Attributes:
        robot: the prototype. Fields that are no variables keep its values.
        objective: the margin whose worst value should be as good as possible.
        variables, requirements, sums: the variables with their bounds, the requirements, and the limits of sums.
        fvi_bounds, characteristic_length: what the FVI is measured with; the length is the same for every geometry.
        spare: reserve of each requirement above its bound in the NLP, so that it also holds between the poses; relative
            to the margin's own size, see `sizes`.
    """

    robot: Mechanism
    objective: str
    variables: tuple[Bounds, ...]
    requirements: tuple[Requirement, ...]
    sums: tuple[SumLimit, ...]
    fvi_bounds: FviBounds
    characteristic_length: float
    spare: float = 1e-4

    def __post_init__(self) -> None:
        for r in self.requirements:
            self.robot.margin_named(r.margin).bound(r.at_least, r.at_most)

    def good(self, objective: float) -> float:
        """A value of the objective, negative if a smaller one is better."""
        return self.robot.margin_named(self.objective).sense * objective

    def bounds(self) -> tuple[Array, Array]:
        """(k,) lowest and (k,) highest values of the variables."""
        return np.array([v.low for v in self.variables]), np.array([v.high for v in self.variables])

    def moving(self) -> Array:
        """(k,) 1 for each variable that can change, 0 for one that its bounds fix."""
        low, high = self.bounds()
        return np.asarray(high > low, dtype=float)

    def from_unit(self, unit: Any) -> list[Any]:
        """k variables from numbers or symbols (k,) in [0, 1]; on a logarithmic scale if bounds are far apart."""
        pairs = zip(*self.bounds(), strict=True)
        return [
            low * (high / low) ** u if _in_powers(low, high) else low + (high - low) * u
            for (low, high), u in zip(pairs, _items(unit), strict=True)
        ]

    def to_unit(self, values: Array) -> Array:
        """(k,) the inverse of `from_unit`, limited to [0, 1]; 0 for a fixed variable."""
        pairs = zip(*self.bounds(), strict=True)
        found = [
            math.log(max(v, low) / low) / math.log(high / low)
            if _in_powers(low, high)
            else (v - low) / ((high - low) or math.inf)
            for (low, high), v in zip(pairs, values, strict=True)
        ]
        return np.clip(found, 0.0, 1.0)

    @property
    def margins(self) -> tuple[str, ...]:
        """The margins of the objective and the requirements, each once."""
        return tuple(dict.fromkeys([self.objective, *(r.margin for r in self.requirements)]))

    def sizes(self, robot: Mechanism, poses: Array) -> dict[str, float]:
        """By margin, its largest finite modulus at the poses (p, n) of a robot; 1 if there is none above 0."""
        found = {}
        for margin in self.margins:
            values = np.abs(robot.margin(margin, poses, self.fvi_bounds, self.characteristic_length))
            found[margin] = float(values[np.isfinite(values)].max(initial=0.0)) or 1.0
        return found

    def starts(self) -> dict[str, int]:
        """The place of each field's first number in the geometry's vector."""
        sizes = self.robot.geometry.sizes()
        firsts = np.cumsum([0, *sizes.values()])[:-1]
        return {name: int(first) for name, first in zip(sizes, firsts, strict=True)}

    def places(self) -> list[int]:
        """The place of each variable in the geometry's vector."""
        starts = self.starts()
        return [starts[v.field] + v.item for v in self.variables]

    def summed(self, limit: SumLimit) -> list[list[int]]:
        """Places whose sum is limited, one list for each entry of the fields. A plain number is in every list."""
        starts, sizes = self.starts(), self.robot.geometry.sizes()
        entries = range(max(sizes[f] for f in limit.fields))
        return [[starts[f] + (k if sizes[f] > 1 else 0) for f in limit.fields] for k in entries]

    def allows(self, robot: Mechanism) -> bool:
        """Whether a robot's variables are within their bounds and its sums within their limits."""
        vector, (low, high) = robot.geometry.vector(), self.bounds()
        values = vector[self.places()]
        sums = (vector[places].sum() <= limit.at_most for limit in self.sums for places in self.summed(limit))
        return bool((low <= values).all() and (values <= high).all() and all(sums))

    def robot_with(self, values: Array) -> Mechanism:
        """The robot with the variables at these values (k,)."""
        vector = self.robot.geometry.vector()
        vector[self.places()] = values
        geometry = self.robot.Geometry.from_vector(vector)
        return self.robot.with_geometry(geometry)


@dataclass(frozen=True, eq=False)
class NlpSolution(Value):
    """The answer of IPOPT for one set of poses.

    Attributes:
        values: (k,) the variables.
        objective: the worst value of the objective over the poses.
        status: IPOPT's own status; `converged` is true only if it means an optimum.
        violations: the shortfall of each requirement or sum at the returned point, the largest first; empty if all
            hold.
        iterations: the number of iterations of the interior-point method.
        seconds: wall-clock time of the solver.
    """

    values: Array
    objective: float
    status: str
    converged: bool
    violations: dict[str, float]
    iterations: int
    seconds: float


def solve(
    problem: Problem, poses: Array, start: Array, sizes: Mapping[str, float] | None = None, seconds: float = math.inf
) -> NlpSolution:
    """Solve over the poses (p, n) from a start (k,).

    Args:
        sizes: the sizes of the margins, see `Problem.sizes`; by default those of the start at the poses.
        seconds: the solver stops after so much time, even if it has not converged.
    """
    started = time.perf_counter()
    if sizes is None:
        sizes = problem.sizes(problem.robot_with(start), poses)
    near, iterations = NearComponents(problem, poses, start), 0
    while True:
        left = seconds - (time.perf_counter() - started)
        answer = _solved(problem, poses, start, sizes, near.kept, left)
        iterations, taken = iterations + answer.iterations, time.perf_counter() - started
        more = near.grown(answer.values)
        if not more or taken >= seconds:
            return replace(answer, converged=answer.converged and not more, iterations=iterations, seconds=taken)


def _solved(
    problem: Problem,
    poses: Array,
    start: Array,
    sizes: Mapping[str, float],
    kept: Mapping[str, list[int]],
    seconds: float,
) -> NlpSolution:
    """With the `kept` components of each requirement only."""
    started = time.perf_counter()
    unit, t = ca.MX.sym("unit", len(start)), ca.MX.sym("t")
    geometry = ca.MX(problem.robot.geometry.vector())
    for place, value in zip(problem.places(), problem.from_unit(unit), strict=True):
        geometry[place] = value
    rows = {
        f"{r.margin} {r.bound}": _margin(problem, r.margin, poses, geometry, sizes, r.bound.value, kept[r.margin])
        - problem.spare
        for r in problem.requirements
    }
    rows |= {str(limit): _room_of_sum(problem, limit, geometry) for limit in problem.sums}
    objective = _margin(problem, problem.objective, poses, geometry, sizes)
    if (reach := _reach(problem, poses, geometry)).numel():
        rows[_REACH] = reach
    constraints = ca.vertcat(objective - t, *rows.values())
    first = problem.to_unit(start)
    nlp: dict[str, Any] = {"x": ca.vertcat(unit, t), "f": -t + _TIE * ca.sumsqr(unit - first), "g": constraints}
    lowest = float(np.nanmin(np.array(ca.Function("objective", [unit], [objective])(first)), initial=1.0))
    solver = ca.nlpsol("synthesis", "ipopt", nlp, _options(seconds))
    answer = solver(
        x0=np.append(first, lowest),
        lbx=np.append(0 * first, -np.inf),
        ubx=np.append(problem.moving(), np.inf),
        lbg=0.0,
        ubg=np.inf,
    )
    stats, x = solver.stats(), np.array(answer["x"]).ravel()
    return NlpSolution(
        values=np.array(problem.from_unit(x[:-1])),
        objective=problem.good(float(x[-1])) * sizes[problem.objective],
        status=stats["return_status"],
        converged=stats["return_status"] == "Solve_Succeeded",
        violations=_violations(rows, np.array(answer["g"]).ravel()[objective.shape[0] :]),
        iterations=int(stats["iter_count"]),
        seconds=time.perf_counter() - started,
    )


def _options(seconds: float) -> dict[str, Any]:
    return {
        "print_time": False,
        "error_on_fail": False,
        "show_eval_warnings": False,  # if a trial geometry cannot reach, IPOPT shortens its step
        "ipopt": {
            "print_level": 0,
            "sb": "yes",
            "tol": 1e-9,
            "max_iter": 400,
            "mu_strategy": "adaptive",
            "max_wall_time": min(max(seconds, 1e-3), 1e6),
        },
    }


def _in_powers(low: float, high: float) -> bool:
    return low > 0.0 and high >= _DECADES * low


def _items(vector: Any) -> list[Any]:
    """The entries of an array or of a vector of symbols."""
    return ca.vertsplit(vector) if isinstance(vector, ca.MX) else list(vector)


def _margin(
    problem: Problem,
    name: str,
    poses: Array,
    geometry: ca.MX,
    sizes: Mapping[str, float],
    bound: float = 0.0,
    kept: list[int] | None = None,
) -> ca.MX:
    """By how much the kept components of a margin, or all, keep a bound at all poses, over the margin's size."""
    components = problem.robot.margin_components(name, problem.fvi_bounds, problem.characteristic_length)
    components = components if kept is None else components[kept]
    room = problem.robot.margin_named(name).sense * (components - bound)
    return _mapped(problem, room / sizes[name], poses, geometry)


def _reach(problem: Problem, poses: Array, geometry: ca.MX) -> ca.MX:
    """The reach of the limbs that no margin of the problem needs, over the sum of the geometry's numbers."""
    model, measured = problem.robot.model(), (problem.fvi_bounds, problem.characteristic_length)
    needed = ca.vertcat(*(problem.robot.margin_components(name, *measured) for name in problem.margins))
    rows = reach_rows(problem.robot, needed)
    return _mapped(problem, rows / ca.sum1(ca.fabs(model.geometry)), poses, geometry)


def _mapped(problem: Problem, expressions: ca.SX, poses: Array, geometry: ca.MX) -> ca.MX:
    """Expressions in a pose and the geometry at all poses, as one column."""
    model = problem.robot.model()
    function = ca.Function("rows", [model.pose, model.geometry], [ca.cse(ca.densify(expressions))])
    return ca.vec(function.map(len(poses))(poses.T, ca.repmat(geometry, 1, len(poses))))


def _violations(rows: dict[str, ca.MX], values: Array) -> dict[str, float]:
    """Named shortfalls beyond the solver's tolerance; NaN (out of reach) counts as infinite."""
    starts = np.cumsum([row.shape[0] for row in rows.values()])[:-1]
    lowest = [np.nan_to_num(part, nan=-np.inf).min() for part in np.split(values, starts)] if rows else []
    short = {name: float(-low) for name, low in zip(rows, lowest, strict=True) if low < -1e-6}
    return dict(sorted(short.items(), key=lambda item: -item[1]))


def _room_of_sum(problem: Problem, limit: SumLimit, geometry: ca.MX) -> ca.MX:
    """The distance of each entry's sum below the limit, over the limit."""
    size = abs(limit.at_most) or 1.0
    totals = [sum((geometry[p] for p in places), ca.MX(0)) for places in problem.summed(limit)]
    return ca.vertcat(*((limit.at_most - total) / size - _SUM_SPARE for total in totals))


def active_sets(
    problem: Problem, robot: Mechanism, worst: Mapping[str, WorstPoses], closeness: float = 1e-3
) -> list[str]:
    """The bounds, sums and requirements that limit the optimum, in words.

    Args:
        worst: the worst value of each requirement's margin.
        closeness: how close counts as at the limit, relative to the variable's range, the sum's limit, or the margin's
            size.
    """
    found = []
    vector = robot.geometry.vector()
    sizes = robot.geometry.sizes()
    for bound, unit in zip(problem.variables, problem.to_unit(vector[problem.places()]), strict=True):
        item = f"[{bound.item}]" if sizes[bound.field] > 1 else ""
        found += [
            f"{bound.field}{item} at its {side} bound {edge:g}"
            for side, edge, at in (("lower", bound.low, 0.0), ("upper", bound.high, 1.0))
            if bound.low < bound.high and abs(unit - at) <= closeness
        ]
    for limit in problem.sums:
        total = max(vector[places].sum() for places in problem.summed(limit))
        if total >= limit.at_most - closeness * abs(limit.at_most):
            found.append(f"{' + '.join(limit.fields)} at its upper bound {limit.at_most:g}")
    for requirement in problem.requirements:
        near = worst[requirement.margin]
        required, side = requirement.bound, "lower" if requirement.bound.sense > 0 else "upper"
        size = max(abs(required.value), np.nan_to_num(near.typical))
        if required.room(near.value) <= closeness * size:
            found.append(f"{requirement.margin} at its {side} bound {required.value:g}")
    return found
