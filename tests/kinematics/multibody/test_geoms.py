"""The members in MuJoCo: every shape is drawn, and MuJoCo's distances between them are ours."""

from itertools import combinations, product

import mujoco
import numpy as np
import pytest

from kinematics.robots.registry import MECHANISMS
from tests.kinematics.multibody.mujoco_model import loaded

EACH = pytest.mark.parametrize("kind", list(MECHANISMS.values()), ids=list(MECHANISMS))


@EACH
def test_mujoco_measures_our_clearance_between_the_shapes_of_the_export(kind):
    robot, rng = kind(), np.random.default_rng(5)
    symbols = robot.model()
    names = symbols.pose, symbols.joints, symbols.g
    members = robot.all_members(*names)
    pose = robot.home + 0.02 * rng.uniform(-1, 1, len(robot.pose_names))
    model, data = loaded(robot, pose, 0.0)
    mujoco.mj_forward(model, data)
    geoms = {member.name: [k for k in range(model.ngeom) if _belongs(model.geom(k).name, member)] for member in members}
    assert model.ngeom == sum(len(member.shapes) for member in members) == sum(map(len, geoms.values()))
    nearest = min(
        mujoco.mj_geomDistance(model, data, one, two, 10.0, np.zeros(6))
        for a, b in combinations(members, 2)
        if not set(a.joints) & set(b.joints)
        for one, two in product(geoms[a.name], geoms[b.name])
    )
    assert nearest == pytest.approx(float(robot.margin("clearance", pose)), abs=1e-9 * robot.geometry.size)


def _belongs(name, member):
    return name == member.name or name.startswith(f"{member.name}, ")
