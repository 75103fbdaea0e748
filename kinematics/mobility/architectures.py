"""Mobility of parallel architectures by their closed loops (Khalil and Dombre 2002, [8.1]-[8.4]).

The count ignores dimensions, so it may be wrong for a special geometry. The chapter says that it holds "for a large
number of architectures"; `ARCHITECTURES` are those that it lists.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from kinematics.errors import InvalidValue

PLANAR, SPATIAL = 3, 6  # constraints of a closed loop, c_j


def loop_mobility(joint_mobilities: Sequence[int], loop_constraints: Sequence[int]) -> int:
    """N, the mobility of all joints less the constraints of the independent loops; [8.1].

    Args:
        joint_mobilities: m_i of every joint of the mechanism.
        loop_constraints: c_j of every independent loop: 3 if planar, 6 if spatial.

    Raises:
        InvalidValue: a joint's mobility is outside 1..5 or a loop has other constraints.
    """
    if any(m not in range(1, 6) for m in joint_mobilities):
        raise InvalidValue("joint_mobilities", list(joint_mobilities), "1 to 5 for each joint")
    if any(c not in (PLANAR, SPATIAL) for c in loop_constraints):
        raise InvalidValue("loop_constraints", list(loop_constraints), "3 (planar) or 6 (spatial) for each loop")
    return sum(joint_mobilities) - sum(loop_constraints)


def mobility_of_identical_chains(chains: int, freedoms: int, constraints: int) -> int:
    """N = n_c d - c_j B with B = n_c - 1 loops; [8.2].

    Args:
        chains: n_c, between base and platform.
        freedoms: d, the sum of a chain's joint mobilities.
        constraints: c_j of each loop.

    Raises:
        InvalidValue: fewer than two chains, no freedom, or loops neither planar nor spatial.
    """
    if chains < 2:
        raise InvalidValue("chains", chains, "at least 2")
    if freedoms < 1:
        raise InvalidValue("freedoms", freedoms, "at least 1")
    if constraints not in (PLANAR, SPATIAL):
        raise InvalidValue("constraints", constraints, "3 (planar) or 6 (spatial)")
    return chains * freedoms - constraints * (chains - 1)


def mobility_of_planar_three_legs(freedoms: int) -> int:
    """N = 3 d - 6 of three identical planar legs with d freedoms each; [8.3]."""
    return mobility_of_identical_chains(3, freedoms, PLANAR)


def mobility_of_spatial_three_legs(freedoms: int) -> int:
    """N = 3 d - 12 of three identical spatial legs with d freedoms each; [8.4]."""
    return mobility_of_identical_chains(3, freedoms, SPATIAL)


@dataclass(frozen=True)
class Architecture:
    """Identical legs between a base and a platform.

    Attributes:
        legs: n_c.
        joints: a leg's joints from base to platform, each as its elementary ones: "R", "P", "RR", "RRR", "RRRPP".
        constraints: c_j of each loop.
        section: where the chapter describes it.
    """

    legs: int
    joints: tuple[str, ...]
    constraints: int
    section: str

    @property
    def freedoms(self) -> int:
        """d, of one leg."""
        return sum(len(joint) for joint in self.joints)

    @property
    def mobility(self) -> int:
        """N, joint by joint and loop by loop; [8.1]."""
        mobilities = [len(joint) for joint in self.joints] * self.legs
        return loop_mobility(mobilities, [self.constraints] * (self.legs - 1))


ARCHITECTURES: dict[str, Architecture] = {
    "planar R-P-R": Architecture(3, ("R", "P", "R"), PLANAR, "8.5.1"),
    "planar P-R-R": Architecture(3, ("P", "R", "R"), PLANAR, "8.5.1"),
    "planar R-R-R": Architecture(3, ("R", "R", "R"), PLANAR, "8.5.1"),
    "spatial R-P-(RRR)": Architecture(3, ("R", "P", "RRR"), SPATIAL, "8.5.2.1"),
    "spatial R-(RR)-(RR)": Architecture(3, ("R", "RR", "RR"), SPATIAL, "8.5.2.1"),
    "Gough-Stewart (RR)-P-(RRR)": Architecture(6, ("RR", "P", "RRR"), SPATIAL, "8.5.2.2"),
    "hexapod R-(RR)-(RRR)": Architecture(6, ("R", "RR", "RRR"), SPATIAL, "8.5.2.2"),
    "C5 P-(RRRPP)": Architecture(6, ("P", "RRRPP"), SPATIAL, "8.5.2.2"),
    "Space robot R-R-P-(RRR)": Architecture(3, ("R", "R", "P", "RRR"), SPATIAL, "8.5.2.2"),
    "Delta R-(RR)-(RR)": Architecture(3, ("R", "RR", "RR"), SPATIAL, "8.5.3"),
    "Hexa R-(RR)-(RRR)": Architecture(6, ("R", "RR", "RRR"), SPATIAL, "8.5.3"),
}
