"""The masses, drives and joint ranges that a study sets: their keys, their faults, and the mechanism's records."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import Field, fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematics import MATERIALS, DriveTrain, InvalidValue, Load, Material, Structure
from studies.errors import KeyPath
from studies.study_file import Dimension, InertiaTable, Key, MaterialTable, StructureTable, Table, table_of

if TYPE_CHECKING:
    from kinematics import InertiaRecord, JointRanges, Mechanism
    from studies.study_file import Study

_WORDS = {
    "rest": "three finite coordinates",
    "passive": "two angles above 0, at most half a turn: at the rods' ends on the arms, at those on the platform",
    "rod_middle": "a number from 0 to 1",
    "screw_lead": "a number above 0",
}
_JOINTS: dict[tuple[str, ...], Dimension] = {("m",): Dimension.LENGTH, ("rad",): Dimension.ANGLE}


def inertia_of(study: Study) -> InertiaRecord:
    """The mechanism's masses; those that the study sets replace the mechanism's own."""
    own = study.mechanism_class.Inertia()
    drive_train = replace(own.drive_train, **study.inertia.drive_train.model_dump(exclude_none=True))
    masses: dict[str, Any] = dict(study.inertia.masses)
    return replace(own, **masses, drive_train=drive_train)


def structure_of(study: Study) -> Structure:
    """The members' materials and the joints; those that the study sets replace the usual ones."""
    asked = study.structure
    materials = dict(MATERIALS) | {name: Material(**m.model_dump()) for name, m in study.material.items()}
    changes: dict[str, Any] = {kind: materials[name] for kind, name in asked.materials.items()}
    if asked.joint_stiffness is not None:
        changes["joint_stiffness"] = asked.joint_stiffness
    return Structure(**changes, joint_play=asked.joint_play)


def load_of(study: Study) -> Load:
    """What `natural_frequency` and `strength` are for."""
    return Load(**study.load.model_dump())


def ranges_of(study: Study) -> JointRanges:
    """The mechanism's joint ranges; those that the study sets replace the mechanism's own."""
    ranges: dict[str, Any] = dict(study.ranges)
    return study.mechanism_class.Ranges(**ranges)


def hardware_tables(mechanism: type[Mechanism], raw: Mapping[str, Any]) -> dict[str, Table]:
    """The keys of `[inertia]`, `[structure]`, `[material]` and `[ranges]`. `raw` has the study's own materials."""
    materials = subtable(raw, "material")
    known = (*MATERIALS, *(name for name in materials if name not in MATERIALS))
    masses = {f.name: _key(f, mechanism.Inertia.dimensions, " >= 0") for f in fields(mechanism.Inertia)}
    ranges = {f.name: _key(f, mechanism.Ranges.dimensions) for f in fields(mechanism.Ranges)}
    joints = Key(
        f"finite low < high, one pair or {len(mechanism.joint_names)} pairs", joint_unit(mechanism), place=True
    )
    own, unit = table_of(InertiaTable), joint_unit(mechanism)
    error = Key(f"a number >= 0, or one a joint{'' if unit is not Dimension.NONE else ' (rad or m)'}", unit, place=True)
    drives = own.keys["drive_train"]
    assert isinstance(drives, Table)
    return {
        "inertia": Table(masses | {"drive_train": drives.updated({"encoder_resolution": error, "backlash": error})}),
        "ranges": Table(ranges | {"joints": joints}),
        "material": Table(dict.fromkeys(materials, table_of(MaterialTable))),
        "structure": Table(dict.fromkeys(mechanism.member_kinds(), Key("a material out of", choices=known))).updated(
            table_of(StructureTable).keys
        ),
    }


def joint_unit(mechanism: type[Mechanism]) -> Dimension:
    """The dimension of the joints' positions; NONE if joints differ in it."""
    return _JOINTS.get(tuple(sorted(set(mechanism.joint_units))), Dimension.NONE)


def _key(field: Field[Any], dimensions: Mapping[str, str], more: str = "") -> Key:
    shape = np.shape(field.default)  # type: ignore[arg-type]
    dimension = Dimension(dimensions.get(field.name, "none"))
    count = f"{shape[0]} finite numbers" if shape else "a finite number"
    return Key(_WORDS.get(field.name, f"{count}{more}"), dimension, place=not more)


def hardware_faults(data: Mapping[str, Any], mechanism: type[Mechanism]) -> Iterator[KeyPath]:
    """The paths of `data` (in SI) that the mechanism's records refuse; each value is tried alone."""
    count, inertia = len(mechanism.joint_names), subtable(data, "inertia")
    masses = {name: value for name, value in inertia.items() if name != "drive_train"}
    of_records: list[tuple[KeyPath, type[Any], Mapping[str, Any]]] = [
        (("ranges",), mechanism.Ranges, subtable(data, "ranges")),
        (("inertia",), mechanism.Inertia, masses),
        (("inertia", "drive_train"), DriveTrain, subtable(inertia, "drive_train")),
    ]
    for path, record, values in of_records:
        for name, value in values.items():
            try:
                record(**{name: value}).check(count)
            except InvalidValue:
                yield (*path, name)


def subtable(data: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    """A table of `data`; empty if the key is missing or is not a table."""
    table = data.get(name)
    return table if isinstance(table, dict) else {}
