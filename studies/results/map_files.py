"""The files of a map: the picture, the numbers node by node, and the boundary."""

from __future__ import annotations

import json
from collections.abc import Sequence

import numpy as np

from kinematics import Array
from studies.report import map_picture
from studies.results.output_folder import OutputFolder, Written
from studies.results.outputs import made_for
from studies.stages import MapOutcome, MapRequest, unit_of
from studies.study_file import Study


def map_names(request: MapRequest) -> tuple[str, str, str]:
    """The names of the files with the picture, the nodes and the boundary."""
    stem = _stem(request)
    return f"{stem}.png", f"{stem}.csv", f"{stem}_boundary.csv"


def write_map(outcome: MapOutcome, study: Study, folder: OutputFolder) -> Written:
    """Write picture, nodes and boundary: all of them or none.

    Raises:
        CannotWrite, FileInTheWay: as `OutputFolder.write`.
    """
    contents: tuple[str | bytes, ...] = map_picture(outcome), nodes_text(outcome), boundary_text(outcome)
    files = dict(zip(map_names(outcome.request), contents, strict=True))
    return folder.write({_stem(outcome.request): files}, made_for(study, outcome.request.robot))


def _stem(request: MapRequest) -> str:
    return "_".join(["map", request.index.name, *request.section.axes])


def nodes_text(outcome: MapOutcome) -> str:
    """One row for each node: its place, the worst value, and the pose with it. An empty value is out of reach."""
    r, chart = outcome.request, outcome.found.map
    first, second = np.meshgrid(chart.first, chart.second)
    columns = [f"{name} [{unit_of(r, name)}]" for name in r.section.axes]
    columns += [r.index.name, "inside region", *(f"worst {n} [{unit_of(r, n)}]" for n in r.robot.pose_names)]
    inside = (chart.inset >= 0.0).astype(float)
    table = np.column_stack(
        [part.ravel() for part in (first, second, chart.values, inside)] + [chart.poses.reshape(first.size, -1)]
    )
    return _csv(outcome, columns, table)


def boundary_text(outcome: MapOutcome) -> str:
    """One row for each point of the closed lines around the level set, with the line's number."""
    columns = ["line", *(f"{name} [{unit_of(outcome.request, name)}]" for name in outcome.request.section.axes)]
    lines = [np.column_stack([np.full(len(line), k), line]) for k, line in enumerate(outcome.found.boundary)]
    return _csv(outcome, columns, np.concatenate([np.empty((0, 3)), *lines]))


def _csv(outcome: MapOutcome, columns: Sequence[str], table: Array) -> str:
    """Header lines that state how the table was made, then the table."""
    head = [f"# {key}: {json.dumps(value)}" for key, value in outcome.header().items()]
    rows = [",".join("" if np.isnan(v) else f"{v:.9g}" for v in row) for row in table]
    return "\n".join([*head, ",".join(columns), *rows]) + "\n"
