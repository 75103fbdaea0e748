"""Mobility [8.1]-[8.4] against every number of chapter 8."""

from __future__ import annotations

import pytest

from kinematics import ARCHITECTURES, InvalidValue, loop_mobility, mobility_of_identical_chains
from kinematics.mobility.architectures import (
    PLANAR,
    SPATIAL,
    mobility_of_planar_three_legs,
    mobility_of_spatial_three_legs,
)

CHAPTER = {  # N, legs n_c, a leg's freedoms d, constraints c_j of a loop, as the text states them
    "planar R-P-R": (3, 3, 3, 3),
    "planar P-R-R": (3, 3, 3, 3),
    "planar R-R-R": (3, 3, 3, 3),
    "spatial R-P-(RRR)": (3, 3, 5, 6),
    "spatial R-(RR)-(RR)": (3, 3, 5, 6),
    "Gough-Stewart (RR)-P-(RRR)": (6, 6, 6, 6),
    "hexapod R-(RR)-(RRR)": (6, 6, 6, 6),
    "C5 P-(RRRPP)": (6, 6, 6, 6),
    "Space robot R-R-P-(RRR)": (6, 3, 6, 6),
    "Delta R-(RR)-(RR)": (3, 3, 5, 6),
    "Hexa R-(RR)-(RRR)": (6, 6, 6, 6),
}


@pytest.mark.parametrize("name", sorted(CHAPTER | ARCHITECTURES))
def test_each_architecture_has_the_mobility_legs_freedoms_and_loops_that_the_chapter_states(name: str) -> None:
    architecture = ARCHITECTURES[name]
    found = architecture.mobility, architecture.legs, architecture.freedoms, architecture.constraints
    assert found == CHAPTER[name]
    assert name.split()[-1] == "-".join(j if len(j) == 1 else f"({j})" for j in architecture.joints)
    same = mobility_of_identical_chains(architecture.legs, architecture.freedoms, architecture.constraints)
    assert same == architecture.mobility


def test_8_3_and_8_4_are_8_2_for_three_legs() -> None:
    for d in range(1, 7):
        assert mobility_of_planar_three_legs(d) == 3 * d - 6 == mobility_of_identical_chains(3, d, PLANAR)
        assert mobility_of_spatial_three_legs(d) == 3 * d - 12 == mobility_of_identical_chains(3, d, SPATIAL)


def test_the_chapters_conclusions_about_a_legs_freedoms() -> None:
    """N = 3 needs d = 3 in the plane and 5 in space; N = 6 d - 30 = 6 needs d = 6."""
    assert [d for d in range(1, 10) if mobility_of_planar_three_legs(d) == 3] == [3]
    assert [d for d in range(1, 10) if mobility_of_spatial_three_legs(d) == 3] == [5]
    assert [d for d in range(1, 10) if mobility_of_identical_chains(6, d, SPATIAL) == 6] == [6]


def test_8_1_takes_unlike_joints_and_loops() -> None:
    assert loop_mobility([1, 1, 1, 1], [PLANAR]) == 1  # the four-bar linkage
    assert loop_mobility([1, 2, 3, 1], [SPATIAL]) == 1  # the spatial RUSR
    assert loop_mobility([1, 1, 1], []) == 3  # an open chain


@pytest.mark.parametrize(
    "call",
    [
        lambda: loop_mobility([0, 1], [3]),
        lambda: loop_mobility([6], []),
        lambda: loop_mobility([1, 1], [4]),
        lambda: mobility_of_identical_chains(1, 6, SPATIAL),
        lambda: mobility_of_identical_chains(3, 0, SPATIAL),
        lambda: mobility_of_identical_chains(3, 5, 5),
    ],
)
def test_impossible_counts_are_refused(call: object) -> None:
    with pytest.raises(InvalidValue):
        call()  # type: ignore[operator]
