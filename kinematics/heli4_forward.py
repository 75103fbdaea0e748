"""Two parallel plates hung by two rods each: where they can be, in closed form.

Plate 1 is at (x, y, Z), plate 2 at (x, y, W). Each rod is a sphere |X + s_i|^2 = l^2 with X = (x, y, Z) for rods 1 and
2 and (x, y, W) for 3 and 4. With u = Z + W and v = Z - W, the differences within the pairs give x and y linearly in u
and v, the difference of the pairs' means is bilinear, u v + alpha u + beta v + gamma = 0, and their sum leaves a
quartic in w = u + beta. Unlike expressions (19)-(35) of Heli4's paper it divides by nothing that vanishes in the
workspace, and its smallest real root is the working assembly mode: both pairs of rods on the lower sheet.
"""

from __future__ import annotations

from types import SimpleNamespace

import casadi as ca

Polynomial = list[ca.SX]  # highest power first


def _forms(s: ca.SX, rod_length: ca.SX) -> SimpleNamespace:
    """The linear and bilinear forms above, from s (3, 4)."""
    squares = ca.sum1(s * s).T - rod_length**2
    first, second = s[:, 0] - s[:, 1], s[:, 2] - s[:, 3]
    det = first[0] * second[1] - first[1] * second[0]
    solve = ca.vertcat(ca.horzcat(second[1], -first[1]), ca.horzcat(-second[0], first[0])) / det
    by_u = -solve @ ca.vertcat(first[2], second[2]) / 2
    by_v = -solve @ ca.vertcat(first[2], -second[2]) / 2
    constant = -solve @ ca.vertcat(squares[0] - squares[1], squares[2] - squares[3]) / 2
    a, b = (s[:, 0] + s[:, 1]) / 2, (s[:, 2] + s[:, 3]) / 2
    apart = 2 * (a[:2] - b[:2])
    return SimpleNamespace(
        by_u=by_u,
        by_v=by_v,
        constant=constant,
        alpha=apart.T @ by_u + a[2] - b[2],
        beta=apart.T @ by_v + a[2] + b[2],
        gamma=apart.T @ constant + (squares[0] + squares[1] - squares[2] - squares[3]) / 2,
        together=2 * (a[:2] + b[:2]),
        a_z=a[2],
        b_z=b[2],
        squares=ca.sum1(squares) / 2,
    )


def quartic(s: ca.SX, rod_length: ca.SX) -> ca.SX:
    """(5,) coefficients in w, highest power first; x, y, u and v enter multiplied by w."""
    f = _forms(s, rod_length)
    uw: Polynomial = [ca.SX(1), -f.beta, ca.SX(0)]
    vw: Polynomial = [-f.alpha, f.alpha * f.beta - f.gamma]
    xw, yw = (_add(_scale(f.by_u[k], uw), _scale(f.by_v[k], vw), [f.constant[k], ca.SX(0)]) for k in range(2))
    linear = _add(
        _scale(f.together[0], xw),
        _scale(f.together[1], yw),
        _scale(f.a_z + f.b_z, uw),
        _scale(f.a_z - f.b_z, vw),
        [f.squares, ca.SX(0)],
    )
    half = ca.SX(0.5)
    squares = _add(
        _scale(ca.SX(2), _multiply(xw, xw)),
        _scale(ca.SX(2), _multiply(yw, yw)),
        _scale(half, _multiply(uw, uw)),
        _scale(half, _multiply(vw, vw)),
    )
    return ca.vertcat(*_add(squares, [*linear, ca.SX(0)]))


def plates_of_root(w: ca.SX, s: ca.SX, rod_length: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
    """(x, y), Z and W that belong to a root of the quartic."""
    f = _forms(s, rod_length)
    u = w - f.beta
    v = -(f.alpha * u + f.gamma) / w
    return f.by_u * u + f.by_v * v + f.constant, (u + v) / 2, (u - v) / 2


def _multiply(p: Polynomial, q: Polynomial) -> Polynomial:
    result = [ca.SX(0)] * (len(p) + len(q) - 1)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            result[i + j] = result[i + j] + a * b
    return result


def _scale(factor: ca.SX, p: Polynomial) -> Polynomial:
    return [factor * c for c in p]


def _add(*polynomials: Polynomial) -> Polynomial:
    size = max(len(p) for p in polynomials)
    result = [ca.SX(0)] * size
    for p in polynomials:
        for i, a in enumerate(p):
            result[size - len(p) + i] = result[size - len(p) + i] + a
    return result
