"""Masses of members, from their sections and materials."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import casadi as ca

from kinematics.machine.bodies import UNIFORM
from kinematics.machine.members import Member, Plate, Tube

Number = float | ca.SX


class ArmMass(NamedTuple):
    """Of an arm about its joint.

    Attributes:
        mass: [kg].
        centre: of the mass, as a fraction of the arm's length.
        factor: inertia about the joint over mass times the square of the centre's distance.
    """

    mass: Number
    centre: Number
    factor: Number


def arm_mass(tube: Number, hub: Number, end: Number, given: tuple[float | None, float | None, float | None]) -> ArmMass:
    """A tube over the whole length, a hub at a third of it, and what is at its end; masses [kg].

    Args:
        given: numbers that take the place of mass, centre and factor; None keeps what follows.
    """
    mass = tube + hub + end
    centre = (tube / 2 + hub / 3 + end) / mass
    factor = (tube / 3 + hub / 9 + end) / (mass * centre**2)
    return ArmMass(*(own if other is None else other for own, other in zip((mass, centre, factor), given, strict=True)))


def rod_mass(tube: Number, joint: Number, mass: float | None, middle: float | None) -> tuple[Number, Number]:
    """Mass of a rod [kg] and the share at its middle: a uniform tube and a joint at each end.

    Args:
        mass, middle: numbers that take the place of both; None keeps what follows.
    """
    whole = tube + 2 * joint
    return whole if mass is None else mass, UNIFORM * tube / whole if middle is None else middle


def member_mass(member: Member, density: float) -> ca.SX:
    """[kg]; of a member at rest, so that nothing in it depends on the pose."""
    return ca.sum1(ca.vertcat(*(_shape_mass(shape, density) for shape in member.shapes)))


def _shape_mass(shape: Tube | Plate, density: float) -> ca.SX:
    if isinstance(shape, Tube):
        return density * shape.area * ca.norm_2(shape.end - shape.start)
    return ca.sum1(ca.vertcat(*_triangle_masses(shape, density)))


def mass_points(rest: Member, moved: Member, density: float) -> list[tuple[ca.SX, ca.SX]]:
    """Particles (mass [kg], point (3,)) with a member's mass, centre and inertia; of thin bars and thin plates.

    Args:
        rest: the member where nothing depends on the pose.
        moved: the same at a pose.
    """
    found: list[tuple[ca.SX, ca.SX]] = []
    for own, at in zip(rest.shapes, moved.shapes, strict=True):
        if isinstance(at, Tube):
            mass = _shape_mass(own, density)
            found += [(mass / 6, at.start), (2 / 3 * mass, (at.start + at.end) / 2), (mass / 6, at.end)]
            continue
        assert isinstance(own, Plate)
        corners, count = at.outline, at.outline.shape[1]
        shares = [ca.SX(0)] * count
        for k, mass in enumerate(_triangle_masses(own, density)):
            triangle = [0, k + 1, k + 2]
            found.append((0.75 * mass, ca.sum2(corners[:, triangle]) / 3))
            for i in triangle:
                shares[i] += mass / 12
        found += [(shares[i], corners[:, i]) for i in range(count)]
    return found


def _triangle_masses(plate: Plate, density: float) -> list[ca.SX]:
    """Of the triangles between the first corner and two that follow each other [kg]."""
    sides = [plate.outline[:, i] - plate.outline[:, 0] for i in range(1, plate.outline.shape[1])]
    return [density * plate.thickness * ca.norm_2(ca.cross(a, b)) / 2 for a, b in pairwise(sides)]
