"""Statics of a limb: the forces that it transmits to the platform, how it gives way, what its members bear."""

from __future__ import annotations

from typing import NamedTuple

import casadi as ca


class Cut(NamedTuple):
    """What the platform's side of a limb exerts on the base's side through a cut across a member.

    A member that is loaded only at its ends bears its largest moment at one of them, so its cuts are there.

    Attributes:
        member: its name.
        along: (3,) unit direction of the member, towards the platform.
        force: (3, k) for each transmitted force of 1 [N or N m].
        moment: (3, k) about the middle of the cut [N m]; without entries for a rod between ball joints.
    """

    member: str
    along: ca.SX
    force: ca.SX
    moment: ca.SX

    @property
    def tension(self) -> ca.SX:
        """(1, k) the force along the member, below 0 for compression."""
        result: ca.SX = self.along.T @ self.force
        return result


class LimbStatics(NamedTuple):
    """What a limb does when it transmits k independent forces to the platform, each of them 1 [N or N m].

    Virtual work with locked drives, and with rigid members, makes wrenches^T v = efforts^T q'.

    Attributes:
        wrenches: (f, k) on the platform's f freedoms: the twist first, then what the pose does not have, such as tilts.
        compliance: (k, k) how far the limb gives way along force i under force j, with rigid drives.
        efforts: (m, k) what the drives of the joints bear [N or N m].
        cuts: the loads of the members.
    """

    wrenches: ca.SX
    compliance: ca.SX
    efforts: ca.SX
    cuts: tuple[Cut, ...] = ()


def rod_cut(name: str, along: ca.SX, column: int, count: int) -> Cut:
    """Of a rod that is in tension by the force `column` of `count`, and by no other."""
    unit = ca.SX(1, count)
    unit[0, column] = 1
    return Cut(name, along, along @ unit, ca.SX(3, count))
