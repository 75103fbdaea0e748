"""Run the benchmarks and the Heli4 study; write their figures and the picture into the README, between its markers."""

from __future__ import annotations

import json
import platform
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]


def main() -> None:
    """Benchmarks, study, README."""
    with tempfile.TemporaryDirectory() as folder:
        tables = {"bench": _bench_table(_benchmarks(Path(folder) / "bench.json"))}
        tables["run"] = _run_table(_study(Path(folder)))
        (ROOT / "docs" / "heli4.png").write_bytes((Path(folder) / "mechanism.png").read_bytes())
    readme = ROOT / "README.md"
    text = readme.read_text()
    for name, table in tables.items():
        start, end = f"<!-- {name}: written by `make bench` -->", f"<!-- /{name} -->"
        before, rest = text.split(start)
        text = f"{before}{start}\n{table}{end}{rest.split(end)[1]}"
        print(table)
    readme.write_text(text)


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
    lines = [f"Medians of one run on {platform.machine()}, two cores.", ""]
    lines += [f"| Heli4, {count:,} poses | Linkwright | batched numpy | ratio |", "| --- | --- | --- | --- |"]
    for what in ("inverse", "forward", "fvi"):
        ours, peer = median[f"test_poses[{what}-linkwright]"], median[f"test_poses[{what}-numpy]"]
        lines.append(f"| {what} | {1e3 * ours:.1f} ms | {1e3 * peer:.1f} ms | {peer / ours:.1f} |")
    rounds = extra["test_whole_synthesis"]["rounds"]
    lines += ["", "| job | time |", "| --- | --- |"]
    lines.append(f"| one max-min NLP (81 poses) | {median['test_one_nlp']:.2f} s |")
    lines.append(
        f"| whole synthesis ({rounds} rounds, a dense search in each) | {median['test_whole_synthesis']:.1f} s |"
    )
    for name, seconds in median.items():
        if name.startswith("test_toppra"):
            intervals = name.split("[")[1].rstrip("]")
            lines.append(f"| toppra, N = {intervals}: half cycle {extra[name]['half_cycle']:.5f} s | {seconds:.3f} s |")
    return "\n".join(lines) + "\n"


def _run_table(run: dict[str, Any]) -> str:
    """The study's answer as Markdown."""
    lines = ["| worst over the cylinder of 1 m diameter, a full turn | prototype | optimum |", "| --- | --- | --- |"]
    lines += [
        f"| {name} | {run['prototype'][name]:.4f} | {worst['value']:.4f} |" for name, worst in run["worst"].items()
    ]
    cycle = run["cycle"]
    peaks = ", ".join(f"{name} {value:.4f}" for name, value in cycle["peak_over_limit"].items())
    lines += ["", f"Held back by: {'; '.join(run['active'])}.", ""]
    lines.append(
        f"Half of the Adept cycle (25 / 305 / 25 mm, half turn, 1 kg): {cycle['half_cycle']:.4f} s; there and back on "
        f"a 1 ms bus {cycle['cycle_on_the_bus']:.3f} s; peak over limit, between gridpoints too: {peaks}."
    )
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
