"""`linkwright certify`, and certificates that `linkwright check` must refuse."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from design import Box, Certificate, certificate_bytes, load_certificate, replay
from design.certificates.box_tree import PROVED
from kinematics import Bound, FviBounds, Heli4
from studies.building.load import load_study
from studies.committed.check import proofs
from studies.committed.optimum import read_optimum
from studies.errors import RequirementFailed
from studies.stages.claim_rows import Row
from studies.stages.pipeline import Outcome, run
from studies.stages.proofs import question_of
from studies.study_file.toml_file import read_toml
from tests.studies.command_line import SMALL, SmallRun, copy_of, linkwright, linkwright_apart

GIVEN = re.sub(r"\[optimise\].*?(?=\[\[requirement)", "", SMALL, flags=re.DOTALL).partition("[trajectory]")[0]


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real mechanisms here, in place of the other files' stand-in."""


@pytest.fixture(scope="module")
def outcome(small_run: SmallRun) -> Outcome:
    """What the geometry of the small run does, but for its cycle."""
    study = load_study(read_toml(small_run[0] / "study.toml"))
    robot = read_optimum(small_run[0] / "optimum.toml").robot(study)
    return run(study.model_copy(update={"trajectory": None}), robot, lambda _: None)


def failed(outcome: Outcome, folder: Path) -> list[Row]:
    return [row for row in proofs(read_optimum(folder / "optimum.toml"), outcome, folder) if not row.holds]


def test_a_replay_bounds_fewer_boxes_than_the_search_did(small_run: SmallRun, outcome: Outcome) -> None:
    for claim in outcome.question.claims():
        certificate = load_certificate(small_run[0] / "certificates" / f"{claim.margin}.npz")
        assert 0 < outcome.question.replay(certificate, claim) < certificate.boxes


def forged(file: Path, change: Callable[[Certificate], Certificate]) -> None:
    """The file and its digest in the optimum, as somebody would who knows the format."""
    before = hashlib.sha256(file.read_bytes()).hexdigest()
    file.write_bytes(certificate_bytes(change(load_certificate(file))))
    optimum = file.parents[1] / "optimum.toml"
    optimum.write_text(optimum.read_text().replace(before, hashlib.sha256(file.read_bytes()).hexdigest()))


def flipped(certificate: Certificate) -> Certificate:
    """A box of the first cut is called proved, as it was not."""
    codes = certificate.codes.copy()
    codes[np.flatnonzero(codes >= 0)[-1]] = PROVED
    return replace(certificate, codes=codes)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (flipped, "does not cover|more entries"),
        (lambda c: replace(c, digest="0" * 64), "geometry"),
        (lambda c: replace(c, version="0.0.9"), "version"),
        (lambda c: replace(c, margin="det_J_q"), "margin"),
        (lambda c: replace(c, region=Box(x=0.0, y=0.0, z=-0.73, theta=0.0)), "region"),
        (lambda c: replace(c, bounds=FviBounds(20.0, 127.0, 2.5, 149.0)), "FVI bounds"),
        (lambda c: replace(c, characteristic_length=0.01), "characteristic length"),
        (lambda c: replace(c, mechanism="Peppermill"), "mechanism"),
        (lambda c: replace(c, status="refuted", counterexample=np.array([0, 0, -0.73, 0])), "does not refute"),
        (lambda c: replace(c, status="refuted", counterexample=np.zeros(3)), "has 3 numbers; expected 4"),
        (lambda c: replace(c, edition=1), "edition"),
        (lambda c: replace(c, status="undecided"), "decides nothing"),
        (lambda c: replace(c, boxes=c.boxes + 1), "boxes"),
        (lambda c: replace(c, bound=Bound(0.39)), "bound"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_forged_certificate_fails_though_its_digest_agrees(
    small_run: SmallRun, outcome: Outcome, tmp_path: Path, change: Callable[[Certificate], Certificate], says: str
) -> None:
    copy_of(small_run[0], tmp_path)
    assert not failed(outcome, tmp_path)
    forged(tmp_path / "certificates" / "internal_determinant.npz", change)
    rows = failed(outcome, tmp_path)
    assert all("internal_determinant" in row.what for row in rows)
    assert any(re.search(says, row.found) for row in rows), rows


def test_a_bound_raised_in_both_files_is_not_proved(small_run: SmallRun, outcome: Outcome, tmp_path: Path) -> None:
    optimum = copy_of(small_run[0], tmp_path)
    file = tmp_path / "certificates" / "J_q.npz"
    claimed = load_certificate(file).bound.value
    raised = outcome.worst["internal_determinant"].value + 1.0
    forged(file, lambda c: replace(c, bound=Bound(raised)))
    optimum.write_text(optimum.read_text().replace(f"at_least = {claimed}", f"at_least = {raised}"))
    assert [row.found for row in failed(outcome, tmp_path) if "not proved" in row.found]


def test_a_digest_that_does_not_agree_is_a_failed_row(small_run: SmallRun, outcome: Outcome, tmp_path: Path) -> None:
    copy_of(small_run[0], tmp_path)
    file = tmp_path / "certificates" / "J_q.npz"
    certificate = load_certificate(file)
    np.savez(file, **np.load(file))  # the same content, coded otherwise
    assert (load_certificate(file).codes == certificate.codes).all()
    assert [row.what for row in failed(outcome, tmp_path)] == ["certificate.J_q.sha256"]


def test_a_claim_left_out_added_or_lowered_in_the_optimum_fails(
    small_run: SmallRun, outcome: Outcome, tmp_path: Path
) -> None:
    optimum = copy_of(small_run[0], tmp_path)
    text = optimum.read_text()
    optimum.write_text(re.sub(r"\[certificate\.J_q\][^\[]*", "", text))
    assert [row.what for row in failed(outcome, tmp_path)] == ["certificate.J_q"]
    optimum.write_text(text.replace("[certificate.J_q]", '[certificate.fvi]\nstatus = "proved"\n[certificate.J_q]'))
    assert [row.what for row in failed(outcome, tmp_path)] == ["certificate.fvi"]
    optimum.write_text(re.sub(r"(\[certificate\.J_q\]\nat_least = )\S+", r"\g<1>0.1", text))
    assert [row.what for row in failed(outcome, tmp_path)] == ["certificate.J_q.at_least"]


def test_an_undecided_claim_is_said_to_be_so_and_nothing_more(
    small_run: SmallRun, outcome: Outcome, tmp_path: Path
) -> None:
    optimum = copy_of(small_run[0], tmp_path)
    entry = '[certificate.internal_determinant]\nat_least = 0.4\nstatus = "undecided"\nmost_boxes = 4000000\n\n'
    optimum.write_text(re.sub(r"\[certificate\.internal_determinant\][^\[]*", entry, optimum.read_text()))
    assert not failed(outcome, tmp_path)
    for old, new in (("= 0.4\n", "= 0.5\n"), ("4000000", "4000001"), ('"undecided"\n', '"undecided"\nboxes = 3\n')):
        optimum.write_text(optimum.read_text().replace(entry, entry.replace(old, new)))
        assert failed(outcome, tmp_path)
        optimum.write_text(optimum.read_text().replace(entry.replace(old, new), entry))


@pytest.mark.parametrize("break_file", [Path.unlink, lambda f: f.write_bytes(f.read_bytes()[:-300])], ids=["no", "cut"])
def test_a_certificate_that_cannot_be_read_is_wrong_input(
    small_run: SmallRun, tmp_path: Path, break_file: Callable[[Path], Any]
) -> None:
    copy_of(small_run[0], tmp_path)
    file = tmp_path / "certificates" / "J_q.npz"
    break_file(file)
    ended = linkwright("check", tmp_path)
    assert ended.returncode == 2
    assert str(file) in ended.stderr


def test_another_studys_certificate_exits_1_with_its_row(small_run: SmallRun, tmp_path: Path) -> None:
    copy_of(small_run[0], tmp_path)
    question = question_of(load_study(read_toml(small_run[0] / "study.toml")), Heli4())  # the prototype's
    (claim,) = question.only("internal_determinant", None)
    other = question.prove(claim, None, None, lambda _: None).certificate
    assert other.status == "proved"
    (tmp_path / "certificates" / "internal_determinant.npz").write_bytes(certificate_bytes(other))
    ended = linkwright("check", tmp_path)
    assert ended.returncode == 1
    assert re.search(r"FAIL +internal_determinant >= 0\.4 everywhere .*geometry: made for", ended.stdout)


def test_a_refuted_claim_fails_a_run_though_its_dense_sample_holds(outcome: Outcome) -> None:
    outcome.require_all()
    (claim,) = outcome.question.only("J_q", outcome.worst["fvi"].value)  # far above
    proof = outcome.question.prove(claim, None, None, lambda _: None)
    assert proof.gap < 0.0
    with pytest.raises(RequirementFailed, match=r"J_q of limb \d: found 0\.\d+ at pose \("):
        replace(outcome, proofs=(proof,)).require_all()


def test_certify_proves_writes_and_exits_0(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(GIVEN)
    ended = linkwright_apart("certify", tmp_path, "--json", "--out", tmp_path / "out")
    assert (ended.returncode, ended.stderr) == (0, "")  # no stage was long
    data = json.loads(ended.stdout)
    assert [(p["margin"], p["status"]) for p in data["proofs"]] == [
        ("internal_determinant", "proved"),
        ("J_q", "proved"),
    ]
    for proof, file in zip(data["proofs"], data["files"], strict=True):
        certificate = load_certificate(Path(file))
        assert replay(certificate, Heli4(), margin=proof["margin"], at_least=proof["at_least"]) > 0


@pytest.mark.parametrize(
    ("change", "arguments", "shown"),
    [
        (("", ""), ("--margin", "J_q", "--at-least", "0.9"), r"J_q >= 0\.9 +refuted .*-0\.\d+ +\(.*\)"),
        (
            ("tolerance = 0.02", "most_boxes = 4"),
            ("--margin", "J_q", "--at-least", "0.8"),
            r"J_q >= 0\.8 +undecided +4 .*undecided boxes, one around \(",
        ),
        (("at_least = 0.4", "at_least = 0.99"), (), r"internal_determinant >= 0\.99 +refuted"),
    ],
)
def test_certify_exits_1_with_margin_and_pose(
    tmp_path: Path, change: tuple[str, str], arguments: tuple[str, ...], shown: str
) -> None:
    (tmp_path / "study.toml").write_text(GIVEN.replace(*change))
    ended = linkwright("certify", tmp_path, *arguments)
    assert ended.returncode == 1, ended.stderr
    assert ended.stderr == ""
    assert re.search(shown, ended.stdout), ended.stdout


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("--margin", "J_X"), f"--margin: found J_X; expected one of {', '.join(Heli4.margins)}"),
        (("--at-least", "1"), "--at-least: found 1.0; expected --margin"),
        (("--margin", "fvi", "--at-least", "nan"), "--at-least: found nan; expected a finite number"),
        (("--margin", "reach", "--at-least", "-0.1"), "--at-least: found -0.1; expected 0 m or more for reach"),
    ],
)
def test_a_wrong_question_exits_2(tmp_path: Path, arguments: tuple[str, ...], says: str) -> None:
    (tmp_path / "study.toml").write_text(GIVEN)
    ended = linkwright("certify", tmp_path, *arguments)
    assert ended.returncode == 2
    assert says in ended.stderr
