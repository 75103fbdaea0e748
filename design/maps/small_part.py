"""Find a small part of a plane that a map shows at only a few nodes, or that is between its nodes."""

from __future__ import annotations

import numpy as np

from design.budget import Budget
from design.maps.map_index import Index
from design.maps.sampled_map import Map, Window, map_of, window_of, worst_behind
from design.maps.section import Section
from design.sampling import descend
from kinematics import Array

_CLIMBS = 16  # number of best nodes that a climb starts from
_NODES = 33  # nodes of each smaller map along an axis
_WIDE = 8  # nodes across the part that a refinement needs
_LOOKS = 60  # most smaller maps: each at least halves the window, so the last one reaches the spacing of doubles


def window_of_part(
    index: Index, section: Section, names: tuple[str, ...], chart: Map, bound: float, budget: Budget
) -> Window | None:
    """Bounds of both axes close around the part that keeps the bound: from nodes, or from a climb between nodes.

    None if there is no such part, or none that is narrower than the chart.
    """
    least = index.sense * bound
    window = _around_seen(section, chart, least)
    if window is None:
        top = _climbed(index, section, names, chart)
        if top is None or not _good(index, section, names, top[None])[0] >= least:
            return None
        window = _around_point(index, section, names, chart, top, least, budget)
    narrower = window is not None and _area(window) < 0.5 * (chart.first[-1] - chart.first[0]) * (
        chart.second[-1] - chart.second[0]
    )
    return window if narrower else None


def _around_point(
    index: Index, section: Section, names: tuple[str, ...], chart: Map, top: Array, least: float, budget: Budget
) -> Window | None:
    """Take smaller and smaller windows about a good point (2,), until its part fills enough nodes of one."""
    half = 2.0 * np.array([chart.first[1] - chart.first[0], chart.second[1] - chart.second[0]])
    for _ in range(_LOOKS):
        window = _clipped(section, top - half, top + half)
        if budget.spent or _area(window) == 0.0:
            return None
        look = map_of(index, section, names, (_NODES, _NODES), window=window)
        rows, columns = np.nonzero((look.good >= least) & (look.inset >= 0.0))
        if len(rows) and min(np.ptp(columns), np.ptp(rows)) >= _WIDE:
            return window
        seen = _around_seen(section, look, least)
        reach = np.abs(np.array(seen).T - top).max(axis=0) if seen else half
        half = np.minimum(reach, half / 2.0)
    return None


def _around_seen(section: Section, chart: Map, least: float) -> Window | None:
    """The window of the nodes that keep the bound, with a step and a half around them; None if no node does."""
    rows, columns = np.nonzero((chart.good >= least) & (chart.inset >= 0.0))
    if not len(rows):
        return None
    spare = 1.5 * np.array([chart.first[1] - chart.first[0], chart.second[1] - chart.second[0]])
    seen = np.stack([chart.first[columns], chart.second[rows]])
    return _clipped(section, seen.min(axis=1) - spare, seen.max(axis=1) + spare)


def _clipped(section: Section, low: Array, high: Array) -> Window:
    """Bounds (2,), cut to those of the plane."""
    first, second = (
        (max(float(a), low_), min(float(b), high_))
        for a, b, (low_, high_) in zip(low, high, window_of(section), strict=True)
    )
    return first, second


def _area(window: Window) -> float:
    (a, b), (c, d) = window
    return (b - a) * (d - c)


def _climbed(index: Index, section: Section, names: tuple[str, ...], chart: Map) -> Array | None:
    """(2,) the best point that climbs from the best nodes in the region find; None if none has a value."""
    good = np.where(np.isfinite(chart.values) & (chart.inset >= 0.0), chart.good, -np.inf)
    best = np.argsort(-good, axis=None, kind="stable")[:_CLIMBS]
    best = best[np.isfinite(good.ravel()[best])]
    if not len(best):
        return None
    rows, columns = np.unravel_index(best, good.shape)
    low, high = (np.array([axis[end] for axis in (chart.first, chart.second)]) for end in (0, -1))
    start = (np.stack([chart.first[columns], chart.second[rows]], axis=-1) - low) / (high - low)

    def depth(unit: Array) -> Array:
        return -_good(index, section, names, low + (high - low) * unit)

    unit, depths = descend(depth, start, 1.0 / (np.array(good.shape[::-1]) - 1.0), rounds=60)
    return np.asarray(low + (high - low) * unit[depths.argmin()])


def _good(index: Index, section: Section, names: tuple[str, ...], points: Array) -> Array:
    """(..., 2) -> (...,) the worst goodness of each point's poses; larger is better; -inf outside a curved boundary."""
    flat = points.reshape(-1, 2)
    good, _ = worst_behind(index, section, names, flat)
    return np.where(section.inset(flat) >= 0.0, good, -np.inf).reshape(points.shape[:-1])
