"""`linkwright run`: what it writes, and what it leaves alone when it fails."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.sizes import later
from tests.studies.command_line import SMALL, SmallRun, linkwright, linkwright_apart
from trajectory import read_setpoints


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real mechanisms here, in place of the other files' stand-in."""


def test_a_run_writes_optimum_report_and_set_points_and_says_so(
    small_run: SmallRun,
) -> None:
    folder, ended = small_run
    assert ended.returncode == 0, ended.stderr
    data = json.loads(ended.stdout)
    assert data["worst"]["fvi"]["value"] > data["prototype"]["fvi"]
    certificates = {"certificates/internal_determinant.npz", "certificates/J_q.npz"}
    of_the_run = {"optimum.toml", *certificates, "report.html", "mechanism.png", "cycle.csv", "frame_reaction.csv"}
    assert {Path(f) for f in data["files"]} == {folder / "out" / f for f in of_the_run} | {
        folder / f for f in ("optimum.toml", *certificates)
    }
    for name in ("optimum.toml", *certificates):
        assert (folder / name).read_bytes() == (folder / "out" / name).read_bytes()
    points = read_setpoints(folder / "out" / "cycle.csv")
    np.testing.assert_allclose(np.diff(points.time), 0.002, rtol=1e-9)
    np.testing.assert_allclose(points.pose[0], points.pose[-1], atol=1e-9)
    assert max(data["cycle"]["peak_over_limit"].values()) <= 1.0
    assert not [f for f in (folder / "out").iterdir() if f.name.startswith(".")]


def test_the_report_opens_offline(small_run: SmallRun) -> None:
    page = (small_run[0] / "out" / "report.html").read_text()
    assert "rod_middle as of the members; drive_train (gear_ratio 1; motor_inertia 0;" in page
    assert '<td>limits not kept by this law</td><td class="n">none</td>' in page
    assert '<td>material of each rod</td><td class="n">carbon tube: density 1600' in page
    sources = re.findall(r'(?:src|href)="([^"]{0,40})', page)
    assert len(sources) >= 5
    assert all(source.startswith("data:image/png;base64,") for source in sources)
    assert "nan" not in re.sub(r'src="[^"]*"', "", page).lower().split()


def test_a_run_proves_its_requirements_and_shows_it(small_run: SmallRun) -> None:
    folder, ended = small_run
    proofs = {proof["margin"]: proof for proof in json.loads(ended.stdout)["proofs"]}
    assert {proof["status"] for proof in proofs.values()} == {"proved"}
    assert proofs["internal_determinant"]["at_least"] == 0.4
    assert 0.0 <= proofs["J_q"]["gap"] <= 0.0201 * proofs["J_q"]["sampled"]
    page = (folder / "out" / "report.html").read_text()
    for proof in proofs.values():
        assert f"{proof['margin']} &gt;= {proof['at_least']:.7g}" in page
        assert f">{proof['boxes']}<" in page
    for certificate in (folder / "certificates").iterdir():
        assert certificate.stat().st_size < 200_000


@pytest.mark.long
def test_a_run_is_reproducible_from_the_study_alone(small_run: SmallRun, tmp_path: Path) -> None:
    """By another process, which has run nothing before."""
    again = tmp_path / "study.toml"
    again.write_text(SMALL)
    assert linkwright_apart("run", again, "--out", tmp_path / "out").returncode == 0
    for name in ("optimum.toml", "cycle.csv", "certificates/J_q.npz"):
        assert (tmp_path / "out" / name).read_bytes() == (small_run[0] / "out" / name).read_bytes()


def test_a_failing_run_exits_1_and_leaves_what_was_there(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(SMALL.replace("at_least = 0.4", "at_least = 0.999"))
    out = tmp_path / "out"
    out.mkdir()
    (out / "notes.txt").write_text("of an earlier day")
    ended = linkwright("run", tmp_path, "--out", out)
    assert ended.returncode == 1
    assert "internal_determinant >= 0.999 falls short" in ended.stderr
    assert (out / "notes.txt").read_text() == "of an earlier day"
    assert [f.name for f in out.iterdir()] == ["notes.txt"]


def test_a_given_geometry_that_fails_its_requirement_writes_nothing(tmp_path: Path) -> None:
    given = re.sub(r"\[optimise\].*?(?=\[\[requirement)", "", SMALL, flags=re.DOTALL)
    (tmp_path / "study.toml").write_text(given.replace("at_least = 0.4", "at_least = 0.99"))
    for command in ("run", "report"):
        ended = linkwright(command, tmp_path, "--out", tmp_path / "out")
        assert ended.returncode == 1, ended.stderr
        assert re.search(r"internal_determinant: found 0\.\d+ at pose \(.*\); expected at least 0\.99", ended.stderr)
        assert not (tmp_path / "out").exists()


LOUD = """
import casadi
solver = casadi.nlpsol
casadi.nlpsol = lambda name, plugin, nlp, options: solver(name, plugin, nlp, options | {"ipopt.print_level": 5})
from studies.cli import main
main()
"""


@pytest.mark.parametrize("after", [later(0), 1])
def test_an_interrupt_ends_a_run_at_once_even_inside_the_solver(tmp_path: Path, after: int) -> None:
    """Once IPOPT has begun to iterate, and ten iterations or a problem later."""
    call = [sys.executable, "-u", "-c", LOUD, "run", "heli4", "--out", str(tmp_path / "out")]
    with subprocess.Popen(call, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as running:
        assert running.stdout is not None
        tables = (line for line in running.stdout if line.startswith("iter"))
        for _ in range(after + 1):
            next(tables)
        running.send_signal(signal.SIGINT)
        _, error = running.communicate(timeout=60)
    assert running.returncode == 130
    assert "interrupted" in error
    assert not (tmp_path / "out").exists()
