"""Peppermill (Harada and Angeles, Trans. CSME 2014): two limbs, four identical motors, a platform on two screws.

A pair of motors slides limb i along its drive axis a_i by d_i and turns it about that axis by theta_i. The limbs hold
the nuts of two coaxial screws of different pitch, so that the difference of the nuts' heights turns the platform. The
pose is [x, y, z, theta]; theta is the paper's phi, which continues to count beyond a turn. Equation numbers are those
of the paper. If an equation in print is wrong, the expression here follows from the closure, and a comment says so.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from types import SimpleNamespace
from typing import Any

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.dynamics import from_actuators, to_actuators
from kinematics.evaluation import evaluate
from kinematics.machine import (
    AXES,
    TURN,
    Bodies,
    Particle,
    PassiveJoint,
    Rod,
    Rotor,
    arm_mass,
    rod_mass,
)
from kinematics.margins import ANGLE_ACCURACY, INTERNAL_STIFFNESS, PASSIVE_JOINT, ROTATIONAL_STIFFNESS, STANDARD
from kinematics.model import Build, FviBounds, Mechanism, Mode, Model, by_name
from kinematics.robots.peppermill import limbs
from kinematics.robots.peppermill.geometry import PeppermillGeometry, PeppermillInertia, PeppermillRanges
from kinematics.robots.peppermill.links import links
from kinematics.robots.peppermill.members import base_members, link_tube, members
from kinematics.robots.peppermill.statics import statics

_E_Z = ca.DM([0, 0, 1])


class Peppermill(Mechanism):
    """Pose [x, y, z, theta], joints d1, d2 and theta1, theta2, moved by the motors 1L, 1R, 2L, 2R.

    `inverse_jacobian` and `jacobians` are for the joints d1, d2 [m], theta1, theta2 [rad]. Indices, torques and
    `actuator_jacobian` are for the four identical motors [rad]. J_x is A of (47). J_q is B with the factors r_i, since
    the paper's joint vector holds r_i dtheta_i.
    """

    Geometry = PeppermillGeometry
    Inertia = PeppermillInertia
    Ranges = PeppermillRanges
    geometry: PeppermillGeometry
    inertia: PeppermillInertia
    pose_names = ("x", "y", "z", "theta")
    joint_names = ("d1", "d2", "theta1", "theta2")
    joint_units = ("m", "m", "rad", "rad")
    rotations = (3,)
    counts_turns = True
    # 750 W servos at 3000 rpm and three times their rated torque; 2.5 m/s and 50 N are wanted. All are our assumptions.
    fvi_bounds = FviBounds(joint_speed=314.0, joint_effort=7.2, speed=2.5, force=50.0)
    tool_member = "screws"
    margins = by_name(*STANDARD, ANGLE_ACCURACY, ROTATIONAL_STIFFNESS, INTERNAL_STIFFNESS, PASSIVE_JOINT)

    @property
    def characteristic_length(self) -> float:
        """|p_1 - p_2| / (4 pi), that is p / (2 pi) for the paper's opposite pitches: nut travel per angle [m]."""
        first, second = self.geometry.pitches
        return abs(first - second) / (2 * TURN)

    @staticmethod
    def default_home(geometry: PeppermillGeometry) -> tuple[float, ...]:
        """On both drive axes' common normal, midway between the heights that both limbs reach."""
        g = geometry
        low, high = zip(
            *((abs(r - f), r + f) for r, f in zip(g.proximal_lengths, g.distal_lengths, strict=True)), strict=True
        )
        bottom, top = max(low[0], 2 * g.half_distance - high[1]), min(high[0], 2 * g.half_distance - low[1])
        return 0.0, 0.0, (bottom + top) / 2 - g.half_distance, 0.0

    @cached_property
    def sides(self) -> tuple[int, int]:
        """Signs of v_1z and v_2z at home: whether each limb's distal link points up (1) or down (-1)."""
        first, second = self._evaluate(_distal_heights, self.home)[0].tolist()
        if math.isnan(first + second):
            return limbs.SIDES[0]
        return (1 if first > 0.0 else -1, 1 if second > 0.0 else -1)

    def conditions(self, records: Sequence[str] = ()) -> dict[str, Any]:
        """As in the base, with unusual sides too, as the ranges of the distal links' ends depend on them."""
        sides = {} if self.sides == limbs.SIDES[0] else {"sides": self.sides}
        return super().conditions(records) | sides

    # The closure and its closed forms.

    @staticmethod
    def closure(pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> ca.SX:
        """d_i minus (17), (18), then (l_i^2 - |q_i - r_i u_i|^2) / 2 l_i: two rows a limb; (19), (22)."""
        link = limbs.distal(pose, joints, g)
        square = link.along_x**2 + link.along_y**2
        return ca.vertcat(joints[:2] - pose[:2], (g.distal_lengths - square / g.distal_lengths) / 2)

    @staticmethod
    def inverse_closed_form(pose: ca.SX, g: SimpleNamespace, mode: Mode) -> ca.SX:
        """(19), (25), usually with the + root for both limbs: 0 < lambda_i < pi."""
        return ca.vertcat(pose[:2], mode.angles(*limbs.cosines_and_sines(pose, mode.branches[2:], g), first=2))

    @staticmethod
    def joint_cosines_and_sines(pose: ca.SX, g: SimpleNamespace, mode: Mode) -> tuple[ca.SX, ca.SX]:
        """Of theta_i without an angle; d_i stands under no cosine, so its rows are never read."""
        cosines, sines = limbs.cosines_and_sines(pose, mode.branches[2:], g)
        return ca.vertcat(ca.cos(pose[:2]), cosines), ca.vertcat(ca.sin(pose[:2]), sines)

    @classmethod
    def j_q_closed_form(cls, pose: ca.SX, g: SimpleNamespace, mode: Mode) -> ca.SX:
        """1 for d_i; for theta_i the root that the branch keeps, times r_i / l_i."""
        roots = ca.DM(mode.branches[2:]) * cls.limb_roots(pose, g)
        slopes: ca.SX = ca.vertcat(1, 1, roots * g.proximal_lengths / g.distal_lengths)
        return slopes

    @staticmethod
    def reach(pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """Distance of P_i from the inner and the outer circle of the chain's reach; the smaller one [m]."""
        return limbs.reach(pose, g)

    @classmethod
    def limb_roots(cls, pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """Of the two-bar chains' triangles."""
        return limbs.triangle(limbs.target(pose, g), g)[2]

    @staticmethod
    def scales(g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """1 for d_i and r_i for theta_i; |p_2 - p_1| / (2 pi) for det A."""
        return ca.vertcat(1, 1, g.proximal_lengths), ca.fabs(g.pitches[1] - g.pitches[0]) / TURN

    # The drives.

    @classmethod
    def drives(cls, g: SimpleNamespace) -> ca.SX:
        """(4, 4) from d_1, d_2, theta_1, theta_2 to the motors eta_1L, eta_1R, eta_2L, eta_2R; (A.4)."""
        rate = TURN / g.drive_pitch
        result = ca.SX(4, 4)
        for motor, hand in enumerate((1, -1, 1, -1)):
            result[motor, motor // 2] = hand * rate
            result[motor, 2 + motor // 2] = 1
        return result

    @property
    def actuator_names(self) -> tuple[str, ...]:
        """The motors: limb, then the hand of the screw."""
        return ("1L", "1R", "2L", "2R")

    @property
    def actuator_units(self) -> tuple[str, ...]:
        """All motors turn."""
        return ("rad",) * 4

    def motors(self, joints: Array) -> Array:
        """(..., 4) joints [m, m, rad, rad] -> (..., 4) motor angles [rad]; (A.1)-(A.4)."""
        return to_actuators(self, joints)

    def from_motors(self, motors: Array) -> Array:
        """(..., 4) motor angles [rad] -> (..., 4) joints; (A.5), whose first row is +- p_c / 4 pi, not / 2 pi."""
        return from_actuators(self, motors)

    # All modes.

    def inverse_modes(self, pose: Array) -> Array:
        """(..., 4) -> (..., 4 modes, 4 joints): elbows (+ +), (+ -), (- +), (- -); else NaN."""
        joints = self._evaluate(_inverse_modes, pose)[0]
        joints[np.isnan(joints).any(axis=(-2, -1))] = np.nan
        return joints

    def forward_modes(self, joints: Array) -> Array:
        """(..., 4) -> (..., 4 modes, 4): signs of v_1z, v_2z (+ -), (+ +), (- -), (- +)."""
        pose = evaluate(self.program(_forward_modes), self._joints(joints))[0]
        pose[np.isnan(pose).any(axis=(-2, -1))] = np.nan
        return pose

    def working_forward(self, joints: Array) -> Array:
        """(..., 4) -> (..., 4): each limb reaches up or down to the platform as it does at home.

        It undoes `inverse` wherever the distal links do so: up to the singularities of the second kind.
        """
        return self.forward_modes(joints)[..., limbs.SIDES.index(self.sides), :]

    def assembly_modes(self, joints: Array) -> Array:
        """(4,) -> (k, 4), every real pose with these joints, at most four; the working one first."""
        joints = self._one(joints)
        modes = np.roll(self.forward_modes(joints), -limbs.SIDES.index(self.sides), axis=0)
        modes = modes[np.isfinite(modes).all(axis=-1)]
        _, first = np.unique(modes, axis=0, return_index=True)
        result: Array = modes[np.sort(first)]
        return result

    # Masses and drawing.

    def passive_joints(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[PassiveJoint]:
        """The two R joints of each CRR limb: the elbow, at lambda_i, and the joint on the nut, which stays upright.

        The elbow rests at a right angle. The joint at the nut rests where the distal link points up or down, as at
        home.
        """
        _, _, elbows, nuts = self.points(pose, joints, g)
        theta, rods = joints[2:], nuts - elbows
        proximal, up = limbs.in_space(limbs.Plane(ca.cos(theta), ca.sin(theta))), ca.SX(_E_Z)
        first = [PassiveJoint(proximal[:, i], rods[:, i], g.distal_lengths[i], 0) for i in range(2)]
        return first + [
            PassiveJoint(self.sides[i] * up, rods[:, i], g.distal_lengths[i], 1, swivels=False) for i in range(2)
        ]

    @staticmethod
    def points(pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> tuple[ca.SX, ca.SX, ca.SX, ca.SX]:
        """O_i, A_i, B_i, P_i, each (3, 2): drive axes' origins, carriages, elbows, nuts; (3), (4), (9), (11)."""
        origins = _E_Z @ (g.half_distance * ca.DM([[-1, 1]]))
        carriages = origins + ca.DM([[1, 0], [0, 1], [0, 0]]) @ ca.diag(joints[:2])
        theta = joints[2:]
        proximal = limbs.in_space(limbs.Plane(ca.cos(theta), ca.sin(theta))) @ ca.diag(g.proximal_lengths)
        nuts = ca.repmat(pose[:3], 1, 2) + _E_Z @ (g.pitches.T / TURN * pose[3])
        return origins, carriages, carriages + proximal, nuts

    members = members
    base_members = base_members
    link_tree = links

    def bodies(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, payload: float | ca.SX) -> Bodies:
        """Motors, carriages, proximal and distal links, nuts, platform, payload."""
        i, bodies = self.inertia, Bodies()
        links = self.structure.link.density * link_tube(pose[:3], pose[:3], g).area  # mass for each metre
        given = i.proximal_mass, i.proximal_centre, i.proximal_factor
        _, carriages, elbows, nuts = self.points(pose, joints, g)
        eta = self.drives(g) @ joints
        bodies.rotors.extend(Rotor(i.motor, eta[k]) for k in range(4))
        for limb in range(2):
            carriage, link = carriages[:, limb], elbows[:, limb] - carriages[:, limb]
            mass, centre, factor = arm_mass(links * g.proximal_lengths[limb], i.proximal_hub, i.proximal_joint, given)
            own = (factor - 1) * mass * (centre * g.proximal_lengths[limb]) ** 2  # beyond the particle at the centre
            slide, proximal, nut = (f"{name} {limb + 1}" for name in ("carriage", "proximal link", "nut"))
            bodies.particles.extend(
                [
                    Particle(slide, i.carriage_mass, carriage),
                    Particle(proximal, mass, carriage + centre * link),
                    Particle(nut, i.nut_mass, nuts[:, limb]),
                ]
            )
            bodies.rotors.append(Rotor(i.carriage, joints[2 + limb], AXES[limb]))
            bodies.rotors.append(Rotor(own, joints[2 + limb], AXES[limb], proximal))
            whole, middle = rod_mass(links * g.distal_lengths[limb], i.distal_joint, i.distal_mass, i.rod_middle)
            bodies.rods.append(Rod(whole, middle, (nut, proximal), nuts[:, limb], elbows[:, limb]))
        bodies.particles.append(Particle("platform", i.platform_mass + payload, pose[:3]))
        bodies.rotors.append(Rotor(i.tool, pose[3], AXES[2]))
        return bodies

    @classmethod
    def points_apart(cls, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> tuple[ca.SX, ca.SX, ca.SX, ca.SX]:
        """O_i, A_i, B_i and P_i, each (3, 2), of the machine as it is built.

        The paper's nuts coincide at theta = 0. Limb 1 is moved down and limb 2 up, by half of `nut_spacing` each: the
        same machine with its drive axes further apart.
        """
        apart = _E_Z @ (g.nut_spacing / 2 * ca.DM([[-1, 1]]))
        origins, carriages, elbows, nuts = (points + apart for points in cls.points(pose, joints, g))
        return origins, carriages, elbows, nuts

    statics = statics

    @classmethod
    def beyond_twist(cls, pose: ca.SX, g: SimpleNamespace, limb: int | None, point: ca.SX) -> ca.SX:
        """Two tilts about the tool point, and each nut's own turn, by which it falls."""
        tilts, turns = -ca.skew(point - pose[:3])[:, :2], ca.SX(3, 2)
        if limb is not None:
            turns[2, limb] = -g.pitches[limb] / TURN
        return ca.horzcat(tilts, turns)

    @staticmethod
    def skeleton(pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> dict[str, ca.SX]:
        """The z axis between the drive axes, these axes, both limbs, the screws and the tool's pointer."""
        origins, carriages, elbows, nuts = Peppermill.points(pose, joints, g)
        lines = {"base": origins}
        for limb in range(2):
            axis = g.half_distance * ca.DM.eye(3)[:, limb]
            lines[f"drive axis {limb + 1}"] = ca.horzcat(origins[:, limb] - axis, origins[:, limb] + axis)
            lines[f"proximal {limb + 1}"] = ca.horzcat(carriages[:, limb], elbows[:, limb])
            lines[f"distal {limb + 1}"] = ca.horzcat(elbows[:, limb], nuts[:, limb])
        lines["screws"] = nuts
        pointer = 0.2 * g.proximal_lengths[0] * ca.vertcat(ca.cos(pose[3]), ca.sin(pose[3]), 0)
        lines["tool"] = ca.horzcat(pose[:3], pose[:3] + pointer)
        return lines


def _distal_heights(_: Peppermill, model: Model) -> list[ca.SX]:
    link = limbs.distal(model.pose, model.joints, model.g)
    return [model.at_pose(ca.vertcat(link.along_y[0], link.along_x[1]))]


def _inverse_modes(_: Peppermill, model: Model) -> list[ca.SX]:
    found = [limbs.cosines_and_sines(model.pose, elbows, model.g) for elbows in limbs.ELBOWS]
    return [ca.horzcat(*(ca.vertcat(model.pose[:2], model.mode.angles(*both, first=2)) for both in found)).T]


def _forward_modes(_: Peppermill, model: Model) -> Build:
    return [model.joints], [ca.horzcat(*(limbs.pose_of_joints(model.joints, s, model.g) for s in limbs.SIDES)).T]
