"""The members of a mechanism as shapes of an MJCF document. They are drawn and measured, and weigh nothing there."""

from __future__ import annotations

from xml.etree import ElementTree as Xml

import numpy as np

from kinematics.arrays import Array
from kinematics.machine import Member, Plate, Reference, Tube

_WEIGHTLESS = {"mass": "0", "contype": "0", "conaffinity": "0"}


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
            geom = Xml.SubElement(body, "geom", _WEIGHTLESS, name=name)  # type: ignore[arg-type]
            if isinstance(shape, Tube):
                ends = np.array([reference(point) for point in (shape.start, shape.end)]).ravel()
                geom.attrib.update(type="capsule", fromto=_text(ends), size=_text(np.array(reference(shape.radius))))
            else:
                Xml.SubElement(asset, "mesh", name=name, vertex=_text(_prism(shape, reference)))
                geom.attrib.update(type="mesh", mesh=name)


def _prism(plate: Plate, reference: Reference) -> Array:
    """(2 k, 3) the corners of both faces."""
    corners, thickness = np.array(reference(plate.outline)).T, float(reference(plate.thickness))
    middle = corners.mean(axis=0)
    normal = np.linalg.svd(corners - middle)[2][2] * thickness / 2
    return np.vstack([corners - normal, corners + normal])


def _text(values: Array) -> str:
    return " ".join(f"{v:.17g}" for v in values.ravel())
