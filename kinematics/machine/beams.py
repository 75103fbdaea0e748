"""Beams: how a straight tube gives way under loads at its tip, by Euler and Bernoulli (no shear)."""

from __future__ import annotations

import math
from typing import NamedTuple

import casadi as ca

from kinematics.machine.materials import Material
from kinematics.machine.members import Tube


class Section(NamedTuple):
    """A ring.

    Attributes:
        area: [m^2].
        second_moment: about any diameter [m^4]; twice as much for torsion.
    """

    area: ca.SX
    second_moment: ca.SX

    @classmethod
    def of(cls, tube: Tube) -> Section:
        """Of a tube, or of a solid bar, whose wall is its radius."""
        inside = tube.radius - tube.wall
        return cls(tube.area, math.pi / 4 * (tube.radius**4 - inside**4))


class Beam(NamedTuple):
    """A tube that is clamped at its root and loaded at its tip.

    Attributes:
        along: (3,) unit direction from root to tip.
        length: [m].
        section, material: what bears the load.
    """

    along: ca.SX
    length: ca.SX
    section: Section
    material: Material

    @property
    def stretch(self) -> ca.SX:
        """l / (E A) [m/N]."""
        return self.length / (self.material.modulus * self.section.area)

    def compliance(self, force: ca.SX, moment: ca.SX) -> ca.SX:
        """(k, k) how far load i moves its own point of the tip, along itself, under load j.

        The moment at a distance s from the tip is M + s Q with Q = e x F. Castigliano's integral of its part across e
        over E I, of its part along e over G J, and of the tension over E A.

        Args:
            force, moment: (3, k) k loads on the tip.
        """
        length, material = self.length, self.material
        tension, torque, across = self.along.T @ force, self.along.T @ moment, ca.skew(self.along) @ force
        mixed = moment.T @ across
        bending = length * (moment.T @ moment - torque.T @ torque)
        bending += length**2 / 2 * (mixed + mixed.T) + length**3 / 3 * (across.T @ across)
        torsion = length / (2 * material.shear_modulus * self.section.second_moment) * (torque.T @ torque)
        result: ca.SX = self.stretch * (tension.T @ tension) + torsion
        return result + bending / (material.modulus * self.section.second_moment)

    def moment_at_root(self, force: ca.SX, moment: ca.SX) -> ca.SX:
        """(3, k) of loads on the tip (3, k)."""
        result: ca.SX = moment + self.length * (ca.skew(self.along) @ force)
        return result
