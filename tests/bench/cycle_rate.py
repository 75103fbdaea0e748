"""Can Heli4 do three cycles a second and keep its drives cool? `python -m tests.bench.cycle_rate` writes the answer.

The standard cycle with a half turn and 1 kg, on the prototype and on the committed optimum of the study heli4: tool
acceleration at most 165 m/s^2, RMS torque at most 60 % of the peak; then with either limit left out.
"""

from __future__ import annotations

import tomllib
from dataclasses import replace
from itertools import product
from pathlib import Path

from kinematics import Heli4, Mechanism
from trajectory import AdeptCycle, Cycle, Limits, cycle_setpoints, jerk_limited, there_and_back

ROOT = Path(__file__).parents[2]
WANTED = 3.0  # cycles a second
PEAK = 127.0
ASKED = Limits(speed=20.0, torque=PEAK, jerk=1e5, tool_acceleration=165.0, rms_torque=0.6 * PEAK)
CASES = {
    "both": ASKED,
    "without the RMS limit": replace(ASKED, rms_torque=None),
    "without the tool cap": replace(ASKED, tool_acceleration=None),
    "without both": replace(ASKED, rms_torque=None, tool_acceleration=None),
}


def main() -> None:
    """Compute, print and write docs/cycle_rate.md."""
    rows, notes = list[str](), list[str]()
    for name, robot in robots().items():
        cycles = {what: there_and_back(robot, AdeptCycle(), c, 1.0, jerk_limited) for what, c in CASES.items()}
        rows += [row(name, what, cycle) for what, cycle in cycles.items()]
        notes += slower_though_freer(name, cycles)
    text = "\n".join([HEADER, *rows, *(["", *notes] if notes else [])]) + "\n"
    (ROOT / "docs" / "cycle_rate.md").write_text(text)
    print(text)


def robots() -> dict[str, Mechanism]:
    """The prototype and the optimum."""
    given = tomllib.loads((ROOT / "studies" / "heli4" / "optimum.toml").read_text())["geometry"]
    fields = {name: tuple(v) if isinstance(v, list) else v for name, v in given.items()}
    return {"prototype": Heli4(), "optimum": Heli4(Heli4.Geometry(**fields))}


def row(name: str, what: str, cycle: Cycle) -> str:
    """One line of the table."""
    bus = float(cycle_setpoints(cycle, 1e-3, cycle.robot.actuator_units).time[-1])
    share = max(float(p.timed.verification.rms_torque.max()) for p in cycle.pieces) / PEAK
    verdict = "yes" if bus <= 1.0 / WANTED else "no"
    return (
        f"| {name} | {what} | {1e3 * cycle.duration / 2:.2f} | {cycle.duration / unrepaired(cycle):.5f} "
        f"| {1 / cycle.duration:.2f} | {1 / bus:.2f} | {verdict} | {share:.0%} | {', '.join(active(cycle))} |"
    )


def unrepaired(cycle: Cycle) -> float:
    """What the laws themselves take, before the repair stretches them [s]."""
    return sum(p.duration / p.timed.factor for p in cycle.pieces)


def slower_though_freer(name: str, cycles: dict[str, Cycle]) -> list[str]:
    """A sentence for each cycle that takes longer than one which keeps all its limits and more."""
    found = []
    for (what, cycle), (other, tighter) in product(cycles.items(), repeat=2):
        freer = all(limit is None or limit == getattr(tighter.limits, f) for f, limit in vars(cycle.limits).items())
        if freer and cycle.duration > tighter.duration:
            by = cycle.duration / tighter.duration - 1
            law = (
                "faster, but stretched by more" if unrepaired(cycle) < unrepaired(tighter) else "another local optimum"
            )
            keeps = "whose motion keeps these limits too"
            found.append(f'- {name}, {what}: {by:.3%} slower than "{other}", {keeps}. The law is {law}.')
    return found


def active(cycle: Cycle) -> list[str]:
    """The limits that are reached, to 0.5 %."""
    peaks = [p.timed.verification.peak_over_limit for p in cycle.pieces]
    return [name for name in peaks[0] if max(p[name] for p in peaks) > 0.995]


HEADER = f"""\
# Three cycles a second?

`python -m tests.bench.cycle_rate` wrote this. The standard cycle (25 / 305 / 25 mm, corners of 24.9 mm, a half turn out
and back) with 1 kg, timed by the jerk-limited law and verified; asked for: {WANTED:g} cycles a second, at most
{ASKED.tool_acceleration:g} m/s^2 at the tool and an RMS torque of at most 60 % of the peak. The drives
({ASKED.speed:g} rad/s, {PEAK:g} N m, {ASKED.jerk:g} rad/s^3) are an assumption of this project. "On the bus" each way
takes whole milliseconds. A limit is active where a motion comes within 0.5 % of it. Where a law exceeds a limit between
its knots, the repair stretches time by a factor.

| Heli4 | limits | half cycle [ms] | repair | cycles/s | on the bus | {WANTED:g} a second | RMS / peak | active |
| --- | --- | --- | --- | --- | --- | --- | --- | --- |"""

if __name__ == "__main__":
    main()
