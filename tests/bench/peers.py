"""Heli4 and the redundant robot in plain batched numpy, by hand: what a careful engineer would write without us."""

from __future__ import annotations

import numpy as np

from kinematics import Array, Heli4, Redundant3T1R

UPPER = np.array([0.0, 0.0, 1.0, 1.0])


def platform_points(g: Heli4.Geometry, pose: Array) -> Array:
    """(k, 4, 3) B_i."""
    radial = np.stack([np.cos(g.azimuths), np.sin(g.azimuths), np.zeros(4)], axis=-1)
    heights = g.plate_offset + UPPER * (g.height_step + g.pitch / (2 * np.pi) * pose[:, 3:4])
    points = pose[:, None, :3] + g.platform_radius * radial
    points[..., 2] += heights
    return points


def actuators(g: Heli4.Geometry) -> tuple[Array, Array]:
    """(4, 3) P_i and (4, 3) u_i."""
    radial = np.stack([np.cos(g.azimuths), np.sin(g.azimuths), np.zeros(4)], axis=-1)
    points = g.base_radius * radial
    points[:, 2] += g.height_step * UPPER
    return points, radial


def inverse(g: Heli4.Geometry, pose: Array) -> Array:
    """(k, 4) -> (k, 4)."""
    base, radial = actuators(g)
    away = base - platform_points(g, pose)
    m, n = 2 * g.arm_length * away[..., 2], 2 * g.arm_length * (away * radial).sum(axis=-1)
    right = g.rod_length**2 - (away**2).sum(axis=-1) - g.arm_length**2
    return np.arctan2(n, m) + np.arctan2(np.sqrt(m**2 + n**2 - right**2), right)


def fvi(g: Heli4.Geometry, pose: Array, speed: float, effort: float, v: float, f: float, length: float) -> Array:
    """(k,) by the batched inverse of the homogeneous inverse Jacobian."""
    q = inverse(g, pose)
    base, radial = actuators(g)
    along = np.sin(q)[..., None] * radial + np.cos(q)[..., None] * np.array([0, 0, 1.0])
    tangent = np.cos(q)[..., None] * radial - np.sin(q)[..., None] * np.array([0, 0, 1.0])
    rods = base + g.arm_length * along - platform_points(g, pose)
    j_x = np.concatenate([rods, (UPPER * g.pitch / (2 * np.pi) * rods[..., 2])[..., None]], axis=-1)
    j_m = j_x / (g.arm_length * (rods * tangent).sum(axis=-1))[..., None]
    j_m[..., 3] /= length
    velocity = 1 / np.linalg.norm(j_m, axis=-1).max(axis=-1)
    force = 1 / np.linalg.norm(np.linalg.inv(j_m), axis=-2).max(axis=-1)
    return np.minimum(velocity * speed / v, force * effort / f)


def stiffness(robot: Heli4, pose: Array) -> Array:
    """(k,) the weakest translational stiffness with theta held: 2 x 2 compliances, an 8 x 8 matrix, `eigvalsh`."""
    g, s = robot.geometry, robot.structure
    q = inverse(g, pose)
    base, radial = actuators(g)
    up, axis = np.array([0, 0, 1.0]), np.cross([0, 0, 1.0], radial)
    along = np.sin(q)[..., None] * radial + np.cos(q)[..., None] * up
    ends = platform_points(g, pose)
    rods = (ends - base - g.arm_length * along) / g.rod_length
    area, _ = _ring(g.rod_radius, g.rod_wall)
    arm_area, inertia = _ring(g.arm_radius, g.arm_wall)
    length, bending = g.arm_length, s.arm.modulus * inertia
    drive = robot.inertia.drive_train.stiffness
    give = g.rod_length / (s.rod.modulus * area) + 2 / s.joint_stiffness
    across, tension = np.cross(along, rods), (along * rods).sum(axis=-1)
    moments = np.stack([np.cross(side * g.parallelogram_width * axis, rods) for side in (-0.5, 0.5)], axis=-2)
    torques = (moments * along[..., None, :]).sum(axis=-1)
    mixed = (moments * across[..., None, :]).sum(axis=-1)
    about = (across * axis).sum(axis=-1) * length
    shared = tension**2 * length / (s.arm.modulus * arm_area) + about**2 / drive
    shared += length**3 / (3 * bending) * (across**2).sum(axis=-1)
    compliance = moments @ np.swapaxes(moments, -1, -2) * length / bending + shared[..., None, None] + give * np.eye(2)
    twist = length / (2 * s.arm.shear_modulus * inertia) - length / bending
    compliance += twist * torques[..., :, None] * torques[..., None, :]
    compliance += length**2 / (2 * bending) * (mixed[..., :, None] + mixed[..., None, :])
    wrenches = np.zeros((len(pose), 4, 2, 7))  # x, y, z, then omega_x, omega_y and both plates' turns
    pull, lead = -rods, g.pitch / (2 * np.pi)
    for k, side in enumerate((-0.5, 0.5)):
        levers = ends + side * g.parallelogram_width * axis - pose[:, None, :3]
        moment = np.cross(levers, pull)
        wrenches[:, :, k, :3], wrenches[:, :, k, 3:5] = pull, moment[..., :2]
        wrenches[:, :2, k, 5], wrenches[:, 2:, k, 6] = moment[:, :2, 2], moment[:, 2:, 2] - lead * pull[:, 2:, 2]
    inner = np.linalg.solve(compliance, wrenches)
    whole = np.einsum("kiap,kiaq->kpq", wrenches, inner, optimize=True)
    free = whole[:, 3:, 3:]
    left = whole[:, :3, :3] - whole[:, :3, 3:] @ np.linalg.solve(free, whole[:, 3:, :3])
    return np.linalg.eigvalsh(left)[:, 0]


def _ring(radius: float, wall: float) -> tuple[float, float]:
    """Area and second moment of area."""
    inside = radius - wall
    return np.pi * (radius**2 - inside**2), np.pi / 4 * (radius**4 - inside**4)


def forward(g: Heli4.Geometry, q: Array) -> Array:
    """(k, 4) -> (k, 4) by Newton's method on the four closures from home, a 4 x 4 solve a step."""
    base, radial = actuators(g)
    along = np.sin(q)[..., None] * radial + np.cos(q)[..., None] * np.array([0, 0, 1.0])
    arms = base + g.arm_length * along
    pose = np.tile([0.0, 0.0, -0.7, 0.0], (len(q), 1))
    for _ in range(60):
        rods = platform_points(g, pose) - arms
        residual = ((rods**2).sum(axis=-1) - g.rod_length**2) / 2
        jacobian = np.concatenate([rods, (UPPER * g.pitch / (2 * np.pi) * rods[..., 2])[..., None]], axis=-1)
        step = np.linalg.solve(jacobian, residual[..., None])[..., 0]
        pose -= step
        if np.abs(step).max() < 1e-13:
            break
    return pose


def redundant_fvi(
    g: Redundant3T1R.Geometry, pose: Array, speed: float, effort: float, v: float, f: float, length: float
) -> Array:
    """(k,) by the batched pseudo-inverse of the homogeneous inverse Jacobian; (33), (39), (40) of Shayya et al."""
    outer = np.array([True, True, False, False, True, True])
    reach = np.where(outer, g.outer_arm_length, g.middle_arm_length)
    rails = np.where(outer, g.outer_rail_y, g.middle_rail_y) * [1, -1, 1, -1, 1, -1]
    ahead, up = np.where(outer, -0.5, 0.5) * g.platform_length, np.array([0.5, 0.5, 0, 0, -0.5, -0.5])
    heights = up * g.platform_height - 2 * up * g.outer_rail_z
    sine, cosine = np.sin(pose[:, 3:]), np.cos(pose[:, 3:])
    y, z = pose[:, 1:2] + ahead * sine - rails, pose[:, 2:3] + heights
    x = np.sqrt(reach**2 - y**2 - z**2)
    turning = ahead * (y * cosine / x - sine) / length
    j_mw = np.stack([np.ones_like(x), y / x, z / x, turning], axis=-1)
    velocity = 1 / np.linalg.norm(j_mw, axis=-1).max(axis=-1)
    force = 1 / np.linalg.norm(np.linalg.pinv(j_mw), axis=-2).max(axis=-1)
    return np.minimum(velocity * speed / v, force * effort / f)
