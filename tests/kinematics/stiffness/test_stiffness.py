"""Stiffness and natural frequency of all mechanisms, against frames of finite elements, springs and energies."""

from dataclasses import fields, replace
from functools import cache

import casadi as ca
import numpy as np
import pytest
import scipy.linalg

from design import Cylinder
from kinematics import (
    MECHANISMS,
    DriveTrain,
    Heli4,
    InvalidValue,
    Mechanism,
    Planar3RRR,
    inverse_dynamics,
    mass_matrix,
    platform_stiffness,
    tool_stiffness,
)
from kinematics.dynamics import transmission
from kinematics.machine import MATERIALS, Load, Material, Structure
from tests.kinematics.numeric import differences
from tests.kinematics.stiffness.machines import FRAMES
from tests.sizes import every_mechanism

NAMES = list(MECHANISMS)
ALL = pytest.mark.parametrize("name", every_mechanism(NAMES))
RIGID = Material(1e3, 1e19, 1e19, 1e9)  # some 1e8 times as stiff as usual
STIFF = Structure(*[RIGID] * 6)
SOFT = Structure(
    arm=MATERIALS["steel"], rod=MATERIALS["aluminium"], link=Material(1e3, 3e10, 2e9, 1e8), joint_stiffness=4e6
)


@cache
def robot(name: str, structure: Structure = SOFT) -> Mechanism:
    """With another stiffness for each drive."""
    usual = MECHANISMS[name](structure=structure)
    stiffness = usual.inertia.drive_train.of_actuators("stiffness", len(usual.joint_names))
    own = tuple((stiffness * np.linspace(0.5, 2.0, len(stiffness))).tolist())
    return usual.with_inertia(replace(usual.inertia, drive_train=DriveTrain(stiffness=own)))


def poses(machine: Mechanism, count: int, seed: int) -> np.ndarray:
    """Around home, to a tenth of the machine's size, and a third of a radian."""
    rng = np.random.default_rng(seed)
    spread = np.array([0.33 if k in machine.rotations else 0.05 for k in range(len(machine.pose_names))])
    near = machine.home + spread * rng.uniform(-1, 1, (20 * count, len(spread)))
    return near[np.isfinite(machine.inverse(near)).all(axis=1)][:count]


def condensed(matrix: np.ndarray, free: list[int], asked: list[int]) -> np.ndarray:
    inverse = np.linalg.inv(matrix[np.ix_(free + asked, free + asked)])
    return np.linalg.inv(inverse[len(free) :, len(free) :])


@cache
def by_frames(name: str) -> list[tuple[np.ndarray, np.ndarray]]:
    """Poses, and the compliance of the tool there by finite elements."""
    found = []
    for pose in poses(robot(name), 2, seed=1):
        frame, tool, directions = FRAMES[name](robot(name), pose)
        found.append((pose, frame.compliance(tool, directions)))
    return found


@ALL
def test_the_tool_gives_way_as_a_frame_of_beams_and_bars_does(name: str) -> None:
    machine = robot(name)
    for pose, expected in by_frames(name):
        found = np.linalg.inv(tool_stiffness(machine, pose))
        size = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
        assert np.abs((found - expected) / size).max() < 1e-7, "seed 1"


@pytest.mark.parametrize(("name", "order"), [("Delta", [0, 1, 2, 3, 4, 5]), ("Redundant3T1R", [0, 1, 2, 5, 3, 4])])
def test_a_platform_of_one_body_tilts_as_the_frame_does(name: str, order: list[int]) -> None:
    machine = robot(name)
    (pose,) = poses(machine, 1, seed=2)
    frame, tool, _ = FRAMES[name](machine, pose)
    expected = frame.compliance(tool, np.eye(6)[order])
    np.testing.assert_allclose(platform_stiffness(machine, pose) @ expected, np.eye(6), atol=1e-6, err_msg="seed 2")
    if name == "Delta":
        held = np.linalg.inv(expected)[3:, 3:]
        assert machine.margin("internal_stiffness", pose) == pytest.approx(np.linalg.eigvalsh(held)[0], rel=1e-7)


@ALL
def test_margins_are_the_weakest_directions_and_the_lowest_frequency(name: str) -> None:
    machine = robot(name).with_load(Load(payload=0.7))
    for pose, compliance in by_frames(name):
        stiffness = np.linalg.inv(compliance)
        turns = list(machine.rotations)
        shifts = [k for k in range(len(pose)) if k not in turns]
        weakest = np.linalg.eigvalsh(stiffness[np.ix_(shifts, shifts)])[0]
        assert machine.margin("stiffness", pose) == pytest.approx(weakest, rel=1e-6)
        if turns:
            weakest = np.linalg.eigvalsh(stiffness[np.ix_(turns, turns)])[0]
            assert machine.margin("rotational_stiffness", pose) == pytest.approx(weakest, rel=1e-6)
        mass = inertia_by_torques(machine, 0.7, pose)
        lowest = np.sqrt(scipy.linalg.eigh(stiffness, mass, eigvals_only=True)[0]) / (2 * np.pi)
        assert machine.margin("natural_frequency", pose) == pytest.approx(lowest, rel=1e-6)


def inertia_by_torques(machine: Mechanism, payload: float, pose: np.ndarray) -> np.ndarray:
    """(n, n) from the torques that accelerate the machine from rest; twist and pose rates are told apart."""
    rates = machine.pose_rates(pose)
    accelerations = np.vstack([np.zeros(len(pose)), rates.T])
    torques = inverse_dynamics(machine, payload, pose, np.zeros(len(pose)), accelerations)
    return (machine.actuator_jacobian(pose).T @ (torques[1:] - torques[0]).T).T


@ALL
def test_the_mass_matrix_is_what_accelerating_torques_feel(name: str) -> None:
    machine = robot(name)
    for pose in poses(machine, 3, seed=4):
        expected = inertia_by_torques(machine, 1.3, pose)
        np.testing.assert_allclose(mass_matrix(machine, 1.3, pose), expected, rtol=1e-8, atol=1e-12, err_msg="seed 4")


@ALL
def test_with_rigid_members_it_is_the_curvature_of_the_drives_energy(name: str) -> None:
    machine = robot(name, STIFF)
    stiffness = machine.inertia.drive_train.of_actuators("stiffness", len(machine.joint_names))
    (pose,) = poses(machine, 1, seed=5)
    drives = np.array(ca.Function("c", [machine.model().geometry], [machine.model().drives])(machine.geometry.vector()))

    def energy(moved: np.ndarray) -> np.ndarray:
        given = (machine.inverse(moved) - machine.inverse(pose)) @ drives.T
        return np.sum(stiffness * given**2, axis=-1) / 2

    def gradient(moved: np.ndarray) -> np.ndarray:
        return differences(lambda at: energy(at)[..., None], moved, 1e-3)[..., 0, :]

    curvature = differences(gradient, pose, 1e-3)
    rates = machine.pose_rates(pose)
    expected, found = rates.T @ curvature @ rates, tool_stiffness(machine, pose)
    size = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    assert np.abs((found - expected) / size).max() < 3e-5, "seed 5"


@ALL
def test_what_a_load_does_is_what_drives_and_members_store(name: str) -> None:
    """The members' energies from their cuts: tension, bending integrated along the member, and torsion."""
    machine, model = robot(name), robot(name).model()
    (pose,) = poses(machine, 1, seed=6)
    found = transmission(machine)
    outputs = [found.wrenches, found.compliance, *(v for cut in found.cuts for v in (cut.along, cut.force, cut.moment))]
    function = ca.Function("statics", [model.pose, model.joints, model.geometry], outputs)
    joints = machine.inverse(pose)
    wrenches, compliance, *cuts = map(np.array, function(pose, joints, machine.geometry.vector()))
    load = np.random.default_rng(6).standard_normal(len(wrenches))
    moved = np.linalg.solve(platform_stiffness(machine, pose), load)
    forces = np.linalg.solve(compliance, wrenches.T @ moved)
    np.testing.assert_allclose(wrenches @ forces, load, rtol=1e-8, atol=1e-8)  # in balance
    efforts = machine.actuator_jacobian(pose)
    stored = 0.0
    lengths = {m.name: m for m in machine.members(*map(ca.SX, (pose, joints)), _numbers(machine))}
    seen = set()
    for cut, along, force, moment in zip(found.cuts, *(cuts[k::3] for k in range(3)), strict=True):
        if cut.member in seen:
            continue
        seen.add(cut.member)
        tube, material = lengths[cut.member].shapes[0], getattr(machine.structure, lengths[cut.member].material)
        start, end = (np.array(ca.DM(p)).ravel() for p in (tube.start, tube.end))
        stored += _energy(np.linalg.norm(end - start), tube, material, along.ravel(), force @ forces, moment @ forces)
        if cut.member.startswith(("rod", "leg", "distal")):
            stored += 2 * (along.ravel() @ force @ forces) ** 2 / machine.structure.joint_stiffness / 2
    if len(load) == len(pose) == len(joints):  # the drives' torques follow from the load alone
        torques = np.linalg.solve(efforts.T, load)
        stiffness = machine.inertia.drive_train.of_actuators("stiffness", len(torques))
        stored += np.sum(torques**2 / stiffness) / 2
        assert load @ moved / 2 == pytest.approx(stored, rel=1e-8)
    else:
        assert 0.0 < stored < load @ moved / 2


@pytest.mark.parametrize("name", ["Heli4", "Hexa", "Peppermill", "Planar3RRR"])
def test_both_ends_of_a_member_are_in_balance(name: str) -> None:
    """The moments at its two cuts differ by the force at the other end."""
    machine, model = robot(name), robot(name).model()
    (pose,) = poses(machine, 1, seed=9)
    members = {m.name: m.shapes[0] for m in machine.members(model.pose, model.joints, model.g)}
    cuts = [cut for cut in transmission(machine).cuts if not cut.member.startswith("rod")]
    count = 4 if name == "Peppermill" else len(machine.joint_names)
    assert len(cuts) == 2 * count
    for root, tip in zip(cuts[::2], cuts[1::2], strict=True):
        tube = members[root.member]
        gap = root.moment - tip.moment - ca.skew(tube.end - tube.start) @ tip.force
        function = ca.Function("gap", [model.pose, model.joints, model.geometry], [gap, root.moment])
        found, size = map(np.array, function(pose, machine.inverse(pose), machine.geometry.vector()))
        assert root.member == tip.member
        assert np.abs(found).max() < 1e-14 * max(np.abs(size).max(), 1.0), "seed 9"


def _numbers(machine: Mechanism):
    _, g = machine.Geometry.symbols()
    for f in fields(machine.geometry):
        setattr(g, f.name, ca.SX(ca.DM(np.asarray(getattr(machine.geometry, f.name), float).ravel())))
    return g


def _energy(length, tube, material, along, force, moment) -> float:
    radius, inside = float(tube.radius), float(tube.radius - tube.wall)
    area, inertia = np.pi * (radius**2 - inside**2), np.pi / 4 * (radius**4 - inside**4)
    nodes, weights = np.polynomial.legendre.leggauss(4)
    bent = 0.0
    for s, w in zip(length * (nodes + 1) / 2, length * weights / 2, strict=True):
        here = moment - s * np.cross(along, force)
        across = here - along * (along @ here)
        bent += w * across @ across / (2 * material.modulus * inertia)
    twist = (along @ moment) ** 2 * length / (2 * material.shear_modulus * 2 * inertia)
    return bent + twist + (along @ force) ** 2 * length / (2 * material.modulus * area)


def test_equal_drives_alone_hold_heli4_with_685_newtons_a_millimetre_and_its_wider_optimum_with_412() -> None:
    """Weakest of many random poses in the paper's cylinder, with 1e5 N m/rad at each drive and the angle held.

    The worst pose of the cylinder, on its lower rim, is weaker still: 669 and 409.
    """
    prototype = Heli4(structure=STIFF)
    lengths = (0.2, 0.08, 0.33431478, 0.78153262, 0.0, 0.02, 0.048806849)  # R, r, L, l, H, h, p
    optimum = prototype.with_geometry(Heli4.Geometry(*lengths))
    region = Cylinder(radius=0.5, z=(-0.8, -0.6), theta=(-np.pi, np.pi))
    assert prototype.inertia.drive_train.stiffness == 1e5
    sample = region.random(prototype.pose_names, 300_000, np.random.default_rng(0))
    for poses_of, expected in ((sample, [685, 412]), (np.array([0.0, -0.5, -0.8, -np.pi]), [669, 409])):
        found = [machine.margin("stiffness", poses_of).min() / 1e3 for machine in (prototype, optimum)]
        np.testing.assert_allclose(found, expected, atol=1.0, err_msg="seed 0")


@pytest.mark.parametrize("name", ["Heli4", "Delta", "Hexa", "Planar3RRR"])
def test_a_machine_twice_as_large_is_twice_as_stiff_and_eight_times_against_turns(name: str) -> None:
    small = robot(name)
    small = small.with_structure(replace(small.structure, joint_stiffness=np.inf))
    sizes = {
        f.name: np.asarray(getattr(small.geometry, f.name)) * (2.0 if f.metadata["kind"].dimension != "angle" else 1.0)
        for f in fields(small.geometry)
    }
    stiffness = tuple(8 * k for k in small.inertia.drive_train.stiffness)
    large = small.with_geometry(small.geometry.with_values(**{k: v.tolist() for k, v in sizes.items()}))
    large = large.with_inertia(replace(large.inertia, drive_train=DriveTrain(stiffness=stiffness)))
    pose = poses(small, 1, seed=8)[0]
    twice = np.where([k in small.rotations for k in range(len(pose))], 1.0, 2.0) * pose
    assert large.margin("stiffness", twice) == pytest.approx(2 * small.margin("stiffness", pose), rel=1e-9)
    if small.rotations:
        expected = 8 * small.margin("rotational_stiffness", pose)
        assert large.margin("rotational_stiffness", twice) == pytest.approx(expected, rel=1e-9)


def test_where_nothing_gives_way_stiffness_is_infinite_and_where_only_some_parts_do_it_is_refused() -> None:
    class OnlyDrives(Planar3RRR):
        statics = Mechanism.statics

    rigid = OnlyDrives(inertia=Planar3RRR.Inertia(drive_train=DriveTrain()))
    pose = rigid.home
    for name in ("stiffness", "rotational_stiffness", "natural_frequency"):
        assert rigid.margin(name, pose) == np.inf
    with pytest.raises(InvalidValue, match="OnlyDrives stiffness: found only rigid parts"):
        tool_stiffness(rigid, pose)
    mixed = rigid.with_inertia(replace(rigid.inertia, drive_train=DriveTrain(stiffness=(np.inf, 1e4, 1e4))))
    with pytest.raises(InvalidValue, match="transmitted force 1 of 3"):
        mixed.margin("stiffness", pose)
    soft = rigid.with_inertia(replace(rigid.inertia, drive_train=DriveTrain(stiffness=1e4)))
    jacobian = soft.inverse_jacobian(pose)
    np.testing.assert_allclose(tool_stiffness(soft, pose), 1e4 * jacobian.T @ jacobian, rtol=1e-9, atol=1e-6)


@ALL
def test_out_of_reach_there_is_no_stiffness(name: str) -> None:
    machine, far = robot(name), np.array(robot(name).home)
    far[0] += 50.0
    if np.isfinite(machine.inverse(far)).all():  # legs of any length reach everywhere
        return
    for margin in ("stiffness", "natural_frequency"):
        assert np.isnan(machine.margin(margin, far))
    assert np.isnan(tool_stiffness(machine, far)).all()
