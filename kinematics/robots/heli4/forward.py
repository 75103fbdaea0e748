"""Two parallel plates hung by two rods each: where they can be, in closed form.

Plate 1 is at (x, y, Z), plate 2 at (x, y, W). Each rod is a sphere |X + s_i|^2 = l^2 with X = (x, y, Z) for rods 1 and
2 and (x, y, W) for 3 and 4. With u = Z + W and v = Z - W, the differences within the pairs give x and y linearly in u
and v, and the difference of the pairs' means is bilinear, u v + alpha u + beta v + gamma = 0. In w = u + beta and
t = v + alpha that is w t = kappa, and the sum of the means is a conic; together they leave a quartic in w, and the
same one backwards in t. Unlike expressions (19)-(35) of Heli4's paper nothing here divides by what vanishes in the
workspace. The smallest real w is the working assembly mode: both pairs of rods on the lower sheet.
"""

from __future__ import annotations

from typing import NamedTuple

import casadi as ca


class Plates(NamedTuple):
    """w t = kappa and a w^2 + b w t + c t^2 + d w + e t + f = 0, and the position that belongs to (w, t)."""

    kappa: ca.SX
    conic: tuple[ca.SX, ca.SX, ca.SX, ca.SX, ca.SX, ca.SX]
    by_w: ca.SX  # (4,) of x, y, Z, W
    by_t: ca.SX
    constant: ca.SX

    def quartic_in_w(self) -> ca.SX:
        """(5,) coefficients, highest power first."""
        a, b, c, d, e, f = self.conic
        return ca.vertcat(a, d, f + b * self.kappa, e * self.kappa, c * self.kappa**2)

    def quartic_in_t(self) -> ca.SX:
        """(5,) the same with the unknowns exchanged, sharp where w is small."""
        a, b, c, d, e, f = self.conic
        return ca.vertcat(c, e, f + b * self.kappa, d * self.kappa, a * self.kappa**2)

    def positions(self, w: ca.SX, t: ca.SX) -> ca.SX:
        """(4,) x, y, Z, W."""
        return self.by_w * w + self.by_t * t + self.constant


def plates(s: ca.SX, rod_length: ca.SX) -> Plates:
    """From s (3, 4) and the rods' common length."""
    squares = ca.sum1(s * s).T - rod_length**2
    first, second = s[:, 0] - s[:, 1], s[:, 2] - s[:, 3]
    det = first[0] * second[1] - first[1] * second[0]
    solve = -ca.vertcat(ca.horzcat(second[1], -first[1]), ca.horzcat(-second[0], first[0])) / (2 * det)
    by_u = solve @ ca.vertcat(first[2], second[2])
    by_v = solve @ ca.vertcat(first[2], -second[2])
    constant = solve @ ca.vertcat(squares[0] - squares[1], squares[2] - squares[3])
    a, b = (s[:, 0] + s[:, 1]) / 2, (s[:, 2] + s[:, 3]) / 2
    apart, together = 2 * (a[:2] - b[:2]), 2 * (a[:2] + b[:2])
    alpha = apart.T @ by_u + a[2] - b[2]
    beta = apart.T @ by_v + a[2] + b[2]
    gamma = apart.T @ constant + (squares[0] + squares[1] - squares[2] - squares[3]) / 2
    centre = constant - by_u * beta - by_v * alpha  # x and y at w = t = 0
    slope = 4 * centre + together
    conic = (
        2 * ca.sumsqr(by_u) + 0.5,
        4 * ca.dot(by_u, by_v),
        2 * ca.sumsqr(by_v) + 0.5,
        ca.dot(slope, by_u) + a[2] + b[2] - beta,
        ca.dot(slope, by_v) + a[2] - b[2] - alpha,
        ca.dot(2 * centre + together, centre)
        + (beta / 2 - a[2] - b[2]) * beta
        + (alpha / 2 - a[2] + b[2]) * alpha
        + ca.sum1(squares) / 2,
    )
    return Plates(
        kappa=alpha * beta - gamma,
        conic=conic,
        by_w=ca.vertcat(by_u, 0.5, 0.5),
        by_t=ca.vertcat(by_v, 0.5, -0.5),
        constant=ca.vertcat(centre, -(alpha + beta) / 2, (alpha - beta) / 2),
    )
