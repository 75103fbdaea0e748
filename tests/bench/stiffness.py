"""The stiffness of each mechanism at home; `python -m tests.bench.stiffness` writes the table of docs/stiffness.md."""

from __future__ import annotations

from kinematics import MECHANISMS
from tests.bench.page import ROOT, write_between

PAGE = ROOT / "docs" / "stiffness.md"
MARGINS = ("stiffness", "rotational_stiffness", "internal_stiffness", "natural_frequency")


def main() -> None:
    """The table, into the page."""
    write_between(PAGE, "home", table(), "python -m tests.bench.stiffness")


def table() -> str:
    """Markdown."""
    heads = ["robot", "each drive [N m/rad or N/m]"] + [f"`{name}`" for name in MARGINS]
    lines = [f"| {' | '.join(heads)} |", "| --- " * len(heads) + "|"]
    for name, mechanism in MECHANISMS.items():
        robot = mechanism()
        found = [f"{float(robot.margin(m, robot.home)):.4g}" if m in robot.margins else "" for m in MARGINS]
        lines.append(f"| {name} | {robot.inertia.drive_train.stiffness:g} | {' | '.join(found)} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
