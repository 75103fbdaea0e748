"""Heli4's joint-and-loop graph, its joints placed by the robot's own points; Krut et al. 2006, figure 1."""

from __future__ import annotations

import numpy as np

from kinematics.arrays import Array
from kinematics.evaluation import evaluate
from kinematics.mobility import Joint, JointGraph
from kinematics.model import Build, Model
from kinematics.robots.heli4.heli4 import Heli4
from kinematics.robots.shared import radial_directions

_E_Z = np.array([0.0, 0.0, 1.0])


def heli4_joint_graph(robot: Heli4, pose: Array) -> JointGraph:
    """16 parts and 22 joints (5 R, 16 S, 1 H) at a pose (4,).

    Parts: base, arm 1-4, rod 11-42, lower and upper plate, tool. The tool turns in the lower plate and screws in the
    upper one: the plate climbs by +p while it turns backwards relative to the tool, hence the sign of the pitch.

    Raises:
        UnreachablePose: a limb cannot reach the pose.
    """
    robot.require_reachable(pose)
    pose = np.asarray(pose, dtype=float)
    drives, arms, platforms, axes = evaluate(robot.program(_places), pose)
    joints = []
    for i in range(4):
        arm, plate = f"arm {i + 1}", ("lower plate", "upper plate")[i // 2]
        joints.append(Joint("R", "base", arm, drives[i], (axes[i],), driven=True))
        for side in (1, 2):
            rod, offset = f"rod {i + 1}{side}", (side - 1.5) * robot.geometry.parallelogram_width * axes[i]
            joints += [Joint("S", arm, rod, arms[i] + offset), Joint("S", rod, plate, platforms[i] + offset)]
    joints.append(Joint("R", "tool", "lower plate", pose[:3], (_E_Z,)))
    joints.append(Joint("H", "tool", "upper plate", pose[:3], (_E_Z,), pitch=-robot.geometry.pitch))
    return JointGraph(tuple(joints))


def _places(_: Heli4, model: Model) -> Build:
    """Drives, elbows, rods' ends and axes."""
    points = Heli4.limbs(model.g).actuators, Heli4.limbs(model.g).elbows(model.joints)
    platform = Heli4.platform_points(model.pose, model.g)
    return [model.pose], [model.at_pose(p).T for p in (*points, platform, radial_directions(model.g.azimuths)[1])]
