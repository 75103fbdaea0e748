"""Run the benchmarks and write their figures into the README, between its markers."""

from __future__ import annotations

import json
import platform
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
START, END = "<!-- bench: written by `make bench` -->", "<!-- /bench -->"


def main() -> None:
    """Benchmarks, table, README."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "bench.json"
        tests = ["-m", "pytest", "tests/bench", "-q", "-p", "no:xdist", f"--benchmark-json={file}"]
        subprocess.run([sys.executable, *tests, "--benchmark-disable-gc"], cwd=ROOT, check=True)
        table = _table(json.loads(file.read_text())["benchmarks"])
    readme = ROOT / "README.md"
    text = readme.read_text()
    before, rest = text.split(START)
    readme.write_text(f"{before}{START}\n{table}{END}{rest.split(END)[1]}")
    print(table)


def _table(benchmarks: list[dict[str, Any]]) -> str:
    """Medians as Markdown."""
    median = {b["name"]: b["stats"]["median"] for b in benchmarks}
    extra = {b["name"]: b["extra_info"] for b in benchmarks}
    lines = [f"Medians on {platform.machine()}, both threads of a two-core machine, one run.\n"]
    lines += [
        "| Heli4, {:,} poses | Linkwright | batched numpy | ratio |".format(extra["test_poses[inverse-numpy]"]["poses"])
    ]
    lines += ["| --- | --- | --- | --- |"]
    for what in ("inverse", "forward", "fvi"):
        ours, peer = median[f"test_poses[{what}-linkwright]"], median[f"test_poses[{what}-numpy]"]
        lines.append(f"| {what} | {1e3 * ours:.1f} ms | {1e3 * peer:.1f} ms | {peer / ours:.1f} |")
    lines += ["", "| job | time |", "| --- | --- |"]
    lines.append(f"| one max-min NLP (81 poses) | {median['test_one_nlp']:.2f} s |")
    rounds = extra["test_whole_synthesis"]["rounds"]
    lines.append(
        f"| whole synthesis ({rounds} rounds, dense search in each) | {median['test_whole_synthesis']:.1f} s |"
    )
    for name, seconds in median.items():
        if name.startswith("test_toppra"):
            count = name.split("[")[1].rstrip("]")
            half = extra[name]["half_cycle"]
            lines.append(f"| toppra, N = {count}: half cycle {half:.5f} s | {seconds:.3f} s |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
