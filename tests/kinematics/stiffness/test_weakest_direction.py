"""Proofs and gradients of the margins of stiffness, and poses where eigenvalues meet or vanish."""

import casadi as ca
import numpy as np
import pytest

from design import Box, certify, replay, worst_poses
from kinematics import MECHANISMS, Delta, Heli4, Measure, Mechanism, Planar3RPR, Planar3RRR
from kinematics.mathematics import singular_values, smallest_eigenvalue
from tests.sizes import few_of

MARGINS = ("stiffness", "rotational_stiffness", "internal_stiffness", "natural_frequency")
ROBOTS = [kind() for kind in MECHANISMS.values()]
CASES = [(robot, margin) for robot in ROBOTS for margin in MARGINS if margin in robot.margins]
QUICK = ("Delta-stiffness", "Heli4-rotational_stiffness", "Planar3RRR-natural_frequency")


def named(robot: Mechanism, margin: str) -> str:
    return f"{type(robot).__name__}-{margin}"


@pytest.mark.parametrize(
    ("robot", "margin"),
    few_of(CASES, lambda robot, margin: named(robot, margin) in QUICK),
    ids=[named(*case) for case in CASES],
)
def test_it_is_proved_up_to_its_worst_value_and_refuted_beyond(robot: Mechanism, margin: str) -> None:
    home = robot.home + 1e-3 * np.arange(1, len(robot.home) + 1)
    region = Box(**{n: (float(v) - 5e-3, float(v) + 5e-3) for n, v in zip(robot.pose_names, home, strict=True)})
    worst = worst_poses(robot, region, margin, about=300, descents=8).value
    proof = certify(robot, region, margin, at_least=0.95 * worst)
    assert proof.status == "proved"
    assert replay(proof, robot, region=region, margin=margin, at_least=0.95 * worst) >= 1
    assert certify(robot, region, margin, at_least=1.001 * worst).status == "refuted"


@pytest.mark.long
@pytest.mark.parametrize(
    ("robot", "region"),
    [
        (Delta(), Box(x=(-0.3, 0.3), y=(-0.3, 0.3), z=(-0.9, -0.7))),
        (Planar3RRR(), Box(x=(-0.05, 0.05), y=(-0.05, 0.05), theta=(-0.2, 0.2))),
    ],
)
def test_stiffness_is_proved_over_a_workspace_to_within_a_tenth(robot: Mechanism, region: Box) -> None:
    worst = worst_poses(robot, region, "stiffness", about=3000, descents=8).value
    assert certify(robot, region, "stiffness", at_least=0.9 * worst).status == "proved"


@pytest.mark.parametrize("robot", ROBOTS, ids=[type(robot).__name__ for robot in ROBOTS])
def test_its_gradient_by_the_geometry_is_that_of_differences(robot: Mechanism) -> None:
    model, rng = robot.model(), np.random.default_rng(1)
    pose = robot.home + 0.02 * rng.standard_normal(len(robot.home))
    measure = Measure(robot.fvi_bounds, robot.characteristic_length)
    margin = robot.margins["stiffness"].components(robot, measure)
    function = ca.Function("margin", [model.pose, model.geometry], [margin, ca.gradient(margin, model.geometry)])
    numbers = robot.geometry.vector()
    direction = rng.standard_normal(len(numbers)) * np.abs(numbers)
    step = 1e-5
    ahead, behind = (float(function(pose, numbers + side * step * direction)[0]) for side in (1, -1))
    slope = float(direction @ np.array(function(pose, numbers)[1]).ravel())
    assert slope == pytest.approx((ahead - behind) / (2 * step), rel=1e-5), "seed 1"


@pytest.mark.parametrize("robot", [Heli4(), Delta(), Planar3RRR()], ids=["Heli4", "Delta", "3-RRR"])
def test_where_two_directions_are_equally_weak_the_gradient_is_a_number(robot: Mechanism) -> None:
    """On the axis, x and y are alike: any mean of their gradients will do, but not NaN."""
    model = robot.model()
    margin = robot.margins["stiffness"].components(robot, Measure(robot.fvi_bounds, robot.characteristic_length))
    gradient = ca.Function("gradient", [model.pose, model.geometry], [ca.gradient(margin, model.geometry)])
    found = np.array(gradient(robot.home, robot.geometry.vector())).ravel()
    assert np.isfinite(found).all()
    assert np.abs(found * robot.geometry.vector()).max() < 100 * float(robot.margin("stiffness", robot.home))


def test_the_smallest_eigenvalue_is_scipys_and_the_free_freedoms_follow() -> None:
    rng = np.random.default_rng(2)
    for n, k in ((2, 2), (4, 3), (7, 4), (6, 6)):
        root, weight_root = rng.standard_normal((n, n)), rng.standard_normal((k, k))
        matrix, weight = root @ root.T, weight_root @ weight_root.T
        symbols = ca.SX.sym("K", n, n), ca.SX.sym("E", k, k)
        found = ca.Function("smallest", list(symbols), [smallest_eigenvalue(*symbols)])(matrix, weight)
        left = np.linalg.inv(np.linalg.inv(matrix)[-k:, -k:])
        expected = np.linalg.eigvals(np.linalg.solve(weight, left)).real.min()
        assert float(found) == pytest.approx(expected, rel=1e-8), "seed 2"


def test_on_a_parallel_singularity_stiffness_is_all_but_zero_and_never_nan() -> None:
    """The legs of the 3-RPR all point at the platform's centre where it is turned back by a quarter."""
    robot = Planar3RPR()
    singular, near = (np.array([0.0, 0.0, -np.pi / 2 + turn]) for turn in (0.0, 1e-3))
    assert abs(float(robot.margin("det_J_x", singular))) < 1e-15
    home = {name: float(robot.margin(name, robot.home)) for name in ("rotational_stiffness", "natural_frequency")}
    assert 0.0 <= robot.margin("rotational_stiffness", singular) < 1e-12 * home["rotational_stiffness"]
    assert 0.0 <= robot.margin("natural_frequency", singular) < 1e-6 * home["natural_frequency"]
    # The legs' lines miss the centre in proportion to the turn, and two such levers make a stiffness.
    first, second = (float(robot.margin("rotational_stiffness", singular + k * (near - singular))) for k in (1, 2))
    assert second / first == pytest.approx(4.0, rel=1e-4)


def test_equal_singular_values_have_gradients_that_are_numbers() -> None:
    symbols = ca.SX.sym("a", 3, 3)
    value = ca.mmin(singular_values(symbols))
    gradient = ca.Function("gradient", [symbols], [ca.gradient(value, symbols)])
    for matrix in (np.eye(3), np.diag([2.0, 1.0, 1.0])):
        found = np.array(gradient(matrix))
        assert np.isfinite(found).all()
        assert np.linalg.norm(found) == pytest.approx(1.0, abs=0.5)  # u v^T of some singular vectors, or a mean of them
