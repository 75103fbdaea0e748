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
    words = "how far the rods are from an internal singularity: 0 on it, 1 at most; of Heli4 by (59)"
    holds_on_paths = True
    singularity = "internal"

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        """One."""
        return ca.fabs(cast("RodLevel", robot).internal_determinant_symbolic())


INTERNAL_DETERMINANT = InternalDeterminant()
