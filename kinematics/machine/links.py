"""Links, hinges and slides: a mechanism whose loops are cut into a tree, as simulators of multibody systems need it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, NamedTuple

import casadi as ca
import numpy as np

Kind = Literal["hinge", "slide"]
Reference = Callable[[ca.SX], ca.DM]  # an expression's value at the reference pose
AXES = [ca.SX(ca.DM.eye(3)[:, k]) for k in range(3)]
ORIGIN = ca.SX(3, 1)


class TreeJoint(NamedTuple):
    """Between a link and its parent: `coordinate` [rad or m] about or along `axis` (3,) through `anchor` (3,)."""

    name: str
    kind: Kind
    axis: ca.SX
    anchor: ca.SX
    coordinate: ca.SX


class Link(NamedTuple):
    """A rigid body; `parent` None is the base."""

    name: str
    parent: str | None
    joints: tuple[TreeJoint, ...]


class Coupling(NamedTuple):
    """A joint that moves `ratio` times as far as another: a screw [m/rad], or links that move as one (1)."""

    follower: str
    leader: str
    ratio: ca.SX


class Connection(NamedTuple):
    """Two links that share a point (3,)."""

    links: tuple[str, str]
    point: ca.SX


class Tree(NamedTuple):
    """Links, parents first, and what closes the loops besides the rods.

    Attributes:
        couplings: always there.
        hinges: (3,) axis about which each rod turns on its first link; empty where they turn freely.
        planes: what such rods do beyond keeping their lengths.
    """

    links: tuple[Link, ...]
    couplings: tuple[Coupling, ...] = ()
    connections: tuple[Connection, ...] = ()
    hinges: tuple[ca.SX, ...] = ()
    planes: tuple[Coupling, ...] = ()


def universal(name: str, anchor: ca.SX, span: ca.SX, reference: Reference) -> tuple[TreeJoint, TreeJoint]:
    """Two hinges across a direction and each other, which turn it by angles that are 0 at the reference.

    With axes e, f and d before, d = sin(b) e + cos(b) (cos(a) d_0 - sin(a) f).
    """
    along = span / ca.norm_2(span)
    before = np.array(reference(along)).ravel()
    first = np.cross(before, np.eye(3)[np.abs(before).argmin()])
    first /= np.linalg.norm(first)
    second = np.cross(before, first)
    across, down, ahead = (ca.dot(along, ca.DM(v)) for v in (first, second, before))
    return (
        TreeJoint(f"{name} a", "hinge", ca.SX(first), anchor, ca.atan2(-down, ahead)),
        TreeJoint(f"{name} b", "hinge", ca.SX(second), anchor, ca.atan2(across, ca.sqrt(down**2 + ahead**2))),
    )
