"""Proofs of strength over the main studies' regions; `python -m tests.bench.strength` writes strength.md's table."""

from __future__ import annotations

import time

from design import certify, worst_poses
from studies.building import load_study, region_of, robot_of
from studies.study_file import read_toml, study_path
from tests.bench.page import ROOT, write_between

PAGE = ROOT / "docs" / "strength.md"
STUDIES = ("peppermill", "redundant_3t1r", "gough_stewart", "heli4")
SECONDS, SHARE = 30.0, 0.3


def main() -> None:
    """The table, into the page."""
    write_between(PAGE, "proofs", table(), "python -m tests.bench.strength")


def table() -> str:
    """Markdown."""
    lines = [
        f"With the prototypes, on two cores, {SECONDS:g} s each; the bound is {SHARE:g} of the lowest value sampled.",
        "",
        "| study | lowest sampled | bound | answer | boxes | time [s] |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    for name in STUDIES:
        study = load_study(read_toml(study_path(name)))
        robot, region = robot_of(study), region_of(study)
        lowest = worst_poses(robot, region, "strength", about=100_000).value
        begun = time.perf_counter()
        found = certify(robot, region, "strength", at_least=SHARE * lowest, seconds=SECONDS)
        lines.append(
            f"| {name} | {lowest:.3f} | {SHARE * lowest:.3f} | {found.status} | {found.boxes:,} | "
            f"{time.perf_counter() - begun:.1f} |"
        )
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
