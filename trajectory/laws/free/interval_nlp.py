"""Nonlinear programs over equal intervals of time, each with the same constraints, for IPOPT.

The unknowns are the pose and its first three derivatives w_k at the start of every interval, the state at the end, and
the duration T. Derivatives are by t / T, so that intervals are joined by constant linear equations. Constraints are
functions of (w_k, T), and sums over the intervals of another function. Jacobian and Hessian consist of equal blocks,
one for each interval. So one block is written out, which is far smaller than the derivatives of the whole program.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from kinematics import CORES, Array


@dataclass(frozen=True, eq=False)
class IntervalConstraints:
    """The constraints of each interval, as expressions in the symbols `start` (4 n,) and `duration`.

    Attributes:
        start: (4 n,) pose and its derivatives by t / T at the start of the interval.
        duration: T [s].
        local: (c,) expressions that must be between `low` and `high` (c,) in each interval.
        summed: (e,) expressions whose sum over the intervals must be at most 1.
    """

    start: ca.SX
    duration: ca.SX
    local: ca.SX
    low: Array
    high: Array
    summed: ca.SX


@dataclass(frozen=True, eq=False)
class Answer:
    """The answer of IPOPT. It is a solution only if `status` is "Solve_Succeeded". Derivatives are by t / T."""

    status: str
    start: Array  # (k, 4 n)
    duration: float


class IntervalProgram:
    """The program of the fastest motion over equal intervals. It is built once and solved from several starts."""

    def __init__(self, constraints: IntervalConstraints, intervals: int) -> None:
        self._constraints, self._intervals = constraints, intervals
        self._size = constraints.start.numel()
        count, size, cores = intervals, self._size, CORES
        unknowns = ca.MX.sym("unknowns", count * size + 3 * size // 4 + 1)
        starts = ca.reshape(unknowns[: count * size], size, count)
        durations = ca.repmat(unknowns[-1], 1, count)
        joins = self._joins(unknowns.numel())
        values, jacobian, hessian = self._blocks()
        local, summed = values.map(count)(starts, durations)
        every = ca.vertcat(joins @ unknowns, ca.vec(local), ca.sum2(summed))
        nothing = ca.MX.sym("nothing", 0)
        multipliers, scale = ca.MX.sym("multipliers", every.numel()), ca.MX.sym("scale")
        parts = jacobian.map(count, "thread", cores).call([starts, durations])
        slopes = ca.vertcat(ca.MX(joins), self._jacobian(parts, unknowns.numel()))
        names = ["x", "p", "lam_f", "lam_g"]
        in_blocks = self._multipliers(multipliers, joins.shape[0])
        parts = hessian.map(count, "thread", cores).call([starts, durations, *in_blocks])
        curvature = self._hessian(parts, unknowns.numel())
        options: dict[str, Any] = {
            "jac_g": ca.Function("slopes", [unknowns, nothing], [every, slopes], names[:2], ["g", "jac_g_x"]),
            "hess_lag": ca.Function(
                "curvature", [unknowns, nothing, scale, multipliers], [curvature], names, ["triu_hess_gamma_x_x"]
            ),
            "print_time": False,
            "show_eval_warnings": False,
            "ipopt": {"print_level": 0, "sb": "yes", "tol": 1e-6, "max_iter": 400},
        }
        c, joined, sums = constraints, np.zeros(joins.shape[0]), np.ones(constraints.summed.numel())
        self._low = np.concatenate([joined, np.tile(c.low, count), -np.inf * sums])
        self._high = np.concatenate([joined, np.tile(c.high, count), sums])
        self._solver = ca.nlpsol("free", "ipopt", {"x": unknowns, "f": unknowns[-1], "g": every}, options)

    def solve(self, guess: Array, end: Array, low: Array, high: Array, duration: float) -> Answer:
        """The best motion from a start.

        Args:
            guess: (k, 4 n) the state at the start of each interval; that of the first row is fixed.
            end: (3 n,) the state at the end, which is fixed.
            low, high: (n,) bounds of the pose.
            duration: duration of the guess [s].
        """
        n = self._size // 4
        first = np.concatenate([guess.ravel(), end, [duration]])
        least, most = np.full(first.size, -np.inf), np.full(first.size, np.inf)
        for k in range(self._intervals + 1):
            at = slice(k * self._size, k * self._size + n)
            least[at], most[at] = low, high
        for at in (slice(0, 3 * n), slice(self._intervals * self._size, first.size - 1)):
            least[at] = most[at] = first[at]
        least[-1], most[-1] = 0.05 * duration, 20.0 * duration
        found = self._solver(x0=first, lbx=least, ubx=most, lbg=self._low, ubg=self._high)
        x = np.array(found["x"])[:, 0]
        status = str(self._solver.stats()["return_status"])
        return Answer(status, x[: self._intervals * self._size].reshape(self._intervals, self._size), float(x[-1]))

    def _joins(self, unknowns: int) -> ca.DM:
        """(3 n k, unknowns) the difference of the state at the end of each interval from the next one's start."""
        n, count, h = self._size // 4, self._intervals, 1.0 / self._intervals
        one = np.array([[1.0, h, h**2 / 2, h**3 / 6], [0.0, 1.0, h, h**2 / 2], [0.0, 0.0, 1.0, h]])
        row, column, value = list[Array](), list[Array](), list[Array]()
        for derivative, across in enumerate(one):
            for order, factor in enumerate(across):
                rows = np.arange(count)[:, None] * 3 * n + derivative * n + np.arange(n)
                columns = np.arange(count)[:, None] * self._size + order * n + np.arange(n)
                if factor:
                    row, column, value = [*row, rows], [*column, columns], [*value, np.full(rows.shape, factor)]
                if order == derivative:
                    row, column = [*row, rows], [*column, columns + self._size]
                    value.append(np.full(rows.shape, -1.0))
        rows, columns, values = (np.concatenate([part.ravel() for part in parts]) for parts in (row, column, value))
        return ca.DM.triplet(rows.tolist(), columns.tolist(), ca.DM(values), 3 * n * count, unknowns)

    def _blocks(self) -> tuple[ca.Function, ca.Function, ca.Function]:
        """Of one interval: the constraints; their derivatives by start and duration; their curvature."""
        c = self._constraints
        both, unknowns = ca.vertcat(c.local, c.summed), ca.vertcat(c.start, c.duration)
        weights = ca.SX.sym("weights", both.numel())
        slopes, curvature = ca.jacobian(both, unknowns), ca.hessian(ca.dot(weights, both), unknowns)[0]
        size, local = self._size, c.local.numel()
        inputs, options = [c.start, c.duration], {"cse": True}
        first = [slopes[:local, :size], slopes[:local, size], slopes[local:, :size], slopes[local:, size]]
        upper = ca.project(ca.densify(curvature[:size, :size]), ca.Sparsity.upper(size)).nz[:]
        second = [upper, ca.densify(curvature[:size, size]), ca.densify(curvature[size, size])]
        return (
            ca.Function("values", inputs, [c.local, c.summed], options),
            ca.Function("slopes", inputs, [ca.densify(v) for v in first], options),
            ca.Function("curvature", [*inputs, weights[:local], weights[local:]], second, options),
        )

    def _jacobian(self, blocks: Sequence[ca.MX], unknowns: int) -> ca.MX:
        """(c k + e, unknowns) from the blocks side by side."""
        local, by_duration, summed, summed_by_duration = blocks
        rows = self._constraints.local.numel() * self._intervals
        size, count = self._size, self._intervals
        of_block = np.arange(rows).reshape(count, 1, -1)
        row = np.broadcast_to(of_block, (count, size, of_block.shape[-1]))
        column = np.broadcast_to(np.arange(count * size).reshape(count, size, 1), row.shape)
        row, column = np.append(row, np.arange(rows)), np.append(column, np.full(rows, unknowns - 1))
        pattern = ca.Sparsity.triplet(rows, unknowns, row.tolist(), column.tolist())
        top = ca.MX(pattern, ca.vertcat(ca.vec(local), ca.vec(by_duration)))
        between = ca.MX.zeros(summed.shape[0], unknowns - count * size - 1)
        return ca.vertcat(top, ca.horzcat(summed, between, ca.sum2(summed_by_duration)))

    def _multipliers(self, multipliers: ca.MX, joined: int) -> tuple[ca.MX, ca.MX]:
        """Those of each interval's own constraints, (c, k), and of the sums, the same for all (e, k)."""
        local = self._constraints.local.numel()
        own = multipliers[joined : joined + local * self._intervals]
        shared = multipliers[joined + local * self._intervals :]
        return ca.reshape(own, local, self._intervals), ca.repmat(shared, 1, self._intervals)

    def _hessian(self, blocks: Sequence[ca.MX], unknowns: int) -> ca.MX:
        """The upper triangle, (unknowns, unknowns), from the blocks side by side."""
        size, count = self._size, self._intervals
        across, down = np.tril_indices(size)  # column by column: the upper triangle's rows rise first
        first = np.arange(count)[:, None] * size
        ends = np.arange(count * size)
        row = np.concatenate([(first + down).ravel(), ends, [unknowns - 1]])
        column = np.concatenate([(first + across).ravel(), np.full(ends.size + 1, unknowns - 1)])
        pattern = ca.Sparsity.triplet(unknowns, unknowns, row.tolist(), column.tolist())
        inside, by_duration, twice = blocks
        return ca.MX(pattern, ca.vertcat(ca.vec(inside), ca.vec(by_duration), ca.sum2(twice)))
