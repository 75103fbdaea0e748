"""Loads over a cycle: impulses on the frame balance; peaks and means are those of dense samples."""

import numpy as np
import pytest

from kinematics import Delta, by_name, frame_reaction, member_forces
from trajectory import Limits, RoundedPath, frame_peaks, frame_reaction_text, member_peaks, there_and_back, time_optimal

G = 9.80665
PERIOD = 0.001
THERE, BACK = 2.0, 0.5


class Bare(Delta):
    """Without the proof of its clearance, which takes longer than all the rest."""

    margins = by_name(*(margin for name, margin in Delta.margins.items() if name != "clearance"))


@pytest.fixture(scope="module")
def cycle():
    robot = Bare()
    places = ((-0.05, 0.0, 0.0), (-0.05, 0.0, 0.03), (0.05, 0.0, 0.03), (0.05, 0.0, 0.0))
    poses = tuple(tuple((robot.home + place).tolist()) for place in places)
    path = RoundedPath(robot.pose_names, poses, (0.01, 0.01))
    return there_and_back(robot, path, Limits(speed=10.0, acceleration=200.0), THERE, time_optimal, BACK)


@pytest.fixture(scope="module")
def rows(cycle):
    lines = frame_reaction_text(cycle, PERIOD).splitlines()
    assert lines[3] == "t,force_x,force_y,force_z,moment_x,moment_y,moment_z"
    return np.array([[float(cell) for cell in line.split(",")] for line in lines[4:]])


def test_from_rest_to_rest_the_mean_force_is_the_weight_that_is_carried(cycle):
    """Each way has its own payload; the force is smooth but where s'' jumps, so many samples approach its integral."""
    still = np.zeros(3)
    for piece in cycle.pieces:
        times = (np.arange(20_000) + 0.5) / 20_000 * piece.duration
        motion = piece.motion.at(times)
        force = frame_reaction(cycle.robot, piece.payload, motion.pose, motion.velocity, motion.acceleration).force
        weight = frame_reaction(cycle.robot, piece.payload, cycle.robot.home, still, still).force
        assert np.abs(force - weight).max() > 0.1 * np.abs(weight).max()
        np.testing.assert_allclose(force.mean(axis=0), weight, atol=1e-3 * np.abs(force).max())


def test_peaks_and_means_are_those_of_dense_samples(cycle):
    found = frame_peaks(cycle)
    starts = np.cumsum([0.0, *(piece.duration for piece in cycle.pieces)])
    samples = {"force": [], "moment": []}
    for piece in cycle.pieces:
        motion = piece.motion.at((np.arange(30_000) + 0.5) / 30_000 * piece.duration)
        reaction = frame_reaction(cycle.robot, piece.payload, motion.pose, motion.velocity, motion.acceleration)
        for name, values in samples.items():
            values.append(getattr(reaction, name))
    lasting = np.diff(starts)
    for name, values in samples.items():
        size = np.linalg.norm(values, axis=-1)
        assert found[name].peak == pytest.approx(size.max(), rel=1e-3)
        assert found[name].peak >= size.max() * (1 - 1e-6)
        assert found[name].rms == pytest.approx(np.sqrt((size**2).mean(axis=1) @ lasting / lasting.sum()), rel=1e-4)
        np.testing.assert_allclose(found[name].axes, np.abs(values).max(axis=(0, 1)), rtol=1e-3, atol=1e-6)
        which = np.flatnonzero(found[name].time < starts[1:])[0]
        around = found[name].time - starts[which] + np.array([-1e-9, 1e-9])  # it may jump there
        motion = cycle.pieces[which].motion.at(around.clip(0.0, lasting[which]))
        sides = frame_reaction(cycle.robot, cycle.pieces[which].payload, *motion[:3])
        assert np.linalg.norm(getattr(sides, name), axis=-1).max() == pytest.approx(found[name].peak, rel=1e-5)


def test_the_file_has_a_row_for_each_set_point(cycle, rows):
    counts = [np.ceil(piece.duration / PERIOD) for piece in cycle.pieces]
    assert len(rows) == sum(counts) + 1
    np.testing.assert_allclose(rows[:, 0], np.arange(len(rows)) * PERIOD, atol=1e-12)
    assert np.linalg.norm(rows[:, 1:4], axis=1).max() == pytest.approx(frame_peaks(cycle)["force"].peak, rel=0.05)


def test_each_members_peaks_are_those_of_dense_samples(cycle):
    found, starts = member_peaks(cycle), np.cumsum([0.0, *(piece.duration for piece in cycle.pieces)])
    samples = []
    for piece in cycle.pieces:
        motion = piece.motion.at((np.arange(30_000) + 0.5) / 30_000 * piece.duration)
        samples.append(member_forces(cycle.robot, piece.payload, *motion[:3]))
    names = samples[0].names
    assert [peak.member for peak in found] == list(names)
    assert {"arm 1", "rod 1 a", "rod 3 b"} <= set(names)
    for k, peak in enumerate(found):
        for field in ("bending", "torsion", "joint_force"):
            largest = max(getattr(part, field)[:, k].max() for part in samples)
            assert getattr(peak, field) == pytest.approx(largest, rel=1e-3, abs=1e-9)
        tension = np.concatenate([part.tension[:, k] for part in samples])
        assert peak.tension == pytest.approx(max(tension.max(), 0.0), rel=1e-3, abs=1e-9)
        assert peak.compression == pytest.approx(max(-tension.min(), 0.0), rel=1e-3, abs=1e-9)
        least = min(part.safety[:, k].min() for part in samples)
        assert peak.safety == pytest.approx(least, rel=1e-3)
        assert peak.safety <= least * (1 + 1e-6)
        assert 0.0 <= min(peak.tension_at, peak.safety_at) <= max(peak.tension_at, peak.safety_at) <= starts[-1]


def test_the_smallest_factor_of_a_member_has_its_pose_and_by_what_it_fails(cycle):
    for peak in member_peaks(cycle):
        assert peak.fails_by in ("buckling", "yield") if peak.member.startswith("rod") else peak.fails_by == "yield"
        starts = np.cumsum([0.0, *(piece.duration for piece in cycle.pieces)])
        which = int(np.searchsorted(starts[1:-1], peak.safety_at, side="right"))
        piece, inside = cycle.pieces[which], peak.safety_at - starts[which]
        motion = piece.motion.at(np.clip(inside, 0.0, piece.duration))
        np.testing.assert_allclose(peak.safety_pose, motion.pose, atol=1e-9)


def test_a_heavier_way_loads_every_rod_more(cycle):
    """The same motion, there with 2 kg and back with 0.5 kg: the peaks are on the way there."""
    there = sum(piece.duration for piece in cycle.there)
    assert all(peak.tension_at <= there for peak in member_peaks(cycle) if peak.member.startswith("rod"))
