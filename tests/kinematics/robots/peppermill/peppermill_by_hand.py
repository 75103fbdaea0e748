"""The Peppermill written a second time, in numpy from its vectors (1)-(14), as an oracle; and where the tests look."""

from dataclasses import dataclass

import numpy as np

from kinematics import Peppermill

TURN = 2 * np.pi
K = np.array([0.0, 0.0, 1.0])
A = np.eye(3)[:2]  # a_i: i, j
X = np.array([[0, 1, 0], [0, 0, 1]])  # x_i: j, k, as (29) and (30) print them
Y = np.array([[0, 0, 1], [1, 0, 0]])  # y_i: k, i


@dataclass(frozen=True)
class ByHand:
    """Vectors (..., 2, 3), the limb's axis before the last."""

    g: Peppermill.Geometry

    def u(self, joints):
        theta = np.asarray(joints)[..., 2:, None]
        return np.cos(theta) * X + np.sin(theta) * Y

    def u_theta(self, joints):
        theta = np.asarray(joints)[..., 2:, None]
        return -np.sin(theta) * X + np.cos(theta) * Y

    @property
    def origins(self):
        return np.array([[-1.0], [1.0]]) * self.g.half_distance * K

    def carriages(self, joints):
        return self.origins + np.asarray(joints)[..., :2, None] * A

    def elbows(self, joints):
        return self.carriages(joints) + np.array(self.g.proximal_lengths)[:, None] * self.u(joints)

    def nuts(self, pose):
        pose = np.asarray(pose)
        climb = np.array(self.g.pitches) / TURN * pose[..., 3:4]
        return pose[..., None, :3] + climb[..., None] * K

    def distal(self, pose, joints):
        """B_i P_i, whose direction is v_i."""
        return self.nuts(pose) - self.elbows(joints)

    def gaps(self, pose, joints):
        """|B_i P_i| - l_i, and how far B_i P_i leaves the limb's plane: (..., 4) [m]."""
        link = self.distal(pose, joints)
        away = np.linalg.norm(link, axis=-1) - self.g.distal_lengths
        return np.concatenate([away, (link * A).sum(-1)], axis=-1)

    def a_and_b(self, pose, joints):
        """A and B of (47), (..., 4, 4)."""
        v = self.distal(pose, joints) / np.array(self.g.distal_lengths)[:, None]
        vu = (v * self.u_theta(joints)).sum(-1)
        lead = np.array(self.g.pitches) / TURN
        a, b = np.zeros((2, *vu.shape[:-1], 4, 4))
        a[..., [0, 1], [0, 1]] = b[..., [0, 1], [0, 1]] = 1.0
        a[..., 2, 1], a[..., 2, 2], a[..., 2, 3] = v[..., 0, 1], v[..., 0, 2], lead[0] * v[..., 0, 2]
        a[..., 3, 0], a[..., 3, 2], a[..., 3, 3] = v[..., 1, 0], v[..., 1, 2], lead[1] * v[..., 1, 2]
        b[..., 2, 2], b[..., 3, 3] = vu[..., 0], vu[..., 1]
        return a, b

    @property
    def drives(self):
        """(A.4) for both limbs."""
        k = TURN / self.g.drive_pitch
        return np.array([[k, 0, 1, 0], [-k, 0, 1, 0], [0, k, 0, 1], [0, -k, 0, 1]])

    def assembled(self, theta, link_angle):
        """Pose and joints built from the links outwards, without any inverse or forward model.

        Args:
            theta, link_angle: (..., 2) theta_i, and theta_i + lambda_i.
        """
        near, far = np.array(self.g.proximal_lengths), np.array(self.g.distal_lengths)
        q = near[:, None] * (np.cos(theta)[..., None] * X + np.sin(theta)[..., None] * Y)
        q = q + far[:, None] * (np.cos(link_angle)[..., None] * X + np.sin(link_angle)[..., None] * Y)
        x, y = q[..., 1, 0], q[..., 0, 1]  # the closure's level rows of limb 2 and limb 1
        heights = (self.origins + q)[..., 2]
        screws = np.stack([np.ones(2), np.array(self.g.pitches) / TURN], axis=-1)
        z_phi = np.linalg.solve(screws, heights[..., None])[..., 0]
        pose = np.stack([x, y, z_phi[..., 0], z_phi[..., 1]], axis=-1)
        return pose, np.concatenate([pose[..., :2], theta], axis=-1)


def box(count, seed, margin=0.0):
    """Poses of the 0.4 x 0.4 x 0.1 m box about the origin, a full turn either way."""
    half = np.array([0.2, 0.2, 0.05, TURN]) + margin
    return np.random.default_rng(seed).uniform(-half, half, (count, 4))


def faces():
    """A dense grid of that box, its faces, edges and corners included."""
    axes = [np.linspace(-h, h, n) for h, n in zip((0.2, 0.2, 0.05, TURN), (31, 31, 21, 41), strict=True)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 4)


def random_geometry(rng):
    first, second = rng.choice([-1, 1], 2) * rng.uniform(0.03, 0.2, 2)
    if abs(first - second) < 0.03:
        second = -first
    return Peppermill.Geometry(
        proximal_lengths=tuple(rng.uniform(0.1, 0.4, 2)),
        distal_lengths=tuple(rng.uniform(0.3, 0.9, 2)),
        half_distance=rng.uniform(0.3, 0.8),
        pitches=(first, second),
        drive_pitch=rng.uniform(0.02, 0.2),
    )


def assembled(geometry, rng, count, elbows=(1, 1), sides=(1, -1)):
    """Random pose and joints (count, 4) in a given mode, kept off its singularities: |sin lambda_i|, |v_iz| > 0.2."""
    off = 0.21
    elbow = np.array(elbows) * rng.uniform(off, np.pi - off, (count, 2))
    above = np.arcsin(off) + rng.uniform(0, np.pi - 2 * np.arcsin(off), (count, 2))  # of v_i over the level plane
    up = np.where(np.array(sides) > 0, above, above + np.pi)  # from j towards k, and from i towards k
    link_angle = np.stack([up[:, 0], np.pi / 2 - up[:, 1]], axis=-1)  # limb 2 counts from k towards i
    return ByHand(geometry).assembled(link_angle - elbow, link_angle)
