"""A path that cannot be passed at speed is refused."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest

from trajectory import AdeptCycle, Path, Reversed, RoughPath, require_smooth


@dataclass(frozen=True)
class Rescaled:
    """A path by another parameter than its arc length."""

    path: Path
    factor: float
    pose_names: tuple[str, ...] = ("x", "y", "z", "theta")

    @property
    def length(self) -> float:
        return self.path.length

    def evaluate(self, s: np.ndarray, order: int = 3) -> tuple[np.ndarray, ...]:
        return tuple(d * self.factor**k for k, d in enumerate(self.path.evaluate(s * self.factor, order)))

    def as_dict(self) -> dict[str, object]:
        return {}


def refused(path: Path) -> RoughPath:
    with pytest.raises(RoughPath) as caught:
        require_smooth(path, np.linspace(0.0, path.length, 2001))
    return caught.value


@pytest.mark.parametrize("blend", [0.001, 0.002, 0.0249])
def test_the_cycle_is_smooth_at_any_usual_blend(blend: float) -> None:
    path = AdeptCycle(blend=blend)
    require_smooth(path, np.linspace(0.0, path.length, 2001))
    require_smooth(Reversed(path), np.linspace(0.0, path.length, 2001))


def test_a_reversal_within_the_path_is_refused_at_its_place(joined: type, path: AdeptCycle) -> None:
    error = refused(joined(path, Reversed(path)))
    assert error.found == pytest.approx(2.0, abs=1e-6)
    assert error.at == pytest.approx(path.length, abs=1e-3)


def test_a_sharp_corner_is_refused(joined: type, straight: type) -> None:
    up = straight()
    error = refused(joined(up, straight((0.0, 0.0, -0.7, 0.0), (1.0, 0.0, 0.0, 0.0))))
    assert error.found == pytest.approx(math.sqrt(2), abs=1e-9)
    assert error.at == pytest.approx(up.length, abs=1e-3)


def test_a_corner_too_sharp_for_the_grid_is_refused_until_the_grid_is_finer(path: AdeptCycle) -> None:
    sharp = replace(path, blend=5e-4)
    assert "jump of the tangent" in refused(sharp).what
    require_smooth(sharp, np.linspace(0.0, sharp.length, 8001))


def test_a_jump_of_the_turning_is_refused(joined: type, straight: type) -> None:
    turning = straight((0.0, 0.0, -0.8, 0.0), (0.0, 0.0, 1.0, 3.0))
    assert "theta" in refused(joined(turning, straight((0.0, 0.0, -0.7, 0.3)))).what


def test_a_parameter_that_is_not_arc_length_is_refused(path: AdeptCycle) -> None:
    assert refused(Rescaled(path, 0.5)).found == pytest.approx(0.5)


def test_a_path_of_nan_is_refused(straight: type) -> None:
    assert math.isnan(refused(straight(direction=(0.0, 0.0, math.nan, 0.0))).found)
