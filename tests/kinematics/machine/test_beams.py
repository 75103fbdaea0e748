"""One beam against the textbook, in a direction of no axis."""

import casadi as ca
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinematics.machine import MATERIALS, Beam, Section, Tube

STEEL, LENGTH = MATERIALS["steel"], 0.7
TURN = Rotation.from_rotvec([0.4, -1.1, 0.8]).as_matrix()  # along, and two directions across


def beam(radius=0.03, wall=0.004):
    tube = Tube(ca.SX(3, 1), ca.SX(LENGTH * TURN[:, 0]), ca.SX(radius), ca.SX(wall))
    return Beam(ca.SX(TURN[:, 0]), ca.SX(LENGTH), Section.of(tube), STEEL)


def numbers(expression):
    return np.array(ca.DM(ca.evalf(expression)))


def test_a_ring_is_a_disc_less_a_disc_and_a_bar_is_solid():
    ring, bar = beam(0.03, 0.004).section, beam(0.03, 0.03).section
    assert float(ring.area) == pytest.approx(np.pi * (0.03**2 - 0.026**2))
    assert float(ring.second_moment) == pytest.approx(np.pi / 64 * (0.06**4 - 0.052**4))
    assert float(bar.area) == pytest.approx(np.pi * 0.03**2)
    assert float(bar.second_moment) == pytest.approx(np.pi / 64 * 0.06**4)


def test_six_loads_on_the_tip_give_the_textbooks_sags_and_turns():
    one = beam()
    area, inertia = float(one.section.area), float(one.section.second_moment)
    force, moment = np.hstack([TURN, np.zeros((3, 3))]), np.hstack([np.zeros((3, 3)), TURN])
    found = numbers(one.compliance(ca.SX(force), ca.SX(moment)))
    bending = STEEL.modulus * inertia
    expected = np.diag(
        [
            LENGTH / (STEEL.modulus * area),
            *[LENGTH**3 / (3 * bending)] * 2,
            LENGTH / (STEEL.shear_modulus * 2 * inertia),
            *[LENGTH / bending] * 2,
        ]
    )
    expected[1, 5] = expected[5, 1] = LENGTH**2 / (2 * bending)  # a force along y turns the tip about z
    expected[2, 4] = expected[4, 2] = -(LENGTH**2) / (2 * bending)
    np.testing.assert_allclose(found, expected, atol=1e-12 * expected.max())


def test_a_force_on_the_tip_is_a_moment_at_the_root_by_its_lever():
    found = numbers(beam().moment_at_root(ca.SX(TURN), ca.SX(np.zeros((3, 3)))))
    expected = np.cross(LENGTH * TURN[:, 0], TURN.T).T
    np.testing.assert_allclose(found, expected, atol=1e-15)
