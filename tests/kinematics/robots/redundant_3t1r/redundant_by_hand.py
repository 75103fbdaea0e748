"""The redundant robot of Shayya et al. written limb by limb in numpy, independently of the package."""

from itertools import product

import numpy as np

from kinematics import Redundant3T1R

SIDES = np.array([1.0, -1, 1, -1, 1, -1])
LEVELS = np.array([1.0, 1, 0, 0, -1, -1])
OUTER = np.array([True, True, False, False, True, True])
NINE_ANGLES = np.deg2rad([-90.0, -60, -45, -30, 0, 30, 45, 60, 90])


class ByHand:
    """Points, arms and the printed expressions of the paper for one geometry."""

    def __init__(self, geometry=None):
        g = geometry or Redundant3T1R.Geometry()
        self.g = g
        self.lengths = np.where(OUTER, g.outer_arm_length, g.middle_arm_length)
        self.y = SIDES * np.where(OUTER, g.outer_rail_y, g.middle_rail_y)
        self.z = LEVELS * g.outer_rail_z
        d, a = g.platform_length, g.platform_height
        corners = [[-d / 2, 0, a / 2], [d / 2, 0, 0], [-d / 2, 0, -a / 2]]
        self.local = np.repeat(corners, 2, axis=0)  # p_i^m (6, 3)

    def rails(self, joints):
        joints = np.asarray(joints, dtype=float)
        return np.stack([joints, self.y + 0 * joints, self.z + 0 * joints], axis=-1)

    def platform(self, poses):
        """B_i (..., 6, 3); (2)."""
        p = np.asarray(poses, dtype=float)
        c, s = np.cos(p[..., 3]), np.sin(p[..., 3])
        zero, one = 0 * c, 0 * c + 1
        rotation = np.stack([c, -s, zero, s, c, zero, zero, zero, one], axis=-1).reshape(*c.shape, 3, 3)
        return p[..., None, :3] + np.einsum("...ij,kj->...ki", rotation, self.local)

    def levers(self, poses):
        """p_i (..., 6, 3), from P to B_i in the base frame."""
        return self.platform(poses) - np.asarray(poses)[..., None, :3]

    def inverse(self, poses):
        """(7), term by term as printed."""
        x, y, z, theta = (np.asarray(poses)[..., k, None] for k in range(4))
        px, py, pz = self.local.T
        c, s = np.cos(theta), np.sin(theta)
        root = self.lengths**2 - (y + px * s + py * c - self.y) ** 2 - (z + pz - self.z) ** 2
        with np.errstate(invalid="ignore"):
            return x + px * c - py * s - np.sqrt(root)

    def arms(self, poses, joints):
        return self.platform(poses) - self.rails(joints)

    def gaps(self, poses, joints):
        """By how much each arm is too long [m]."""
        return np.linalg.norm(self.arms(poses, joints), axis=-1) - self.lengths

    def directions(self, poses):
        """n_i (..., 6, 3)."""
        arms = self.arms(poses, self.inverse(poses))
        return arms / np.linalg.norm(arms, axis=-1, keepdims=True)

    def jacobians(self, poses):
        """Diagonal of (31) and the matrix (32), as printed."""
        n = self.directions(poses)
        turning = -np.einsum("...ij,...ij->...i", n, np.cross(self.levers(poses), [0.0, 0, 1]))
        return n[..., 0], np.concatenate([n, turning[..., None]], axis=-1)

    def inverse_jacobian(self, poses):
        """(33)."""
        j_q, j_x = self.jacobians(poses)
        return j_x / j_q[..., None]

    def homogeneous(self, poses):
        return self.inverse_jacobian(poses) / np.array([1, 1, 1, self.g.platform_length / 2])

    def direct(self, joints, height_of_b5=1.0):
        """(10)-(22) as printed with numpy's own linear algebra; a = `height_of_b5` (p_z1 - p_z5).

        Returns the four candidates, each (B_1, B_3, pose).
        """
        g, a = self.g, height_of_b5 * self.g.platform_height
        centres = self.rails(joints)
        raised = centres[4] + [0, 0, a]  # (14)
        first = sphere_intersections(np.array([centres[0], centres[1], raised]), [g.outer_arm_length] * 3)
        found = []
        for b_1 in first:
            height = b_1[2] - self.local[0, 2] + self.local[2, 2]  # (19)
            for b_3 in circle_intersections(centres[2], centres[3], g.middle_arm_length, height):
                eta = (b_3 - b_1)[:2]
                theta = np.arctan2(eta[1], eta[0])
                lever = self.platform(np.array([0, 0, 0, theta]))[0]
                found.append((b_1, b_3, np.append(b_1 - lever, theta)))
        return found


def sphere_intersections(centres, radii):
    """Both points at the given distances from three centres."""
    squares = (centres**2).sum(axis=1) - np.square(radii)
    normals = 2 * (centres[0] - centres[1:])
    base = np.linalg.lstsq(normals, squares[0] - squares[1:], rcond=None)[0]
    along = np.cross(*normals)
    along /= np.linalg.norm(along)
    off = base - centres[0]
    half = along @ off
    root = np.sqrt(half**2 - (off @ off - radii[0] ** 2))
    return [base + (-half + sign * root) * along for sign in (1, -1)]


def circle_intersections(first, second, radius, height):
    """Both points at one height at one distance from two centres."""
    middle, apart = (first + second) / 2, second - first
    reach = radius**2 - (height - first[2]) ** 2 - apart @ apart / 4
    across = np.array([apart[1], -apart[0], 0]) / np.linalg.norm(apart[:2])
    base = np.array([middle[0], middle[1], height])
    return [base + sign * np.sqrt(reach) * across for sign in (1, -1)]


def box(count, seed, y=0.3187, z=0.7, theta=np.pi, x=1.0):
    """Random poses around the paper's workspace."""
    high = np.array([x, y, z, theta])
    return np.random.default_rng(seed).uniform(-high, high, (count, 4))


def reachable(robot, poses, margin=0.0):
    return poses[robot.margin("reach", poses) > margin]


def random_geometry(rng):
    """Far from the paper's: either hand of the rails, z1 above and below a/2, small and large platforms."""
    sign = rng.choice([-1.0, 1.0], 3)
    height = rng.uniform(0.05, 0.4)
    return Redundant3T1R.Geometry(
        outer_arm_length=rng.uniform(1.0, 2.0),
        middle_arm_length=rng.uniform(0.9, 1.8),
        outer_rail_y=sign[0] * rng.uniform(0.15, 0.6),
        middle_rail_y=sign[1] * rng.uniform(0.15, 0.6),
        outer_rail_z=height / 2 + sign[2] * rng.uniform(0.05, 0.5),
        platform_length=rng.uniform(0.05, 0.4),
        platform_height=height,
        parallelogram_width=rng.uniform(0.02, 0.2),
    )


def quarter(count=161, top=0.9):
    """(y, z) grid of the first quadrant between the rails' guides, and the area that each node stands for."""
    g = Redundant3T1R.Geometry()
    sides = [(abs(g.outer_rail_y) - g.platform_length / 2, count), (top, 2 * count)]
    axes = [np.linspace(0, end, size) for end, size in sides]
    weights = []
    for axis in axes:
        weight = np.full(axis.size, axis[1])
        weight[[0, -1]] /= 2
        weights.append(weight)
    nodes = np.array(list(product(*axes)))
    return nodes, 4 * np.outer(*weights).ravel()


def poses_at(nodes, theta):
    return np.column_stack([np.zeros(len(nodes)), nodes, np.broadcast_to(theta, len(nodes))])
