"""Proofs over geometries; `python -m tests.bench.over_geometries` writes the table of certificates.md."""

from __future__ import annotations

import time
from dataclasses import replace

from design import Bounds, Problem, Region, certify_design, replay_design, synthesise
from studies.building import load_study, problem_of, region_of
from studies.study_file import read_toml, study_path
from tests.bench.page import ROOT, write_between

PAGE = ROOT / "docs" / "certificates.md"
UNBOUNDED = "clearance"  # a requirement that no proof over geometries can use
REDUNDANT = {
    "outer_rail_y": (-0.5, -0.25),
    "middle_rail_y": (-0.6, -0.35),
    "outer_rail_z": (0.2, 0.4),
    "platform_length": (0.08, 0.15),
}
QUESTIONS = (("heli4", 1e-4), ("redundant_3t1r", 5e-3), ("peppermill", 1e-2), ("peppermill", 1.0))
SECONDS = 60.0


def main() -> None:
    """The table, into the page."""
    write_between(PAGE, "over geometries", table(), "python -m tests.bench.over_geometries")


def table() -> str:
    """Markdown."""
    lines = [
        f"Two cores, at most {SECONDS:g} s. Above: how far the target is above the optimum's worst value.",
        "",
        "| without clearance | variables | optimum | target | above | answer | poses | boxes | time [s] | replay |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    lines += [row(name, above) for name, above in QUESTIONS]
    return "\n".join(lines) + "\n"


def row(name: str, above: float) -> str:
    """One question."""
    problem, region = question(name)
    best = synthesise(problem, region)
    worst = best.after[problem.objective].value
    target, begun = worst * (1.0 + above), time.perf_counter()
    found = certify_design(problem, region, at_most=target, best=best.robot, seconds=SECONDS)
    taken, again = time.perf_counter() - begun, ""
    if found.status == "proved":
        begun = time.perf_counter()
        replay_design(found, problem)
        again = f"{time.perf_counter() - begun:.1f}"
    count = int(problem.moving().sum())
    return (
        f"| {name} | {count} | {worst:.6f} | {target:.6f} | {100 * above:g} % | {found.status} | {len(found.poses)} | "
        f"{found.boxes:,} | {taken:.1f} | {again} |"
    )


def question(name: str) -> tuple[Problem, Region]:
    """A study's problem without the requirement that cannot be used; the redundant robot's with variables."""
    study = load_study(read_toml(study_path(name)))
    problem = problem_of(study)
    variables = problem.variables
    if name == "redundant_3t1r":
        variables = tuple(Bounds(field, 0, low, high) for field, (low, high) in REDUNDANT.items())
    kept = tuple(r for r in problem.requirements if r.margin not in (UNBOUNDED, problem.objective))
    return replace(problem, variables=variables, requirements=kept), region_of(study)


if __name__ == "__main__":
    main()
