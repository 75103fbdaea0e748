"""The report's pictures, as PNG bytes; nothing is shown on a screen."""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from design import Map, Problem, Region, Section, index_of, map_of
from kinematics import Array, Mechanism, PlacedShape, placed_shapes
from studies.report.around_robot import draw_parts, parts_around
from studies.report.solids import faces

_COLOURS = ("#0b6e8e", "#d1495b", "#edae49", "#3c7a3f", "#6a4c93", "#8a5a44")
_LINES = {
    "base": ("#888888", 1.1),
    "tool": (_COLOURS[2], 2.0),
}
_BODIES = {"": "#b8b8b8", "arm": _COLOURS[0], "link": _COLOURS[0], "plate": _COLOURS[1], "screw": _COLOURS[2]}
_ROD = "#555555"
_DASHES = ("-", "--")  # symmetric joints have equal curves: dashes let the curve below be seen
STYLE: Any = {
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.alpha": 0.25,
    "grid.linewidth": 0.6,
    "hatch.linewidth": 0.4,
}


def can_be_mapped(region: Region, names: Sequence[str]) -> bool:
    """Whether the region has a plane to draw."""
    return len(_free(region, names)) >= 2


def _free(region: Region, names: Sequence[str]) -> list[str]:
    return [n for n in names if region.intervals[n][0] < region.intervals[n][1]]


def section_of(problem: Problem, robot: Mechanism, region: Region, margin: str, size: int = 61) -> Map:
    """Map a margin over the region's first two free coordinates, the worst over the others."""
    first, second = _free(region, robot.pose_names)[:2]
    index = index_of(robot, margin, problem.fvi_bounds, problem.characteristic_length)
    return map_of(index, Section(region, (first, second)), robot.pose_names, (size, size))


def mechanism_picture(robots: dict[str, Mechanism], region: Region) -> bytes:
    """Each robot in 3-D in its workspace, all in the same scale, with the workspace's edge.

    What is around the robot is drawn lightly where it is near. Of a robot that reaches no pose of the workspace, only
    the parts with a known place are drawn.
    """
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(5.6 * len(robots), 4.2))
        poses = {label: pose_in(robot, region) for label, robot in robots.items()}
        drawn = {label: _finite(robot.polylines(poses[label])) for label, robot in robots.items()}
        shapes = {label: placed_shapes(robot, poses[label]) for label, robot in robots.items()}
        known = [line for own in drawn.values() for line in own.values()] + region.outline()
        every = [shape for own in shapes.values() for shape in own]
        low, high = _common_box(known + [side for shape in every if shape.kind for side in _limits(shape)])
        short = [shape for shape in every if np.ptp(shape.corners, axis=0).max() <= (high - low).max()]
        low, high = _common_box([low[None], high[None], *(side for shape in short for side in _limits(shape))])
        parts = {label: parts_around(robot, poses[label], low, high) for label, robot in robots.items()}
        seen = [polygon for own in parts.values() for part in own for polygon in part.polygons]
        low, high = _common_box([low[None], high[None], *seen])
        for k, (label, lines) in enumerate(drawn.items(), start=1):
            axes = figure.add_subplot(1, len(robots), k, projection="3d")
            for name, line in lines.items():
                if (kind := name.split()[0]) in _LINES:
                    colour, width = _LINES[kind]
                    axes.plot(*line.T, color=colour, linewidth=width)
            _draw_bodies(axes, shapes[label], low, high)
            draw_parts(axes, parts[label])
            for edge in region.outline():
                axes.plot(*edge.T, color="#3c7a3f", linewidth=0.8, alpha=0.7)
            axes.set(title=label, xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
            axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
            axes.locator_params(nbins=5)
            axes.set_box_aspect(high - low, zoom=1.1)  # as long as the limits: equal scales
            axes.view_init(elev=18, azim=-60)
        if handles := [part.handle for part in next(iter(parts.values()))]:
            figure.legend(handles=handles, loc="lower center", ncols=2, frameon=False)
            figure.subplots_adjust(bottom=0.08 + 0.05 * ((len(handles) + 1) // 2))
        return png(figure)


def _limits(shape: PlacedShape) -> list[Array]:
    """The corners moved by `around` to either side; without those that have no place."""
    finite = shape.corners[np.isfinite(shape.corners).all(axis=-1)]
    return [finite - shape.around, finite + shape.around]


def _draw_bodies(axes: Any, shapes: list[PlacedShape], low: Array, high: Array) -> None:
    """The members, without what reaches out of the box, such as long rails; one collection, so that what is in front
    hides the rest.
    """
    polygons, colours = [], []
    for shape in shapes:
        within = not ((shape.corners < low) | (shape.corners > high)).any()
        if np.isfinite(shape.corners).all() and within:
            found = faces(shape)
            polygons += found
            colours += [_BODIES.get(shape.kind, _ROD)] * len(found)
    if polygons:
        axes.add_collection3d(Poly3DCollection(polygons, facecolors=colours, shade=True, linewidths=0.0))


def pose_in(robot: Mechanism, region: Region) -> Array:
    """(n,) a pose of the region: home if it is in the region, else the most central of a few that the robot reaches.

    If the robot reaches none of these, the most central of them.
    """
    names, home = robot.pose_names, np.asarray(robot.home, dtype=float)
    poses = region.spread(names)
    middle = np.array([region.intervals[name] for name in names]).mean(axis=-1)
    away = np.abs(poses - middle) / np.where(region.extent(names) > 0.0, region.extent(names), 1.0)
    poses = poses[np.argsort(away.max(axis=-1), kind="stable")]
    if region.contains(home, names):
        poses = np.vstack([home, poses])
    reached = np.isfinite(robot.inverse(poses)).all(axis=-1)
    return np.asarray(poses[int(np.argmax(reached))])  # the first where all are False


def _finite(lines: dict[str, Array]) -> dict[str, Array]:
    """The lines without their NaN points, which a pose out of reach leaves without a place."""
    return {name: line[np.isfinite(line).all(axis=-1)] for name, line in lines.items()}


def _common_box(lines: list[Array]) -> tuple[Array, Array]:
    """(3,) lower and upper limits that hold every line; a flat side is as wide as a hundredth of the longest."""
    points = np.concatenate(lines)
    low, high = points.min(axis=0), points.max(axis=0)
    wanting = np.maximum(0.0, 0.01 * float((high - low).max()) - (high - low))
    return low - wanting / 2, high + wanting / 2


def map_picture(sections: dict[str, Map], title: str, bound: float | None) -> bytes:
    """Worst values over the plane: a panel for each robot, same colours, a red line at the bound if it is crossed."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(4.9 * len(sections), 4.2), layout="constrained")
        shown = {label: np.where(chart.inset >= 0.0, chart.values, np.nan) for label, chart in sections.items()}
        everything = np.concatenate([values[np.isfinite(values)] for values in shown.values()])
        panels: list[Axes] = list(np.atleast_1d(figure.subplots(1, len(sections), sharey=True)))
        for axes, (label, chart) in zip(panels, sections.items(), strict=True):
            limits = {"vmin": everything.min(), "vmax": everything.max()}
            mesh = axes.pcolormesh(chart.first, chart.second, shown[label], cmap="viridis", **limits)
            low = float(np.nanmin(shown[label]))
            if bound is not None and low < bound < np.nanmax(shown[label]):
                axes.contour(chart.first, chart.second, shown[label], levels=[bound], colors="red")
            axes.set(title=f"{label}: lowest {low:.3f} on this grid", xlabel=_axis(chart.section.axes[0]))
            axes.set_aspect("equal")
            axes.grid(False)
        panels[0].set_ylabel(_axis(chart.section.axes[1]))
        figure.colorbar(mesh, ax=panels, label=title)
        return png(figure)


def path_picture(poses: Array, time: Array, names: Sequence[str]) -> bytes:
    """The tool's path from its start, and each pose coordinate over time."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(9.8, 3.2), layout="constrained")
        left, right = figure.subplots(1, 2)
        away = 1e3 * (poses - poses[0])
        if "z" in names:
            left.plot(np.hypot(away[:, 0], away[:, 1]), away[:, 2], color=_COLOURS[0])
            left.set(title="path of the tool", xlabel="across [mm]", ylabel="up [mm]")
        else:
            left.plot(away[:, 0], away[:, 1], color=_COLOURS[0])
            left.set(title="path of the tool", xlabel="x [mm]", ylabel="y [mm]")
        left.set_aspect("equal", adjustable="datalim")
        for k, name in enumerate(names):
            unit, factor = ("mm", 1e3) if name in "xyz" else ("deg", 180 / np.pi)
            right.plot(1e3 * time, factor * (poses[:, k] - poses[0, k]), color=_COLOURS[k], label=f"{name} [{unit}]")
        right.set(title="pose from the start", xlabel="time [ms]")
        right.legend(frameon=False)
        return png(figure)


def motion_picture(time: Array, rows: Sequence[tuple[str, Array, Array | None]], joints: Sequence[str]) -> bytes:
    """Joint quantities over time, one panel each, with dotted limits.

    Args:
        time: (k,) [s].
        rows: label, values (k, m), limits (m,) or None.
        joints: the joints' names.
    """
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(9.8, 2.3 * len(rows)), layout="constrained")
        panels: list[Axes] = list(np.atleast_1d(figure.subplots(len(rows), 1, sharex=True)))
        for axes, (label, values, limits) in zip(panels, rows, strict=True):
            for k, name in enumerate(joints):
                axes.plot(1e3 * time, values[:, k], _DASHES[k % 2], color=_COLOURS[k % 6], label=name, linewidth=1.2)
            for limit in () if limits is None else np.unique(np.abs(limits)):
                for sign in (-1, 1):
                    axes.axhline(sign * limit, color="0.3", linestyle=":", linewidth=1.4)
            axes.set_ylabel(label)
        figure.legend(
            *panels[0].get_legend_handles_labels(), loc="outside upper right", ncols=len(joints), frameon=False
        )
        panels[-1].set_xlabel("time [ms]")
        return png(figure)


def _axis(name: str) -> str:
    return f"{name} [{'m' if name in ('x', 'y', 'z') else 'rad'}]"


def png(figure: Figure) -> bytes:
    """The figure as PNG; the same figure gives the same bytes."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=130, metadata={"Software": None})
    return buffer.getvalue()
