"""From the study and the options of `linkwright map` to an index over a section."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from design import Box, Cylinder, Index, InvalidRegion, InvalidSection, Region, Section, index_of
from kinematics import FviBounds, Mechanism
from studies.building import problem_of, region_of
from studies.stages.bound_option import InvalidOption, bound_option
from studies.study_file import LARGEST, Study
from trajectory import in_si

DEFAULT = "fvi"
_FVI_BOUND = 1.0  # at 1 the robot just gives the wanted speed and force


@dataclass(frozen=True)
class MapRequest:
    """A checked request for a map.

    Attributes:
        robot, index, section: the robot, its index, and the plane with its other coordinates.
        bound: the index should be at least this, or at most if smaller is better; None takes all in reach.
        fvi_bounds, characteristic_length: what the indices are measured with.
    """

    robot: Mechanism
    index: Index
    section: Section
    bound: float | None
    fvi_bounds: FviBounds
    characteristic_length: float


def angles_of(robot: Mechanism) -> tuple[str, ...]:
    """The pose coordinates that are angles."""
    return tuple(robot.pose_names[i] for i in robot.rotations)


def map_request(
    study: Study,
    robot: Mechanism,
    margin: str | None = None,
    section: str | None = None,
    at: Sequence[str] = (),
    over: Sequence[str] = (),
    at_least: float | None = None,
    at_most: float | None = None,
) -> MapRequest:
    """Check the options against the study's robot and region.

    Args:
        margin: one of the robot's margins; by default the FVI.
        section: two coordinates, such as "y,z"; by default the region's first two free ones.
        at: each "name=value" or "name=value,value,..."; a name may end in `_deg` or `_mm`.
        over: each "name=low:high", which replaces the region's own interval; "radius=0.7" for a cylinder.
        at_least, at_most: the bound; by default the study's requirement of this margin, else 1 for the FVI.

    Raises:
        InvalidOption: names the option, what was found and what would be right.
    """
    name = margin or DEFAULT
    if name not in robot.margins:
        raise InvalidOption("--margin", name, f"one of {', '.join(robot.margins)}")
    given = bound_option(robot.margins[name], at_least, at_most)
    region = _region(study, robot, over)
    values = _assignments("--at", at, robot.pose_names, angles_of(robot), ",")
    free = [n for n in robot.pose_names if region.is_free(n) and n not in values]
    axes = tuple(part.strip() for part in section.split(",")) if section else tuple(free[:2])
    if len(axes) != 2:
        raise InvalidOption("--section", section or ", ".join(axes) or "nothing free", "two coordinates, such as y,z")
    plane = Section(region, (axes[0], axes[1]), values)
    try:
        plane.check(robot.pose_names)
    except InvalidSection as error:
        raise InvalidOption("--section" if error.key == "axes" else "--at", error.found, error.expected) from error
    problem = problem_of(study)
    bounds = {r.margin: r.bound.value for r in problem.requirements}
    wanted = bounds.get(name, _FVI_BOUND if name == "fvi" else None) if given is None else given.value
    index = index_of(robot, name, problem.fvi_bounds, problem.characteristic_length)
    return MapRequest(robot, index, plane, wanted, problem.fvi_bounds, problem.characteristic_length)


def _region(study: Study, robot: Mechanism, over: Sequence[str]) -> Region:
    """The study's region, with the bounds that `over` replaces."""
    region = region_of(study)
    known = (*robot.pose_names, "radius") if isinstance(region, Cylinder) else robot.pose_names
    changed = _assignments("--over", over, known, angles_of(robot), ":")
    try:
        if not isinstance(region, Cylinder):
            return Box(**{**region.intervals, **{name: _pair(name, pair) for name, pair in changed.items()}})
        radius = changed.pop("radius", (region.radius,))
        if len(radius) != 1:
            raise InvalidOption("--over", f"{len(radius)} values for radius", "radius=VALUE")
        others = {n: pair for n, pair in region.intervals.items() if n not in ("x", "y")}
        return Cylinder(radius[0], **{**others, **{name: _pair(name, pair) for name, pair in changed.items()}})
    except InvalidRegion as error:
        raise InvalidOption("--over", f"{error.found} for {error.key}", error.expected) from error


def _pair(name: str, values: tuple[float, ...]) -> tuple[float, float]:
    if len(values) != 2:
        raise InvalidOption("--over", f"{len(values)} values for {name}", f"{name}=LOW:HIGH")
    return values[0], values[1]


def _assignments(
    option: str, given: Sequence[str], known: Sequence[str], angles: Sequence[str], separator: str
) -> dict[str, tuple[float, ...]]:
    """Values in SI by name, from texts such as "name_deg=1,2"; `separator` stands between the values."""
    found: dict[str, tuple[float, ...]] = {}
    for text in given:
        key, equals, right = text.partition("=")
        name, suffix = key.strip(), ""
        if name not in known:
            name, _, suffix = name.rpartition("_")
        if not equals or name not in known or suffix not in ("", _suffix(name, angles)):
            names = ", ".join(f"{n}[_{_suffix(n, angles)}]" for n in known)
            raise InvalidOption(option, text, f"NAME=VALUE, where NAME is one of {names}")
        if name in found:
            raise InvalidOption(option, f"{name} twice", "each name once")
        try:
            values = tuple(in_si(part.strip(), suffix) for part in right.split(separator))
        except ValueError:
            raise InvalidOption(option, text, f"numbers with '{separator}' between them") from None
        if not all(abs(v) <= LARGEST for v in values):  # NaN is not
            raise InvalidOption(option, text, f"finite numbers from {-LARGEST:g} to {LARGEST:g}")
        found[name] = values
    return found


def _suffix(name: str, angles: Sequence[str]) -> str:
    return "deg" if name in angles else "mm"
