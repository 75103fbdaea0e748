"""A mechanism as an MJCF document, MuJoCo's format: the same masses, with its loops closed.

At the pose of the export every frame coincides with the base's, so that all points and axes are in base coordinates
there, and every joint's `ref` is its coordinate: the document loads with its loops closed at that pose, and its joints
are the mechanism's own (q1 ..., x, y ...). Rods whose mass is split between their ends are tendons of constant length;
with mass at their middle they are bodies. A link that only carries a rotor gets 1e-12 kg. The members are drawn,
and so is what is around them.
"""

from __future__ import annotations

from xml.etree import ElementTree as Xml

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.dynamics import GRAVITY
from kinematics.machine import Link
from kinematics.model import Mechanism
from kinematics.multibody.geoms import add_geoms, every_digit
from kinematics.multibody.geoms_around import add_floor_and_boxes, add_payload
from kinematics.multibody.open_tree import OpenTree, open_tree

_STEP = 1e-4  # [s]
_STIFF = {"solref": f"{2 * _STEP:g} 1", "solimp": "0.9999 0.9999 0.001 0.5 2"}  # the stiffest that MuJoCo takes
_COMPILER = {"angle": "radian", "boundmass": "1e-12", "boundinertia": "1e-12", "inertiafromgeom": "false"}


def mjcf(robot: Mechanism, pose: Array, payload: float = 0.0) -> str:
    """The mechanism as an MJCF document, SI units. Each motor's control is its torque; `gear` is the gear ratio.

    Args:
        robot: one whose links follow from its bodies, or that has the hook `link_tree`.
        pose: (n,) where the document starts.
        payload: mass at the tool [kg].

    Raises:
        InvalidValue: its links do not follow from its bodies, or a payload that is no mass.
        UnreachablePose: a limb cannot reach the pose.
    """
    cut = open_tree(robot, pose, payload)
    root = Xml.Element("mujoco", model=type(robot).__name__)
    Xml.SubElement(root, "compiler", _COMPILER)
    option = Xml.SubElement(root, "option", timestep=f"{_STEP:g}", integrator="RK4", gravity=f"0 0 -{GRAVITY}")
    Xml.SubElement(option, "flag", contact="disable", energy="enable")
    world = Xml.SubElement(root, "worldbody")
    elements = _links(world, cut)
    tendons, equality = (Xml.SubElement(root, tag) for tag in ("tendon", "equality"))
    _close(cut, elements, tendons, equality)
    _drive(robot, cut, elements, tendons, Xml.SubElement(root, "actuator"))
    model, asset = robot.model(), Xml.SubElement(root, "asset")
    members = robot.all_members(model.pose, model.joints, model.g)
    bodies = elements | {"": world}
    add_geoms(members, bodies, asset, cut.reference)
    add_floor_and_boxes(robot, world)
    add_payload(robot, members, bodies, asset, cut.reference)
    for element in (tendons, equality, asset):
        if not len(element):
            root.remove(element)
    Xml.indent(root)
    return Xml.tostring(root, encoding="unicode") + "\n"


def _links(world: Xml.Element, cut: OpenTree) -> dict[str, Xml.Element]:
    """Bodies by their names, and joints by `joint` and theirs."""
    elements: dict[str, Xml.Element] = {}
    for link in cut.tree.links:
        body = Xml.SubElement(elements[link.parent] if link.parent else world, "body", name=link.name)
        elements[link.name] = body
        for joint in link.joints:
            places = {
                name: every_digit(cut.reference(getattr(joint, name))) for name in ("axis", "anchor", "coordinate")
            }
            elements[f"joint {joint.name}"] = Xml.SubElement(
                body, "joint", name=joint.name, type=joint.kind,
                axis=places["axis"], pos=places["anchor"], ref=places["coordinate"],
            )  # fmt: skip
        body.append(_inertial(link, cut))
    return elements


def _inertial(link: Link, cut: OpenTree) -> Xml.Element:
    """Mass, centre and principal moments of the link's particles; moments below 1e-12 kg m^2 are raised to it."""
    from scipy.spatial.transform import Rotation  # slow to import, and needed nowhere else

    own = [p for p in cut.particles() if p.link == link.name and p.mass > 0.0]
    masses = np.array([p.mass for p in own])
    points = np.array([np.array(cut.reference(p.point)).ravel() for p in own]).reshape(-1, 3)
    if not own:
        return Xml.Element("inertial", pos="0 0 0", mass="0", diaginertia="0 0 0")
    centre = masses @ points / masses.sum()
    from_centre = points - centre
    moments, axes = np.linalg.eigh(np.einsum("k,ki,kj->ij", masses, from_centre, from_centre))
    axes[:, 2] *= np.linalg.det(axes)
    quaternion = Rotation.from_matrix(axes).as_quat(scalar_first=True)
    moments = np.maximum(moments.sum() - moments, 0.0)
    moments[0] = min(moments[0], moments[1] + moments[2])  # the largest; equal for flat bodies, but for rounding
    return Xml.Element(
        "inertial", pos=every_digit(centre), mass=every_digit(masses.sum()), quat=every_digit(quaternion),
        diaginertia=every_digit(moments),
    )  # fmt: skip


def _close(cut: OpenTree, elements: dict[str, Xml.Element], tendons: Xml.Element, equality: Xml.Element) -> None:
    """Couplings of joints, shared points, and rods that are no bodies."""
    for follower, leader, ratio in cut.tree.couplings:
        line = f"0 {every_digit(cut.reference(ratio))} 0 0 0"
        Xml.SubElement(equality, "joint", joint1=follower, joint2=leader, polycoef=line).attrib.update(_STIFF)
    for (first, second), point in cut.tree.connections:
        anchor = every_digit(cut.reference(point))
        Xml.SubElement(equality, "connect", body1=first, body2=second, anchor=anchor).attrib.update(_STIFF)
    for k, rod in enumerate([] if cut.rods_are_bodies else cut.bodies.rods):
        tendon = Xml.SubElement(tendons, "spatial", name=f"rod {k + 1}")
        for link, point, side in zip(rod.links, (rod.start, rod.end), "ab", strict=True):
            site = f"rod {k + 1}{side}"
            Xml.SubElement(elements[link], "site", name=site, pos=every_digit(cut.reference(point)))
            Xml.SubElement(tendon, "site", site=site)
        Xml.SubElement(equality, "tendon", tendon1=f"rod {k + 1}").attrib.update(_STIFF)


def _drive(
    robot: Mechanism, cut: OpenTree, elements: dict[str, Xml.Element], tendons: Xml.Element, actuators: Xml.Element
) -> None:
    """Rotors, friction and motors, each on the joint that it turns with, or on a tendon over several joints."""
    model, drives, count = robot.model(), robot.inertia.drive_train, len(robot.joint_names)
    gear, coulomb, viscous = (drives.of_actuators(n, count) for n in ("gear_ratio", "coulomb", "viscous"))
    names = (*robot.joint_names, *robot.pose_names)

    def carrier(angle: ca.SX) -> tuple[Xml.Element, float]:
        """What moves by the angle, and how far for a unit of it."""
        weights = np.array(cut.reference(ca.jacobian(angle, ca.vertcat(model.joints, model.pose)))).ravel()
        used = np.flatnonzero(weights)
        if used.size == 1:
            return elements[f"joint {names[used[0]]}"], float(weights[used[0]])
        name = " ".join(f"{weights[k]:+.17g} {names[k]}" for k in used)
        if name not in elements:
            elements[name] = Xml.SubElement(tendons, "fixed", name=name)
            for k in used:
                Xml.SubElement(elements[name], "joint", joint=names[k], coef=every_digit(weights[k]))
        return elements[name], 1.0

    for rotor in cut.bodies.rotors:
        element, rate = carrier(rotor.angle)
        inertia = float(cut.reference(ca.SX(rotor.inertia)))
        element.set("armature", every_digit(float(element.get("armature", 0.0)) + inertia * rate**2))
    for k, angle in enumerate(ca.vertsplit(model.drives @ model.joints)):
        element, rate = carrier(angle)
        for attribute, value in (("damping", viscous[k] * rate**2), ("frictionloss", coulomb[k] * abs(rate))):
            if value:
                element.set(attribute, every_digit(value))
                element.set("solreffriction", _STIFF["solref"])  # else strong damping turns its sign
        kind = "joint" if element.tag == "joint" else "tendon"
        on = {kind: element.get("name", "")}
        Xml.SubElement(actuators, "motor", on, name=robot.actuator_names[k], gear=every_digit(gear[k] * rate))
