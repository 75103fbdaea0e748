"""The redundant robot's maps as its paper has them; `python -m tests.bench.maps` writes them into docs/."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from design import (
    Box,
    CertifiedRegion,
    Cylinder,
    LevelSet,
    Section,
    certified_cells,
    certified_cylinder,
    index_of,
    level_set,
    map_of,
)
from design.maps.level_sets import boundary
from kinematics import Heli4, Redundant3T1R
from studies.report.map_plot import draw_boundary, draw_cells, draw_contours, label_axes
from studies.report.plots import STYLE, png
from tests.bench.table_1 import HIGHEST, NINE, PRINTED, RULES, STEPS, conventions, limit_of_y

DOCS = Path(__file__).parents[2] / "docs"
START, END = "<!-- written by `python -m tests.bench.maps` -->", "<!-- /maps -->"
ROBOT = Redundant3T1R()
QUARTER = Box(x=0.0, y=(0.0, limit_of_y(ROBOT)), z=(0.0, HIGHEST), theta=(-math.pi / 2, math.pi / 2))
PLANE = ("y", "z")
SECTIONS = {
    "theta = 0": Section(QUARTER, PLANE, {"theta": (0.0,)}),
    "nine angles": Section(QUARTER, PLANE, {"theta": NINE}),
    "every angle": Section(QUARTER, PLANE),
}
TOLERANCE = 1e-4
UNIT = np.ones(2)
BETWEEN = "#edae49"


def main() -> None:
    """Pictures and tables."""
    index = index_of(ROBOT, "fvi")
    found = {name: level_set(index, section, ROBOT.pose_names, 1.0, TOLERANCE) for name, section in SECTIONS.items()}
    proof = certified_cells(ROBOT, QUARTER, PLANE, "fvi", at_least=1.0)
    value, pose = lowest_between()
    _write("map_null_orientation.png", [("theta = 0", "boundary"), ("theta = 0", "contours")], found, None)
    _write("map_nine_angles.png", [("nine angles", "boundary"), ("nine angles", "contours")], found, None)
    _write("map_certified.png", [("every angle", "boundary"), ("every angle", "contours")], found, proof)
    _write_between(found, pose)
    lines = [*_table(found), *_conventions(), *_between(found, value, pose), *_certified(found, proof)]
    page = DOCS / "maps.md"
    before, rest = page.read_text().split(START)
    page.write_text(f"{before}{START}\n" + "\n".join(lines) + f"\n{END}{rest.split(END)[1]}")


def lowest_between() -> tuple[float, np.ndarray]:
    """Lowest FVI over all angles where all nine angles give 1 or more, and its pose; by grids ever finer about it."""
    index, names, region = index_of(ROBOT, "fvi"), ROBOT.pose_names, QUARTER
    for _ in range(6):
        passes = map_of(index, replace(SECTIONS["nine angles"], region=region), names, (81, 81)).values >= 1.0
        every = map_of(index, Section(region, PLANE), names, (81, 81))
        row, column = np.unravel_index(int(np.where(passes, every.values, np.inf).argmin()), passes.shape)
        steps = np.array([every.first[1] - every.first[0], every.second[1] - every.second[0]])
        middle = np.array([every.first[column], every.second[row]])
        sides = {}
        for k, name in enumerate(PLANE):
            low, high = QUARTER.intervals[name]
            sides[name] = (max(low, middle[k] - 2 * steps[k]), min(high, middle[k] + 2 * steps[k]))
        region = Box(**{**QUARTER.intervals, **sides})
    return float(every.values[row, column]), every.poses[row, column]


def _write(name: str, panels: list[tuple[str, str]], found: dict[str, LevelSet], proof: CertifiedRegion | None) -> None:
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(5.4, 4.6), layout="compressed")
        for axes, (case, what) in zip(figure.subplots(1, len(panels), sharey=True), panels, strict=True):
            handles = _panel(figure, axes, case, what, found, proof)
            axes.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.12), frameon=False, fontsize=7)
            label_axes(axes, PLANE, ())
            axes.set(title=f"{case}: {what}", xlim=(0, 0.34), ylim=(0, HIGHEST))
        (DOCS / "pictures" / name).write_bytes(png(figure))


def _panel(
    figure: Figure, axes: Axes, case: str, what: str, found: dict[str, LevelSet], proof: CertifiedRegion | None
) -> list:
    chart = found[case]
    handles = [draw_boundary(axes, chart.boundary, UNIT, f"FVI >= 1, {case}")]
    if what == "contours":
        draw_contours(figure, axes, chart.map, "FVI", UNIT, 1.0)
    if proof is not None and what == "contours":
        handles.append(draw_cells(axes, proof.cells(PLANE), UNIT, "proved"))
    return handles


def _write_between(found: dict[str, LevelSet], pose: np.ndarray) -> None:
    """The set that nine angles miss, near its worst pose, and the FVI of that pose over the angle."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(8.4, 3.6), layout="constrained")
        left, right = figure.subplots(1, 2, width_ratios=(1, 2))
        for ring in found["nine angles"].boundary:
            left.fill(*ring.T, color=BETWEEN, label=">= 1 at nine angles, < 1 between")
        for ring in found["every angle"].boundary:
            left.fill(*ring.T, color="#cfe3ea", label=">= 1 at every angle")
        left.plot(*pose[1:3], "o", color="k", markersize=4, label="lowest of the set")
        left.set(title="near the worst pose", xlim=(pose[1] - 0.02, 0.32), ylim=(pose[2] - 0.03, pose[2] + 0.06))
        label_axes(left, PLANE, ())
        left.set_aspect("auto")
        left.locator_params(axis="x", nbins=4)
        left.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), frameon=False, fontsize=7)
        angles = np.linspace(-math.pi / 2, math.pi / 2, 721)
        for at, style in ((angles, "-"), (np.array(NINE), "o")):
            poses = np.column_stack([np.tile(pose[:3], (len(at), 1)), at])
            label = "every angle" if style == "-" else "nine angles"
            right.plot(np.degrees(at), ROBOT.fvi(poses), style, color="#0b6e8e", label=label)
        right.axhline(1.0, color="#d1495b", linewidth=1.0)
        right.set(title=f"at y = {pose[1]:.4f} m, z = {pose[2]:.4f} m", xlabel="theta [deg]", ylabel="FVI")
        dip = math.degrees(pose[3])
        right.set(xlim=(dip - 28.0, dip + 28.0), ylim=(0.995, 1.025))
        right.legend(frameon=False)
        (DOCS / "pictures" / "map_between_angles.png").write_bytes(png(figure))


def _table(found: dict[str, LevelSet]) -> list[str]:
    """Converged figures of the whole plane, four times the quarter's area."""
    lines = ["| FVI >= 1 | area [m²] | mean | deviation | nodes |", "| --- | --- | --- | --- | --- |"]
    for name, case in found.items():
        now, before = case.figures, case.coarser
        cells = [
            f"{4 * now.area:.4f} ({4 * abs(now.area - before.area):.1e})",
            f"{now.mean:.4f} ({abs(now.mean - before.mean):.1e})",
            f"{now.deviation:.4f} ({abs(now.deviation - before.deviation):.1e})",
        ]
        lines.append(f"| {name} | {' | '.join(cells)} | {len(case.map.first)} x {len(case.map.second)} |")
    return [*lines, "", "In brackets: by how much the last halving of the step moved the figure.", ""]


def _conventions() -> list[str]:
    """Which steps reproduce the printed table, by rule; and the simplest one's figures."""
    tried = list(conventions(ROBOT))
    groups: dict[tuple[str, str, float], list] = {}
    for one in tried:
        groups.setdefault((one.axis, one.rule, one.step), []).append(one)
    whole = {key for key, cases in groups.items() if all(case.matches for case in cases)}
    lines = ["| columns of y | area counted by | steps [mm] that give every printed digit |", "| --- | --- | --- |"]
    for axis in dict.fromkeys(one.axis for one in tried):
        for rule in RULES:
            steps = ", ".join(f"{1e3 * step:g}" for step in STEPS if (axis, rule, step) in whole)
            lines.append(f"| {axis} | {rule} | {steps or 'none'} |")
    coarsest = max((key for key in whole if key[1] == "nodes"), key=lambda key: key[2])
    lines += ["", f"Nodes at multiples of {1e3 * coarsest[2]:g} mm:", ""]
    lines += ["| case | area [m²] | mean | deviation | printed |", "| --- | --- | --- | --- | --- |"]
    for one in groups[coarsest]:
        numbers = " | ".join(f"{v:.4f}" for v in one.figures)
        lines.append(f"| {one.case} | {numbers} | {', '.join(f'{v:.2f}' for v in PRINTED[one.case])} |")
    return [*lines, f"\n{len(whole)} of {len(groups)} conventions give every printed digit.", ""]


def _between(found: dict[str, LevelSet], value: float, pose: np.ndarray) -> list[str]:
    area = 4 * (found["nine angles"].figures.area - found["every angle"].figures.area)
    where = f"y = {pose[1]:.4f} m, z = {pose[2]:.4f} m, theta = {math.degrees(pose[3]):.2f}°"
    return [f"FVI >= 1 at nine angles but not between: {area:.5f} m², down to {value:.5f} at {where}.", ""]


def _certified(found: dict[str, LevelSet], proof: CertifiedRegion) -> list[str]:
    sampled = found["every angle"].figures.area
    cylinder = Cylinder(radius=0.6, z=(-0.8, -0.6), theta=(-math.pi, math.pi))
    lines = ["| robot | claim | family | proved | sampled | boxes | time [s] |", "| --- " * 7 + "|"]
    area = proof.area(PLANE)
    share = f"{4 * area:.4f} m², {100 * area / sampled:.1f} % | {4 * sampled:.4f} m²"
    lines.append(
        f"| Redundant3T1R | fvi >= 1 | {len(proof.certificates)} cells of a quarter of y, z | {share} "
        f"| {proof.boxes} | {proof.seconds:.1f} |"
    )
    for margin, bound in (("fvi", 1.0), ("internal_determinant", 0.45)):
        radial = certified_cylinder(Heli4(), cylinder, margin, at_least=bound)
        lines.append(
            f"| Heli4, prototype | {margin} >= {bound:g} | `{cylinder}` and smaller | radius {radial.radius:.4f} m "
            f"| radius {sampled_radius(margin, bound):.4f} m | {radial.boxes} | {radial.seconds:.1f} |"
        )
    return lines


def sampled_radius(margin: str, bound: float) -> float:
    """Radius of the largest disc about the axis in the map of Heli4's prototype over x, y."""
    region = Cylinder(radius=0.6, z=(-0.8, -0.6), theta=(-math.pi, math.pi))
    chart = map_of(index_of(Heli4(), margin), Section(region, ("x", "y")), Heli4.pose_names, (129, 129))
    return min(float(np.hypot(*ring.T).min()) for ring in boundary(chart, bound))


if __name__ == "__main__":
    main()
