"""A frame of finite elements: beams, bars, springs and rigid links in space. It knows nothing of the project."""

from itertools import pairwise

import numpy as np

E_Z = np.array([0.0, 0.0, 1.0])


def ring(radius, wall):
    """Area and second moment of area of a ring."""
    inside = radius - wall
    return np.pi * (radius**2 - inside**2), np.pi / 4 * (radius**4 - inside**4)


def cross(r):
    """The matrix of r x ."""
    return np.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0]], float)


def beam_matrix(length, material, section):
    """(12, 12) of Euler and Bernoulli along x: u, v, w and turns about x, y, z at both ends."""
    (area, inertia), e, g = section, material.modulus, material.shear_modulus
    k = np.zeros((12, 12))
    k[np.ix_([0, 6], [0, 6])] = e * area / length * np.array([[1, -1], [-1, 1]])
    k[np.ix_([3, 9], [3, 9])] = g * 2 * inertia / length * np.array([[1, -1], [-1, 1]])
    for places, sign in (([1, 5, 7, 11], 1.0), ([2, 4, 8, 10], -1.0)):
        h = sign * length
        bending = np.array(
            [[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h],
             [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]]
        )  # fmt: skip
        k[np.ix_(places, places)] += e * inertia / length**3 * bending
    return k


class Frame:
    """Nodes with six freedoms each, in the directions of x, y and z; constraints are linear."""

    def __init__(self):
        self.places, self.stiffness, self.constraints = [], [], []

    def node(self, place):
        self.places.append(np.asarray(place, float))
        return len(self.places) - 1

    def _add(self, nodes, matrix):
        freedoms = np.concatenate([6 * n + np.arange(6) for n in nodes])
        self.stiffness.append((freedoms, matrix))

    def beam(self, start, end, material, section, elements=3):
        """A clamped beam between two nodes, in several elements."""
        between = np.linspace(self.places[start], self.places[end], elements + 1)
        nodes = [start, *(self.node(p) for p in between[1:-1]), end]
        along = between[1] - between[0]
        length = np.linalg.norm(along)
        x = along / length
        y = np.cross(x, np.eye(3)[np.abs(x).argmin()])
        y /= np.linalg.norm(y)
        turned = np.kron(np.eye(4), np.array([x, y, np.cross(x, y)]))
        matrix = turned.T @ beam_matrix(length, material, section) @ turned
        for pair in pairwise(nodes):
            self._add(pair, matrix)

    def bar(self, one, start, two, end, stiffness):
        """A spring [N/m] between ball joints at two places of the bodies of two nodes."""
        along = (end - start) / np.linalg.norm(end - start)
        arms = np.cross(start - self.places[one], along), np.cross(end - self.places[two], along)
        row = np.concatenate([-along, -arms[0], along, arms[1]])
        self._add((one, two), stiffness * np.outer(row, row))

    def sprung(self, one, two, direction, compliance):
        """Two nodes at one place are one, but that a force along a direction parts them by its compliance."""
        row = np.concatenate([direction, np.zeros(3)])
        self.joint(one, two, np.linalg.svd(row[None])[2][1:])
        if compliance:
            self._add((one, two), np.kron([[1, -1], [-1, 1]], np.outer(row, row)) / compliance)
        else:
            self.joint(one, two, row)

    def ground(self, node, directions, matrix):
        """Holds a node: along directions (r, 6) by springs `matrix` (r, r), and firmly in all others."""
        directions = np.atleast_2d(directions)
        self._add((node,), directions.T @ np.atleast_2d(matrix) @ directions)
        firm = np.linalg.svd(directions)[2][len(directions) :]
        for row in firm:
            self.constrain({node: row})

    def constrain(self, parts):
        """The sum of row . freedoms of nodes is zero."""
        self.constraints.append({node: np.asarray(row, float) for node, row in parts.items()})

    def joint(self, one, two, kept):
        """Two nodes of two bodies: rows (r, 6) of the relative motion at node two's place are kept at zero."""
        arm = self.places[two] - self.places[one]
        moved = np.block([[np.eye(3), -cross(arm)], [np.zeros((3, 3)), np.eye(3)]])
        for row in np.atleast_2d(kept):
            self.constrain({one: row @ moved, two: -row})

    def rigid(self, one, two):
        self.joint(one, two, np.eye(6))

    def ball(self, one, two):
        self.joint(one, two, np.eye(6)[:3])

    def hinge(self, one, two, axis):
        """All but the turn about an axis."""
        self.joint(one, two, np.linalg.svd(np.concatenate([np.zeros(3), axis])[None])[2][1:])

    def compliance(self, node, directions):
        """(r, r) how far unit loads along directions (r, 6) at a node move it along them."""
        count = 6 * len(self.places)
        whole, rows = np.zeros((count, count)), np.zeros((len(self.constraints), count))
        for freedoms, matrix in self.stiffness:
            whole[np.ix_(freedoms, freedoms)] += matrix
        for row, parts in zip(rows, self.constraints, strict=True):
            for n, values in parts.items():
                row[6 * n : 6 * n + 6] = values
        _, values, vectors = np.linalg.svd(rows)
        free = vectors[int((values > 1e-9 * values[0]).sum()) :].T
        load = np.zeros((count, len(directions)))
        load[6 * node : 6 * node + 6] = np.asarray(directions, float).T
        reduced = free.T @ whole @ free
        moved = free @ np.linalg.lstsq(reduced, free.T @ load, rcond=1e-13)[0]
        assert np.abs(free.T @ (whole @ moved - load)).max() < 1e-6  # the load is held
        return load.T @ moved
