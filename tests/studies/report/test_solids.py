"""Tubes and plates as faces for a drawing."""

import numpy as np

from kinematics import PlacedShape
from studies.report.solids import faces


def test_the_side_of_a_tube_is_as_far_from_its_axis_as_its_radius() -> None:
    start, end = np.array([0.1, 0.2, 0.3]), np.array([0.5, -0.1, 0.9])
    corners = np.vstack(faces(PlacedShape("rod", "rod", np.array([start, end]), 0.02)))
    along = (end - start) / np.linalg.norm(end - start)
    from_start = corners - start
    aside = from_start - np.outer(from_start @ along, along)
    np.testing.assert_allclose(np.linalg.norm(aside, axis=1), 0.02, rtol=1e-12)


def test_a_plate_has_two_faces_half_of_its_thickness_from_its_outline() -> None:
    outline = np.array([[0.0, 0, 1], [0.2, 0, 1], [0.2, 0.1, 1], [0, 0.1, 1]])
    corners = np.vstack(faces(PlacedShape("plate", "plate", outline, 0.006)))
    assert np.unique(corners[:, 2].round(12)).tolist() == [0.994, 1.006]
    assert all(len(face) == 4 for face in faces(PlacedShape("plate", "plate", outline[:3], 0.006)))
