"""The map of a study: sampled until its figures stand still and, where asked, the part of it that is proved."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any

import numpy as np

from design import Box, CertifiedRegion, Cylinder, LevelSet, Region, certified_cells, certified_cylinder, level_set
from studies.stages.map_options import InvalidOption, MapRequest, angles_of
from studies.stages.timed_stage import Progress, stage


@dataclass(frozen=True)
class MapOutcome:
    """A map, its level set, and the certified region where one was asked for."""

    request: MapRequest
    found: LevelSet
    certified: CertifiedRegion | None

    @property
    def area_unit(self) -> str:
        """Of the plane: the product of its axes' units."""
        units = [unit_of(self.request, name) for name in self.request.section.axes]
        return f"{units[0]}²" if units[0] == units[1] else " ".join(units)

    @property
    def certified_area(self) -> float | None:
        """Of the proved part, in the plane; None where nothing was asked or a radius is no area in this plane."""
        if self.certified is None:
            return None
        axes = self.request.section.axes
        if isinstance(self.request.section.region, Box):
            return self.certified.area(axes)
        return float(np.pi * self.certified.radius**2) if set(axes) == {"x", "y"} else None

    @property
    def still_moves(self) -> str:
        """What figures that did not stand still are worth, in words; "" where they did."""
        found = self.found
        if found.settled:
            return ""
        nodes = " x ".join(map(str, found.map.values.shape[::-1]))
        if math.isinf(found.moved):
            return f"one map of {nodes} nodes only, or a part that the map before did not see: may be far off"
        return f"figures still move by {found.moved:.2g} with {nodes} nodes; {found.tolerance:g} was asked"

    @property
    def none_seen(self) -> str:
        """What an area of 0 says, in words."""
        axes, steps = self.request.section.axes, self.found.step
        apart = " and ".join(f"{v:.2g} {unit_of(self.request, n)}" for n, v in zip(axes, steps, strict=True))
        return f"no node keeps the bound; they are {apart} apart, a narrower part would be missed"

    def header(self) -> dict[str, Any]:
        """What made the numbers, as plain data."""
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

    def figures(self) -> dict[str, Any]:
        """The numbers, as plain data; `moved` is by how much the last refinement changed each."""
        now, before = self.found.figures, self.found.coarser
        value, pose = self.found.map.lowest
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
    """Of a pose coordinate."""
    return "rad" if name in angles_of(request.robot) else "m"


def run_map(
    request: MapRequest, tolerance: float, certify: bool, progress: Progress, seconds: float = math.inf
) -> MapOutcome:
    """Sample, and prove where asked.

    Args:
        tolerance: as in `level_set`.
        seconds: for the map, and as many for the proof; each then says what it reached.

    Raises:
        InvalidOption: a tolerance or a time not above 0, or no family of regions of which something could be proved.
        OutOfTime: not even a coarse map was complete.
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
    """The search for the certified region, with everything that may be wrong checked before anything runs."""
    r = request
    if r.bound is None:
        raise InvalidOption("--certified", f"no bound of {r.index.name}", "--at-least C")
    region, bound, name = _fixed(r), r.bound, r.index.name
    measured: dict[str, Any] = {"bounds": r.fvi_bounds, "characteristic_length": r.characteristic_length}
    measured["seconds"] = seconds
    if isinstance(region, Cylinder):
        return lambda: certified_cylinder(r.robot, region, name, at_least=bound, **measured)
    return lambda: certified_cells(r.robot, region, r.section.axes, name, at_least=bound, **measured)


def _fixed(request: MapRequest) -> Region:
    """The region with the section's single values in place of its intervals."""
    region, at = request.section.region, request.section.at
    for name, values in at.items():
        if len(values) != 1:
            raise InvalidOption("--certified", f"{len(values)} values of {name}", "one value, or its whole interval")
    fixed = {name: (values[0], values[0]) for name, values in at.items()}
    if not isinstance(region, Cylinder):
        return Box(**{**region.intervals, **fixed})
    if fixed.keys() & {"x", "y"}:
        raise InvalidOption("--certified", f"a cylinder at {' and '.join(fixed)}", "x and y on an axis or open")
    others = {name: pair for name, pair in region.intervals.items() if name not in ("x", "y")}
    return Cylinder(region.radius, **{**others, **fixed})
