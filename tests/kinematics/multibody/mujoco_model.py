"""A robot's MJCF export in MuJoCo, and the motions that it is compared on."""

from __future__ import annotations

import math
from dataclasses import replace

import casadi as ca
import mujoco
import numpy as np

from kinematics import GoughStewart, Heli4, Peppermill, Redundant3T1R
from kinematics.machine.bodies import UNIFORM
from kinematics.multibody.mjcf import mjcf
from kinematics.multibody.open_tree import tree_motion
from trajectory import AdeptCycle

MAIN = (Heli4, Redundant3T1R, Peppermill, GoughStewart)
PATHS = {
    Heli4: AdeptCycle(),
    Redundant3T1R: AdeptCycle(heading=math.pi / 2, pick=(0.0, -0.1525, 0.0), turn=math.pi / 2),
    Peppermill: AdeptCycle(pick=(-0.1525, 0.0, -0.0125)),
    GoughStewart: AdeptCycle(span=0.15, pick=(-0.075, 0.0, 0.6), turn=0.3),
}


def with_rods(robot, uniform):
    """Rods as bodies, or their masses at their ends; a hexapod's are 0.3 m long."""
    field, values = ("rod_length", (0.0, 0.3)) if isinstance(robot, GoughStewart) else ("rod_middle", (0.0, UNIFORM))
    mass = {"rod_mass": 0.8} if isinstance(robot, GoughStewart) else {}  # a rod without length has none of its own
    return robot.with_inertia(replace(robot.inertia, **{field: values[int(uniform)]}, **mass))


def cycle(kind, half, times):
    """There and back in 2 `half` seconds, s by the septic smoothstep: pose, velocity, acceleration (k, n)."""
    path, step = PATHS[kind], np.polynomial.Polynomial([0, 0, 0, 0, 35, -84, 70, -20])
    there = times <= half
    u, way = np.where(there, times / half, 2 - times / half).clip(0, 1), np.where(there, 1.0, -1.0) / half
    s, rate, second = (path.length * step.deriv(k)(u) * way**k for k in range(3))
    pose, first, curve = path.evaluate(s, 2)
    parts = [pose, first * rate[:, None], curve * rate[:, None] ** 2 + first * second[:, None]]
    if kind is GoughStewart:  # level, the turn about z
        parts = [np.concatenate([p[:, :3], np.zeros((len(p), 2)), p[:, 3:]], axis=1) for p in parts]
    return parts


def loaded(robot, pose, payload):
    """MuJoCo's model and data of the export."""
    model = mujoco.MjModel.from_xml_string(mjcf(robot, pose, payload))
    return model, mujoco.MjData(model)


class OpenTree:
    """MuJoCo's export without its loops."""

    def __init__(self, robot, reference, payload):
        self.robot, self.reference = robot, reference
        self.model, self.data = loaded(robot, reference, payload)
        self.names = [self.model.joint(k).name for k in range(self.model.njnt)]

    def place(self, pose, velocity, acceleration):
        """Puts all joints where the motion has them."""
        motion = tree_motion(self.robot, self.reference, pose, velocity, acceleration)
        for k, part in enumerate((self.data.qpos, self.data.qvel, self.data.qacc)):
            part[:] = [motion[name][k] for name in self.names]

    def loop_errors(self, pose):
        """By how much the loops do not close at a pose [m or rad]."""
        self.place(pose, np.zeros_like(pose), np.zeros_like(pose))
        mujoco.mj_forward(self.model, self.data)
        return self.data.efc_pos.copy()

    def forces(self, pose, velocity, acceleration):
        """{joint: force} from MuJoCo's own inertia matrix and bias; drives' friction and loops are not in them."""
        self.place(pose, velocity, acceleration)
        mujoco.mj_fwdPosition(self.model, self.data)
        mujoco.mj_fwdVelocity(self.model, self.data)
        inertia = np.zeros((self.model.nv, self.model.nv))
        mujoco.mj_fullM(self.model, self.data, inertia)
        return dict(zip(self.names, inertia @ self.data.qacc + self.data.qfrc_bias, strict=True))

    def wrench(self, pose, velocity, acceleration):
        """(n,) `forces` on the twist, by virtual work."""
        n, forces = len(pose), self.forces(pose, velocity, acceleration)
        rates = tree_motion(self.robot, self.reference, np.tile(pose, (n, 1)), np.eye(n), np.zeros((n, n)))
        by_pose = sum(rates[name][1] * force for name, force in forces.items())
        return np.array(ca.evalf(self.robot.pose_rate_map(ca.SX(pose)))).T @ by_pose
