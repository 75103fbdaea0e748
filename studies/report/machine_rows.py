"""What the report says of materials, joints, load and surroundings: the figures mean nothing without them."""

from __future__ import annotations

from kinematics import MATERIALS, Mechanism, Obstacle
from studies.study_file import Study

Row = tuple[str, str]


def machine_rows(robot: Mechanism, study: Study) -> list[Row]:
    """Rows of two texts: what it is, and what it is made of or where it is."""
    return [*_structure_rows(robot, study), *_load_rows(robot), *_surroundings_rows(robot)]


def _structure_rows(robot: Mechanism, study: Study) -> list[Row]:
    structure, rows = robot.structure, []
    for kind in robot.member_kinds():
        material = getattr(structure, kind)
        usual = (name for name, known in MATERIALS.items() if known == material)
        name = study.structure.materials.get(kind) or next(usual, "its own material")
        moduli = f"modulus {material.modulus / 1e9:g} GPa, shear modulus {material.shear_modulus / 1e9:g} GPa"
        text = f"{name}: density {material.density:g} kg/m³, {moduli}, strength {material.strength / 1e6:g} MPa"
        rows.append((f"material of each {kind}", text))
    gives = structure.joint_stiffness < float("inf")
    stiff = f"{structure.joint_stiffness:g} N/m" if gives else "none gives way"
    return [*rows, ("stiffness of joints", stiff), ("play of joints", f"{1e3 * structure.joint_play:g} mm")]


def _load_rows(robot: Mechanism) -> list[Row]:
    load = robot.load
    text = f"payload {load.payload:g} kg, acceleration {load.acceleration:g} m/s² in the worst direction"
    return [("load of strength and natural_frequency", text)]


def _surroundings_rows(robot: Mechanism) -> list[Row]:
    around = robot.surroundings
    rows = [("floor", "none" if around.floor is None else f"at z = {around.floor:g} m")]
    rows += [(f"box {box.name!r}", _of_box(box)) for box in around.obstacles]
    hull, text = around.payload_hull, "none"
    if hull is not None:
        text = f"radius {hull.radius:g} m, from {hull.low:g} m to {hull.high:g} m along the tool's z axis"
    return [*rows, ("room of the payload", text)]


def _of_box(box: Obstacle) -> str:
    low, high = (", ".join(f"{v:g}" for v in corner) for corner in (box.low, box.high))
    return f"({low}) to ({high}) m; the robot stays {'inside' if box.inside else 'outside'}"
