"""Arms and rods of rotary limbs as members."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING

import casadi as ca

from kinematics.machine import Member, Tube, bar

if TYPE_CHECKING:
    from kinematics.robots.shared.rotary_limbs import Limbs, RotaryLimbs

SIDES = {" a": -0.5, " b": 0.5}  # of the two rods of a limb, in parts of their distance


def limb_members(
    robot: type[RotaryLimbs], pose: ca.SX, joints: ca.SX, g: SimpleNamespace, width: ca.SX | None
) -> list[Member]:
    """Each limb's arm, from P_i to A_i, and its rod to B_i; or its two rods, `width` apart on an axle of the arm."""
    limbs, ends = robot.limbs(g), robot.platform_points(pose, g)
    elbows, axes = limbs.elbows(joints), limbs.axes()
    found = []
    for i in range(joints.numel()):
        arm = Tube(limbs.actuators[:, i], elbows[:, i], g.arm_radius, g.arm_wall)
        shapes, rods = [arm], {"": 0 * axes[:, i]}
        if width is not None:
            rods = {name: side * width * axes[:, i] for name, side in SIDES.items()}
            first, second = (elbows[:, i] + aside for aside in rods.values())
            shapes.append(Tube(first, second, g.rod_radius, g.rod_radius))
        arm_joints = (f"P{i + 1}", *(f"A{i + 1}{name}" for name in rods))
        found.append(Member(f"arm {i + 1}", arm_joints, "arm", tuple(shapes)))
        for name, aside in rods.items():
            tube = Tube(elbows[:, i] + aside, ends[:, i] + aside, g.rod_radius, g.rod_wall)
            held = (f"A{i + 1}{name}", f"B{i + 1}{name}")
            found.append(Member(f"rod {i + 1}{name}", held, "rod", (tube,), f"rod {i + 1}"))
    return found


def motors(limbs: Limbs, g: SimpleNamespace) -> list[Member]:
    """Each limb's motor, along the arm's axis about P_i."""
    points, half = limbs.actuators, g.motor_length / 2 * limbs.axes()
    starts, ends = points - half, points + half
    return [
        bar(f"motor {i + 1}", ("base", f"P{i + 1}"), "", starts[:, i], ends[:, i], g.motor_radius)
        for i in range(points.shape[1])
    ]


def pairs_held(*limbs: int) -> list[str]:
    """What the joints of both rods of some limbs, counted from 0, are called on the platform."""
    return [f"B{i + 1}{name}" for i in limbs for name in SIDES]


def studs(points: ca.SX, axes: ca.SX, width: ca.SX) -> ca.SX:
    """(3, 2 m) where the rods meet the platform, half of `width` to either side of the B_i (3, m)."""
    both = [points[:, i] + side * width * axes[:, i] for i in range(points.shape[1]) for side in SIDES.values()]
    result: ca.SX = ca.horzcat(*both)
    return result
