"""One max-min NLP over a fixed set of poses, in epigraph form, solved by IPOPT.

Maximise t subject to: every component of the objective margin is at least t at every pose; every requirement holds at
every pose with a little to spare; the geometry stays within its bounds and sums. Gradients and Hessians come from the
mechanism's own expressions by automatic differentiation.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from design.requirement import Bounds, Requirement, SumLimit
from kinematics import FviBounds, Mechanism

Array = np.ndarray


@dataclass(frozen=True)
class Problem:
    """What is to be optimised, whatever the poses.

    Attributes:
        robot: the prototype; fields that are no variables keep its values.
        objective: the margin whose worst value is maximised.
        variables, requirements, sums: as named.
        fvi_bounds, characteristic_length: what the FVI is measured with; the length stays while the geometry varies.
        spare: how much more than its bound each requirement gets in the NLP, so that it holds between the poses too.
    """

    robot: Mechanism
    objective: str
    variables: tuple[Bounds, ...]
    requirements: tuple[Requirement, ...]
    sums: tuple[SumLimit, ...]
    fvi_bounds: FviBounds
    characteristic_length: float
    spare: float = 1e-4

    def bounds(self) -> tuple[Array, Array]:
        """(k,) lowest and (k,) highest values of the variables."""
        return np.array([v.low for v in self.variables]), np.array([v.high for v in self.variables])

    def starts(self) -> dict[str, int]:
        """Where each field's first number stands in the geometry's vector."""
        sizes = self.robot.geometry.sizes()
        firsts = np.cumsum([0, *sizes.values()])[:-1]
        return {name: int(first) for name, first in zip(sizes, firsts, strict=True)}

    def places(self) -> list[int]:
        """Where each variable stands in the geometry's vector."""
        starts = self.starts()
        return [starts[v.field] + v.item for v in self.variables]

    def summed(self, limit: SumLimit) -> list[list[int]]:
        """Places whose sum is limited, one list for each entry of the fields; a plain number counts in every one."""
        starts, sizes = self.starts(), self.robot.geometry.sizes()
        entries = range(max(sizes[f] for f in limit.fields))
        return [[starts[f] + (k if sizes[f] > 1 else 0) for f in limit.fields] for k in entries]

    def geometry(self, values: Array) -> Array:
        """The geometry's vector with the variables at these values."""
        vector = self.robot.geometry.vector()
        vector[self.places()] = values
        return vector


@dataclass(frozen=True)
class NlpSolution:
    """What IPOPT returned for one set of poses.

    Attributes:
        values: (k,) the variables.
        objective: t, the worst objective over the poses.
        status: IPOPT's own words; `converged` only where they mean an optimum.
        violations: by how much each requirement or sum falls short at the returned point, the largest first; empty when
            all hold.
        iterations: of the interior-point method.
        seconds: wall-clock time of the solve.
    """

    values: Array
    objective: float
    status: str
    converged: bool
    violations: dict[str, float]
    iterations: int
    seconds: float


def solve(problem: Problem, poses: Array, start: Array) -> NlpSolution:
    """Solve over the poses (p, n) from a start (k,)."""
    low, high = problem.bounds()
    span = high - low
    scaled, t = ca.MX.sym("scaled", len(low)), ca.MX.sym("t")
    values = low + span * scaled
    geometry = ca.MX(problem.robot.geometry.vector())
    for k, place in enumerate(problem.places()):
        geometry[place] = values[k]
    rows = {
        f"{r.margin} >= {r.at_least:g}": _mapped(problem, r.margin, poses, geometry) - (r.at_least + problem.spare)
        for r in problem.requirements
    }
    rows |= {str(limit): limit.at_most - _sums(problem, limit, geometry) for limit in problem.sums}
    epigraph = _mapped(problem, problem.objective, poses, geometry) - t
    nlp: dict[str, Any] = {"x": ca.vertcat(scaled, t), "f": -t, "g": ca.vertcat(epigraph, *rows.values())}
    solver = ca.nlpsol("synthesis", "ipopt", nlp, _OPTIONS)
    first = np.clip((start - low) / span, 0.0, 1.0)
    started = time.perf_counter()
    answer = solver(
        x0=np.append(first, 0.5),
        lbx=np.append(0 * low, -np.inf),
        ubx=np.append(0 * low + 1, np.inf),
        lbg=0.0,
        ubg=np.inf,
    )
    stats, x = solver.stats(), np.array(answer["x"]).ravel()
    return NlpSolution(
        values=low + span * x[:-1],
        objective=float(x[-1]),
        status=stats["return_status"],
        converged=stats["return_status"] == "Solve_Succeeded",
        violations=_violations(rows, np.array(answer["g"]).ravel()[epigraph.shape[0] :]),
        iterations=int(stats["iter_count"]),
        seconds=time.perf_counter() - started,
    )


_OPTIONS: dict[str, Any] = {
    "print_time": False,
    "error_on_fail": False,
    "show_eval_warnings": False,  # the line search may try a geometry that cannot reach; IPOPT then shortens its step
    "ipopt": {"print_level": 0, "sb": "yes", "tol": 1e-9, "max_iter": 400, "mu_strategy": "adaptive"},
}


def _mapped(problem: Problem, margin: str, poses: Array, geometry: ca.MX) -> ca.MX:
    """All components of a margin at all poses, as one column."""
    model = problem.robot.model()
    components = problem.robot.margin_components(margin, problem.fvi_bounds, problem.characteristic_length)
    function = ca.Function(margin, [model.pose, model.geometry], [ca.cse(components)])
    return ca.vec(function.map(len(poses))(poses.T, ca.repmat(geometry, 1, len(poses))))


def _violations(rows: dict[str, ca.MX], values: Array) -> dict[str, float]:
    """Named shortfalls beyond the solver's tolerance; NaN (out of reach) counts as infinite."""
    starts = np.cumsum([row.shape[0] for row in rows.values()])[:-1]
    lowest = [np.nan_to_num(part, nan=-np.inf).min() for part in np.split(values, starts)] if rows else []
    short = {name: float(-low) for name, low in zip(rows, lowest, strict=True) if low < -1e-6}
    return dict(sorted(short.items(), key=lambda item: -item[1]))


def _sums(problem: Problem, limit: SumLimit, geometry: ca.MX) -> ca.MX:
    return ca.vertcat(*(sum((geometry[p] for p in places), ca.MX(0)) for places in problem.summed(limit)))


def active_sets(problem: Problem, robot: Mechanism, worst: dict[str, float], closeness: float = 1e-3) -> list[str]:
    """Which bounds, sums and requirements hold the optimum back, in words.

    Args:
        worst: worst value of each requirement's margin.
        closeness: relative, to the variable's range or to the bound.
    """
    found = []
    vector = robot.geometry.vector()
    sizes = robot.geometry.sizes()
    for bound, value in zip(problem.variables, vector[problem.places()], strict=True):
        item = f"[{bound.item}]" if sizes[bound.field] > 1 else ""
        found += [
            f"{bound.field}{item} at its {side} bound {edge:g}"
            for side, edge in (("lower", bound.low), ("upper", bound.high))
            if abs(value - edge) <= closeness * (bound.high - bound.low)
        ]
    for limit in problem.sums:
        total = max(vector[places].sum() for places in problem.summed(limit))
        if total >= limit.at_most * (1.0 - closeness):
            found.append(f"{' + '.join(limit.fields)} at its upper bound {limit.at_most:g}")
    found += [
        f"{requirement.margin} at its lower bound {requirement.at_least:g}"
        for requirement in problem.requirements
        if worst[requirement.margin]
        <= requirement.at_least + max(2 * problem.spare, closeness * abs(requirement.at_least))
    ]
    return found
