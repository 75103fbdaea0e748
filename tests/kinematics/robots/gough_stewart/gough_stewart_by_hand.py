"""The Gough-Stewart platform written out by hand from the figure, and random examples: what the tests compare with."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from kinematics import Array, GoughStewart

AROUND_HOME = np.array([0.15, 0.15, 0.15, 0.35, 0.35, 0.35])


def random_points(rng: np.random.Generator, planar: bool = False) -> Array:
    """(6, 3), in the xy plane if planar."""
    return rng.normal(size=(6, 3)) * ([1.0, 1.0, 0.0] if planar else 1.0)


def random_frame(rng: np.random.Generator) -> Array:
    """(4, 4) a rigid transform."""
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = Rotation.random(random_state=rng).as_matrix(), rng.normal(size=3)
    return result


def random_robot(rng: np.random.Generator, planar: bool = False, frames: bool = True) -> GoughStewart:
    """Any joint centres and, unless told otherwise, any frames Z and E."""
    points = {"base_points": random_points(rng, planar), "platform_points": random_points(rng, planar)}
    placed = {"Z": random_frame(rng), "E": random_frame(rng)} if frames else {}
    return GoughStewart(GoughStewart.Geometry(**points, **placed))


def random_poses(rng: np.random.Generator, count: int) -> Array:
    """(count, 6) within 0.15 m and 0.35 rad of home in each coordinate."""
    return np.array(GoughStewart().home) + rng.uniform(-1.0, 1.0, (count, 6)) * AROUND_HOME


def anywhere(rng: np.random.Generator, count: int) -> Array:
    """(count, 6) of every orientation."""
    place = rng.uniform(-1.0, 1.0, (count, 3))
    return np.hstack([place, angles_of(Rotation.random(count, random_state=rng).as_matrix())])


def matrix_of(pose: Array) -> Array:
    """(..., 6) -> (..., 3, 3), Rz(yaw) Ry(pitch) Rx(roll) from scipy."""
    return Rotation.from_euler("xyz", pose[..., 3:].reshape(-1, 3)).as_matrix().reshape(*pose.shape[:-1], 3, 3)


def angles_of(matrix: Array) -> Array:
    """(k, 3, 3) -> (k, 3) roll, pitch, yaw from scipy."""
    return Rotation.from_matrix(matrix).as_euler("xyz")


def transform_of(pose: Array) -> Array:
    """(6,) -> (4, 4)."""
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = matrix_of(pose), pose[:3]
    return result


def pose_of(transform: Array) -> Array:
    """(4, 4) -> (6,)."""
    return np.concatenate([transform[:3, 3], angles_of(transform[None, :3, :3])[0]])


def leg_vectors(robot: GoughStewart, pose: Array) -> tuple[Array, Array]:
    """A_i B_i (6, 3) and O_E B_i (6, 3) in R_f at one pose, point by point through R_f, R_0, R_m and R_E; [8.5]."""
    g = robot.geometry
    base_in_f, platform_in_f = np.array(g.Z), transform_of(pose) @ np.linalg.inv(np.array(g.E))
    legs, arms = [], []
    for a, b in zip(g.base_points, g.platform_points, strict=True):
        end = (platform_in_f @ [*b, 1.0])[:3]
        legs.append(end - (base_in_f @ [*a, 1.0])[:3])
        arms.append(end - pose[:3])
    return np.array(legs), np.array(arms)


def printed_inverse_jacobian(robot: GoughStewart, pose: Array) -> Array:
    """(6, 6) [8.20] as printed: u_i and u_i x B_i O_E, row by row."""
    rows = []
    for leg, arm in zip(*leg_vectors(robot, pose), strict=True):
        u = leg / np.linalg.norm(leg)
        rows.append(np.concatenate([u, np.cross(u, -arm)]))
    return np.array(rows)


def moved(pose: Array, twist: Array, time: float) -> Array:
    """(6,) the pose after a constant twist (v, omega), for a time."""
    turned = Rotation.from_rotvec(time * twist[3:]).as_matrix() @ matrix_of(pose)
    return np.concatenate([pose[:3] + time * twist[:3], angles_of(turned[None])[0]])


def pose_errors(found: Array, wanted: Array) -> Array:
    """(...,) distance of poses: translation [m] plus the chord of the rotation."""
    shift = np.linalg.norm(found[..., :3] - wanted[..., :3], axis=-1)
    return shift + np.linalg.norm(matrix_of(found) - matrix_of(wanted), axis=(-2, -1))
