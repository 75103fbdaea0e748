"""Limits are positive numbers, one or one a joint."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics import InvalidValue
from trajectory import Limits

JOINT_AND_TOOL = ("speed", "acceleration", "torque", "jerk", "tool_speed", "tool_acceleration", "rms_torque")


@pytest.mark.parametrize("field", JOINT_AND_TOOL)
@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf, "fast", True])
def test_an_impossible_limit_is_named(field: str, value: object) -> None:
    with pytest.raises(InvalidValue, match=f"Limits {field}"):
        Limits(**{"speed": 20.0, field: value})


def test_a_speed_limit_is_needed() -> None:
    with pytest.raises(InvalidValue, match="Limits speed"):
        Limits(speed=None)  # type: ignore[arg-type]


def test_one_number_holds_for_every_joint_and_several_for_their_own() -> None:
    limits = Limits(speed=20, torque=[1, 2, 3, 4], acceleration=np.array([5.0, 6.0, 7.0, 8.0]))
    assert limits.of_joints("speed", 4).tolist() == [20.0] * 4
    assert limits.of_joints("torque", 4).tolist() == [1.0, 2.0, 3.0, 4.0]
    assert limits.of_joints("jerk", 4) is None
    assert limits.as_dict() == {"speed": 20.0, "acceleration": [5.0, 6.0, 7.0, 8.0], "torque": [1.0, 2.0, 3.0, 4.0]}
    assert hash(limits) == hash(Limits(speed=20.0, torque=(1, 2, 3, 4), acceleration=(5, 6, 7, 8)))


def test_limits_for_another_number_of_joints_are_refused() -> None:
    with pytest.raises(InvalidValue, match="Limits torque"):
        Limits(speed=20, torque=(1, 2, 3)).of_joints("torque", 4)


def test_a_tool_limit_is_one_number() -> None:
    with pytest.raises(InvalidValue, match="tool_speed"):
        Limits(speed=20, tool_speed=(1.0, 2.0))  # type: ignore[arg-type]


@pytest.mark.parametrize("given", [{"stall_torque": 100.0}, {"no_load_speed": 30.0}])
def test_half_of_a_speed_torque_line_is_refused(given: dict[str, float]) -> None:
    with pytest.raises(InvalidValue, match="both ends"):
        Limits(speed=20, **given)


@pytest.mark.parametrize(
    "line", [{"stall_torque": 0.0, "no_load_speed": 30.0}, {"stall_torque": 1.0, "no_load_speed": -1}]
)
def test_an_impossible_line_is_refused(line: dict[str, float]) -> None:
    with pytest.raises(InvalidValue, match="> 0"):
        Limits(speed=20, **line)


def test_a_range_holds_for_every_joint_and_several_for_their_own() -> None:
    low, high = Limits(speed=20, position=(-1, 2)).ranges(3)
    assert (low.tolist(), high.tolist()) == ([-1.0] * 3, [2.0] * 3)
    limits = Limits(speed=20, position=[[-1, 2], [0, 3]])
    low, high = limits.ranges(2)
    assert (low.tolist(), high.tolist()) == ([-1.0, 0.0], [2.0, 3.0])
    assert limits.as_dict()["position"] == [[-1.0, 2.0], [0.0, 3.0]]
    assert Limits(speed=20).ranges(2) is None
    with pytest.raises(InvalidValue, match="3: one for each joint"):
        limits.ranges(3)


@pytest.mark.parametrize(
    "value", [1.0, (2.0, 1.0), (1.0, 1.0), (0.0, math.nan), (1.0, 2.0, 3.0), (), "low", [(0, 1), (1, 0)]]
)
def test_an_impossible_range_is_named(value: object) -> None:
    with pytest.raises(InvalidValue, match="Limits position"):
        Limits(speed=20, position=value)  # type: ignore[arg-type]
