"""Mobility of a mechanism of rigid parts and joints: Gruebler's count, and the rank that confirms it.

The count is of Krut et al. 2006, (37)-(45). It only looks at the graph; the rank looks at the joints' places and axes
in one pose, so it sees singularities. With m the mobility index, m_K the kinematic mobility and m_S the degree of
constraint, m = m_K - m_S: the paper's (44) prints a plus, which holds as well only where m_S = 0.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Value
from kinematics.errors import InvalidValue
from kinematics.machine import TURN

FREEDOMS = {"fixed": 0, "R": 1, "P": 1, "H": 1, "C": 2, "U": 2, "S": 3}
_AXES = {"fixed": 0, "R": 1, "P": 1, "H": 1, "C": 1, "U": 2, "S": 0}


class GrueblerCount(NamedTuple):
    """What the graph alone tells; symbols of the paper in brackets."""

    parts: int  # p
    joints: int  # n
    loops: int  # nu (37)
    unknown_velocities: int  # U_K (38), (39): the joints' freedoms
    velocity_equations: int  # E_K (40)
    unknown_forces: int  # U_S (41)
    force_equations: int  # E_S (42)

    @property
    def mobility(self) -> int:
        """m of (43)."""
        return self.unknown_velocities - self.velocity_equations


class Mobility(NamedTuple):
    """What the rank of all velocity constraints tells at one pose, and how clearly."""

    kinematic: int  # m_K: independent motions
    constraint: int  # m_S: redundant constraints
    smallest_kept: float  # of the singular values, over the largest
    largest_dropped: float

    @property
    def mobility(self) -> int:
        """m = m_K - m_S, the same at every pose."""
        return self.kinematic - self.constraint


@dataclass(frozen=True, eq=False)
class Joint(Value):
    """A joint between two parts, at a place (3,) [m] of the pose in question.

    Attributes:
        kind: R revolute, P prismatic, H helical, C cylindrical, U universal, S spherical, or fixed.
        axes: unit axes (3,): none for S and fixed, two for U, one for the others.
        pitch: of H, in metres per turn: how far `second` moves along the axis in one turn about it from `first`.
        driven: whether an actuator moves it.
    """

    kind: str
    first: str
    second: str
    place: np.ndarray
    axes: tuple[np.ndarray, ...] = ()
    pitch: float = 0.0
    driven: bool = False

    def __post_init__(self) -> None:
        if self.kind not in FREEDOMS:
            raise InvalidValue("joint kind", self.kind, f"one of {', '.join(FREEDOMS)}")
        if len(self.axes) != _AXES[self.kind]:
            raise InvalidValue(f"axes of a joint {self.kind}", len(self.axes), str(_AXES[self.kind]))

    @property
    def freedoms(self) -> int:
        """f, how many independent velocities the joint leaves."""
        return FREEDOMS[self.kind]

    def motions(self) -> np.ndarray:
        """(6, f) twists (omega, v at the joint's place) of `second` relative to `first`."""
        zero = np.zeros(3)
        if self.kind == "S":
            return np.vstack([np.eye(3), np.zeros((3, 3))])
        turns = [np.concatenate([a, self.pitch / TURN * a]) for a in self.axes if self.kind != "P"]
        slides = [np.concatenate([zero, a]) for a in self.axes if self.kind in "PC"]
        return np.array([*turns, *slides]).reshape(-1, 6).T


@dataclass(frozen=True)
class JointGraph:
    """Parts joined by joints; `base` names the part that does not move."""

    joints: tuple[Joint, ...]
    base: str = "base"

    @property
    def parts(self) -> tuple[str, ...]:
        """Every part, the base first."""
        named = dict.fromkeys(part for joint in self.joints for part in (joint.first, joint.second))
        return (self.base, *(part for part in named if part != self.base))

    @property
    def _size(self) -> float:
        """Distance of the farthest joint, which makes lengths and angles comparable [m]."""
        return max(float(np.linalg.norm(j.place)) for j in self.joints) or 1.0

    def with_drives_locked(self) -> JointGraph:
        """The same mechanism with its actuators holding: redundant constraints then show parallel singularities."""
        held = (replace(j, kind="fixed", axes=()) if j.driven else j for j in self.joints)
        return replace(self, joints=tuple(held))

    def count(self) -> GrueblerCount:
        """Gruebler's count, (37)-(42)."""
        p, n, freedoms = len(self.parts), len(self.joints), sum(j.freedoms for j in self.joints)
        return GrueblerCount(p, n, n - p + 1, freedoms, 6 * (n - p + 1), 6 * n - freedoms, 6 * (p - 1))

    def constraints(self) -> np.ndarray:
        """(sum of 6 - f, 6 (p - 1)) equations on the twists (omega, v at the origin) of all parts but the base.

        Each joint's rows are orthonormal once lengths are divided by the distance of the farthest joint.
        """
        parts = self.parts
        length = self._size
        units = np.array([1.0] * 3 + [1.0 / length] * 3)
        rows = []
        for joint in self.joints:
            allowed = units[:, None] * joint.motions()
            forbidden = np.linalg.svd(allowed)[0][:, joint.freedoms :].T if joint.freedoms else np.eye(6)
            row = np.zeros((6 - joint.freedoms, len(parts), 6))
            row[:, parts.index(joint.second)] = forbidden @ _moved_to(joint.place / length)
            row[:, parts.index(joint.first)] = -row[:, parts.index(joint.second)]
            rows.append(row[:, 1:].reshape(len(row), -1))
        return np.vstack(rows)

    def motions(self, tolerance: float = 1e-9) -> np.ndarray:
        """(m_K, p, 6) independent motions: twists (omega, v at the origin) [rad/s, m/s] of all parts, base first."""
        matrix = self.constraints()
        kept = int((_shares(matrix) > tolerance).sum())
        free = np.linalg.svd(matrix)[2][kept:].reshape(-1, len(self.parts) - 1, 6)
        free[..., 3:] *= self._size
        return np.concatenate([np.zeros((len(free), 1, 6)), free], axis=1)

    def mobility(self, tolerance: float = 1e-9) -> Mobility:
        """m_K and m_S from the rank of `constraints`: singular values up to `tolerance` of the largest count as 0."""
        matrix = self.constraints()
        shares = _shares(matrix)
        kept = shares > tolerance
        rank = int(kept.sum())
        dropped = float(shares[~kept].max(initial=0.0))
        return Mobility(matrix.shape[1] - rank, matrix.shape[0] - rank, float(shares[kept].min(initial=1.0)), dropped)


def _moved_to(place: np.ndarray) -> np.ndarray:
    """(6, 6) from a twist at the origin to the same twist at a place: v + omega x place."""
    x, y, z = place
    result = np.eye(6)
    result[3:, :3] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]
    return result


def _shares(matrix: np.ndarray) -> np.ndarray:
    values = np.linalg.svd(matrix, compute_uv=False)
    result: np.ndarray = values / values[0]
    return result
