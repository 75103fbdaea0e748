"""The internal determinant: how far single rods are from losing the platform's orientation; Krut et al. 2006, (59)."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import casadi as ca

from kinematics.model import Margin, Measure, Mechanism

if TYPE_CHECKING:
    from kinematics.robots.shared.paired_rods import RodLevel


class InternalDeterminant(Margin):
    """|det J_int|, dimensionless in [0, 1]; of mechanisms that state the length of each single rod."""

    name = "internal_determinant"
    words = "internal determinant, its modulus in [0, 1]; of Heli4 |(59)| over d^4 l^4"
    holds_on_paths = True
    singularity = "internal"

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        """One."""
        return ca.fabs(cast("RodLevel", robot).internal_determinant_symbolic())


INTERNAL_DETERMINANT = InternalDeterminant()
