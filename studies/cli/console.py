"""What the command line prints: tables for people on a terminal or in a pipe, one JSON object for machines."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.markup import escape
from rich.table import Column, Table
from rich.text import Text

from studies.report import PROOFS, margin_columns, margin_rows, proof_rows
from studies.results import Written
from studies.stages import Lasting, Outcome, Proof, Question, Row, Timing
from trajectory.drive_files import FORMATS


@contextmanager
def progress() -> Iterator[Callable[[str], None]]:
    """Show progress on standard error: on a terminal a spinner with the current step, in a pipe the `Lasting` lines.

    On a terminal each step leaves a line. Of steps with the same text before the colon, only the first leaves one.
    """
    console = Console(stderr=True, log_path=False)
    if not console.is_terminal:
        yield lambda step: print(step, file=sys.stderr, flush=True) if isinstance(step, Lasting) else None
        return
    with console.status("starting") as status:
        last, shown = "", set[str]()

        def tell(step: str) -> None:
            nonlocal last
            if isinstance(step, Lasting) and step in shown:
                return
            status.update(escape(step))
            if (head := step.partition(":")[0]) != last:
                console.log(escape(step), highlight=False)
                shown.add(step)
            last = head

        yield tell


def print_json(data: dict[str, Any]) -> None:
    """Print one object on standard output. A number that is not finite becomes null: JSON has no other way."""
    sys.stdout.write(json.dumps(_plain(data), indent=2) + "\n")


def print_table(title: str, columns: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Print a table on standard output. In a pipe it is as wide as its contents."""
    console = Console()
    table = Table(
        *(Column(Text(c)) for c in columns),
        title=Text(title),
        title_justify="left",
        box=None,
        pad_edge=False,
        highlight=False,
    )
    for row in rows:
        table.add_row(*(Text(str(cell)) for cell in row))
    width = None if console.is_terminal else max(console.width, 240)
    Console(width=width).print(table, soft_wrap=not console.is_terminal)
    Console().print()


def print_outcome(outcome: Outcome, written: Written, as_json: bool) -> None:
    """Print the margins, the geometry, the cycle and the files written."""
    if as_json:
        print_json(_outcome_data(outcome, written))
        return
    sampled = next(iter(outcome.worst.values())).sampled
    print_table(f"Worst over the region ({sampled} poses and descents)", margin_columns(outcome), margin_rows(outcome))
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
    _print_between(timing)
    print_files(written)


def _print_between(timing: Timing) -> None:
    """Print the errors that a drive's own interpolation adds between set-points."""
    found = timing.setpoints.header["between set-points"]
    names = list(dict.fromkeys(name for measured in found.values() for name in measured))
    users = {way: ", ".join(n for n, f in FORMATS.items() if f.interpolation == way) for way in found}
    rows = [(way, users[way], *(_figure(measured.get(name, "")) for name in names)) for way, measured in found.items()]
    print_table("Between set-points, by the drive's interpolation", ("interpolation", "formats", *names), rows)


def print_proofs(question: Question, proofs: Sequence[Proof], written: Written, as_json: bool) -> None:
    """Print each claim and its answer."""
    if as_json:
        print_json(
            {
                "study": question.study.name,
                "geometry_hash": question.robot.geometry.digest,
                "region": repr(question.region),
                "proofs": [_proof_data(proof) for proof in proofs],
                **files_data(written),
            }
        )
        return
    print_table(f"{question.study.name}, over {question.region}", PROOFS, proof_rows(proofs))
    print_files(written)


def print_checks(found: dict[str, list[Row]], as_json: bool, verbose: bool) -> None:
    """Print a line for each study, and the claims that fail. With `as_json` or `verbose`, print all claims."""
    if as_json:
        data = {name: [{**vars(row), "holds": row.holds} for row in rows] for name, rows in found.items()}
        holds = all(row.holds for rows in found.values() for row in rows)
        print_json({"holds": holds, "studies": data})
        return
    for name, rows in found.items():
        failed = sum(not row.holds for row in rows)
        verdict = f"all {len(rows)} claims hold" if failed == 0 else f"{failed} of {len(rows)} claims FAIL"
        if not (failed or verbose):
            print(f"{name}: {verdict}")
            continue
        table = [
            ("ok" if row.holds else "FAIL", row.what, row.expected, _unless_same(row), f"{row.margin:.3g}", row.where)
            for row in rows
            if verbose or not row.holds
        ]
        print_table(f"{name}: {verdict}", ("", "claim", "expected", "found", "margin", "at pose"), table)


def _unless_same(row: Row) -> str:
    return "the same" if row.found == row.expected else row.found


def _outcome_data(outcome: Outcome, written: Written) -> dict[str, Any]:
    return {
        "study": outcome.study.name,
        "geometry": outcome.robot.geometry.as_dict(),
        "worst": {m: {"value": w.value, "pose": w.pose.tolist()} for m, w in outcome.worst.items()},
        "prototype": {m: w.value for m, w in outcome.prototype.items()} if outcome.prototype else None,
        "active": outcome.active,
        "region": repr(outcome.region),
        "rounds": [vars(r) for r in outcome.synthesis.rounds] if outcome.synthesis else [],
        "cycle": outcome.cycle_figures() or None,
        "cycle_header": dict(outcome.timing.setpoints.header) if outcome.timing else None,
        "prototype_cycle": outcome.prototype_timing.figures() if outcome.prototype_timing else None,
        "proofs": [_proof_data(proof) for proof in outcome.proofs],
        **files_data(written),
    }


def _proof_data(proof: Proof) -> dict[str, Any]:
    found = proof.certificate
    return {
        "margin": found.margin,
        "at_least": found.at_least,
        "status": found.status,
        "boxes": found.boxes,
        "seconds": proof.seconds,
        "sampled": proof.sampled,
        "gap": proof.gap,
        "counterexample": None if found.counterexample is None else found.counterexample.tolist(),
        "within_reach": found.within_reach,
        "boxes_left": len(found.left),
    }


def _figure(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def print_files(written: Written, as_json: bool = False) -> None:
    """Print which files were written, removed, or kept from an earlier command that answered another question."""
    if as_json:
        print_json(files_data(written))
        return
    for file in written.files:
        print(f"wrote {file}")
    for file in written.removed:
        print(f"removed {file}: it answered another question")
    for file in written.left:
        print(f"kept {file}: an earlier command wrote it for another question")


def files_data(written: Written) -> dict[str, list[Path]]:
    """The same as plain data. Empty lists are left out, except that of the files written."""
    return {name: list(files) for name, files in vars(written).items() if files or name == "files"}


def _plain(value: Any) -> Any:
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    return str(value) if isinstance(value, Path) else value
