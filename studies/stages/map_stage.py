"""The map of a study: it is sampled until its figures no longer change and, on request, partly proved."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any

import numpy as np

from design import Box, CertifiedRegion, Cylinder, LevelSet, Region, certified_cells, certified_cylinder, level_set
from kinematics import Bound
from studies.stages.bound_option import InvalidOption
from studies.stages.map_options import MapRequest, angles_of
from studies.stages.timed_stage import Progress, stage


@dataclass(frozen=True)
class MapOutcome:
    """A map, its level set (the part that keeps the bound), and the certified region if one was asked for."""

    request: MapRequest
    found: LevelSet
    certified: CertifiedRegion | None

    @property
    def area_unit(self) -> str:
        """The unit of an area in the plane: the product of its axes' units."""
        units = [unit_of(self.request, name) for name in self.request.section.axes]
        return f"{units[0]}²" if units[0] == units[1] else " ".join(units)

    @property
    def certified_area(self) -> float | None:
        """Area of the proved part in the plane; None if no proof was asked for, or if it has only a radius."""
        if self.certified is None:
            return None
        axes = self.request.section.axes
        if isinstance(self.request.section.region, Box):
            return self.certified.area(axes)
        return float(np.pi * self.certified.radius**2) if set(axes) == {"x", "y"} else None

    @property
    def still_moves(self) -> str:
        """A warning in words that the figures still change; "" if they do not."""
        found = self.found
        if found.settled:
            return ""
        nodes = " x ".join(map(str, found.map.values.shape[::-1]))
        if math.isinf(found.moved):
            return f"only one map of {nodes} nodes, or a part that the map before did not show: may be far off"
        changed = f"the last refinement, to {nodes} nodes, changed the figures by {found.moved:.2g}"
        return f"{changed}; the tolerance is {found.tolerance:g}"

    @property
    def none_seen(self) -> str:
        """The meaning of an area of 0, in words."""
        axes, steps = self.request.section.axes, self.found.step
        apart = " and ".join(f"{v:.2g} {unit_of(self.request, n)}" for n, v in zip(axes, steps, strict=True))
        return f"no node keeps the bound; the nodes are {apart} apart and could miss a narrower part"

    def header(self) -> dict[str, Any]:
        """How the numbers were made, as plain data."""
        r = self.request
        return {
            "linkwright": version("linkwright"),
            "mechanism": type(r.robot).__name__,
            "geometry_hash": r.robot.geometry.digest,
            "index": r.index.name,
            "bound": r.bound,
            "section": str(r.section),
            "worst_over": r.section.rest(r.robot.pose_names),
            "region": repr(r.section.region),
            "fvi_bounds": vars(r.fvi_bounds),
            "characteristic_length": r.characteristic_length,
            "nodes": list(self.found.map.values.shape[::-1]),
        }

    @property
    def worst_part(self) -> str | None:
        """The part of the robot that has the worst value in the plane, such as "limb 1"; None if there is no one."""
        r = self.request
        if r.index.name not in r.robot.margins:
            return None
        return r.robot.margin_place(r.index.name, self.found.map.worst[1], r.fvi_bounds, r.characteristic_length)

    def figures(self) -> dict[str, Any]:
        """The numbers, as plain data; `moved` has the change of each in the last refinement."""
        now, before = self.found.figures, self.found.coarser
        value, pose = self.found.map.worst
        data: dict[str, Any] = {
            "area": now.area,
            "mean": now.mean,
            "deviation": now.deviation,
            "settled": self.found.settled,
            "moved_by": self.found.moved,
            "step": list(self.found.step),
            "moved": {name: abs(getattr(now, name) - getattr(before, name)) for name in vars(now)},
            "worst": value,
            "worst_pose": pose.tolist(),
            "worst_part": self.worst_part,
        }
        if (proof := self.certified) is not None:
            data["certified"] = {
                "area": self.certified_area,
                "radius": proof.radius or None,
                "certificates": len(proof.certificates),
                "boxes": proof.boxes,
                "left": len(proof.left),
                "complete": proof.complete,
                "seconds": proof.seconds,
            }
        return data


def unit_of(request: MapRequest, name: str) -> str:
    """The unit of a pose coordinate."""
    return "rad" if name in angles_of(request.robot) else "m"


def run_map(
    request: MapRequest, tolerance: float, certify: bool, progress: Progress, seconds: float = math.inf
) -> MapOutcome:
    """Sample the map, and prove a part of it if asked.

    Args:
        tolerance: as in `level_set`.
        seconds: time for the map, and the same again for the proof. Each returns what it reached by then.

    Raises:
        InvalidOption: a tolerance or a time is not above 0, or no region can be proved with these options.
        OutOfTime: the time ended before a coarse map was complete.
    """
    if not (np.isfinite(tolerance) and tolerance > 0.0):
        raise InvalidOption("--tolerance", tolerance, "a finite number > 0")
    if not seconds > 0.0:
        raise InvalidOption("--seconds", seconds, "a number > 0")
    prove = _proof(request, seconds) if certify else None
    with stage(f"map of {request.index.name}", progress, seconds):
        names = request.robot.pose_names
        found = level_set(request.index, request.section, names, request.bound, tolerance, seconds)
    if prove is None:
        return MapOutcome(request, found, None)
    with stage("certified region", progress, seconds):
        return MapOutcome(request, found, prove())


def _proof(request: MapRequest, seconds: float) -> Callable[[], CertifiedRegion]:
    """The search for the certified region. The options are checked here, before anything runs."""
    r = request
    if r.bound is None:
        word = r.robot.margins[r.index.name].word.replace("_", "-")
        raise InvalidOption("--certified", f"no bound of {r.index.name}", f"--{word} C")
    region, bound, name = _fixed(r), r.bound, r.index.name
    measured: dict[str, Any] = {"bounds": r.fvi_bounds, "characteristic_length": r.characteristic_length}
    measured |= {"seconds": seconds, Bound(bound, r.index.sense).word: bound}
    if isinstance(region, Cylinder):
        return lambda: certified_cylinder(r.robot, region, name, **measured)
    return lambda: certified_cells(r.robot, region, r.section.axes, name, **measured)


def _fixed(request: MapRequest) -> Region:
    """The region, with the section's single values instead of its intervals."""
    region, at = request.section.region, request.section.at
    for name, values in at.items():
        if len(values) != 1:
            raise InvalidOption("--certified", f"{len(values)} values of {name}", "one value, or its whole interval")
    fixed = {name: (values[0], values[0]) for name, values in at.items()}
    if not isinstance(region, Cylinder):
        return Box(**{**region.intervals, **fixed})
    if fixed.keys() & {"x", "y"}:
        raise InvalidOption("--certified", f"a cylinder with fixed {' and '.join(fixed)}", "x and y free, or axes")
    others = {name: pair for name, pair in region.intervals.items() if name not in ("x", "y")}
    return Cylinder(region.radius, **{**others, **fixed})
