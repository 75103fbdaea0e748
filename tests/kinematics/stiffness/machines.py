"""The mechanisms as frames of beams and bars, from their geometry's numbers and the places where their pictures are."""

import numpy as np

from tests.kinematics.stiffness.frame import E_Z, Frame, ring

X, Y, Z, RX, RY, RZ = np.eye(6)


def arm(frame, base, elbow, axis, drive, material, section):
    """A beam on a drive that turns about an axis; returns the node at its end."""
    root, tip = frame.node(base), frame.node(elbow)
    frame.ground(root, np.concatenate([np.zeros(3), axis]), drive)
    frame.beam(root, tip, material, section)
    return tip


def rod(frame, robot, carrier, start, platform, end, material, section):
    """A rod between ball joints on two bodies, with the joints' own stiffness in series."""
    length = np.linalg.norm(np.subtract(end, start))
    give = length / (material.modulus * section[0]) + 2 / robot.structure.joint_stiffness
    frame.bar(carrier, start, platform, end, 1 / give)


def rotary(frame, robot, pose, bodies, width):
    """Arms and rods (two of them `width` apart, or one); `bodies` gives each limb's platform node."""
    g, s, lines = robot.geometry, robot.structure, robot.polylines(pose)
    drive = robot.inertia.drive_train.of_actuators("stiffness", len(bodies))
    ends = platform_points(robot, pose)
    for i, body in enumerate(bodies):
        base, elbow = lines[f"arm {i + 1}"]
        axis = np.cross(E_Z, arm_direction(robot, i))
        tip = arm(frame, base, elbow, axis, drive[i], s.arm, ring(g.arm_radius, g.arm_wall))
        for side in (0.0,) if width is None else (-0.5, 0.5):
            aside = side * (width or 0.0) * axis
            rod(frame, robot, tip, elbow + aside, body, ends[i] + aside, s.rod, ring(g.rod_radius, g.rod_wall))


def arm_direction(robot, i):
    g = robot.geometry
    azimuth = (g.azimuths if hasattr(g, "azimuths") else g.arm_azimuths)[i]
    return np.array([np.cos(azimuth), np.sin(azimuth), 0.0])


def platform_points(robot, pose):
    """Where the rods meet the platform, by the pictures."""
    lines, m = robot.polylines(pose), len(robot.joint_names)
    if "rod 1" in lines:
        return [lines[f"rod {i + 1}"][1] for i in range(m)]
    return [lines[f"rods {i + 1}"][[1, 2]].mean(axis=0) for i in range(m)]


def heli4(robot, pose):
    frame, place = Frame(), pose[:3]
    lower, upper, tool = (frame.node(place) for _ in range(3))
    rotary(frame, robot, pose, [lower, lower, upper, upper], robot.geometry.parallelogram_width)
    frame.hinge(lower, tool, E_Z)
    frame.joint(tool, upper, [X, Y, RX, RY])
    lead = robot.geometry.pitch / (2 * np.pi)  # the upper plate rises as the screw turns in it
    frame.constrain({upper: Z + lead * RZ, tool: -Z - lead * RZ})
    return frame, tool, [X, Y, Z, RZ]


def delta(robot, pose):
    frame = Frame()
    plate = frame.node(pose)
    rotary(frame, robot, pose, [plate] * 3, robot.geometry.parallelogram_width)
    return frame, plate, [X, Y, Z]


def par4(robot, pose):
    """Two halves, two bars that hinge on them beside each other, and a gear between bar, half and tool."""
    g, frame = robot.geometry, Frame()
    turned = g.bar_angle + pose[3] / g.amplification
    half = g.bar_length / 2 * np.array([np.cos(turned), np.sin(turned), 0.0])
    first, second, tool = (frame.node(p) for p in (pose[:3] - half, pose[:3] + half, pose[:3]))
    for aside in (-0.03, 0.03):
        offset = aside * np.array([1.0, 0.3, 0.0])
        bar = frame.node(pose[:3] + offset)
        for body, place in ((first, pose[:3] - half), (second, pose[:3] + half)):
            pin = frame.node(place + offset)
            frame.rigid(body, pin)
            frame.hinge(bar, pin, E_Z)
    middle = frame.node(pose[:3])  # of the bars, on the last of them
    shift = np.eye(6)[:3]
    for k in range(3):
        frame.constrain({first: shift[k] / 2, second: shift[k] / 2, middle: -shift[k]})
        frame.constrain({first: np.eye(6)[3 + k], middle: -np.eye(6)[3 + k]})
    frame.joint(middle, tool, [X, Y, Z, RX, RY])
    k = g.amplification  # tool less half is k times bar less half
    frame.constrain({tool: RZ, first: (k - 1) * RZ, bar: -k * RZ})
    rotary(frame, robot, pose, [first, first, second, second], g.parallelogram_width)
    return frame, tool, [X, Y, Z, RZ]


def hexa(robot, pose):
    frame = Frame()
    platform = frame.node(pose[:3])
    rotary(frame, robot, pose, [platform] * 6, None)
    return frame, platform, np.eye(6)


def redundant(robot, pose):
    g, frame, s = robot.geometry, Frame(), robot.structure
    platform, lines = frame.node(pose[:3]), robot.polylines(pose)
    for i, drive in enumerate(robot.inertia.drive_train.of_actuators("stiffness", 6)):
        pair = f"rods {i + 1}" in lines
        corners = lines[f"rods {i + 1}"] if pair else lines[f"arm {i + 1}"]
        slide = frame.node(corners[[0, 3]].mean(axis=0) if pair else corners[0])
        frame.ground(slide, X, drive)
        for start, end in ((0, 1), (3, 2)) if pair else ((0, 1),):
            rod(frame, robot, slide, corners[start], platform, corners[end], s.rod, ring(g.rod_radius, g.rod_wall))
    return frame, platform, [X, Y, Z, RZ]


def hexapod(robot, pose):
    g, frame = robot.geometry, Frame()
    platform, lines = frame.node(pose[:3]), robot.polylines(pose)
    for i, drive in enumerate(robot.inertia.drive_train.of_actuators("stiffness", 6)):
        start, end = lines[f"leg {i + 1}"]
        slide = frame.node(start)
        frame.ground(slide, np.concatenate([(end - start) / np.linalg.norm(end - start), np.zeros(3)]), drive)
        rod(frame, robot, slide, start, platform, end, robot.structure.leg, ring(g.leg_radius, g.leg_wall))
    return frame, platform, np.eye(6)


def planar(robot, pose):
    """3-RRR, 3-PRR and 3-RPR: the platform stays in its plane."""
    g, frame, s = robot.geometry, Frame(), robot.structure
    platform, lines = frame.node([*pose[:2], 0.0]), robot.polylines(pose)
    for row in (Z, RX, RY):
        frame.constrain({platform: row})
    section = ring(g.link_radius, g.link_wall)
    for i, drive in enumerate(robot.inertia.drive_train.of_actuators("stiffness", 3)):
        base, centre, end = lines[f"leg {i + 1}"]
        if hasattr(g, "arm_lengths"):
            carrier = arm(frame, base, centre, E_Z, drive, s.link, section)
        else:
            along = end - base
            if hasattr(g, "rail_angles"):
                along = np.array([np.cos(g.rail_angles[i]), np.sin(g.rail_angles[i]), 0.0])
            carrier = frame.node(centre)
            frame.ground(carrier, np.concatenate([along / np.linalg.norm(along), np.zeros(3)]), drive)
        rod(frame, robot, carrier, centre, platform, end, s.link, section)
    return frame, platform, [X, Y, RZ]


def peppermill(robot, pose):
    """Limbs of two hinged beams on carriages that two motors push and turn; nuts on one screw."""
    g, frame, material = robot.geometry, Frame(), robot.structure.link
    tool, lines, rate = frame.node(pose[:3]), robot.polylines(pose), 2 * np.pi / robot.geometry.drive_pitch
    section = ring(g.link_radius, g.link_wall)
    drives = robot.inertia.drive_train.of_actuators("stiffness", 4)
    for i, lead in enumerate(np.array(g.pitches) / (2 * np.pi)):
        apart = (i - 0.5) * g.nut_spacing * E_Z
        carriage, elbow = lines[f"proximal {i + 1}"] + apart
        nut_place = lines[f"distal {i + 1}"][1] + apart
        axis = np.eye(3)[i]
        root, near, far, tip, nut = (frame.node(p) for p in (carriage, elbow, elbow, nut_place, nut_place))
        motors = np.array([[rate, 1.0], [-rate, 1.0]])
        slides, turns = np.concatenate([axis, np.zeros(3)]), np.concatenate([np.zeros(3), axis])
        frame.ground(root, [slides, turns], motors.T @ np.diag(drives[2 * i : 2 * i + 2]) @ motors)
        frame.beam(root, near, material, section)
        frame.hinge(near, far, axis)
        end = frame.node(nut_place)
        give = 2 / robot.structure.joint_stiffness
        frame.beam(far, end, material, section)
        along = (nut_place - elbow) / np.linalg.norm(nut_place - elbow)
        pinned = frame.node(nut_place)
        frame.sprung(end, pinned, along, give)
        frame.rigid(pinned, tip)
        frame.hinge(tip, nut, axis)
        frame.joint(tool, nut, [X, Y, RX, RY])  # the nut slides and turns on the screw, by its lead
        on_axis = nut_place - pose[:3]
        assert np.abs(on_axis[:2]).max() < 1e-12
        frame.constrain({nut: Z + lead * RZ, tool: -Z - lead * RZ})
    return frame, tool, [X, Y, Z, RZ]


FRAMES = {
    "Heli4": heli4,
    "Delta": delta,
    "Par4": par4,
    "Hexa": hexa,
    "Redundant3T1R": redundant,
    "GoughStewart": hexapod,
    "Planar3RRR": planar,
    "Planar3PRR": planar,
    "Planar3RPR": planar,
    "Peppermill": peppermill,
}
