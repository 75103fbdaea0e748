"""Our timing laws and other libraries': same path, same limits, same verifier.

`python -m tests.bench.trajectory_peers` writes docs/peers.md and the short table of the README.
"""

from __future__ import annotations

import math
import os
import platform
from functools import partial
from importlib import import_module
from importlib.metadata import version

from tests.bench.page import ROOT, write_between
from tests.bench.timing.cases import Case, others, reference
from tests.bench.timing.measure import LONG, REPEATS, Row, measured
from trajectory import free_motion, jerk_limited, lower_bound, time_optimal

FINE = 400  # intervals; the law's own number is the `jerk` law's first row
OURS = {  # law, and whether it keeps the jerk limit
    "`toppra` law": (time_optimal, False),
    "`jerk` law": (jerk_limited, True),
    f"`jerk` law, {FINE} intervals": (partial(jerk_limited, intervals=FINE), True),
    "`free` law (a path of its own)": (free_motion, True),
}
PEERS = (  # name, module, function, options, keeps the jerk limit
    ("toppra, its defaults", "toppra_peer", "defaults", {}, False),
    ("toppra, ParametrizeConstAccel", "toppra_peer", "constant_acceleration", {}, False),
    ("toppra, ParametrizeConstAccel, N = 2000", "toppra_peer", "constant_acceleration", {"intervals": 2000}, False),
    ("Drake Toppra, a stand-in for the torque", "drake_peer", "toppra", {}, False),
    ("copp-py TOPP2, 1001 stations", "copp_peer", "topp2", {"stations": 1001}, False),
    ("copp-py TOPP3, 501 stations", "copp_peer", "topp3", {"stations": 501}, True),
    ("copp-py TOPP3, 1001 stations", "copp_peer", "topp3", {"stations": 1001}, True),
    ("copp-py TOPP3, 2001 stations, 2 at rest", "copp_peer", "topp3", {"stations": 2001, "at_rest": 2}, True),
    ("ruckig on s", "ruckig_peer", "ruckig", {}, True),
)
LIBRARIES = {"toppra_peer": "toppra", "drake_peer": "drake", "copp_peer": "copp-py", "ruckig_peer": "ruckig"}
_MODULES = {"toppra", "pydrake", "copp_py", "ruckig"}


def main() -> None:
    """Compute, print and write."""
    cases = [reference(), *others()]
    rows = {case.name: rows_of(case) for case in cases}
    bounds = {case.name: _bound(case) for case in cases}
    first = cases[0].name
    goals = _goals(rows[first], bounds[first])
    parts = [_header()]
    for case in cases:
        parts += [f"## {case.name[0].upper()}{case.name[1:]}", _what(case), *_table(rows[case.name], bounds[case.name])]
        parts += ["", *_losses(rows[case.name]), ""]
    parts += ["## Goals, in the reference case", *goals, ""]
    (ROOT / "docs" / "peers.md").write_text("\n".join(parts))
    print("\n".join(parts))
    short = [*_table(rows[first], bounds[first]), "", *_losses(rows[first]), "", *goals]
    write_between(ROOT / "README.md", "peers", "\n".join(short) + "\n")


def rows_of(case: Case) -> list[Row]:
    """All laws, those without a jerk limit first."""
    rows = []
    for name, (law, jerk) in OURS.items():
        limits = case.limits if jerk else case.without_jerk
        own = {"within": case.within} if law is free_motion else {}
        rows.append(measured(case, name, jerk, partial(law, case.robot, case.path, limits, case.payload, **own)))
    for name, module, function, options, jerk in PEERS:
        try:
            law = getattr(import_module(f"tests.bench.timing.{module}"), function)
        except ModuleNotFoundError as error:
            if error.name not in _MODULES:
                raise
            rows.append(Row(name, jerk, reason="not installed"))
            continue
        rows.append(measured(case, name, jerk, partial(law, case, **options)))
    return sorted(rows, key=lambda row: row.jerk)


def _bound(case: Case) -> float:
    return lower_bound(case.robot, case.path, case.without_jerk, case.payload)


def _table(rows: list[Row], bound: float) -> list[str]:
    lines = [
        "| law | keeps jerk | half cycle [ms] | solve [s] | worst peak / limit | of | at its limits [ms] |",
        "| --- | --- | --- | --- | --- | --- | --- |",
        f"| certified lower bound on this path, without jerk | | {1e3 * bound:.2f} | | | | |",
    ]
    for row in rows:
        keeps = "yes" if row.jerk else "no"
        if math.isnan(row.duration):
            lines.append(f"| {row.law} | {keeps} | {row.reason} | | | | |")
            continue
        held = f"{1e3 * row.held:.2f}" if row.held == row.held else row.reason
        cells = [
            row.law,
            keeps,
            f"{1e3 * row.duration:.2f}",
            f"{row.solve:.3g}",
            f"{row.worst:.4f}",
            row.quantity,
            held,
        ]
        lines.append(f"| {' | '.join(cells)} |")
    return lines


def _ours(rows: list[Row], law: str) -> Row:
    return next(row for row in rows if row.law == f"`{law}` law")


def _losses(rows: list[Row]) -> list[str]:
    """Where a peer, at its limits on the same path, is faster, or is solved sooner with a motion that is no slower."""
    lines = []
    for law, jerk in (("toppra", False), ("jerk", True)):
        ours = _ours(rows, law)
        peers = [r for r in rows if r.jerk == jerk and not r.law.startswith("`") and r.held == r.held]
        for peer in peers:
            if peer.held < ours.held or math.isnan(ours.held):
                lines.append(
                    f"- Lost: {peer.law} is faster than our `{law}` law, by {_percent(ours.held / peer.held - 1)}, "
                    f"solved in {peer.solve / ours.solve:.2g} times its time."
                )
            elif peer.solve < ours.solve:
                lines.append(
                    f"- Solved sooner: {peer.law}, in {peer.solve / ours.solve:.2g} of our `{law}` law's time, "
                    f"with a motion {_percent(peer.held / ours.held - 1)} slower."
                )
    return lines or ["No peer is faster here, nor solved sooner."]


def _percent(share: float) -> str:
    return f"{100 * share:.3f} %"


def _goals(rows: list[Row], bound: float) -> list[str]:
    toppra, jerk = _ours(rows, "toppra"), _ours(rows, "jerk")
    free = next(row for row in rows if row.law.startswith("`free`"))
    copp = min((r.held for r in rows if "TOPP3" in r.law and r.held == r.held), default=math.nan)
    least = [
        ("`toppra` law over its certified bound, at most 1.015", toppra.held / bound, 1.015, "{:.4f}"),
        ("`jerk` law, at most 132.5 ms", 1e3 * jerk.held, 132.5, "{:.2f} ms"),
        ("`jerk` law below copp-py's best TOPP3, at its limits", 1e3 * jerk.held, 1e3 * copp, "{:.3f} ms"),
        ("`free` law, at most 108 ms", 1e3 * free.held, 108.0, "{:.2f} ms"),
        ("`toppra` solved within 0.2 s", toppra.solve, 0.2, "{:.3f} s"),
        ("`jerk` solved within 0.05 s", jerk.solve, 0.05, "{:.3f} s"),
        ("`free` solved within 20 s", free.solve, 20.0, "{:.1f} s"),
        ("worst peak / limit of the three, repaired, at most 1", _worst_held(toppra, jerk, free), 1.0, "{:.6f}"),
    ]
    lines = ["| goal | found | asked | holds |", "| --- | --- | --- | --- |"]
    for what, found, asked, form in least:
        holds = "yes" if found <= asked else "no"
        lines.append(f"| {what} | {form.format(found)} | {form.format(asked)} | {holds} |")
    return lines


def _worst_held(*rows: Row) -> float:
    return float("nan") if any(math.isnan(r.worst_held) for r in rows) else max(r.worst_held for r in rows)


def _what(case: Case) -> str:
    path = ", ".join(f"{key} {_spelled(value)}" for key, value in case.path.as_dict().items() if key != "pose_names")
    limits = ", ".join(f"{key} {value:g}" for key, value in case.limits.as_dict().items())
    return f"{type(case.robot).__name__}; path (m, rad): {path}; limits (SI): {limits}; payload {case.payload:g} kg.\n"


def _spelled(value: object) -> str:
    if isinstance(value, list):
        return "(" + ", ".join(_spelled(v) for v in value) + ")"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _header() -> str:
    modules = {module for _, module, *_ in PEERS}
    found = []
    for module in sorted(modules):
        try:
            found.append(f"{LIBRARIES[module]} {version(LIBRARIES[module])}")
        except ModuleNotFoundError:
            found.append(f"{LIBRARIES[module]} not installed")
    load = f"a load average of {os.getloadavg()[0]:.1f} at the end of the run"
    machine = f"{platform.machine()} with {os.cpu_count()} cores, {load}"
    return HEADER.format(found=", ".join(found), machine=machine, repeats=REPEATS, long=LONG)


HEADER = """\
# Timing laws against peers

`python -m tests.bench.trajectory_peers` wrote this, with {found}, on {machine}.

Every law gets the same half cycle, from rest to rest, the same limits and the same payload, and one verifier measures
all of them densely between their knots, before any repair. "Solve" is from the problem to the law: the median of
{repeats} repeats after a first run, or one repeat where the first run took more than {long:g} s. "At its limits" is the
same motion at the pace, slower or faster, at which every limit holds and one is reached. Laws whose acceleration steps
are measured without the jerk limit. The limits of the drives are assumptions of this project.

How each peer gets the problem, in the strongest form that its interface takes:

- **toppra**: a spline through 501 poses of the path; torque and acceleration as its `SecondOrderConstraint` with our
  inverse dynamics called pose by pose, the drives' speed as a bound of its own. Gridpoints are its own choice, but for
  N = 2000. By default its trajectory is a cubic spline in time, which is verified as it is; a law of
  `ParametrizeConstAccel` is travelled on the exact path.
- **Drake** computes the torque of open trees only: the limit of a closed loop's torque cannot be given to it. It gets
  the drives' path, their speed, and constant accelerations that stand in for the torque: the largest whose law keeps
  the torque, the same for all drives or in proportion to their largest q', whichever is faster; found by solving
  several times, all of them counted. 1000 equal intervals.
- **copp-py** gets exact derivatives, exact torque rows, and the problem without units; TOPP3 is linearised about its
  own last answer until the time stands. Its s'' between stations is its own interpolation.
- **ruckig** gets s as its one axis, with the best constant speed, acceleration and jerk for which each limit holds for
  every s; the search for them is counted.
"""


if __name__ == "__main__":
    main()
