"""Real roots against numpy's and mpmath's, and against polynomials built from known roots."""

import mpmath as mp
import numpy as np
import pytest

from kinematics.evaluation import threads
from kinematics.mathematics.polynomials import real_roots


def known(row):
    return row[~np.isnan(row)]


def from_roots(roots):
    return np.stack([np.poly(r) for r in roots])


@pytest.mark.parametrize("degree", [1, 2, 3, 4, 5, 6])
def test_all_real_roots_of_random_polynomials_and_no_other(degree):
    rng = np.random.default_rng(degree)
    coefficients = rng.normal(size=(3_000, degree + 1)) * 10.0 ** rng.uniform(-3, 3, (3_000, 1))
    for c, row in zip(coefficients, real_roots(coefficients), strict=True):
        roots = np.roots(c)
        size = 1 + np.abs(roots)
        if np.any((np.abs(roots.imag) < 1e-6 * size) & (np.abs(roots.imag) > 0)):
            continue
        expected = np.sort(roots[roots.imag == 0].real)
        found = known(row)
        assert found.size == expected.size
        assert np.abs((found - expected) / (1 + np.abs(expected))).max(initial=0.0) < 1e-8
        assert (np.diff(found) > 0).all()


@pytest.mark.parametrize("degree", [2, 3, 4, 6])
def test_well_apart_roots_to_the_last_digits(degree):
    rng = np.random.default_rng(10 + degree)
    roots = np.cumsum(rng.uniform(0.3, 2.0, (100, degree)), axis=1) - 2.0
    coefficients = from_roots(roots)
    for c, row in zip(coefficients, real_roots(coefficients), strict=True):
        assert known(row).size == degree
        with mp.workdps(40):
            for x in row:
                exact = mp.findroot(
                    lambda v, c=c: mp.fsum(mp.mpf(float(k)) * v**i for i, k in enumerate(c[::-1])), float(x)
                )
                slope = np.polyval(np.polyder(c), x)
                bound = 4e-16 * abs(x) + 1e-15 * np.polyval(np.abs(c), abs(x)) / abs(slope)
                assert abs(float(exact - mp.mpf(float(x)))) <= bound


@pytest.mark.parametrize("scale", [1e-30, 1e-6, 1e6, 1e30])
def test_roots_of_any_size(scale):
    roots = np.array([-3.0, -0.5, 1.0, 7.0])
    found = real_roots(np.poly(roots * scale) * scale**-2)
    np.testing.assert_allclose(found, roots * scale, rtol=1e-13)


@pytest.mark.parametrize("spread", [1e3, 1e6, 1e9])
def test_roots_far_apart(spread):
    roots = np.array([-spread, -1.0, 1.0 / spread, 2.0])
    np.testing.assert_allclose(real_roots(np.poly(roots)), roots, rtol=1e-6)


def test_leading_zeros_lower_the_degree():
    found = real_roots(np.array([[0.0, 0.0, 1.0, -3.0, 2.0], [0.0, 1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 2.0, -1.0]]))
    np.testing.assert_array_equal(known(found[0]), [1.0, 2.0])
    np.testing.assert_allclose(known(found[1]), [0.0], atol=1e-100)
    np.testing.assert_array_equal(known(found[2]), [0.5])


@pytest.mark.parametrize("c", [[0.0] * 5, [0.0, 0.0, 0.0, 0.0, 3.0], [1.0, 0.0, 0.0, 0.0, 1.0]], ids=str)
def test_constants_and_positive_quartics_have_none(c):
    assert known(real_roots(np.array(c))).size == 0


def test_double_roots_are_found_once_or_as_a_close_pair():
    rng = np.random.default_rng(20)
    for _ in range(2_000):
        double, a, b = rng.uniform(-2, 2, 3)
        if min(abs(double - a), abs(double - b), abs(a - b)) < 0.1:
            continue
        found = known(real_roots(np.poly([double, double, a, b])))
        assert found.size in (3, 4)
        for root in (double, a, b):
            assert np.abs(found - root).min() < 1e-6


def test_triple_root_at_zero():
    assert known(real_roots(np.array([1.0, -1.0, 0.0, 0.0, 0.0]))).tolist() == [0.0, 1.0]


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_a_coefficient_that_is_not_finite_gives_no_root(bad):
    for place in range(5):
        c = np.array([[1.0, 0.0, -5.0, 0.0, 4.0]] * 2)
        c[1, place] = bad
        found = real_roots(c)
        np.testing.assert_allclose(found[0], [-2, -1, 1, 2])
        assert np.isnan(found[1]).all()


def test_the_smallest_alone_are_those_of_all():
    c = np.random.default_rng(21).normal(size=(20_000, 5))
    everything = real_roots(c)
    for most in (1, 2, 3):
        np.testing.assert_array_equal(real_roots(c, most), everything[:, :most])


@pytest.mark.parametrize("shape", [(5,), (0, 5), (2, 3, 5), (4, 2), (3, 1)], ids=str)
def test_leading_shape_is_kept(shape):
    assert real_roots(np.ones(shape)).shape == (*shape[:-1], shape[-1] - 1)


def test_no_root_depends_on_the_number_of_threads(monkeypatch):
    c = np.random.default_rng(22).normal(size=(10_001, 5))
    monkeypatch.setattr(threads, "CORES", 1)
    alone = real_roots(c)
    monkeypatch.setattr(threads, "CORES", 5)
    np.testing.assert_array_equal(real_roots(c), alone)
