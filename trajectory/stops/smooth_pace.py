"""The pace of least mean square on given knots: linear programmes, each with its tangents at the answer before it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kinematics import Array
from trajectory.stops.smooth_braking_rows import JerkRows, LinearRows, Rows, tangent_rows

if TYPE_CHECKING:
    from scipy.sparse import csr_array

INSTANTS = np.linspace(0.0, 1.0, 9)  # of each interval, where its rows stand
_LOWEST = 0.01  # pace: slower ones have their tangents here
_CONVERGED = 1e-3  # relative, of the mean square
_ROUNDS = 50
_SOLVED, _INFEASIBLE = 0, 2  # of linprog
_NEAR = 0.02  # of a limit: rows that are so close to it are in the first programme
_KEPT = 1e-9  # of a limit: what a programme's answer may be over a row that is not in it
_NEXT = 0.02  # of a limit: rows that are so close to it come in with those that are over it


class Pace(NamedTuple):
    """x = tau'^2 and b = -tau'' at times tau of the motion, (n + 1,) each; b is linear in tau between them."""

    tau: Array
    x: Array
    b: Array

    @property
    def square(self) -> float:
        """Integral of x [s]."""
        return float(np.trapezoid(self.x, self.tau))


def least_pace(rows: Rows, jerk: JerkRows, near: Pace, margin: float) -> Pace | None:
    """From pace 1 with b = 0, b never negative, to b = 0: that of least mean square, None if there is none.

    Args:
        rows, jerk: at `INSTANTS` of the n intervals.
        near: a guess, whose tau are the knots.
        margin: as for `tangent_rows`.
    """
    best = None
    for _ in range(_ROUNDS):
        found = _with_tangents(rows, jerk, near, margin)
        if found is None:
            if best is not None or (near.x == 1.0).all():
                return best
            near = near._replace(x=np.ones_like(near.x), b=np.zeros_like(near.b))
            continue
        if best is not None and abs(best.square - found.square) <= _CONVERGED * best.square:
            return found
        best = near = found
    return None


def _with_tangents(rows: Rows, jerk: JerkRows, near: Pace, margin: float) -> Pace | None:
    """With the tangents at `near`. Few rows matter: those over which an answer without them goes come in."""
    ends = np.maximum(near.x, _LOWEST**2)
    pace = np.sqrt(ends)
    inside = (1.0 - INSTANTS) * ends[:-1, None] + INSTANTS * ends[1:, None]
    linear = tangent_rows(rows, jerk, inside, 0.5 * (pace[1:] + pace[:-1]), margin)
    active = _over(linear, near) > -_NEAR
    active[:, 0] = True
    active[:, -1, rows.most.shape[-1] :] = True  # the jerk's, which jumps at the knots
    while True:
        found = _programme(linear, active, pace, near.tau)
        if found is None:
            return None
        over = _over(linear, found)
        if not ((over > _KEPT) & ~active).any():
            return found
        active |= over > -_NEXT


def _over(rows: LinearRows, pace: Pace) -> Array:
    """(n, j, rows) by how much a pace is over the rows."""
    step = np.diff(pace.tau)[:, None]
    c = (pace.b[:-1] - pace.b[1:])[:, None] / step
    b = (1.0 - INSTANTS) * pace.b[:-1, None] + INSTANTS * pace.b[1:, None]
    x = (1.0 - INSTANTS) * pace.x[:-1, None] + INSTANTS * (pace.x[1:, None] - (1.0 - INSTANTS) * step**2 * c)
    found: Array = rows.by_x * x[..., None] + rows.by_b * b[..., None] + rows.by_c * c[..., None] - rows.most
    return found


def _programme(rows: LinearRows, active: Array, pace: Array, tau: Array) -> Pace | None:
    """The least integral of x under the active rows; variables x and, over the length of tau, b at the knots.

    x falls by twice the integral of b, which for a b that is linear in time, as it is where the jerk is constant, is
    weighted by the pace: more at an interval's faster end.
    """
    from scipy.optimize import linprog  # slow to import, as scipy.sparse is

    n, length = tau.size - 1, tau[-1] - tau[0]
    steps = np.diff(tau) / length
    k, instant, _ = np.nonzero(active)
    share, step = INSTANTS[instant], steps[k]
    by_x, by_b, by_c = (part[active] / length**power for power, part in enumerate(rows[:3]))
    by_c = by_c / step - by_x * share * (1.0 - share) * step
    limited = _matrix(
        (by_x * (1.0 - share), k),
        (by_x * share, k + 1),
        (by_b * (1.0 - share) + by_c, k + n + 1),
        (by_b * share - by_c, k + n + 2),
        columns=2 * n + 2,
    )
    first, one = steps * 2.0 * (2.0 * pace[:-1] + pace[1:]) / (3.0 * (pace[:-1] + pace[1:])), np.ones(n)
    k = np.arange(n)
    falls = _matrix((-one, k), (one, k + 1), (first, k + n + 1), (2.0 * steps - first, k + n + 2), columns=2 * n + 2)
    low, high = np.zeros(2 * n + 2), np.concatenate([np.ones(n + 1), [0.0], np.full(n - 1, np.inf), [0.0]])
    low[0] = 1.0
    mean = np.concatenate([np.append(steps, 0.0) + np.append(0.0, steps), np.zeros(n + 1)]) / 2.0
    bounds = np.stack([low, high], axis=1)
    for presolve in (False, True):  # each now and then ends without a verdict, where the other one finds it
        options = {"primal_feasibility_tolerance": _KEPT, "presolve": presolve}
        answer = linprog(mean, limited, rows.most[active], falls, np.zeros(n), bounds, "highs-ds", options=options)
        if answer.status in (_SOLVED, _INFEASIBLE):
            break
    if answer.status != _SOLVED:
        return None
    x, b = np.split(np.maximum(answer.x, 0.0), 2)
    return Pace(tau, x, b / length)


def _matrix(*parts: tuple[Array, Array], columns: int) -> csr_array:
    """One row for each entry of the parts: values and their columns."""
    from scipy.sparse import coo_array

    values, where = (np.concatenate(part) for part in zip(*parts, strict=True))
    rows = np.tile(np.arange(parts[0][0].size), len(parts))
    return coo_array((values, (rows, where)), shape=(parts[0][0].size, columns)).tocsr()
