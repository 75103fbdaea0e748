"""Errors of a synthesis."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematics import LinkwrightError

if TYPE_CHECKING:
    from design.synthesis.exchange import Candidate


class SynthesisFailed(LinkwrightError):
    """The optimisation has no answer. `best` is the best geometry that was seen, which is not an optimum, or None."""

    exit_status = 1

    def __init__(self, reason: str, status: str, best: Candidate | None = None) -> None:
        self.reason, self.status, self.best = reason, status, best
        seen = f"\n  the best geometry found: {best}" if best is not None else ""
        super().__init__(f"no optimum: {reason} (solver status: {status}){seen}")


class ImpossibleSum(SynthesisFailed):
    """A sum, by its place in the problem, is too large even with every variable at its lower bound."""

    exit_status = 2

    def __init__(self, number: int, reason: str) -> None:
        self.number = number
        super().__init__(reason, "not started")
