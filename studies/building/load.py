"""Read a `study.toml` into a checked `Study`. All faults of the file are reported at once."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic import ValidationError

from kinematics import InvalidGeometry, Mechanism
from studies.building.against_mechanism import (
    at_odds,
    impossible_bounds,
    repeated_margins,
    study_table,
    wrong_words,
)
from studies.building.mechanisms import MechanismRefused, NamedMechanism, mechanism_named
from studies.building.objects import path_of, robot_of
from studies.building.surroundings import names_told, require_room_in
from studies.errors import Fault, KeyPath, StudyError, spelled
from studies.study_file import (
    Conversion,
    Finding,
    Key,
    Study,
    SurroundingsTable,
    Table,
    TomlFile,
    WaypointTable,
    table_of,
)
from trajectory import InvalidPath, read_waypoints

# These keys can be checked only if the mechanism is known.
_OF_THE_MECHANISM = ("geometry", "inertia", "ranges", "region", "home", "optimise", "certify", "requirement")


def load_study(file: TomlFile, allow_code: bool = False) -> Study:
    """Check a study file; all values of the result are in SI and radians.

    Args:
        file: as `read_toml` reads it.
        allow_code: whether the Python module that the study names for its mechanism may run.

    Raises:
        StudyError: it holds every fault with its key and line.
        WaypointFileError: a file of waypoints that the study names cannot be used.
    """
    conversion, raw = Conversion(), file.data
    named = _mechanism(file, conversion, allow_code)
    if named is not None:
        mechanism = named.mechanism_class
        table = study_table(mechanism, raw)
        data = conversion.to_si(raw, table)
        wrong = set(at_odds(data, mechanism))
        for path, expected in wrong_words(data, mechanism):
            key = conversion.spelling[path]
            conversion.findings.append(Finding(key, f"{key[-1]} = {spelled(file.value(key))}", expected))
            wrong.discard((*path[:-1], expected.partition(",")[0]))
        names_told(file, conversion, data, mechanism)
        for path, expected in impossible_bounds(data, mechanism):
            key = conversion.spelling[path]
            conversion.findings.append(Finding(key, spelled(file.value(key)), expected))
        for path, first, margin in repeated_margins(data):
            expected = f"one requirement a margin; line {file.line(first)} has the first one on {margin}"
            conversion.findings.append(Finding(path, f"a second requirement on {margin}", expected))
    else:
        table = table_of(Study)
        data = conversion.to_si(_without_the_mechanism_s(raw), table)
        wrong = {("mechanism",)}
        conversion.reported.update((name,) for name in _OF_THE_MECHANISM)
    try:
        of_code = {} if named is None else named._asdict()
        study = Study.model_validate(data | of_code | {"name": file.path.resolve().parent.name})
    except ValidationError as error:
        wrong.update(_invalid(error, table))
    if told := _faults(file, table, conversion, wrong):
        raise StudyError(told)
    assert named is not None
    try:
        named.mechanism_class.Geometry(**study.geometry)
    except InvalidGeometry as error:
        raise StudyError([_of_geometry(error, named.mechanism_class, file, conversion)]) from error
    _require_thin_walls(study, file, conversion)
    if study.surroundings != SurroundingsTable():
        require_room_in(robot_of(study), file)
    return _with_waypoints(study, file, conversion, named.mechanism_class.pose_names)


def _of_geometry(error: InvalidGeometry, kind: type[Mechanism], file: TomlFile, conversion: Conversion) -> Fault:
    """The fault at the refused field; at the radius if the study gives it and not the wall, which is too thick."""
    key, expected = conversion.spelling.get(("geometry", error.field)), error.expected
    if key is None and (radius := kind.Geometry.walls().get(error.field)) is not None:
        key = conversion.spelling.get(("geometry", radius))
        expected = f"at least {error.field}, which is {error.found} m by default"
    key = key or ("geometry",)
    return file.fault(key, spelled(file.value(key)), expected)


def _require_thin_walls(study: Study, file: TomlFile, conversion: Conversion) -> None:
    """Check that no bounds of the optimisation allow a wall that is thicker than its tube's radius.

    Raises:
        StudyError: at the bounds.
    """
    kind = study.mechanism_class.Geometry
    own = kind(**study.geometry).as_dict()
    bounds = {} if study.optimise is None else study.optimise.variables
    for wall, radius in kind.walls().items():
        (_, most), (least, _) = (bounds.get(name, (own[name], own[name])) for name in (wall, radius))
        if most > least:
            key = conversion.spelling[("optimise", "variables", wall if wall in bounds else radius)]
            expected = f"bounds in which {wall} is at most {radius}"
            raise StudyError([file.fault(key, f"a wall of up to {most:g} m and a radius from {least:g} m", expected)])


def _with_waypoints(study: Study, file: TomlFile, conversion: Conversion, pose_names: tuple[str, ...]) -> Study:
    """The study with the waypoints of the file that it names, so that its digest includes them.

    Raises:
        StudyError: a waypoint of the study itself does not fit.
        WaypointFileError: a waypoint of the file does not fit.
    """
    if study.trajectory is None or study.trajectory.path is None:
        return study
    path, key = study.trajectory.path, ("trajectory", "path")
    if (path.file is None) == (not path.waypoint):
        found = "neither a file nor waypoints" if path.file is None else "a file and waypoints"
        raise StudyError([file.fault(key, found, "either a file or waypoints")])
    if path.file is not None:
        beside = file.path.parent / path.file
        if beside.suffix.lower() != ".csv" or not beside.is_file():
            what = "which does not exist" if not beside.exists() else "which is no CSV file"
            found = f"{spelled(path.file)}, {what}"
            raise StudyError([file.fault((*key, "file"), found, "a .csv file of waypoints beside the study")])
        read = read_waypoints(beside, pose_names)
        rows = zip(read.poses, (0.0, *read.blends, 0.0), strict=True)
        waypoints = tuple(
            WaypointTable(
                coordinates={n: v for n, v in zip(pose_names, pose, strict=True) if v is not None}, blend=blend
            )
            for pose, blend in rows
        )
        path = path.model_copy(update={"waypoint": waypoints})
        return study.model_copy(update={"trajectory": study.trajectory.model_copy(update={"path": path})})
    if len(path.waypoint) == 1:
        raise StudyError([file.fault((*key, "waypoint"), "one waypoint", "two or more")])
    try:
        path_of(study.trajectory, pose_names)
    except InvalidPath as error:
        own = conversion.spelling.get((*key, "waypoint", error.pose - 1, error.field))
        found = f"{own[-1]} = {spelled(file.value(own))}" if own else f"{error.field} {error.found}"
        raise StudyError([file.fault((*key, "waypoint", error.pose - 1), found, error.expected)]) from error
    return study


def _without_the_mechanism_s(raw: dict[str, Any]) -> dict[str, Any]:
    """The tables and rows that do not depend on the mechanism."""
    data = {key: raw[key] for key in raw if key not in _OF_THE_MECHANISM}
    trajectory = data.get("trajectory")
    if isinstance(trajectory, dict) and isinstance(trajectory.get("path"), dict):
        path = {key: value for key, value in trajectory["path"].items() if key != "waypoint"}
        data["trajectory"] = {**trajectory, "path": path}
    return data


def _mechanism(file: TomlFile, conversion: Conversion, allow_code: bool) -> NamedMechanism | None:
    """The mechanism that the study names, or None. A finding is added if the key's own words do not explain why."""
    name = file.data.get("mechanism")
    if not isinstance(name, str):
        return None
    try:
        return mechanism_named(name, file.path.resolve().parent, allow_code)
    except MechanismRefused as error:
        conversion.findings.append(Finding(("mechanism",), error.found, error.expected))
        return None


def _invalid(error: ValidationError, table: Table) -> Iterator[KeyPath]:
    """The SI paths that the models reject."""
    for detail in error.errors(include_url=False, include_context=False, include_input=False):
        if detail["loc"] == ("mechanism_class",):
            continue  # a fault of the mechanism is reported at its name
        path: list[str | int] = []
        node = table
        for part in detail["loc"]:
            # The rest of pydantic's path names the variant of a union that failed, or the entry of an array.
            if isinstance(part, int) and node.rows:
                path.append(part)
            elif isinstance(part, str) and part in node.keys:
                path.append(part)
                inner = node.keys[part]
                if isinstance(inner, Key):
                    break
                node = inner
        # A region of an unknown kind is rejected as a whole.
        yield (*path, "kind") if detail["type"].startswith("union_tag") else tuple(path)


def _faults(file: TomlFile, table: Table, conversion: Conversion, wrong: set[KeyPath]) -> list[Fault]:
    faults = [file.fault(f.path, f.found, f.expected) for f in conversion.findings]
    told = {finding.path for finding in conversion.findings}
    for path in sorted(wrong, key=str):
        if path in conversion.reported and path not in conversion.spelling:
            continue  # a misspelt key is not also reported as missing
        spelling = conversion.spelling.get(path, path)
        if spelling in told:
            continue
        try:
            value: Any = file.value(spelling)
            found = spelled(value)
        except LookupError:
            value, found = None, "nothing"
        node = _node(table, path)
        suffix = str(spelling[-1])[len(str(path[-1])) + 1 :]
        expected = node.describe(suffix, value) if isinstance(node, Key) else node.describe(value)
        faults.append(file.fault(spelling, found, expected))
    return faults


def _node(table: Table, path: KeyPath) -> Key | Table:
    node: Key | Table = table
    for part in path:
        if isinstance(part, str) and isinstance(node, Table):
            node = node.keys[part]
    return node
