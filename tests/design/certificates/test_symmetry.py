"""A mirror is used where it is shown to hold, and a wrong one never lets a certificate through."""

from __future__ import annotations

import math
from pathlib import Path

import casadi as ca
import numpy as np
import pytest

from design import Box, BrokenCertificate, certify, load_certificate, replay, save_certificate, worst_poses
from design.certificates.normal_form import Form, NoForm, forms
from design.certificates.symmetry import mirrors_of
from kinematics import Redundant3T1R
from tests.design.certificates.auditor import Auditor

PI = math.pi
ROBOT = Redundant3T1R()
HALF_TURN = Box(x=0.0, y=(-0.3, 0.3), z=(-0.3, 0.3), theta=(-PI / 2, PI / 2))
SMALL = Box(x=0.0, y=(-0.1, 0.1), z=(-0.1, 0.1), theta=(-0.4, 0.4))
ONE_WAY = Box(x=0.0, y=(-0.3, 0.3), z=(0.1, 0.15), theta=(0.4, 0.9))
OF_JACOBIANS = ("J_q", "det_J_q", "det_J_x", "fvi")


class Wrong(Redundant3T1R):
    """States mirrors that it has not."""

    mirrors = (("y",), ("theta",), ("y", "z"), ("x", "theta"))


@pytest.mark.parametrize("margin", OF_JACOBIANS)
@pytest.mark.parametrize("mirror", Redundant3T1R.mirrors)
def test_a_stated_mirror_keeps_the_margin_at_random_poses(margin: str, mirror: tuple[str, ...]) -> None:
    signs = np.array([-1.0 if name in mirror else 1.0 for name in ROBOT.pose_names])
    poses = HALF_TURN.random(ROBOT.pose_names, 5000, np.random.default_rng(3))
    np.testing.assert_allclose(ROBOT.margin(margin, signs * poses), ROBOT.margin(margin, poses), rtol=1e-10)
    assert mirror in mirrors_of(ROBOT, HALF_TURN, margin)


def test_a_mirror_is_for_a_region_that_it_keeps_and_a_margin_of_the_jacobians() -> None:
    assert mirrors_of(ROBOT, ONE_WAY, "fvi") == ()
    flat = Box(x=0.0, y=(-0.3, 0.3), z=0.0, theta=(-1.0, 1.0))
    assert mirrors_of(ROBOT, flat, "fvi") == (("y", "theta"),)
    for margin in ("reach", "joint_travel", "passive_joint", "clearance", "internal_determinant"):
        assert mirrors_of(ROBOT, HALF_TURN, margin) == ()


def test_a_quarter_proves_what_the_whole_does(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    quarter = certify(ROBOT, SMALL, "det_J_x", at_least=0.02)
    assert quarter.status == "proved"
    assert quarter.mirrors == Redundant3T1R.mirrors
    save_certificate(quarter, tmp_path / "quarter.npz")
    read = load_certificate(tmp_path / "quarter.npz")
    assert read.mirrors == quarter.mirrors
    assert replay(read, ROBOT) > 0
    auditor = Auditor(read, ROBOT)
    assert all(auditor.proves(low, high) for low, high in auditor.boxes(np.random.default_rng(7), 4))
    monkeypatch.setattr("design.certificates.certificate.mirrors_of", lambda *_: ())
    whole = certify(ROBOT, SMALL, "det_J_x", at_least=0.02)
    assert whole.status == "proved"
    assert whole.boxes > 2 * quarter.boxes


def test_a_wrong_mirror_is_not_used_and_a_certificate_that_relies_on_it_is_broken(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The claim holds where y >= 0 and fails where y < 0."""
    sides = [Box(**(ONE_WAY.intervals | {"y": y})) for y in ((-0.3, 0.0), (0.0, 0.3))]
    worst = [worst_poses(ROBOT, side, "fvi", about=20_000).value for side in sides]
    assert worst[0] < worst[1] - 0.01
    bound = 0.3 * worst[0] + 0.7 * worst[1]
    monkeypatch.setattr("design.certificates.refutation.Refuter.refutation", lambda *_: None)
    honest = certify(Wrong(), ONE_WAY, "fvi", at_least=bound, most_boxes=3_000)
    assert honest.mirrors == ()
    assert honest.status == "undecided"
    monkeypatch.setattr("design.certificates.certificate.mirrors_of", lambda *_: (("y",),))
    forged = certify(Wrong(), ONE_WAY, "fvi", at_least=bound)
    assert forged.status == "proved"
    with pytest.raises(BrokenCertificate, match="mirrors"):
        replay(forged, Wrong())


def test_equal_functions_have_equal_forms_and_others_have_not() -> None:
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    same = [
        ((x + y) * (x + y), x * x + 2 * x * y + y * y),
        (ca.sin(y - x) * y, -(y * ca.sin(x - y))),
        (ca.cos(y - x), ca.cos(x - y)),
        (ca.fabs(3 * x), ca.fabs(-3 * x)),
        (ca.sqrt(x * x + y) / (x + y), ca.sqrt(y + x * x) * (1 / (y + x))),
    ]
    other = [(ca.sin(x), ca.sin(y)), (ca.cos(x), ca.sin(x)), (ca.sin(x), ca.sin(-x)), (x / 10, 0.1 * x + 1e-20 * x)]
    for pairs, equal in ((same, True), (other, False)):
        for one, two in pairs:
            found, _ = forms([x, y], ca.vertcat(one, two), [Form.atom("x"), Form.atom("y")])
            assert (found[0] == found[1]) == equal, (one, two)


def test_a_form_tells_what_must_be_defined_even_where_it_cancels() -> None:
    x = ca.SX.sym("x")
    found, needed = forms([x], x + 1 / (x * (x + 1)) - 1 / (x * x + x), [Form.atom("x")])
    assert found[0] == Form.atom("x")
    assert len(needed) == 1


def test_what_has_no_rule_has_no_form() -> None:
    x = ca.SX.sym("x")
    for expression in (ca.exp(x), ca.if_else(x > 0, x, 1.0), x + math.nan):
        with pytest.raises(NoForm):
            forms([x], expression, [Form.atom("x")])
