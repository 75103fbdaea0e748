"""The reference case: the prototype, the standard cycle, and an assumed drive set's limits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest

from kinematics import Heli4
from tests.kinematics.weighed import HELI4
from trajectory import AdeptCycle, Cycle, Limits, Path, TimedPath, TimeLaw, there_and_back, time_optimal


@dataclass(frozen=True)
class Straight:
    """A straight path without rotation, for oracles in closed form."""

    start: tuple[float, float, float, float] = (0.0, 0.0, -0.8, 0.0)
    direction: tuple[float, float, float, float] = (0.0, 0.0, 1.0, 0.0)
    length: float = 0.1
    pose_names: tuple[str, ...] = ("x", "y", "z", "theta")
    stops: None = None

    def evaluate(self, s: np.ndarray, order: int = 3) -> tuple[np.ndarray, ...]:
        s = np.asarray(s, dtype=float)[..., None]
        direction = np.broadcast_to(self.direction, (*s.shape[:-1], 4))
        none = np.zeros_like(direction)
        return (self.start + s * self.direction, direction, none, none, none)[: order + 1]

    @property
    def knots(self) -> tuple[float, ...]:
        return (0.0, self.length)

    def steepest(self, s: np.ndarray, order: int) -> np.ndarray:  # noqa: ARG002
        return np.zeros((s.size, 4))

    def as_dict(self) -> dict[str, object]:
        return {"length": self.length}


@dataclass(frozen=True)
class Joined:
    """One path after another."""

    first: Path
    second: Path
    stops: None = None

    @property
    def length(self) -> float:
        return self.first.length + self.second.length

    @property
    def pose_names(self) -> tuple[str, ...]:
        return self.first.pose_names

    def evaluate(self, s: np.ndarray, order: int = 3) -> tuple[np.ndarray, ...]:
        in_first = (s <= self.first.length)[..., None]
        first = self.first.evaluate(np.minimum(s, self.first.length), order)
        second = self.second.evaluate(np.clip(s - self.first.length, 0.0, self.second.length), order)
        return tuple(np.where(in_first, a, b) for a, b in zip(first, second, strict=True))

    @property
    def knots(self) -> tuple[float, ...]:
        return (*self.first.knots, *(self.first.length + s for s in self.second.knots[1:]))

    def steepest(self, s: np.ndarray, order: int) -> np.ndarray:
        first = self.first.steepest(np.minimum(s, self.first.length), order)
        second = self.second.steepest(np.clip(s - self.first.length, 0.0, self.second.length), order)
        return np.where((s <= self.first.length)[:, None], first, second)

    def as_dict(self) -> dict[str, object]:
        return {}


def _s_curve(path: Path, duration: float) -> TimedPath:
    """s''' of +j, -j, -j, +j for a quarter of the time each: rest to rest, s'' continuous and zero at both ends."""
    quarter = duration / 4
    j = path.length / (2 * quarter**3)
    position = j * quarter**3 * np.array([0, 1 / 6, 1, 11 / 6, 2])
    speed = j * quarter**2 * np.array([0, 0.5, 1, 0.5, 0])
    acceleration, jerk = j * quarter * np.array([0, 1, 0, -1]), j * np.array([1, -1, -1, 1])
    return TimedPath(path, TimeLaw("S", np.arange(5) * quarter, position, speed, acceleration, jerk, np.zeros(4)))


@pytest.fixture(scope="session")
def s_curve() -> Callable[[Path, float], TimedPath]:
    return _s_curve


@pytest.fixture(scope="session")
def joined() -> type[Joined]:
    return Joined


@pytest.fixture(scope="session")
def straight() -> type[Straight]:
    return Straight


@pytest.fixture(scope="session")
def robot() -> Heli4:
    return Heli4(inertia=HELI4)


@pytest.fixture(scope="session")
def path() -> AdeptCycle:
    return AdeptCycle()


@pytest.fixture(scope="session")
def limits() -> Limits:
    return Limits(speed=20.0, torque=127.0)


@pytest.fixture(scope="session")
def timed(robot: Heli4, path: AdeptCycle, limits: Limits) -> TimedPath:
    return time_optimal(robot, path, limits, payload=1.0)


@pytest.fixture(scope="session")
def cycle(robot: Heli4, path: AdeptCycle, limits: Limits) -> Cycle:
    return there_and_back(robot, path, limits, 1.0, time_optimal)
