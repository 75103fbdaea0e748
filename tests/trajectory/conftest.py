"""The reference case: the prototype, the standard cycle, and an assumed drive set's limits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from kinematics import Heli4
from trajectory import AdeptCycle, Cycle, Limits, Path, TimedPath, there_and_back, time_optimal


@dataclass(frozen=True)
class Straight:
    """A straight path without rotation, for oracles in closed form."""

    start: tuple[float, float, float, float] = (0.0, 0.0, -0.8, 0.0)
    direction: tuple[float, float, float, float] = (0.0, 0.0, 1.0, 0.0)
    length: float = 0.1
    pose_names: tuple[str, ...] = ("x", "y", "z", "theta")

    def evaluate(self, s: np.ndarray, order: int = 3) -> tuple[np.ndarray, ...]:
        s = np.asarray(s, dtype=float)[..., None]
        direction = np.broadcast_to(self.direction, (*s.shape[:-1], 4))
        none = np.zeros_like(direction)
        return (self.start + s * self.direction, direction, none, none, none)[: order + 1]

    @property
    def knots(self) -> tuple[float, ...]:
        return (0.0, self.length)

    def steepest_third(self, s: np.ndarray) -> np.ndarray:
        return np.zeros((s.size, 4))

    def as_dict(self) -> dict[str, object]:
        return {"length": self.length}


@dataclass(frozen=True)
class Joined:
    """One path after another."""

    first: Path
    second: Path

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

    def steepest_third(self, s: np.ndarray) -> np.ndarray:
        first = self.first.steepest_third(np.minimum(s, self.first.length))
        second = self.second.steepest_third(np.clip(s - self.first.length, 0.0, self.second.length))
        return np.where((s <= self.first.length)[:, None], first, second)

    def as_dict(self) -> dict[str, object]:
        return {}


@pytest.fixture(scope="session")
def joined() -> type[Joined]:
    return Joined


@pytest.fixture(scope="session")
def straight() -> type[Straight]:
    return Straight


@pytest.fixture(scope="session")
def robot() -> Heli4:
    return Heli4()


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
