"""The picture of a map, as PNG bytes: contours, the bound, and the proved part."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch
from matplotlib.path import Path
from matplotlib.ticker import MaxNLocator

from design import Cylinder, Index, Map, boundary
from kinematics import Array, Bound
from studies.report.plots import STYLE, png
from studies.stages import MapOutcome, angles_of

BOUND, OPEN = "#d1495b", "#111111"
PROVED: Any = {"facecolor": "none", "edgecolor": "#333333", "hatch": "////", "linewidth": 0.25}
_LEVELS = 14
_SAME, _AROUND = 1e-9, 1e-3  # of the size of a number: what is one number, and how far the levels around it reach
_LETTERS = 13  # of the title on one inch


def map_picture(outcome: MapOutcome) -> bytes:
    """One panel: filled contours, the bound in red, the certified region hatched, undecided boxes in black."""
    request, chart = outcome.request, outcome.found.map
    with mpl.rc_context(STYLE):
        angles = angles_of(request.robot)
        scale = np.array([180.0 / np.pi if name in angles else 1.0 for name in request.section.axes])
        figure = Figure(figsize=(2.6 + _panel_width(chart, angles), 4.8), layout="constrained")
        axes = figure.subplots()
        draw_contours(figure, axes, chart, _label(request.index), scale, request.bound)
        drawn: list[Patch | Line2D] = [draw_boundary(axes, outcome.found.boundary, scale, bound_label(outcome))]
        if outcome.certified is not None:
            drawn += _draw_certified(axes, outcome, scale)
        label_axes(axes, request.section.axes, angles)
        figure.suptitle(wrapped(_title(outcome), figure.get_figwidth()), fontsize=9)
        figure.legend(handles=drawn, loc="outside lower center", ncols=1 if len(drawn) < 3 else 2, frameon=False)
        return png(figure)


def wrapped(title: str, width: float) -> str:
    """The title with lines that are no longer than a picture of so many inches."""
    lines = (line for part in title.splitlines() for line in wrap(part, int(_LETTERS * width)))
    return "\n".join(lines)


def _label(index: Index) -> str:
    return f"{index.name} [{index.unit}]" if index.unit else index.name


def _panel_width(chart: Map, angles: Sequence[str]) -> float:
    """Width in inches of a panel 3.6 inches high. Both axes have one scale where both are lengths."""
    if set(chart.section.axes) & set(angles):
        return 3.6
    return float(np.clip(3.6 * np.ptp(chart.first) / np.ptp(chart.second), 1.8, 6.0))


def bound_label(outcome: MapOutcome) -> str:
    """The label of the red line."""
    request = outcome.request
    if request.bound is None:
        return "region in reach"
    return f"{request.index.name} {Bound(request.bound, request.index.sense)}, sampled"


def draw_contours(figure: Figure, axes: Axes, chart: Map, name: str, scale: Array, bound: float | None) -> None:
    """Draw filled, labelled contours of a map inside the region. Their steps are fine where the bound is kept."""
    first, second, values = scale[0] * chart.first, scale[1] * chart.second, np.ma.masked_invalid(chart.values)
    levels = _levels(chart, bound)
    filled = axes.contourf(first, second, values, levels=levels, cmap="viridis", extend="both")
    lines = axes.contour(first, second, values, levels=levels, colors="k", linewidths=0.3, alpha=0.6)
    axes.clabel(lines, levels[::2], fontsize=6, inline_spacing=2)
    if np.isfinite(chart.inset).all():
        edge = Path.make_compound_path(*(Path(scale * ring) for ring in boundary(chart, None)))
        for artist in (filled, lines):
            artist.set_clip_path(edge, axes.transData)
        for text in lines.labelTexts:
            text.set_visible(edge.contains_point(text.get_position()))
    figure.colorbar(filled, ax=axes, label=name).ax.ticklabel_format(useOffset=False)
    axes.grid(False)


def _levels(chart: Map, bound: float | None) -> Array:
    """Round contour levels over the part that keeps the bound, and over as wide a span on the bound's other side."""
    values = chart.values[(chart.inset >= 0.0) & np.isfinite(chart.values)]
    if not values.size:
        return np.array([0.0, 1.0])
    low, high = float(values.min()), float(values.max())
    if bound is not None and low < bound < high:
        if chart.sense > 0:
            low = max(low, 2 * bound - high)
        else:
            high = min(high, 2 * bound - low)
    size = max(abs(low), abs(high)) or 1.0
    if high - low < _SAME * size:  # one number everywhere
        low, high = low - _AROUND * size, high + _AROUND * size
    return np.asarray(MaxNLocator(_LEVELS).tick_values(low, high))


def draw_boundary(axes: Axes, rings: Sequence[Array], scale: Array, label: str, colour: str = BOUND) -> Line2D:
    """Draw closed lines; returns the handle for a legend."""
    for ring in rings:
        axes.plot(*(scale * ring).T, color=colour, linewidth=1.6, clip_on=False)
    return Line2D([], [], color=colour, linewidth=1.6, label=label)


def label_axes(axes: Axes, names: Sequence[str], angles: Sequence[str]) -> None:
    """Label both axes with name and unit. Two lengths get the same scale."""
    first, second = (f"{name} [{'deg' if name in angles else 'm'}]" for name in names)
    axes.set(xlabel=first, ylabel=second)
    axes.locator_params(axis="x", nbins=5)
    if not set(names) & set(angles):
        axes.set_aspect("equal")


def draw_cells(axes: Axes, cells: Array, scale: Array, label: str) -> Patch:
    """Draw proved cells (k, 2, 2), hatched; returns the handle for a legend."""
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    polygons = [scale * np.take_along_axis(cell, corners, axis=0) for cell in cells]
    axes.add_collection(PolyCollection(polygons, **PROVED))
    return Patch(**PROVED, label=label)


def _draw_certified(axes: Axes, outcome: MapOutcome, scale: Array) -> list[Patch | Line2D]:
    proof, plane = outcome.certified, outcome.request.section.axes
    assert proof is not None
    handles: list[Patch | Line2D] = []
    if not isinstance(outcome.request.section.region, Cylinder):
        handles.append(draw_cells(axes, proof.cells(plane), scale, "proved"))
    elif proof.radius > 0.0:
        label = f"proved, radius {proof.radius:.3f} m"
        if set(plane) == {"x", "y"}:
            axes.add_patch(Circle((0, 0), proof.radius, **PROVED))
        for k, name in enumerate(plane):
            if name in ("x", "y") and len(set(plane) & {"x", "y"}) == 1:
                (axes.axvspan, axes.axhspan)[k](-proof.radius, proof.radius, **PROVED)
        handles.append(Patch(**PROVED, label=label))
    if len(proof.left):
        columns = [outcome.request.robot.pose_names.index(name) for name in plane]
        corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
        open_boxes = [scale * np.take_along_axis(box[:, columns], corners, axis=0) for box in proof.left]
        axes.add_collection(PolyCollection(open_boxes, facecolors="none", edgecolors=OPEN, linewidths=0.8))
        handles.append(Patch(facecolor="none", edgecolor=OPEN, label="undecided boxes"))
    return handles


def _title(outcome: MapOutcome) -> str:
    """The title: what is mapped, where, and the figures."""
    request, figures = outcome.request, outcome.found.figures
    section, angles = request.section, angles_of(request.robot)
    shown = []
    for name, values in section.at.items():
        factor, unit = (180.0 / np.pi, " deg") if name in angles else (1.0, " m")
        shown.append(f"{name} = {', '.join(f'{factor * v:g}' for v in values)}{unit}")
    worst = section.rest(request.robot.pose_names)
    if worst:
        shown.append(f"worst over {', '.join(worst)}")
    first = f"{type(request.robot).__name__}, {request.index.words}" + (f": {'; '.join(shown)}" if shown else "")
    if figures.area == 0.0:
        return f"{first}\n{outcome.none_seen}"
    second = f"area {figures.area:.4g} {outcome.area_unit}, mean {figures.mean:.4g}, deviation {figures.deviation:.3g}"
    return f"{first}\n{second}"
