"""The members in MuJoCo: every shape is drawn, and MuJoCo's distances between them are ours."""

import re
from dataclasses import replace
from itertools import combinations, product

import casadi as ca
import mujoco
import numpy as np
import pytest

from kinematics import Delta, GoughStewart, Obstacle, PayloadHull, Surroundings
from kinematics.margins.clearance.solids import rooms
from kinematics.robots.registry import MECHANISMS
from tests.house import ROOT
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


HULLS = {"tall": PayloadHull(0.01, -0.1, -0.03), "flat": PayloadHull(0.05, -0.04, -0.02)}


@pytest.mark.parametrize("hull", HULLS)
@pytest.mark.parametrize("kind", [Delta, GoughStewart], ids=["Delta", "GoughStewart"])
def test_mujoco_measures_our_clearance_from_floor_boxes_frame_and_payload(kind, hull):
    own = kind()
    rng = np.random.default_rng(5)
    pose = own.home + 0.02 * rng.uniform(-1, 1, len(own.pose_names))
    low = own.home[2] - 0.25 if kind is Delta else -0.05
    around = {
        "the floor": Surroundings(floor=low),
        "a box": Surroundings(obstacles=(Obstacle("a box", (0.1, 0.1, low), (0.4, 0.2, own.home[2] + 0.02)),)),
        "a frame": Surroundings(obstacles=(Obstacle("a frame", (-0.7, -0.8, -1.2), (0.9, 1.0, 1.1), inside=True),)),
    }
    for name, surroundings in around.items():
        robot = own.with_surroundings(replace(surroundings, payload_hull=HULLS[hull]))
        model, data = loaded(robot, pose, 0.0)
        mujoco.mj_forward(model, data)
        geoms = [k for k in range(model.ngeom) if model.geom(k).name.startswith((name, "payload"))]
        assert sum(model.geom(k).name == "payload" for k in geoms) == 1
        for part, expected in _parts(robot, pose, name).items():
            mine = [k for k in range(model.ngeom) if model.geom(k).name.split(",")[0] == part]
            theirs = [k for k in geoms if model.geom(k).name.startswith(name)]
            assert mine, part
            found = min(mujoco.mj_geomDistance(model, data, a, b, 10.0, np.zeros(6)) for a, b in product(mine, theirs))
            rounding = 5e-3 * 0.01 if part == "payload" and hull == "flat" else 1e-9
            assert found == pytest.approx(expected, abs=rounding), (name, part)


def _parts(robot, pose, name):
    """The distance of each member with one tube, and of the payload, from what is around."""
    found = rooms(robot)
    distances = ca.Function("d", [robot.model().pose, robot.model().geometry], [found.distances])
    values = np.array(distances(pose, robot.geometry.vector())).ravel()
    places = [p.place for p in (*found.pairs, *found.walled)]
    return {
        place.removesuffix(f" and {name}"): value
        for place, value in zip(places, values, strict=True)
        if place.endswith(f" and {name}") and place.startswith(("payload", "leg", "rod")) and value > 0
    }


def _belongs(name, member):
    return name == member.name or name.startswith(f"{member.name}, ")


def test_the_example_of_the_page_on_bodies_runs_and_its_export_loads():
    (code,) = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "bodies.md").read_text(), re.DOTALL)
    names = {}
    exec(code, names)
    robot, pose = names["robot"], np.array([0.1, 0.0, -0.7])
    assert robot.margin_place("clearance", pose) in code
    model, _ = loaded(robot, pose, 0.5)
    assert {"the floor", "conveyor", "payload"} <= {model.geom(k).name for k in range(model.ngeom)}
    plain, _ = loaded(Delta(), pose, 0.5)
    np.testing.assert_array_equal(model.body_mass, plain.body_mass)
