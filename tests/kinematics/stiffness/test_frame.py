"""The oracle itself: frames against closed forms of one beam and of two tubes."""

import numpy as np
import pytest

from kinematics.machine import MATERIALS
from tests.kinematics.stiffness.frame import Frame, ring

STEEL, ALUMINIUM = MATERIALS["steel"], MATERIALS["aluminium"]


@pytest.mark.parametrize("elements", [1, 3, 7])
def test_a_cantilever_sags_by_the_textbooks_in_any_number_of_elements(elements):
    frame, length, section = Frame(), 0.4, ring(0.02, 0.002)
    root, tip = frame.node([0.1, 0, 0]), frame.node([0.1, length, 0])  # along y
    for row in np.eye(6):
        frame.constrain({root: row})
    frame.beam(root, tip, STEEL, section, elements)
    found = frame.compliance(tip, np.eye(6))
    bending, twist = STEEL.modulus * section[1], STEEL.shear_modulus * 2 * section[1]
    expected = np.diag([length**3 / (3 * bending), length / (STEEL.modulus * section[0]), length**3 / (3 * bending),
                        length / bending, length / twist, length / bending])  # fmt: skip
    expected[0, 5] = expected[5, 0] = -(length**2) / (2 * bending)
    expected[2, 3] = expected[3, 2] = length**2 / (2 * bending)
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-9 * length**2 / bending)


def test_two_tubes_in_a_row_stretch_as_springs_in_series():
    frame, sections = Frame(), (ring(0.02, 0.002), ring(0.01, 0.001))
    first, middle, last = (frame.node([0, 0, z]) for z in (0.0, 0.3, 0.8))
    for row in np.eye(6):
        frame.constrain({first: row})
    frame.beam(first, middle, STEEL, sections[0])
    frame.beam(middle, last, ALUMINIUM, sections[1])
    found = frame.compliance(last, np.eye(6)[2:3])[0, 0]
    expected = 0.3 / (STEEL.modulus * sections[0][0]) + 0.5 / (ALUMINIUM.modulus * sections[1][0])
    assert found == pytest.approx(expected, rel=1e-9)
