"""What verifies a motion and what times it say the same of every limit, though they share no code."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, NamedTuple

import casadi as ca
import numpy as np
import pytest

from kinematics import DriveTrain, Heli4, actuator_motion
from trajectory import LIMITS, AdeptCycle, JointField, Limit, Limits, PathMotion, RangeField, ToolField
from trajectory.limits import (
    Along,
    Cap,
    Disc,
    InstantLimit,
    Linear,
    MeanSquareLimit,
    Place,
    Sloped,
    Squared,
    SymbolicMotion,
    Third,
    TorqueAlong,
)
from trajectory.limits.model import NO_SLACK
from trajectory.motions import Motion, motion_of, pose_motion, torque_along

PAYLOAD = 1.0
VALUES = {JointField: 30.0, ToolField: 5.0, RangeField: (-2.0, 3.0)}
ALL = Limits(**{field.name: VALUES[type(field)] for limit in LIMITS for field in limit.fields})  # type: ignore[arg-type]


class Sample(NamedTuple):
    """A motion at instants, and the way on which it is at a pace."""

    robot: Heli4
    motion: Motion
    along: Along
    pace: PathMotion


@pytest.fixture(scope="module")
def sample() -> Sample:
    robot = Heli4(inertia=Heli4.Inertia(drive_train=DriveTrain(coulomb=1.5, viscous=0.3)))
    path, rng = AdeptCycle(), np.random.default_rng(5)
    s = rng.uniform(0.01, 0.99, 60) * path.length
    pace = PathMotion(
        s, *(rng.uniform(low, 1.0, 60) * size for low, size in ((0.1, 5.0), (-1, 150.0), (-1, 2e4))), 0 * s
    )
    derivatives = path.evaluate(s, 3)
    tool = tuple(rate[:, :3] for rate in derivatives[1:3])

    def split() -> TorqueAlong:
        parts = torque_along(robot, PAYLOAD, derivatives, 3.0, 100.0)
        return TorqueAlong(*parts, 0 * parts.constant, parts.constant)

    along = Along(actuator_motion(robot, *derivatives), (tool[0], tool[1]), split)
    return Sample(robot, motion_of(robot, pose_motion(path, pace), PAYLOAD), along, pace)


def measured(limit: Limit, sample: Sample) -> np.ndarray:
    """(k, rows) what the verifier sees, over the limit."""
    if isinstance(limit, MeanSquareLimit):
        values = np.abs(limit.quantity(sample.motion))
        return values / np.asarray(limit.most(ALL, values.shape[-1]))
    assert isinstance(limit, InstantLimit)
    use = limit.use(sample.robot, sample.motion, ALL, NO_SLACK)
    assert use is not None
    assert use.ratio is not None
    return use.ratio


def asked(limit: Limit, sample: Sample) -> np.ndarray:
    """(k, rows) what a law sees, over the limit."""
    constraint: Any = limit.constraint(sample.along, ALL)
    rate, u = sample.pace.speed[:, None], sample.pace.acceleration[:, None]
    x, z = rate**2, sample.pace.jerk[:, None] / rate
    match constraint:
        case Cap():
            return rate / np.sqrt(constraint.most)[:, None]
        case Disc():
            return np.linalg.norm(constraint.by_u * u + constraint.by_x * x, axis=-1, keepdims=True)
        case Third():
            return rate * np.abs(constraint.by_z * z + constraint.by_u * u + constraint.by_x * x)
    used = np.abs(constraint.by_u * u + constraint.by_x * x + constraint.by_rate * rate + constraint.constant)
    return used + constraint.slope * rate if isinstance(constraint, Sloped) else used


@pytest.mark.parametrize("limit", [limit for limit in LIMITS if limit.kind is not Place], ids=lambda limit: limit.name)
def test_a_law_asks_for_what_is_measured(limit: Limit, sample: Sample) -> None:
    seen, wanted = measured(limit, sample), asked(limit, sample)
    seen = seen.max(axis=-1, keepdims=True) if limit.kind is Cap else seen
    assert seen.max() > 0.1
    if limit.exact:
        assert np.abs(wanted - seen).max() < 1e-9 * seen.max()
    else:
        kept = (wanted.reshape(len(seen), -1, seen.shape[1]) <= 1.0).all(axis=1)  # a joint may have several rows
        assert kept.any()
        assert (seen[kept] <= 1.0).all()


@pytest.mark.parametrize("limit", LIMITS, ids=lambda limit: limit.name)
def test_its_symbols_are_beyond_one_just_where_it_is_broken(limit: Limit, sample: Sample) -> None:
    seen, motion = measured(limit, sample), sample.motion
    for k in range(0, len(seen), 5):
        joints = tuple(ca.SX(rate[k]) for rate in motion.joints)
        tool = (ca.SX(rate[k, :3]) for rate in motion.tool[1:3])
        symbols = SymbolicMotion((joints[0], joints[1], joints[2], joints[3]), *tool, ca.SX(motion.torque[k]))
        found = np.abs(np.array(ca.DM(limit.symbolic(symbols, ALL)))[:, 0])
        rows = found.reshape(-1, seen.shape[1]).max(axis=0)
        assert np.allclose(rows, seen[k] ** (2 if isinstance(limit.fields[0], ToolField) else 1))  # a norm is squared


def test_every_field_belongs_to_one_limit() -> None:
    declared = [field.name for limit in LIMITS for field in limit.fields]
    assert sorted(declared) == sorted(field.name for field in fields(Limits))
    assert len({limit.name for limit in LIMITS}) == len(LIMITS)


def test_limits_are_left_out_by_kind() -> None:
    assert ALL.has(Third)
    assert ALL.has(Linear)
    plain = ALL.without(Third, Sloped, Squared)
    assert (plain.jerk, plain.stall_torque, plain.no_load_speed, plain.rms_torque) == (None,) * 4
    assert plain.torque == ALL.torque
    assert not plain.has(Squared)
