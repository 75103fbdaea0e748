"""A file of waypoints gives the path that it says, or an error that says where it does not."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from trajectory import RoundedPath, WaypointFileError, read_waypoints

NAMES = ("x", "y", "z", "theta")
GOOD = """\
# from the camera
x_mm,y_mm,z_mm,theta_deg,blend_mm

-100, 0, -800, 0,
-100, 0, -775, , 24.9
100, 50.5, -775, 90, 20
100, 50.5, -800, 180, 0
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "waypoints.csv"


def test_units_blends_and_free_angles_are_read(file: Path) -> None:
    file.write_text(GOOD)
    turn = math.pi
    poses = (
        (-0.1, 0.0, -0.8, 0.0),
        (-0.1, 0.0, -0.775, None),
        (0.1, 0.0505, -0.775, turn / 2),
        (0.1, 0.0505, -0.8, turn),
    )
    assert read_waypoints(file, NAMES) == RoundedPath(NAMES, poses, (0.0249, 0.02))


def test_columns_may_stand_in_any_order_and_in_si(file: Path) -> None:
    file.write_text("theta,z,y,x\n0.5,3,2,1\n0.25,6,5,4\n")
    assert read_waypoints(file, NAMES) == RoundedPath(NAMES, ((1.0, 2.0, 3.0, 0.5), (4.0, 5.0, 6.0, 0.25)), ())


@pytest.mark.parametrize(
    ("before", "after", "line", "column", "found"),
    [
        ("theta_deg", "theta_grad", 2, "theta_grad", "unknown"),
        ("theta_deg", "theta_mm", 2, "theta_mm", "unknown"),
        ("y_mm", "x", 2, "x", "twice"),
        (",blend_mm", "", 4, "", "5 cells"),
        ("y_mm,", "blend,", 2, "blend_mm", "twice"),
        ("50.5, -775", "5O.5, -775", 6, "y_mm", "5O.5"),
        ("90, 20", "90, inf", 6, "blend_mm", "inf"),
        ("-100, 0, -800, 0", "-100, 0, -800, ", 4, "theta_deg", "nothing"),
        ("-775, 90, 20", "-775, 90, 20, 1", 6, "", "6 cells"),
        ("-775, , 24.9", "-775, , 25.1", 5, "blend_mm", "25.1"),
        ("-800, 180, 0", "-800, 180, 5", 7, "blend_mm", "5"),
        ("-775, , 24.9", "-800, , 24.9", 5, "", "the place ["),
        ("-100, 0, -800, 0,\n-100, 0, -775, , 24.9\n100, 50.5, -775, 90, 20\n", "", 4, "", "1 pose"),
        ("0, -775, ,", '0, "-775, ,', 5, "", "end of data"),
    ],
)
def test_a_fault_is_told_with_line_and_column(
    file: Path, before: str, after: str, line: int, column: str, found: str
) -> None:
    assert before in GOOD
    file.write_text(GOOD.replace(before, after))
    with pytest.raises(WaypointFileError) as caught:
        read_waypoints(file, NAMES)
    error = caught.value
    assert (error.file, error.line, error.column) == (file, line, column)
    assert found in error.found
    assert error.exit_status == 2


@pytest.mark.parametrize("content", [b"", b"# nothing\n\n", b"\xff\xfe\x00", None])
def test_a_file_that_is_empty_missing_or_no_text_is_refused(file: Path, content: bytes | None) -> None:
    if content is not None:
        file.write_bytes(content)
    with pytest.raises(WaypointFileError, match=r"waypoints\.csv"):
        read_waypoints(file, NAMES)
