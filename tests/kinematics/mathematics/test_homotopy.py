"""Path tracking on systems whose solutions are known."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from kinematics.mathematics.homotopy import refine, track


def conics(a: complex, b: complex) -> np.ndarray:
    """x^2 = a z^2 and y^2 = b z^2 in (x, y, z)."""
    return np.array([np.diag([1.0, 0.0, -a]), np.diag([0.0, 1.0, -b])], dtype=complex)


def path(first: np.ndarray, last: np.ndarray) -> np.ndarray:
    return np.stack([first, last - first, 0 * first])


STARTS = np.array([[x, y, 1.0] for x in (-1, 1) for y in (-1, 1)], dtype=complex)


def test_four_intersections_of_two_conics_arrive_where_the_square_roots_say() -> None:
    ends, reached = track(path(conics(1, 1), conics(4, 9)), STARTS, 2)
    np.testing.assert_array_equal(reached, 1.0)
    ends, last = refine(conics(4, 9), ends, 2)
    assert last.max() < 1e-14
    np.testing.assert_allclose(ends / ends[:, 2:], STARTS * [2, 3, 1], atol=1e-14)


def test_a_loop_around_a_branch_point_exchanges_the_roots() -> None:
    points = STARTS
    corners = [1, 1j, -1, -1j, 1]
    for a, b in pairwise(corners):
        points, reached = track(path(conics(a, 1), conics(b, 1)), points, 2)
        np.testing.assert_array_equal(reached, 1.0)
    np.testing.assert_allclose(points / points[:, 2:], STARTS * [-1, 1, 1], atol=1e-9)


def test_a_path_into_a_singular_point_stops_there_and_says_so() -> None:
    _, reached = track(path(conics(1, 1), conics(-1, 1)), STARTS, 2)
    assert (np.abs(reached - 0.5) < 1e-6).all()


def test_a_path_of_degree_two_in_t_is_followed_exactly() -> None:
    """x^2 = (1 + t)^2 z^2."""
    moving = np.zeros((3, 2, 3, 3), dtype=complex)
    moving[0] = conics(1, 1)
    moving[1, 0, 2, 2], moving[2, 0, 2, 2] = -2.0, -1.0
    ends, reached = track(moving, STARTS, 2)
    np.testing.assert_array_equal(reached, 1.0)
    np.testing.assert_allclose(ends / ends[:, 2:], STARTS * [2, 1, 1], atol=1e-9)


def test_refining_at_a_singular_point_reports_no_convergence() -> None:
    _, last = refine(conics(0, 1), np.array([[0.0, 1.0, 1.0]]), 2)
    assert np.isnan(last[0])
