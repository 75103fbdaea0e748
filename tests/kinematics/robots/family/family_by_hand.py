"""The planar robots, Delta, Hexa and Par4 written a second time, in numpy, as an oracle; and where the tests look."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from kinematics import Delta, Hexa, Mechanism, Par4, Planar3PRR, Planar3RPR, Planar3RRR

E_Z = np.array([0.0, 0.0, 1.0])
PLANAR = (Planar3RPR, Planar3PRR, Planar3RRR)
FAMILY = (*PLANAR, Delta, Hexa, Par4)


def radial(angles) -> np.ndarray:
    """(..., 3) unit vectors of the horizontal plane."""
    a = np.asarray(angles, dtype=float)
    return np.stack([np.cos(a), np.sin(a), 0 * a], axis=-1)


def rotation(angles) -> np.ndarray:
    """Rz(yaw) Ry(pitch) Rx(roll), by three products."""
    roll, pitch, yaw = np.moveaxis(np.asarray(angles, dtype=float), -1, 0)

    def about(axis: int, angle: np.ndarray) -> np.ndarray:
        i, j = (axis + 1) % 3, (axis + 2) % 3
        r = np.zeros((*angle.shape, 3, 3))
        r[..., axis, axis] = 1.0
        r[..., i, i] = r[..., j, j] = np.cos(angle)
        r[..., i, j], r[..., j, i] = -np.sin(angle), np.sin(angle)
        return r

    return about(2, yaw) @ about(1, pitch) @ about(0, roll)


def flat(points) -> np.ndarray:
    return np.column_stack([np.array(points), np.zeros(3)])


@dataclass(frozen=True)
class ByHand:
    """Points (..., m, 3) of the limbs of any of the six."""

    robot: Mechanism

    @property
    def kind(self) -> type:
        return type(self.robot)

    @property
    def rod_lengths(self) -> np.ndarray:
        g = self.robot.geometry
        return np.array(g.rod_lengths) if self.kind in PLANAR else np.array(g.rod_length)

    def tangents_and_ends(self, joints) -> tuple[np.ndarray, np.ndarray]:
        """d A_i / d q_i and A_i, where the rods begin."""
        g, q = self.robot.geometry, np.asarray(joints, dtype=float)[..., None]
        if self.kind is Planar3PRR:
            along = radial(g.rail_angles) + 0 * q
            return along, flat(g.base_points) + q * along
        if self.kind is Planar3RRR:
            zero, arms, base = radial(g.zero_angles), np.array(g.arm_lengths)[:, None], flat(g.base_points)
            quarter = np.cross(E_Z, zero)
        else:
            azimuths = g.arm_azimuths if self.kind is Hexa else g.azimuths
            zero, quarter, arms = E_Z, radial(azimuths), g.arm_length
            base = np.array(g.base_points) if self.kind is Hexa else g.base_radius * quarter
        swing = zero * np.cos(q) + quarter * np.sin(q)
        return arms * (quarter * np.cos(q) - zero * np.sin(q)), base + arms * swing

    def platform(self, pose) -> np.ndarray:
        """B_i."""
        g, x = self.robot.geometry, np.asarray(pose, dtype=float)
        if self.kind in PLANAR:
            angles = np.stack([0 * x[..., 2], 0 * x[..., 2], x[..., 2]], axis=-1)
            place = np.stack([x[..., 0], x[..., 1], 0 * x[..., 2]], axis=-1)
            return place[..., None, :] + flat(g.platform_points) @ np.swapaxes(rotation(angles), -1, -2)
        if self.kind is Hexa:
            return x[..., None, :3] + np.array(g.platform_points) @ np.swapaxes(rotation(x[..., 3:]), -1, -2)
        points = x[..., None, :3] + g.platform_radius * radial(g.azimuths)
        if self.kind is Par4:
            moved = radial(g.bar_angle + x[..., 3] / g.amplification) - radial(g.bar_angle)
            points = points + np.array([-1, -1, 1, 1])[:, None] * (g.bar_length / 2 * moved)[..., None, :]
        return points

    def rods(self, pose, joints) -> np.ndarray:
        """From B_i to A_i."""
        return self.tangents_and_ends(joints)[1] - self.platform(pose)

    def gaps(self, pose, joints) -> np.ndarray:
        """What each loop lacks to be closed, in metres."""
        if self.kind is Planar3RPR:
            legs = self.platform(pose) - flat(self.robot.geometry.base_points)
            return np.asarray(joints) - np.linalg.norm(legs, axis=-1)
        return np.linalg.norm(self.rods(pose, joints), axis=-1) - self.rod_lengths


def centre_and_spread(kind: type) -> tuple[np.ndarray, np.ndarray]:
    """A box of poses that the defaults reach on one side of every singularity."""
    spread = {
        Planar3RPR: [0.12, 0.12, 0.6],
        Planar3PRR: [0.1, 0.1, 0.4],
        Planar3RRR: [0.1, 0.1, 0.4],
        Delta: [0.28, 0.28, 0.1],
        Hexa: [0.1, 0.1, 0.05, 0.4, 0.4, 0.4],
        Par4: [0.3, 0.3, 0.1, np.pi],
    }[kind]
    return np.array(kind().home), np.array(spread)


def poses_of(kind: type, count: int, seed: int, share: float = 1.0) -> np.ndarray:
    """Poses spread evenly in that box, or in a share of it about its centre."""
    centre, spread = centre_and_spread(kind)
    return centre + share * spread * np.random.default_rng(seed).uniform(-1, 1, (count, len(centre)))


def random_geometry(kind: type, rng: np.random.Generator):
    """Every field of the default changed at random, so that no symmetry is left."""
    default = kind.Geometry()
    changes = {}
    for name, value in default.as_dict().items():
        array = np.array(value)
        if name.endswith(("azimuths", "angles", "angle")):
            moved = array + rng.uniform(-0.25, 0.25, array.shape)
        elif name.endswith("points"):
            moved = array + 0.15 * np.abs(array).max() * rng.uniform(-1, 1, array.shape)
        else:
            moved = array * rng.uniform(0.9, 1.1, array.shape)
        changes[name] = tuple(map(tuple, moved.tolist())) if moved.ndim == 2 else tuple(np.atleast_1d(moved).tolist())
        if np.ndim(value) == 0:
            changes[name] = float(moved)
    return kind.Geometry(**changes)


@cache
def robots(kind: type) -> tuple[Mechanism, Mechanism]:
    """The default, and one without symmetry."""
    return kind(), kind(random_geometry(kind, np.random.default_rng(7)))


__all__ = ["FAMILY", "PLANAR", "ByHand", "poses_of", "radial", "random_geometry", "robots", "rotation"]
