"""What the command line prints of proofs: each claim as proved, refuted or undecided; and of checks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from studies.cli.console import files_data, print_files, print_json, print_table
from studies.report import PROOFS, proof_rows
from studies.results import Written
from studies.stages import Proof, Question, Row


def print_proofs(question: Question, proofs: Sequence[Proof], written: Written, as_json: bool) -> None:
    """Print each claim and its answer."""
    if as_json:
        print_json(
            {
                "study": question.study.name,
                "geometry_hash": question.robot.geometry.digest,
                "region": repr(question.region),
                "proofs": [proof_data(proof) for proof in proofs],
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


def proof_data(proof: Proof) -> dict[str, Any]:
    """A claim and its answer, as plain data."""
    found = proof.certificate
    return {
        "margin": found.margin,
        found.bound.word: found.bound.value,
        "status": found.status,
        "boxes": found.boxes,
        "seconds": proof.seconds,
        "sampled": proof.sampled,
        "gap": proof.gap,
        "counterexample": None if found.counterexample is None else found.counterexample.tolist(),
        "part": proof.part,
        "within_reach": found.within_reach,
        "boxes_left": len(found.left),
    }
