"""Rows that the command line and the report both show."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from studies.stages import Outcome, Proof, Timing, shown_pose
from trajectory import FRAME_UNITS

FRAME = ("on the frame", "peak", "at [s]", "RMS", "peak along x", "along y", "along z")
MEMBERS = (
    "",
    "member",
    "largest tension [N]",
    "at [s]",
    "largest compression [N]",
    "at [s]",
    "bending [N m]",
    "torsion [N m]",
    "joint force [N]",
    "safety factor",
    "smallest at [s]",
    "fails first by",
)
LOADS = (
    "member",
    "largest tension [N]",
    "largest compression [N]",
    "bending [N m]",
    "torsion [N m]",
    "joint force [N]",
)
_ROUNDING = 1e-12  # of the largest number beside it
_HUGE = 1e6  # a larger number, such as the factor of a member that bears nothing, says nothing about rounding
PROOFS = ("claim at every pose", "answer", "boxes", "time [s]", "worst sampled", "room to the bound", "at pose")


def margin_columns(outcome: Outcome) -> tuple[str, ...]:
    """The headings of `margin_rows`."""
    return "margin", "wanted", f"worst value, {outcome.before}", "worst value, result", "at pose"


def margin_rows(outcome: Outcome) -> list[tuple[str, ...]]:
    """The worst value of each margin, in the columns `margin_columns`."""
    wanted = {r.margin: str(r.bound) for r in outcome.problem.requirements}
    if outcome.study.optimise:
        size = "large" if outcome.problem.good(1.0) > 0.0 else "small"
        wanted.setdefault(outcome.problem.objective, f"as {size} as possible")
    before = (outcome.prototype or {}) | (outcome.unasked_before or {})
    units = {name: f" [{margin.unit}]" if margin.unit else "" for name, margin in outcome.robot.margins.items()}
    return [
        (
            margin + units[margin],
            wanted.get(margin, ""),
            _figure(before[margin].value) if margin in before else "",
            _figure(worst.value),
            shown_pose(worst.pose, outcome.part(margin)),
        )
        for margin, worst in (outcome.worst | outcome.unasked).items()
    ]


def _figure(value: float) -> str:
    return f"{value:.6f}" if 1e-3 <= abs(value) < 1e4 or not value else f"{value:.6g}"


def load_rows(outcome: Outcome) -> list[tuple[str, ...]]:
    """What each member bears at most over the region, from rest, in the columns `LOADS`."""
    if (loads := outcome.loads) is None or not loads.names:
        return []
    numbers = _shown(np.stack(loads[1:], axis=-1).tolist())
    return [(name, *row) for name, row in zip(loads.names, numbers, strict=True)]


def loads_title(outcome: Outcome) -> str:
    """What the loads of the members are for."""
    load = outcome.robot.load
    return (
        f"Members over the region, {load.payload:g} kg from rest at {load.acceleration:g} m/s^2 in the worst direction"
    )


def frame_rows(timing: Timing) -> list[tuple[str, ...]]:
    """What the machine exerts on its frame over the cycle, in the columns `FRAME`."""
    return [
        (
            f"{name} [{FRAME_UNITS[name]}]",
            *(f"{v:.6g}" for v in (p.peak, p.time, p.rms)),
            *(f"{v if abs(v) > _ROUNDING * p.peak else 0.0:.6g}" for v in p.axes),
        )
        for name, p in timing.frame.items()
    ]


def member_rows(timing: Timing) -> list[tuple[str, ...]]:
    """What each member bears over the cycle, in the columns `MEMBERS`, the nearest to its limit first."""
    peaks = sorted(timing.members, key=lambda peak: peak.safety)
    return [
        ("BREAKS" if peak.breaks else "", peak.member, *row, peak.fails_by)
        for peak, row in zip(peaks, _shown([peak.numbers() for peak in peaks]), strict=True)
    ]


def _shown(rows: Sequence[Sequence[float]]) -> list[list[str]]:
    """Four digits of each number, and 0 for what is only rounding beside the largest of its column."""
    largest = [_ROUNDING * min(max(map(abs, column)), _HUGE) for column in zip(*rows, strict=True)]
    return [[f"{v if abs(v) > least else 0.0:.4g}" for v, least in zip(row, largest, strict=True)] for row in rows]


def proof_rows(proofs: Sequence[Proof]) -> list[tuple[str, ...]]:
    """The answer to each claim, in the columns `PROOFS`, with a pose that refutes it or one in an undecided box."""
    return [
        (
            proof.claim,
            proof.certificate.status,
            str(proof.certificate.boxes),
            f"{proof.seconds:.2f}",
            f"{proof.sampled:.6g}",
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
