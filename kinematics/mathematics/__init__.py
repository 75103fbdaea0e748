"""General mathematics: real roots, path tracking, symbolic linear algebra, distances, orientations."""

from kinematics.mathematics.bisection import bisected
from kinematics.mathematics.convex_distance import Convex, shortest_way, signed_distance
from kinematics.mathematics.distinct_solutions import distinct, gaps, working_first
from kinematics.mathematics.double_roots import not_below_zero
from kinematics.mathematics.homotopy import refine, track
from kinematics.mathematics.jacobi_rotations import singular_values
from kinematics.mathematics.linear_forms import LinearForms
from kinematics.mathematics.orientation import angles, rotation, rotation_symbolic, turn
from kinematics.mathematics.polynomials import product, real_roots
from kinematics.mathematics.positive_definite import (
    cholesky,
    lower_solved,
    root_inverse,
    row_sums,
    smallest_eigenvalue,
)
from kinematics.mathematics.rigid_displacements import displacement, leg_quadrics, study_quadric
from kinematics.mathematics.scaling import near_inverse
from kinematics.mathematics.segment_distance import segment_distances
from kinematics.mathematics.symbolic_linear_algebra import Minors, adjugate, determinant, volume

__all__ = [
    "Convex",
    "LinearForms",
    "Minors",
    "adjugate",
    "angles",
    "bisected",
    "cholesky",
    "determinant",
    "displacement",
    "distinct",
    "gaps",
    "leg_quadrics",
    "lower_solved",
    "near_inverse",
    "not_below_zero",
    "product",
    "real_roots",
    "refine",
    "root_inverse",
    "rotation",
    "rotation_symbolic",
    "row_sums",
    "segment_distances",
    "shortest_way",
    "signed_distance",
    "singular_values",
    "smallest_eigenvalue",
    "study_quadric",
    "track",
    "turn",
    "volume",
    "working_first",
]
