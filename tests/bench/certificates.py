"""What certificates cost; `python -m tests.bench.certificates` writes its tables into README.md and docs."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

from design import Box, Certificate, Cylinder, Region, certificate_bytes, certify, replay, worst_poses
from kinematics import GoughStewart, Heli4, Mechanism, Peppermill, Redundant3T1R
from tests.bench.page import ROOT, write_between

CYLINDER = Cylinder(radius=0.5, z=(-0.8, -0.6), theta=(-math.pi, math.pi))
NARROW = Box(x=0.0, y=(-0.2, 0.2), z=(-0.2, 0.2), theta=(-math.pi / 2, math.pi / 2))
HALF_TURN = Box(x=0.0, y=(-0.3, 0.3), z=(-0.3, 0.3), theta=(-math.pi / 2, math.pi / 2))
TILTED = dict.fromkeys(("roll", "pitch", "yaw"), (-0.2, 0.2))
HEXAPOD = Box(x=(-0.1, 0.1), y=(-0.1, 0.1), z=(0.5, 0.7), **TILTED)
MILL = Box(x=(-0.2, 0.2), y=(-0.2, 0.2), z=(-0.05, 0.05), theta=(-2 * math.pi, 2 * math.pi))
IN_WORDS = {
    CYLINDER: "cylinder of 0.5 m radius, 0.2 m high, a full turn",
    NARROW: "±0.2 m in y and z, ±90°",
    HALF_TURN: "±0.3 m in y and z, ±90°",
    HEXAPOD: "±0.1 m and ±0.2 rad in all six",
    MILL: "±0.2 m, ±0.2 m, ±0.05 m, a full turn either way",
}
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
    (Redundant3T1R(), NARROW, "clearance", 0.0268),
    (Heli4(), CYLINDER, "clearance", 0.00295),
    (GoughStewart(), HEXAPOD, "joint_travel", 0.04),
    (GoughStewart(), HEXAPOD, "passive_joint", 0.19),
    (Peppermill(), MILL, "joint_travel", 0.095),
    (Peppermill(), MILL, "passive_joint", 0.155),
]
GROWTH = [CASES[0], CASES[4]]
GAPS = (0.1, 0.03, 0.01, 0.003, 0.001)
RUNS = 3
Answer = TypeVar("Answer")


@dataclass(frozen=True)
class Cost:
    """One claim's certificate, and the shortest of several runs of its search and of its replay [s]."""

    certificate: Certificate
    search: float
    replay: float
    replayed: int

    def row(self) -> str:
        """As Markdown, under `COLUMNS`."""
        found = self.certificate
        claim = f"{found.margin} {found.bound}"
        size = f"{len(certificate_bytes(found)) / 1e3:.1f}"
        cells = [found.mechanism, IN_WORDS[found.region], claim, found.status, f"{found.boxes:,}", f"{self.search:.2f}"]
        return f"| {' | '.join([*cells, f'{self.replayed:,}', f'{self.replay:.2f}', size])} |\n"


COLUMNS = "| robot | region | claim | answer | boxes | proof [s] | boxes replayed | replay [s] | file [kB] |\n"
HEAD = COLUMNS + "| --- " * (COLUMNS.count("|") - 1) + "|\n"


def main() -> None:
    """The costs into both pages, and how they grow into the longer one."""
    about = (
        f"Shortest of {RUNS} runs on {os.cpu_count()} cores at a load average of {os.getloadavg()[0]:.1f} before them, "
    )
    about += "the search for a counterexample included.\n\n"
    costs = "".join(_cost(*case).row() for case in CASES)
    write_between(ROOT / "README.md", "certificates", about + HEAD + costs)
    write_between(ROOT / "docs" / "certificates.md", "certificates", about + HEAD + costs + "\n" + _growth())


def _cost(robot: Mechanism, region: Region, margin: str, bound: float) -> Cost:
    certificate, search = _shortest(lambda: certify(robot, region, margin, at_least=bound))
    replayed, seconds = _shortest(lambda: replay(certificate, robot))
    return Cost(certificate, search, seconds, replayed)


def _shortest(job: Callable[[], Answer]) -> tuple[Answer, float]:
    times = []
    for _ in range(RUNS):
        started = time.perf_counter()
        answer = job()
        times.append(time.perf_counter() - started)
    return answer, min(times)


def _growth() -> str:
    lines = [
        "Boxes as the bound comes closer to the lowest value that a dense search finds, by their relative gap:",
        "",
    ]
    lines.append(f"| claim | lowest found | {' | '.join(f'gap {gap:g}' for gap in GAPS)} |")
    lines.append("| --- " * (2 + len(GAPS)) + "|")
    for robot, region, margin, _ in GROWTH:
        worst = worst_poses(robot, region, margin).value
        boxes = [certify(robot, region, margin, at_least=worst * (1 - gap)).boxes for gap in GAPS]
        cells = [f"{type(robot).__name__}, {margin}", f"{worst:.6f}", *(f"{count:,}" for count in boxes)]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
