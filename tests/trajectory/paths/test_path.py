"""A path that cannot be passed at speed is refused."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest

from trajectory import AdeptCycle, Path, Reversed, RoughPath, RoundedPath, require_smooth
from trajectory.paths.path import SCHOENFLIES


@dataclass(frozen=True)
class Unknown:
    """A path that does not say where its tangent jumps."""

    path: Path
    stops: None = None
    pose_names: tuple[str, ...] = SCHOENFLIES

    @property
    def length(self) -> float:
        return self.path.length

    @property
    def knots(self) -> tuple[float, ...]:
        return (0.0, self.length)

    def evaluate(self, s: np.ndarray, order: int = 3) -> tuple[np.ndarray, ...]:
        return self.path.evaluate(s, order)


@dataclass(frozen=True)
class Rescaled(Unknown):
    """A path by another parameter than its arc length."""

    factor: float = 1.0

    def evaluate(self, s: np.ndarray, order: int = 3) -> tuple[np.ndarray, ...]:
        return tuple(d * self.factor**k for k, d in enumerate(self.path.evaluate(s * self.factor, order)))


def refused(path: Path) -> RoughPath:
    with pytest.raises(RoughPath) as caught:
        require_smooth(path)
    return caught.value


@pytest.mark.parametrize("blend", [1e-7, 2e-4, 0.0249])
def test_a_rounded_path_is_smooth_at_any_blend_by_construction_and_to_samples(blend: float) -> None:
    path = AdeptCycle(blend=blend)
    for way in (path, Reversed(path), Unknown(path)):
        require_smooth(way)


def test_a_corner_without_a_blend_is_refused_at_its_place() -> None:
    corner = RoundedPath(SCHOENFLIES, ((0, 0, 0, 0), (0.1, 0, 0, 0), (0.1, 0.2, 0, 0)), (0.0,))
    for way in (corner, Unknown(corner)):
        error = refused(way)
        assert (error.at, error.found) == (pytest.approx(0.1), pytest.approx(math.sqrt(2)))


def test_a_reversal_within_the_path_is_refused_at_its_place(joined: type, path: AdeptCycle) -> None:
    error = refused(joined(path, Reversed(path)))
    assert error.found == pytest.approx(2.0, abs=1e-6)
    assert error.at == pytest.approx(path.length, abs=1e-3)


def test_a_sharp_corner_is_refused(joined: type, straight: type) -> None:
    up = straight()
    error = refused(joined(up, straight((0.0, 0.0, -0.7, 0.0), (1.0, 0.0, 0.0, 0.0))))
    assert error.found == pytest.approx(math.sqrt(2), abs=1e-9)
    assert error.at == pytest.approx(up.length, abs=1e-3)


def test_a_jump_of_the_turning_is_refused(joined: type, straight: type) -> None:
    turning = straight((0.0, 0.0, -0.8, 0.0), (0.0, 0.0, 1.0, 3.0))
    assert "theta" in refused(joined(turning, straight((0.0, 0.0, -0.7, 0.3)))).what


def test_a_parameter_that_is_not_arc_length_is_refused(path: AdeptCycle) -> None:
    assert refused(Rescaled(path, factor=0.5)).found == pytest.approx(0.5)


def test_a_path_of_nan_is_refused(straight: type) -> None:
    assert math.isnan(refused(straight(direction=(0.0, 0.0, math.nan, 0.0))).found)
