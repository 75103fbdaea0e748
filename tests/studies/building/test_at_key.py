"""What the computation refuses is told with the study's file, line and key."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.studies.command_line import SMALL, linkwright

PATH = """
[trajectory.path]
payload = 0.5
[[trajectory.path.waypoint]]
x = 0.0
y = 0.0
z = -0.75
theta = 0.0
[[trajectory.path.waypoint]]
x = 0.1
y = 0.0
z = -0.75
blend_mm = 40
[[trajectory.path.waypoint]]
x = 0.0
y = 0.1
z = -0.75
theta = 0.0
"""
ROUNDED = re.sub(r"\[trajectory.cycle\].*?payload = 0.5\n", "", SMALL, flags=re.S) + PATH
DRIVE = "[trajectory.drive]\nincrements = 4096\n"
FILES = SMALL.replace("period = 0.002", 'period = 0.002\nfiles = ["cia402"]')
FAR = SMALL.replace("[-0.2, 0.2]", "[-0.9, 0.9]").replace("pick = [-0.15", "pick = [-0.9")


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real mechanisms here, in place of the other files' stand-in."""


@pytest.mark.parametrize(
    ("text", "arguments", "at", "key", "says", "status"),
    [
        (
            SMALL.replace("torque = 127", "torque = [127, 127, 127]"),
            [],
            "torque =",
            "limits.torque",
            "one a joint of the 4",
            2,
        ),
        (SMALL, ["--law", "jerk"], "[trajectory.limits]", "limits.jerk", "found nothing for the jerk law", 2),
        (
            SMALL + "rms_torque = 80\n",
            ["--law", "toppra"],
            "rms_torque",
            "limits.rms_torque",
            "found 80 for the toppra law; expected no such limit, or another law",
            2,
        ),
        (
            SMALL + "[inertia.drive_train]\nviscous = 0.1\n",
            [],
            "viscous",
            "inertia.drive_train.viscous",
            "found 0.1 for the toppra law",
            2,
        ),
        (
            ROUNDED.replace("torque = 127", "torque = 127\njerk = 1e5"),
            ["--law", "free"],
            "[trajectory.path]",
            "trajectory.path",
            "path of the free law: found another path; expected an Adept cycle",
            2,
        ),
        (FAR, [], "[trajectory.cycle]", "trajectory.cycle", "reach margin of limb", 2),
        (
            SMALL + "[ranges]\njoints_deg = [80, 100]\n",
            [],
            "[trajectory.cycle]",
            "trajectory.cycle",
            "joint_travel margin",
            2,
        ),
        (SMALL + DRIVE + "encoder_gear = 0\n", [], "encoder_gear", "drive.encoder_gear", "found 0; expected finite", 2),
        (SMALL + DRIVE + "encoder_gear = [1, 2]\n", [], "encoder_gear", "drive.encoder_gear", "one a joint", 2),
        (SMALL + DRIVE + "axes = ['a', 'a', 'b', 'c']\n", [], "axes", "drive.axes", "different names", 2),
        (SMALL.replace("= 127", "= 1.0"), [], "torque", "limits.torque", "N m; expected from -1 to 1", 1),
        (
            SMALL.replace("= 127", "= 1.0\njerk = 1e5"),
            ["--law", "jerk"],
            "torque",
            "limits.torque",
            "N m; expected from -1 to 1",
            1,
        ),
        (
            SMALL + "position = [1.5, 2.2]\n",
            [],
            "position",
            "limits.position",
            "rad; expected from 1.5 to 2.2",
            1,
        ),
        (FILES, [], "[trajectory]", "drive.increments", "found nothing; expected the increments", 2),
    ],
)
def test_what_is_refused_is_told_at_its_key(
    tmp_path: Path, text: str, arguments: list[str], at: str, key: str, says: str, status: int
) -> None:
    study = tmp_path / "study.toml"
    study.write_text(text)
    ended = linkwright("trajectory", study, "--prototype", *arguments)
    assert ended.returncode == status
    line = next(k for k, line in enumerate(text.splitlines(), start=1) if line.startswith(at))
    assert f"{study}:{line}: " in ended.stderr
    assert f"{key}: " in ended.stderr
    assert says in ended.stderr


def test_a_sum_that_cannot_hold_and_a_requirement_that_fails_are_told_at_their_keys(tmp_path: Path) -> None:
    study = tmp_path / "study.toml"
    sums = '[[optimise.sums]]\nfields = ["arm_length", "rod_length"]\nat_most = 0.1\n'
    study.write_text(SMALL + sums)
    ended = linkwright("optimise", study)
    assert ended.returncode == 2
    assert f"{study}:{study.read_text().splitlines().index('at_most = 0.1') + 1}: optimise.sums" in ended.stderr
    given = re.sub(r"\[optimise\].*?(?=\[\[requirement)", "", SMALL, flags=re.S)
    study.write_text(re.sub(r"at_least = .*", "at_least = 0.999", given))
    ended = linkwright("run", study, "--out", tmp_path / "out")
    assert ended.returncode == 1
    line = study.read_text().splitlines().index("at_least = 0.999") + 1
    assert f"{study}:{line}: requirement.at_least: " in ended.stderr.replace("requirement.1.", "requirement.")
