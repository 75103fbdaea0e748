"""No certificate fails its audit in arbitrary precision, and its replay notices what was changed."""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from design import (
    Box,
    BrokenCertificate,
    Certificate,
    Cylinder,
    OtherCertificate,
    Region,
    UnreadableCertificate,
    certify,
    load_certificate,
    replay,
    save_certificate,
)
from design.certificates.box_tree import LEFT, OUTSIDE, PROVED
from kinematics import Bound, GoughStewart, Heli4, InvalidValue, Mechanism, Peppermill, Redundant3T1R
from tests.design.certificates.auditor import Auditor
from tests.sizes import few_of

PI = math.pi
CYLINDER = Cylinder(radius=0.5, z=(-0.8, -0.6), theta=(-PI, PI))
YZ = Box(x=0.0, y=(0.0, 0.3), z=(0.1, 0.3), theta=(-PI / 2, PI / 2))
NARROWER = Box(x=0.0, y=(-0.26, 0.26), z=(-0.26, 0.26), theta=(-PI / 2, PI / 2))
HEXAPOD = Box(x=(-0.1, 0.1), y=(-0.1, 0.1), z=(0.5, 0.7), roll=(-0.2, 0.2), pitch=(-0.2, 0.2), yaw=(-0.2, 0.2))
SCREWS = Box(x=(-0.2, 0.2), y=(-0.2, 0.2), z=(-0.05, 0.05), theta=(-2 * PI, 2 * PI))
CLAIMS: list[tuple[Mechanism, Region, str, float, int]] = [
    (Heli4(), CYLINDER, "internal_determinant", 0.45, 30),
    (Heli4(), CYLINDER, "det_J_x", 0.45, 30),
    (Heli4(), CYLINDER, "J_q", 0.4, 30),
    (Heli4(), CYLINDER, "reach", 0.01, 30),
    (Heli4(), Cylinder(radius=0.3, z=(-0.72, -0.68), theta=(-0.5, 0.5)), "fvi", 1.0, 4),
    (Redundant3T1R(), YZ, "fvi", 1.0, 4),
    (Peppermill(), SCREWS, "det_J_x", 1e-6, 30),
    (Peppermill(), SCREWS, "J_q", 1e-6, 30),
    (GoughStewart(), HEXAPOD, "det_J_x", 1e-6, 4),
    (Heli4(), CYLINDER, "joint_travel", 0.165, 30),
    (Heli4(), CYLINDER, "passive_joint", 0.32, 30),
    (Redundant3T1R(), NARROWER, "clearance", 0.015, 30),
    (Redundant3T1R(), Box(x=0.0, y=(-0.2, 0.2), z=(0.0, 0.1), theta=(-PI / 2, PI / 2)), "passive_joint", 0.5, 1),
    (GoughStewart(), HEXAPOD, "joint_travel", 0.04, 10),
    (GoughStewart(), HEXAPOD, "passive_joint", 0.19, 4),
    (Peppermill(), SCREWS, "joint_travel", 0.095, 30),
    (Peppermill(), SCREWS, "passive_joint", 0.155, 30),
]
LONG = ((Heli4, "det_J_x"), (Redundant3T1R, "fvi"), (GoughStewart, "det_J_x"))  # others are alike


@pytest.mark.parametrize(
    ("robot", "region", "margin", "at_least", "sample"),
    few_of(CLAIMS, lambda robot, _, margin, *__: (type(robot), margin) not in LONG),
    ids=[f"{type(robot).__name__}-{margin}" for robot, _, margin, _, _ in CLAIMS],
)
def test_a_certificate_stands_its_replay_and_its_audit(
    robot: Mechanism, region: Region, margin: str, at_least: float, sample: int
) -> None:
    found = certify(robot, region, margin, at_least=at_least)
    assert found.status == "proved"
    assert 0 < replay(found, robot, region=region, margin=margin, at_least=at_least) <= found.boxes
    auditor, rng = Auditor(found, robot), np.random.default_rng(23)
    for low, high in auditor.boxes(rng, sample):
        assert auditor.proves(low, high), f"seed 23: {low}, {high}"
        for _ in range(3):
            pose = low + (high - low) * rng.random(len(low))
            if region.contains(pose[None], robot.pose_names).all():
                assert auditor.holds_at(pose), f"seed 23: {pose}"


def test_the_audit_itself_refuses_a_false_box() -> None:
    """The certificate's boxes with a bound above the true worst value."""
    false = replace(_proved(), bound=Bound(0.9))
    auditor = Auditor(false, Heli4())
    boxes = auditor.boxes(np.random.default_rng(1), 40)
    assert not all(auditor.proves(low, high, depth=1) for low, high in boxes)
    assert not all(auditor.holds_at(0.5 * (low + high)) for low, high in boxes)


_KEPT: list[Certificate] = []


def _proved() -> Certificate:
    if not _KEPT:
        _KEPT.append(certify(Heli4(), CYLINDER, "J_q", at_least=0.4))
    return _KEPT[0]


def test_a_file_keeps_every_bit(tmp_path: Path) -> None:
    path = tmp_path / "j_q.npz"
    save_certificate(_proved(), path)
    read = load_certificate(path)
    assert replay(read, Heli4(), region=CYLINDER, margin="J_q", at_least=0.4) > 0
    for name in (
        "mechanism",
        "digest",
        "conditions",
        "margin",
        "bound",
        "bounds",
        "characteristic_length",
        "version",
        "boxes",
    ):
        assert getattr(read, name) == getattr(_proved(), name)
    assert repr(read.region) == repr(CYLINDER)
    assert (read.codes == _proved().codes).all()


def test_a_refutation_is_kept_and_replayed(tmp_path: Path) -> None:
    found = certify(Heli4(), CYLINDER, "J_q", at_least=0.44)
    save_certificate(found, tmp_path / "no.npz")
    read = load_certificate(tmp_path / "no.npz")
    assert replay(read, Heli4()) == 1
    with pytest.raises(BrokenCertificate, match="does not refute"):
        replay(replace(read, bound=Bound(0.4)), Heli4())


@pytest.mark.parametrize(
    ("change", "what"),
    [
        ({"mechanism": "Peppermill"}, "mechanism"),
        ({"digest": "0" * 64}, "geometry"),
        ({"conditions": "0" * 64}, "joint ranges or working mode"),
        ({"version": "0.0.0"}, "version"),
    ],
)
def test_a_certificate_for_something_else_is_refused(change: dict[str, str], what: str) -> None:
    with pytest.raises(OtherCertificate, match=what) as caught:
        replay(replace(_proved(), **change), Heli4())  # type: ignore[arg-type]
    assert caught.value.what == what


def test_another_geometry_region_margin_or_bound_is_refused() -> None:
    with pytest.raises(OtherCertificate, match="joint ranges or working mode"):
        replay(_proved(), Heli4(ranges=Heli4.Ranges(passive=(0.9, 1.0))))
    other = Heli4(Heli4.Geometry(arm_length=0.3510001))
    with pytest.raises(OtherCertificate, match="geometry"):
        replay(_proved(), other)
    with pytest.raises(OtherCertificate, match="region"):
        replay(_proved(), Heli4(), region=Cylinder(radius=0.5001, z=(-0.8, -0.6), theta=(-PI, PI)))
    with pytest.raises(OtherCertificate, match="margin"):
        replay(_proved(), Heli4(), margin="fvi")
    with pytest.raises(OtherCertificate, match="bound"):
        replay(_proved(), Heli4(), at_least=0.41)


def test_other_fvi_bounds_or_another_length_are_refused() -> None:
    bounds = Heli4.fvi_bounds
    assert replay(_proved(), Heli4(), bounds=bounds, characteristic_length=Heli4().characteristic_length) > 0
    with pytest.raises(OtherCertificate, match="FVI bounds"):
        replay(_proved(), Heli4(), bounds=replace(bounds, force=bounds.force + 1.0))
    with pytest.raises(OtherCertificate, match="characteristic length"):
        replay(_proved(), Heli4(), characteristic_length=0.01)


def test_a_number_of_boxes_that_its_list_does_not_have_is_caught() -> None:
    with pytest.raises(BrokenCertificate, match="boxes"):
        replay(replace(_proved(), boxes=_proved().boxes - 1), Heli4())


def test_a_raised_bound_or_a_grown_region_is_caught() -> None:
    for change in ({"bound": Bound(0.43)}, {"region": Cylinder(radius=0.8, z=(-0.8, -0.6), theta=(-PI, PI))}):
        with pytest.raises(BrokenCertificate):
            replay(replace(_proved(), **change), Heli4())  # type: ignore[arg-type]


def test_a_tampered_list_of_boxes_is_caught() -> None:
    codes = _proved().codes
    cut = int(np.flatnonzero(codes >= 0)[5])
    proved = np.flatnonzero(codes == PROVED)
    forged = [codes[:-1], codes[1:], np.append(codes, PROVED), np.array([PROVED], dtype=np.int8), codes[:0]]
    for place, code in ((cut, PROVED), (int(proved[0]), OUTSIDE), (int(proved[-1]), LEFT), (cut, 7), (cut, -9)):
        one = codes.copy()
        one[place] = code
        forged.append(one)
    for one in forged:
        with pytest.raises(BrokenCertificate):
            replay(replace(_proved(), codes=one), Heli4())


def test_an_undecided_certificate_proves_nothing() -> None:
    found = certify(Heli4(), CYLINDER, "J_q", at_least=0.43, most_boxes=50)
    assert found.status == "undecided"
    for one in (found, replace(found, status="proved")):
        with pytest.raises(BrokenCertificate):
            replay(one, Heli4())


def test_a_broken_file_is_named(tmp_path: Path) -> None:
    path = tmp_path / "c.npz"
    with pytest.raises(InvalidValue, match="characteristic_length"):
        replay(replace(_proved(), characteristic_length=-1.0), Heli4())
    with pytest.raises(BrokenCertificate, match="cannot be read"):
        load_certificate(path)
    save_certificate(_proved(), path)
    whole = path.read_bytes()
    for content in (b"", b"not an archive", whole[: len(whole) // 2]):
        path.write_bytes(content)
        with pytest.raises(UnreadableCertificate, match=f"{path.name} cannot be read") as caught:
            load_certificate(path)
        assert caught.value.exit_status == 2
    rng = np.random.default_rng(5)
    for _ in range(300):
        damaged = bytearray(whole)
        damaged[int(rng.integers(len(whole)))] ^= int(rng.integers(1, 256))
        path.write_bytes(damaged)
        with suppress(UnreadableCertificate):  # a byte that zip and numpy pass over may change
            assert (load_certificate(path).codes == _proved().codes).all(), "seed 5"
    np.savez(path, header=np.array("{}"), counterexample=np.empty(0), codes=np.empty(0, np.int8), left=np.empty(0))
    with pytest.raises(BrokenCertificate):
        load_certificate(path)
