"""What `linkwright map` prints."""

from __future__ import annotations

import math

from studies.cli.console import files_data, print_files, print_json, print_table
from studies.report import bound_label
from studies.results import Written
from studies.stages import MapOutcome, shown_pose


def print_map(outcome: MapOutcome, written: Written, as_json: bool) -> None:
    """Print the figures, how much the last refinement changed them, what is proved, and the files written."""
    figures, unit = outcome.figures(), outcome.area_unit
    if as_json:
        rings = [ring.tolist() for ring in outcome.found.boundary]
        print_json({**outcome.header(), **figures, "boundary": rings, **files_data(written)})
        return
    request, moved, worst = outcome.request, figures["moved"], figures["worst"]
    rows = [
        (f"area [{unit}]", f"{figures['area']:.6g}", f"{moved['area']:.2g}", ""),
        ("mean over it", _number(figures["mean"], 6), _number(moved["mean"], 2), ""),
        ("standard deviation over it", _number(figures["deviation"], 6), _number(moved["deviation"], 2), ""),
        (
            "worst in the plane",
            f"{worst:.6g}" if math.isfinite(worst) else "out of reach or singular",
            "",
            shown_pose(outcome.found.map.worst[1], outcome.worst_part),
        ),
    ]
    if figures["area"] == 0.0:
        rows.insert(0, ("seen", outcome.none_seen, "", ""))
    if outcome.still_moves:
        rows.insert(0, ("not settled", outcome.still_moves, "", ""))
    rest = request.section.rest(request.robot.pose_names)
    title = f"{bound_label(outcome)}; {request.section}" + (f"; worst over {', '.join(rest)}" if rest else "")
    print_table(title, ("figure", "value", "last change", "at pose"), rows)
    if (proof := outcome.certified) is not None:
        proved = []
        if outcome.certified_area is not None:
            share = outcome.certified_area / figures["area"] if figures["area"] else 0.0
            proved.append((f"area [{unit}]", f"{outcome.certified_area:.6g}, {100 * share:.1f} % of the sampled"))
        if proof.radius:
            proved.append(("radius [m]", f"{proof.radius:.6g}"))
        proved += [
            ("certificates", str(len(proof.certificates))),
            ("boxes", str(proof.boxes)),
            ("undecided boxes", str(len(proof.left))),
            *([] if proof.complete else [("not complete", "the time was used up")]),
            ("time [s]", f"{proof.seconds:.1f}"),
        ]
        print_table(f"Proved: {proof.margin} {proof.bound}", ("figure", "value"), proved)
    print_files(written)


def _number(value: float, digits: int) -> str:
    """A number as text; "none" for NaN, the mean over an empty area."""
    return "none" if math.isnan(value) else f"{value:.{digits}g}"
