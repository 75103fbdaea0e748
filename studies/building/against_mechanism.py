"""Checks of a study against its mechanism: the keys that depend on it, and the faults that only it shows."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from kinematics import MATERIALS, is_length
from studies.building.geometry_fields import GeometryField, geometry_fields, shape
from studies.building.hardware import hardware_faults, hardware_tables, joint_unit, subtable
from studies.errors import KeyPath
from studies.study_file import (
    REGION_KINDS,
    BoxTable,
    CertifyTable,
    CycleTable,
    CylinderTable,
    Dimension,
    Key,
    OptimiseTable,
    RequirementTable,
    Study,
    SumTable,
    Table,
    TrajectoryTable,
    WaypointPathTable,
    WaypointTable,
    table_of,
)

if TYPE_CHECKING:
    from kinematics import Mechanism

_PER_JOINT = ("limits", "approach", "drive")  # tables of the trajectory
_TURN = 2 * math.pi * (1 + 1e-12)  # the conversion of degrees rounds


def study_table(mechanism: type[Mechanism], raw: Mapping[str, Any]) -> Table:
    """The keys of a study of `mechanism`. Those of the region depend on its kind in `raw`."""
    fields = geometry_fields(mechanism)
    lengths = Key("a list out of", choices=_lengths(fields))
    margins = Key("one of", choices=tuple(mechanism.margins))
    optimise = {
        "variables": Table({name: _bounds(field) for name, field in fields.items()}),
        "sums": table_of(SumTable, rows=True).updated({"fields": lengths}),
    }
    return table_of(Study).updated(
        {
            "geometry": Table({name: _dimensions(field) for name, field in fields.items()}),
            **hardware_tables(mechanism, raw),
            "home": _home_table(mechanism),
            "region": _region_table(mechanism, raw.get("region")),
            "optimise": table_of(OptimiseTable).updated(optimise),
            "certify": table_of(CertifyTable).updated(
                {"margins": Key("a list out of", choices=tuple(mechanism.margins))}
            ),
            "requirement": table_of(RequirementTable, rows=True).updated({"margin": margins}),
            "trajectory": _trajectory_table(mechanism.pose_names, len(mechanism.joint_names)),
        }
    )


def _trajectory_table(pose_names: Sequence[str], joints: int) -> Table:
    """The keys of `[trajectory]`: coordinates of waypoints, and the cycle's angles that the pose has.

    A planar robot has no cycle.
    """
    lacking = {
        "turn": not {"theta", "yaw"} & set(pose_names),
        "start_angle": not {"theta", "yaw"} & set(pose_names),
        "tilt": not {"roll", "pitch"} <= set(pose_names),
    }
    cycle = Table({name: key for name, key in table_of(CycleTable).keys.items() if not lacking.get(name)})
    coordinates = {name: Key("a finite number", _pose_dimension(name), place=True) for name in pose_names}
    waypoint = table_of(WaypointTable, rows=True).updated(coordinates)
    path = table_of(WaypointPathTable).updated({"waypoint": waypoint})
    trajectory = table_of(TrajectoryTable).updated({"path": path})
    trajectory = trajectory.updated({name: _counted(trajectory.keys[name], joints) for name in _PER_JOINT})
    if "z" in pose_names:
        return trajectory.updated({"path": replace(path, other="[trajectory.cycle]"), "cycle": cycle})
    return Table({name: key for name, key in trajectory.keys.items() if name != "cycle"})


def at_odds(data: Mapping[str, Any], mechanism: type[Mechanism]) -> Iterator[KeyPath]:
    """The paths of `data` (in SI) that do not fit `mechanism`. The models report what they reject themselves."""
    fields = geometry_fields(mechanism)
    for name, value in subtable(data, "geometry").items():
        field = fields[name]
        if shape(value) != field.shape or not all(field.kind.allows(n, n) for n in _numbers(value)):
            yield ("geometry", name)
    yield from hardware_faults(data, mechanism)
    materials = {*MATERIALS, *subtable(data, "material")}
    for kind, name in subtable(data, "structure").items():
        if isinstance(name, str) and name not in materials:
            yield ("structure", kind)
    yield from _uncounted(subtable(data, "trajectory"), len(mechanism.joint_names))
    joints = subtable(data, "home").get("joints")
    if isinstance(joints, tuple) and len(joints) != len(mechanism.joint_names):
        yield ("home", "joints")
    if isinstance(data.get("region"), dict):
        yield from _region_faults(data["region"], mechanism)
    optimise = subtable(data, "optimise")
    for name, bounds in subtable(optimise, "variables").items():
        field = fields[name]
        pairs = bounds if field.shape and isinstance(bounds, tuple) else (bounds,)
        ends = [_numbers(pair) for pair in pairs]
        if (
            len(ends) != math.prod(field.shape)
            or any(len(pair) != 2 or not field.kind.allows(pair[0], pair[1]) for pair in ends)
            or all(pair[0] == pair[1] for pair in ends)
        ):
            yield ("optimise", "variables", name)
    for i, names in _rows(optimise, "sums", "fields"):
        if isinstance(names, tuple) and not set(map(str, names)) <= set(_lengths(fields)):
            yield ("optimise", "sums", i, "fields")
    certified = subtable(data, "certify").get("margins")
    if isinstance(certified, tuple) and not set(map(str, certified)) <= set(mechanism.margins):
        yield ("certify", "margins")
    for i, margin in _rows(data, "requirement", "margin"):
        if not isinstance(margin, str) or margin not in mechanism.margins:
            yield ("requirement", i, "margin")
        elif mechanism.margins[margin].word not in data["requirement"][i]:
            yield ("requirement", i, mechanism.margins[margin].word)


def wrong_words(data: Mapping[str, Any], mechanism: type[Mechanism]) -> Iterator[tuple[KeyPath, str]]:
    """The path of each bound that a requirement's margin does not have, and what would be right."""
    for i, name in _rows(data, "requirement", "margin"):
        margin = mechanism.margins.get(name) if isinstance(name, str) else None
        for word in ("at_least", "at_most"):
            if margin is not None and word != margin.word and word in data["requirement"][i]:
                yield ("requirement", i, word), margin.right_word


def impossible_bounds(data: Mapping[str, Any], mechanism: type[Mechanism]) -> Iterator[tuple[KeyPath, str]]:
    """The path of each bound that no requirement of its margin may have, and what would be right."""
    for i, name in _rows(data, "requirement", "margin"):
        margin, row = mechanism.margins.get(name) if isinstance(name, str) else None, data["requirement"][i]
        if margin is None:
            continue
        if name == "reach" and _is_below(row.get("at_least"), 0.0):
            yield ("requirement", i, "at_least"), "a finite number; for the margin reach, 0 or more"
        if margin.sense < 0 and _is_below(row.get("at_most"), margin.lowest):
            yield ("requirement", i, "at_most"), f"{margin.lowest:g} or more, as {name} is never below it"


def repeated_margins(data: Mapping[str, Any]) -> Iterator[tuple[KeyPath, KeyPath, str]]:
    """Of each further requirement on a margin: its path, that of the first one, and the margin."""
    first: dict[str, KeyPath] = {}
    for i, name in _rows(data, "requirement", "margin"):
        path: KeyPath = ("requirement", i, "margin")
        if isinstance(name, str) and (known := first.setdefault(name, path)) != path:
            yield path, known, name


def _counted(node: Key | Table, joints: int) -> Key | Table:
    """The key or table with the number of joints in its words."""
    if isinstance(node, Key):
        return replace(node, expected=node.expected.replace("a joint", f"a joint of the {joints}"))
    return node.updated({name: _counted(inner, joints) for name, inner in node.keys.items()})


def _uncounted(trajectory: Mapping[str, Any], joints: int) -> Iterator[KeyPath]:
    """The paths of lists per joint that have a wrong length. A range is a pair of numbers, not such a list."""
    for table in _PER_JOINT:
        for name, value in subtable(trajectory, table).items():
            several = isinstance(value, tuple) and (name != "position" or any(isinstance(v, tuple) for v in value))
            if several and len(value) != joints:
                yield ("trajectory", table, name)


def _region_faults(region: Mapping[str, Any], mechanism: type[Mechanism]) -> Iterator[KeyPath]:
    if region.get("kind") not in REGION_KINDS:
        return
    for name in _coordinates(mechanism, region["kind"]):
        interval = region.get(name)
        if interval is None:
            yield ("region", name)
        elif _within_a_turn(mechanism, name):
            angles = _numbers(interval)
            if angles and angles[-1] - angles[0] > _TURN:
                yield ("region", name)


def _home_table(mechanism: type[Mechanism]) -> Table:
    count = len(mechanism.joint_names)
    joints = Key(f"a finite number for each of {count} joints", joint_unit(mechanism), place=True)
    return Table(
        {name: Key("a finite number", _pose_dimension(name), place=True) for name in mechanism.pose_names}
        | {"joints": joints}
    )


def _region_table(mechanism: type[Mechanism], region: object) -> Table:
    kind = region.get("kind") if isinstance(region, dict) else None
    own = table_of(BoxTable if kind == "box" else CylinderTable)
    return own.updated({name: _coordinate(mechanism, name) for name in _coordinates(mechanism, kind)})


def _coordinates(mechanism: type[Mechanism], kind: object) -> tuple[str, ...]:
    """The pose coordinates that have their own key in a region of this kind."""
    disc = ("x", "y") if kind == "cylinder" else ()
    return tuple(name for name in mechanism.pose_names if name not in disc)


def _coordinate(mechanism: type[Mechanism], name: str) -> Key:
    reach = ", at most a turn apart" if _within_a_turn(mechanism, name) else ""
    return Key(f"a number, or low < high{reach}", _pose_dimension(name), place=True)


def _within_a_turn(mechanism: type[Mechanism], name: str) -> bool:
    return _pose_dimension(name) is Dimension.ANGLE and not mechanism.counts_turns


def _pose_dimension(name: str) -> Dimension:
    return Dimension.LENGTH if is_length(name) else Dimension.ANGLE


def _dimensions(field: GeometryField) -> Key:
    count = " x ".join(map(str, field.shape)) or "a"
    plural = "s" if field.shape else ""
    return _key_of(field, f"{count} finite number{plural}{field.kind.condition}")


def _bounds(field: GeometryField) -> Key:
    pair = f"low < high{field.kind.condition_on_pairs}"
    if not field.shape:
        return _key_of(field, pair)
    count = math.prod(field.shape)
    return _key_of(field, f"a list of {count} pairs, each {pair}; low = high fixes an entry, but not all")


def _key_of(field: GeometryField, expected: str) -> Key:
    dimension = Dimension(field.kind.dimension)
    return Key(expected, dimension, place=dimension is Dimension.LENGTH and field.kind.above is None)


def _lengths(fields: Mapping[str, GeometryField]) -> tuple[str, ...]:
    return tuple(name for name, field in fields.items() if field.kind.dimension == Dimension.LENGTH)


def _rows(data: Mapping[str, Any], name: str, key: str) -> Iterator[tuple[int, Any]]:
    rows = data.get(name)
    for i, row in enumerate(rows if isinstance(rows, tuple) else ()):
        if isinstance(row, dict) and key in row:
            yield i, row[key]


def _is_below(value: object, least: float) -> bool:
    return isinstance(value, int | float) and value < least


def _numbers(value: object) -> list[float]:
    if isinstance(value, tuple):
        return [number for entry in value for number in _numbers(entry)]
    return [value] if isinstance(value, int | float) else []
