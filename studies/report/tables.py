"""Rows that the command line and the report both show."""

from __future__ import annotations

from collections.abc import Sequence

from studies.stages import Outcome, Proof, shown_pose

PROOFS = ("claim at every pose", "answer", "boxes", "time [s]", "lowest sampled", "sampled - bound", "at pose")


def margin_columns(outcome: Outcome) -> tuple[str, ...]:
    """The headings of `margin_rows`."""
    return "margin", "wanted", f"worst value, {outcome.before}", "worst value, result", "at pose"


def margin_rows(outcome: Outcome) -> list[tuple[str, ...]]:
    """The worst value of each margin, in the columns `margin_columns`."""
    wanted = {r.margin: f">= {r.at_least:g}" for r in outcome.problem.requirements}
    if outcome.study.optimise:
        wanted.setdefault(outcome.problem.objective, "as large as possible")
    return [
        (
            margin,
            wanted.get(margin, ""),
            f"{outcome.prototype[margin].value:.6f}" if outcome.prototype else "",
            f"{worst.value:.6f}",
            shown_pose(worst.pose, outcome.part(margin)),
        )
        for margin, worst in outcome.worst.items()
    ]


def proof_rows(proofs: Sequence[Proof]) -> list[tuple[str, ...]]:
    """The answer to each claim, in the columns `PROOFS`, with a pose that refutes it or one in an undecided box."""
    return [
        (
            proof.claim,
            proof.certificate.status,
            str(proof.certificate.boxes),
            f"{proof.seconds:.2f}",
            f"{proof.sampled:.6f}",
            f"{proof.gap:.3g}",
            _where(proof),
        )
        for proof in proofs
    ]


def _where(proof: Proof) -> str:
    certificate = proof.certificate
    if certificate.counterexample is not None:
        pose = shown_pose(certificate.counterexample, proof.part)
        return pose if certificate.within_reach else f"out of reach: {pose}"
    if len(certificate.left):
        return f"{len(certificate.left)} undecided boxes, one around {shown_pose(certificate.left[0].mean(axis=0))}"
    return ""
