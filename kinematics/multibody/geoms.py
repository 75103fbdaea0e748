"""The members of a mechanism as shapes of an MJCF document. They are drawn and measured, and weigh nothing there."""

from __future__ import annotations

from xml.etree import ElementTree as Xml

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.machine import Member, Reference, Tube
from kinematics.multibody.placed_shapes import PlacedShape

_ONE_POINT = 1e-9  # [m]
WEIGHTLESS = {"mass": "0", "contype": "0", "conaffinity": "0"}


def add_geoms(members: list[Member], bodies: dict[str, Xml.Element], asset: Xml.Element, reference: Reference) -> None:
    """Add each member to the body of its link: tubes as capsules, plates as meshes.

    Rods that are no bodies are left out.

    Args:
        bodies: by the names of their links; what is on the base belongs to the body "".
        asset: the element that holds the meshes.
        reference: an expression's value at the pose of the document.
    """
    for member in members:
        body = bodies[""] if "base" in member.joints else bodies.get(member.link or member.name)
        for k, shape in enumerate(member.shapes if body is not None else ()):
            name = member.name if len(member.shapes) == 1 else f"{member.name}, {k + 1}"
            geom = Xml.SubElement(body, "geom", WEIGHTLESS, name=name)  # type: ignore[arg-type]
            corners, around = np.array(reference(shape.corners)).T, float(reference(shape.around))
            if isinstance(shape, Tube):
                geom.attrib.update(_capsule(corners, around))
            else:
                sides = PlacedShape(member.name, member.material, corners, around).sides()
                Xml.SubElement(asset, "mesh", name=name, vertex=every_digit(np.vstack(sides)))
                geom.attrib.update(type="mesh", mesh=name)


def _capsule(corners: Array, around: float) -> dict[str, str]:
    """A sphere where both ends are one to MuJoCo's own limit."""
    if np.linalg.norm(corners[1] - corners[0]) < _ONE_POINT:
        return {"type": "sphere", "pos": every_digit(corners[0]), "size": every_digit(around)}
    return {"type": "capsule", "fromto": every_digit(corners), "size": every_digit(around)}


def every_digit(values: ca.DM | Array | float) -> str:
    """Numbers as an attribute."""
    return " ".join(f"{v:.17g}" for v in np.array(values, dtype=float).ravel())
