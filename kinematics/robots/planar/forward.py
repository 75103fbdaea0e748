"""The forward model of every planar robot with three legs: three points of a plate are on three circles.

Points of the plane are complex numbers. Platform point b_i lies on the circle of centre c_i and radius r_i: with
u_i = c_i - b_i exp(i theta), the position p is at r_i from u_i. For q = p - u_1 and d_k = u_k - u_1: |q| = r_1 and
q . d_k = f_k = (|d_k|^2 + r_1^2 - r_k^2) / 2, k = 2, 3, so that

    |f_2 d_3 - f_3 d_2|^2 = r_1^2 (d_2 x d_3)^2.

Every |d_k|^2, d_2 . d_3, d_2 x d_3 and f_k is of degree one in cos and sin of theta, the whole of degree three: a
sextic in tan(theta / 2), and the same one backwards in cot(theta / 2), which serves around theta = pi.
"""

from __future__ import annotations

import numpy as np

from kinematics.arrays import Array
from kinematics.mathematics import product, real_roots

_CHART = 1.1  # each of tan and cot serves up to here; between 1 / 1.1 and 1.1 both do
_CANDIDATE = 1e-5  # error of the third circle, over the size squared, from where Newton's method starts
_CLOSED = 4e-15  # the same where it has converged, to rounding: between near solutions less would not tell
_BLOCK = 50_000  # rows at a time


def placements(centres: Array, radii: Array, points: Array, every: bool = False) -> tuple[Array, Array, Array]:
    """Isolated placements of the plate.

    Args:
        centres, radii: (k, 3) complex c_i and r_i of k problems.
        points: (3,) complex b_i.
        every: also use the stationary points of the sextic, for two placements that have the same angle by symmetry.

    Returns:
        rows (j,): the problem of each placement; p (j,) complex and theta (j,) in (-pi, pi]. A placement may appear
        more than once.
    """
    blocks = range(0, max(len(centres), 1), _BLOCK)
    found = [_placements(centres[s : s + _BLOCK], radii[s : s + _BLOCK], points, every) for s in blocks]
    rows = [start + rows for start, (rows, _, _) in zip(blocks, found, strict=True)]
    return np.concatenate(rows), np.concatenate([f[1] for f in found]), np.concatenate([f[2] for f in found])


def rods_and_determinant(p: Array, theta: Array, centres: Array, points: Array) -> tuple[Array, Array, Array]:
    """(k, 3) complex rods from c_i, (k, 3) their moments about p, and (k,) the determinant of these as three lines."""
    turned = np.exp(1j * theta)[:, None] * points
    rods = p[:, None] + turned - centres
    moments = (turned.conj() * rods).imag
    pairs = _cross(np.roll(rods, -1, axis=1), np.roll(rods, -2, axis=1))
    return rods, moments, np.sum(moments * pairs, axis=1)


def _placements(centres: Array, radii: Array, points: Array, every: bool) -> tuple[Array, Array, Array]:
    size = np.abs(centres - centres[:, :1]).max(axis=1) + np.abs(points - points[0]).max() + radii.max(axis=1)
    posed = np.flatnonzero((radii >= 0.0).all(axis=1) & np.isfinite(size))
    unit = size[posed, None]
    c, r, b = (centres - centres[:, :1])[posed] / unit, radii[posed] / unit, (points - points[0]) / unit
    rows, theta = _angles(_sextic(c, r, b), every)
    c, r, b, rows = c[rows], r[rows], b[rows], posed[rows]
    turned = np.exp(1j * theta)[:, None] * b
    d = c[:, 1:] - c[:, :1] - turned[:, 1:] + turned[:, :1]
    far = np.abs(d[:, 0]) < np.abs(d[:, 1])  # the farther of the circles 2 and 3 meets circle 1 more sharply
    d, others = np.where(far[:, None], d[:, ::-1], d), np.where(far[:, None], r[:, :0:-1], r[:, 1:])
    square = np.abs(d[:, 0]) ** 2
    f = (square + r[:, 0] ** 2 - others[:, 0] ** 2) / 2
    height = np.sqrt(np.maximum(r[:, 0] ** 2 * square - f**2, 0.0))
    result = []
    for side in (1.0, -1.0):
        q = np.divide((f + side * 1j * height) * d[:, 0], square, out=np.full(len(f), np.nan + 0j), where=square > 0.0)
        near = np.abs(np.abs(q - d[:, 1]) ** 2 - others[:, 1] ** 2) < _CANDIDATE
        p, angle, error = _polished(q[near], theta[near], c[near], r[near], b[near], 20 if every else 4)
        closed = error <= _CLOSED
        place = rows[near][closed]
        turn = np.exp(1j * angle[closed])
        result.append((place, p[closed] * size[place] + centres[place, 0] - turn * points[0], np.angle(turn)))
    first, second = result
    return (
        np.concatenate([first[0], second[0]]),
        np.concatenate([first[1], second[1]]),
        np.concatenate([first[2], second[2]]),
    )


def _sextic(centres: Array, radii: Array, points: Array) -> Array:
    """(k, 3) each -> (k, 7) in tan(theta / 2), highest power first."""
    c, b = centres[:, 1:] - centres[:, :1], points[:, 1:] - points[:, :1]
    own = c.conj() * b
    square = [
        _half_angle(np.abs(c[:, k]) ** 2 + np.abs(b[:, k]) ** 2, -2 * own[:, k].real, 2 * own[:, k].imag)
        for k in (0, 1)
    ]
    mixed = c[:, ::-1].conj() * b  # conj(c_3) b_2, conj(c_2) b_3
    across, along = c[:, 0].conj() * c[:, 1], b[:, 0].conj() * b[:, 1]
    dot = _half_angle((across + along).real, -mixed.real.sum(axis=1), mixed.imag.sum(axis=1))
    cross = _half_angle((across + along).imag, mixed[:, 0].imag - mixed[:, 1].imag, mixed[:, 0].real - mixed[:, 1].real)
    one = np.array([[1.0, 0.0, 1.0]])
    f2, f3 = ((square[k] + (radii[:, 0] ** 2 - radii[:, k + 1] ** 2)[:, None] * one) / 2 for k in (0, 1))
    left = product(product(f2, f2), square[1]) + product(product(f3, f3), square[0]) - 2 * product(product(f2, f3), dot)
    result: Array = left - radii[:, :1] ** 2 * product(product(cross, cross), one)
    return result


def _angles(sextic: Array, every: bool) -> tuple[Array, Array]:
    """Rows and angles of all real roots."""
    rows, angles = [], []
    for polynomial, inverted in ((sextic, False), (sextic[:, ::-1], True)):  # tan(theta / 2), then its inverse
        found = [real_roots(polynomial)]
        if every:
            found.append(real_roots(polynomial[:, :-1] * np.arange(6, 0, -1)))
        for roots in found:
            row, column = np.nonzero(np.abs(roots) <= _CHART)
            rows.append(row)
            root = roots[row, column]
            angles.append(2 * (np.arctan2(1, root) if inverted else np.arctan(root)))
    return np.concatenate(rows), np.concatenate(angles)


def _polished(p: Array, theta: Array, c: Array, r: Array, b: Array, steps: int) -> tuple[Array, Array, Array]:
    """Newton's method on the three circles; also the largest error left, over the size squared."""
    error = np.zeros_like(r)
    for last in range(steps + 1):
        rods, moments, det = rods_and_determinant(p, theta, c, b)
        error = (np.abs(rods) ** 2 - r**2) / 2
        if last == steps:
            break
        inverse = det / (det**2 + 1e-28)  # no step where det vanishes
        m1, m2 = np.roll(moments, -1, axis=1), np.roll(moments, -2, axis=1)
        v1, v2 = np.roll(rods, -1, axis=1), np.roll(rods, -2, axis=1)
        turn = np.sum(error * _cross(v1, v2), axis=1) * inverse
        shift = np.sum(error * 1j * (m1 * v2 - m2 * v1), axis=1) * inverse
        p, theta = p - shift, theta - turn
    return p, theta, np.abs(error).max(axis=1, initial=0.0)


def _half_angle(constant: Array, cosine: Array, sine: Array) -> Array:
    """(k, 3) constant + cosine cos + sine sin, times 1 + t^2, in t = tan of half the angle."""
    return np.stack(np.broadcast_arrays(constant - cosine, 2 * sine, constant + cosine), axis=-1)


def _cross(first: Array, second: Array) -> Array:
    result: Array = (first.conj() * second).imag
    return result
