"""What certificates cost; `python -m tests.bench.certificates` writes the tables of docs/certificates.md."""

from __future__ import annotations

import math
import os
import time
from pathlib import Path

from design import Box, Cylinder, Region, certify, replay, worst_poses
from kinematics import GoughStewart, Heli4, Mechanism, Peppermill, Redundant3T1R

PAGE = Path(__file__).parents[2] / "docs" / "certificates.md"
START, END = "<!-- written by `python -m tests.bench.certificates` -->", "<!-- /certificates -->"
CYLINDER = Cylinder(radius=0.5, z=(-0.8, -0.6), theta=(-math.pi, math.pi))
HALF_TURN = Box(x=0.0, y=(-0.3, 0.3), z=(-0.3, 0.3), theta=(-math.pi / 2, math.pi / 2))
TILTED = dict.fromkeys(("roll", "pitch", "yaw"), (-0.2, 0.2))
HEXAPOD = Box(x=(-0.1, 0.1), y=(-0.1, 0.1), z=(0.5, 0.7), **TILTED)
MILL = Box(x=(-0.2, 0.2), y=(-0.2, 0.2), z=(-0.05, 0.05), theta=(-2 * math.pi, 2 * math.pi))
CASES: list[tuple[Mechanism, Region, str, float]] = [
    (Heli4(), CYLINDER, "internal_determinant", 0.45),
    (Heli4(), CYLINDER, "det_J_x", 0.45),
    (Heli4(), CYLINDER, "J_q", 0.4),
    (Heli4(), CYLINDER, "fvi", 0.5),
    (Redundant3T1R(), HALF_TURN, "fvi", 1.0),
    (GoughStewart(), HEXAPOD, "det_J_x", 1e-6),
    (Peppermill(), MILL, "det_J_x", 1e-6),
    (Peppermill(), MILL, "J_q", 1e-6),
    (Heli4(), CYLINDER, "joint_travel", 0.16),
    (Heli4(), CYLINDER, "passive_joint", 0.32),
    (Redundant3T1R(), HALF_TURN, "clearance", 0.062),
    (GoughStewart(), HEXAPOD, "joint_travel", 0.04),
    (GoughStewart(), HEXAPOD, "passive_joint", 0.19),
    (Peppermill(), MILL, "joint_travel", 0.095),
    (Peppermill(), MILL, "passive_joint", 0.155),
]
GROWTH = [CASES[0], CASES[4]]
GAPS = (0.1, 0.03, 0.01, 0.003, 0.001)


def main() -> None:
    """Both tables, into the page."""
    lines = [f"One run on {os.cpu_count()} cores, the search for a counterexample included.", ""]
    lines += [
        "| robot | region | claim | answer | boxes | proof [s] | replay [s] |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    for robot, region, margin, bound in CASES:
        started = time.perf_counter()
        found = certify(robot, region, margin, at_least=bound)
        proved = time.perf_counter()
        replay(found, robot)
        cells = (type(robot).__name__, f"`{region}`", f"{margin} >= {bound:g}", found.status, f"{found.boxes}")
        lines.append(f"| {' | '.join(cells)} | {proved - started:.2f} | {time.perf_counter() - proved:.2f} |")
    heads = " | ".join(f"gap {gap:g}" for gap in GAPS)
    lines += [
        "",
        "Boxes as the bound comes closer to the lowest value that a dense search finds, by their relative gap:",
        "",
    ]
    lines += [f"| claim | lowest found | {heads} |", "| --- " * (2 + len(GAPS)) + "|"]
    for robot, region, margin, _ in GROWTH:
        worst = worst_poses(robot, region, margin).value
        boxes = [certify(robot, region, margin, at_least=worst * (1 - gap)).boxes for gap in GAPS]
        lines.append(f"| {type(robot).__name__}, {margin} | {worst:.6f} | {' | '.join(map(str, boxes))} |")
    before, rest = PAGE.read_text().split(START)
    PAGE.write_text(f"{before}{START}\n" + "\n".join(lines) + f"\n{END}{rest.split(END)[1]}")


if __name__ == "__main__":
    main()
