"""Run the benchmarks and the Heli4 study; write their figures and the picture into the README, between its markers."""

from __future__ import annotations

import json
import os
import platform
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from kinematics.printed_bounds import rounded_down
from tests.bench import certificates, trajectory_peers
from tests.bench.page import ROOT, write_between


def main() -> None:
    """Benchmarks, study, certificates, timing laws."""
    with tempfile.TemporaryDirectory() as folder:
        tables = {"bench": _bench_table(_benchmarks(Path(folder) / "bench.json"))}
        tables["run"] = _run_table(_study(Path(folder)))
        (ROOT / "docs" / "pictures").mkdir(exist_ok=True)
        (ROOT / "docs" / "pictures" / "heli4.png").write_bytes((Path(folder) / "mechanism.png").read_bytes())
    for name, table in tables.items():
        write_between(ROOT / "README.md", name, table)
    certificates.main()
    trajectory_peers.main()


def _benchmarks(file: Path) -> list[dict[str, Any]]:
    tests = [
        "-m",
        "pytest",
        "tests/bench",
        "-q",
        "-p",
        "no:xdist",
        f"--benchmark-json={file}",
        "--benchmark-disable-gc",
    ]
    subprocess.run([sys.executable, *tests], cwd=ROOT, check=True)
    found: list[dict[str, Any]] = json.loads(file.read_text())["benchmarks"]
    return found


def _study(folder: Path) -> dict[str, Any]:
    call = [
        sys.executable,
        "-c",
        "from studies.cli import main; main()",
        "run",
        "heli4",
        "--json",
        "--out",
        str(folder),
    ]
    found: dict[str, Any] = json.loads(subprocess.run(call, cwd=ROOT, check=True, capture_output=True).stdout)
    return found


def _bench_table(benchmarks: list[dict[str, Any]]) -> str:
    """Medians as Markdown."""
    median = {b["name"]: b["stats"]["median"] for b in benchmarks}
    extra = {b["name"]: b["extra_info"] for b in benchmarks}
    count = extra["test_poses[inverse-numpy]"]["poses"]
    lines = [
        f"Medians of one run on {platform.machine()} with {os.cpu_count()} cores; Linkwright uses all, numpy one.",
        "",
    ]
    lines += [f"| Heli4, {count:,} poses | Linkwright | batched numpy | ratio |", "| --- | --- | --- | --- |"]
    for what in ("inverse", "forward", "fvi", "stiffness"):
        ours, peer = median[f"test_poses[{what}-linkwright]"], median[f"test_poses[{what}-numpy]"]
        lines.append(f"| {what} | {1e3 * ours:.1f} ms | {1e3 * peer:.1f} ms | {peer / ours:.1f} |")
    lines += [
        "",
        *_bulk_rows(median, count),
        "",
        *_clearance_rows(median, extra),
        "",
        "| job | time |",
        "| --- | --- |",
    ]
    poses, rounds = extra["test_one_nlp"]["poses"], extra["test_whole_synthesis"]["rounds"]
    lines.append(f"| one max-min NLP over {poses} poses | {median['test_one_nlp']:.2f} s |")
    lines.append(
        f"| whole synthesis ({rounds} rounds, a dense search in each) | {median['test_whole_synthesis']:.1f} s |"
    )
    for name, seconds in median.items():
        law = {"test_toppra": "`toppra` law", "test_jerk_law": "jerk law, repaired"}.get(name.split("[")[0])
        if law is not None:
            intervals = name.split("[")[1].rstrip("]")
            lines.append(
                f"| {law}, from N = {intervals}: half cycle {extra[name]['half_cycle']:.5f} s | {seconds:.3f} s |"
            )
    return "\n".join(lines) + "\n"


def _bulk_rows(median: dict[str, float], count: int) -> list[str]:
    """The FVI of each mechanism against CasADi's map and batched numpy."""
    heads = ["Linkwright", "CasADi map, serial", "CasADi map, threads", "its best over ours", "numpy pinv", "over ours"]
    lines = [f"| FVI, {count:,} random poses | {' | '.join(heads)} |", "| --- " * (1 + len(heads)) + "|"]
    for name in ("Redundant3T1R", "Heli4", "Peppermill", "GoughStewart"):
        ours, *maps = (median[f"test_fvi[{name}-{way}]"] for way in ("linkwright", "casadi serial", "casadi thread"))
        cells = [f"{1e3 * t:.1f} ms" for t in (ours, *maps)] + [f"{min(maps) / ours:.1f}"]
        peer = median.get(f"test_fvi[{name}-numpy]")
        cells += [f"{1e3 * peer:.0f} ms", f"{peer / ours:.0f}"] if peer else ["", ""]
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return lines


def _clearance_rows(median: dict[str, float], extra: dict[str, dict[str, Any]]) -> list[str]:
    """The clearance of robots of capsules against batched numpy and FCL, per pose."""
    lines = ["| clearance, per pose | Linkwright | batched numpy | over ours | FCL | over ours |"]
    lines.append("| --- " * 6 + "|")
    for name in ("Heli4", "Redundant3T1R", "Peppermill"):
        tests = (f"test_clearance[{name}-{way}]" for way in ("linkwright", "numpy", "fcl"))
        ours, *peers = (1e6 * median[test] / extra[test]["poses"] for test in tests)
        cells = [cell for peer in peers for cell in (f"{peer:.3g} us", f"{peer / ours:.0f}")]
        lines.append(f"| {name} | {ours:.3g} us | {' | '.join(cells)} |")
    return lines


def _run_table(run: dict[str, Any]) -> str:
    """The study's answer as Markdown."""
    lines = [f"| worst over `{run['region']}` | prototype | optimum | of the optimum |", "| --- | --- | --- | --- |"]
    proofs = {p["margin"]: f"{p['status']} >= {rounded_down(p['at_least'], 6)}" for p in run["proofs"]}
    lines += [
        f"| {name} | {run['prototype'][name]:.4f} | {worst['value']:.4f} | {proofs.get(name, '')} |"
        for name, worst in run["worst"].items()
    ]
    lines += [
        f"| {name} | {run['unasked_before'][name]:.5g} | {worst['value']:.5g} | not asked |"
        for name, worst in run["unasked"].items()
    ]
    lines += ["", f"Held back by: {'; '.join(run['active'])}.", ""]
    header, cycle, before = run["cycle_header"], run["cycle"], run["prototype_cycle"]
    path = ", ".join(
        f"{key[5:]} {value:.4g}" for key, value in header.items() if isinstance(value, float) and "path" in key
    )
    limits = ", ".join(f"{key[6:]} {value:g}" for key, value in header.items() if key.startswith("limit "))
    peaks = ", ".join(f"{name} {value:.4f}" for name, value in cycle["peak_over_limit"].items())
    lines += [
        f"| cycle: {path}; payload {header['payloads [kg]'][0]:g} kg | prototype | optimum |",
        "| --- | --- | --- |",
    ]
    names = {
        "half_cycle": "half cycle [s]",
        "cycle_on_the_bus": f"there and back, {1e3 * header['period [s]']:g} ms bus [s]",
    }
    names["worst_rms_over_peak_torque"] = "worst RMS over peak torque"
    lines += [f"| {words} | {before[name]:.4f} | {cycle[name]:.4f} |" for name, words in names.items()]
    lines += ["", f"Limits (SI): {limits}; peak over limit of the optimum, between gridpoints too: {peaks}."]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
