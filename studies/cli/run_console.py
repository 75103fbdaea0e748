"""What the command line prints of a run and of a cycle."""

from __future__ import annotations

from typing import Any

from studies.cli.console import files_data, print_files, print_json, print_table
from studies.cli.proof_console import proof_data
from studies.report import (
    FRAME,
    LOADS,
    MEMBERS,
    PROOFS,
    frame_rows,
    load_rows,
    loads_title,
    margin_columns,
    margin_rows,
    member_rows,
    proof_rows,
)
from studies.results import Written
from studies.stages import Outcome, Timing, became_worse
from trajectory.drive_files import FORMATS


def print_outcome(outcome: Outcome, written: Written, as_json: bool) -> None:
    """Print the margins, the geometry, the cycle and the files written."""
    if as_json:
        print_json(_outcome_data(outcome, written))
        return
    sampled = next(iter(outcome.worst.values())).sampled
    print_table(f"Worst over the region ({sampled} poses and descents)", margin_columns(outcome), margin_rows(outcome))
    if worse := became_worse(outcome):
        print_table(
            f"Worse than the {outcome.before}, and not asked about", ("",), [(str(change),) for change in worse]
        )
    if rows := load_rows(outcome):
        print_table(loads_title(outcome), LOADS, rows)
    if outcome.proofs:
        print_table("Proofs over the region", PROOFS, proof_rows(outcome.proofs))
    changed = outcome.problem.robot.geometry.as_dict()
    geometry = [
        (name, str(changed[name]), str(value))
        for name, value in outcome.robot.geometry.as_dict().items()
        if value != changed[name]
    ]
    if geometry:
        print_table("Geometry", ("field", outcome.before, "result"), geometry)
    if outcome.active:
        print_table("The optimum is limited by", ("active constraint",), [(item,) for item in outcome.active])
    if outcome.timing:
        print_timing(outcome.timing, Written(), False, (outcome.before, outcome.prototype_timing))
    print_files(written)


def print_timing(
    timing: Timing, written: Written, as_json: bool, before: tuple[str, Timing | None] = ("", None)
) -> None:
    """Print the cycle's figures and peaks, and beside them those of a second, named geometry if there is one."""
    robot, figures = timing.cycle.robot, timing.figures()
    if as_json:
        made_for = {"mechanism": type(robot).__name__, "geometry_hash": robot.geometry.digest}
        between = timing.setpoints.header["between set-points"]
        print_json(
            {
                **made_for,
                **figures,
                **timing.loads(),
                "lower_bound_of": "any motion on the cycle's own path, without a jerk limit",
                "proved_on_the_path": timing.cycle.certificate.margins,
                "proved_over_limit": timing.cycle.proved,
                "between_setpoints": between,
                "seconds": timing.seconds,
                **files_data(written),
            }
        )
        return
    names = [name for name in figures if name != "peak_over_limit"]
    title = f"Cycle of {type(robot).__name__}, geometry {robot.geometry.digest[:12]}"
    label, timing_before = before
    if timing_before:
        known = timing_before.figures()
        rows = [(name, _figure(known[name]), _figure(figures[name])) for name in names]
        print_table(title, ("figure", label, "result"), rows)
    else:
        print_table(title, ("figure", "value"), [(name, _figure(figures[name])) for name in names])
    proved = timing.cycle.certificate
    print_table(
        f"Proved at every pose of the path, with {proved.intervals} intervals",
        ("margin", "at least"),
        proved.rows(),
    )
    for k, piece in enumerate(timing.cycle.there, start=1):
        which = f", piece {k}" if len(timing.cycle.there) > 1 else ""
        print_table(
            f"Way there{which}, checked between the gridpoints too",
            ("quantity", "peak", "limit", "peak over limit", "proved at most", "joint", "at [s]"),
            piece.timed.verification.rows(),
        )
    if timing.members:
        print_table("Members over the whole cycle, the nearest to its limit first", MEMBERS, member_rows(timing))
    print_table("Reaction on the frame over the whole cycle", FRAME, frame_rows(timing))
    _print_between(timing)
    print_files(written)


def _print_between(timing: Timing) -> None:
    """Print the errors that a drive's own interpolation adds between set-points."""
    found = timing.setpoints.header["between set-points"]
    names = list(dict.fromkeys(name for measured in found.values() for name in measured))
    users = {way: ", ".join(n for n, f in FORMATS.items() if f.interpolation == way) for way in found}
    rows = [(way, users[way], *(_figure(measured.get(name, "")) for name in names)) for way, measured in found.items()]
    print_table("Between set-points, by the drive's interpolation", ("interpolation", "formats", *names), rows)


def _outcome_data(outcome: Outcome, written: Written) -> dict[str, Any]:
    return {
        "study": outcome.study.name,
        "geometry": outcome.robot.geometry.as_dict(),
        "worst": {
            m: {"value": w.value, "pose": w.pose.tolist(), "part": outcome.part(m)} for m, w in outcome.worst.items()
        },
        "prototype": {m: w.value for m, w in outcome.prototype.items()} if outcome.prototype else None,
        "unasked": {m: {"value": w.value, "pose": w.pose.tolist()} for m, w in outcome.unasked.items()},
        "unasked_before": {m: w.value for m, w in outcome.unasked_before.items()} if outcome.unasked_before else None,
        "loads_from_rest": outcome.loads.as_data() if outcome.loads else [],
        "became_worse": [str(change) for change in became_worse(outcome)],
        "active": outcome.active,
        "region": repr(outcome.region),
        "rounds": [vars(r) for r in outcome.synthesis.rounds] if outcome.synthesis else [],
        "cycle": outcome.cycle_figures() | outcome.timing.loads() if outcome.timing else None,
        "cycle_header": dict(outcome.timing.setpoints.header) if outcome.timing else None,
        "prototype_cycle": outcome.prototype_timing.figures() if outcome.prototype_timing else None,
        "proofs": [proof_data(proof) for proof in outcome.proofs],
        **files_data(written),
    }


def _figure(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
