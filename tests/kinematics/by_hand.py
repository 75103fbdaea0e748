"""Heli4 written a second time, in numpy from expressions (1)-(8), as an oracle; and where the tests look at it."""

from dataclasses import dataclass

import numpy as np

from kinematics import Heli4

DEG = np.pi / 180
E_Z = np.array([0.0, 0.0, 1.0])
UPPER = np.array([0.0, 0.0, 1.0, 1.0])
OBLIQUE = Heli4.Geometry(
    height_step=0.06, plate_offset=0.03, pitch=-0.045, azimuths=(10 * DEG, 205 * DEG, 85 * DEG, 300 * DEG)
)


@dataclass(frozen=True)
class ByHand:
    """Points (..., 4, 3) of the limbs."""

    g: Heli4.Geometry

    @property
    def pitch(self) -> float:
        return self.g.pitch / (2 * np.pi)

    @property
    def u(self) -> np.ndarray:
        a = np.array(self.g.azimuths)
        return np.stack([np.cos(a), np.sin(a), 0 * a], axis=-1)

    @property
    def axes(self) -> np.ndarray:
        return np.cross(E_Z, self.u)

    @property
    def actuators(self) -> np.ndarray:
        return self.g.base_radius * self.u + (self.g.height_step * UPPER)[:, None] * E_Z

    def arms(self, joints):
        """A_i."""
        q = np.asarray(joints)[..., None]
        return self.actuators + self.g.arm_length * (np.sin(q) * self.u + np.cos(q) * E_Z)

    def arm_tangents(self, joints):
        """r_i = d A_i / d q_i."""
        q = np.asarray(joints)[..., None]
        return self.g.arm_length * (np.cos(q) * self.u - np.sin(q) * E_Z)

    def platforms(self, pose):
        """B_i."""
        x = np.asarray(pose)
        heights = self.g.plate_offset + UPPER * (self.g.height_step + self.pitch * x[..., 3:4])
        return x[..., None, :3] + self.g.platform_radius * self.u + heights[..., None] * E_Z

    def rods(self, pose, joints):
        """l_i, from B_i to A_i."""
        return self.arms(joints) - self.platforms(pose)

    def gaps(self, pose, joints):
        """|A_i B_i| - l, the closure (9) in metres."""
        return np.linalg.norm(self.rods(pose, joints), axis=-1) - self.g.rod_length


def cylinder(count: int, seed: int, radius: float = 0.5, z=(-0.8, -0.6), theta=np.pi) -> np.ndarray:
    """Poses spread evenly in the paper's workspace."""
    rng = np.random.default_rng(seed)
    r, a = radius * np.sqrt(rng.random(count)), rng.uniform(-np.pi, np.pi, count)
    return np.stack([r * np.cos(a), r * np.sin(a), rng.uniform(*z, count), rng.uniform(-theta, theta, count)], axis=-1)


def random_geometry(rng: np.random.Generator) -> Heli4.Geometry:
    """Opposite limbs on one plate, but nothing else of the prototype's symmetry."""
    turn = rng.uniform(-np.pi, np.pi)
    azimuths = turn + np.array([0, np.pi, np.pi / 2, 3 * np.pi / 2]) + rng.uniform(-0.4, 0.4, 4)
    return Heli4.Geometry(
        base_radius=rng.uniform(0.25, 0.45),
        platform_radius=rng.uniform(0.03, 0.08),
        arm_length=rng.uniform(0.28, 0.42),
        rod_length=rng.uniform(0.75, 0.9),
        height_step=rng.uniform(-0.1, 0.1),
        plate_offset=rng.uniform(-0.05, 0.06),
        pitch=rng.choice([-1, 1]) * rng.uniform(0.03, 0.09),
        azimuths=tuple(azimuths),
        parallelogram_width=rng.uniform(0.05, 0.15),
    )
