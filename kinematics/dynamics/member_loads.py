"""What the members of a robot bear: forces and moments at their cuts, as the platform moves and carries its load.

The platform's masses need a load Q on its freedoms. The limbs transmit it, W t = Q. If there are more forces t than
freedoms, their stiffness shares the load: of all t, that which stores the least energy, t = C^-1 W^T K^-1 Q. To what a
member passes on from the platform comes what its own mass and the masses that hang on it need, by d'Alembert.

Rods' masses act at their ends in Q, as `bodies` says. A rod's own mass adds, at its ends, half its weight and inertia
along it; and it bends the rod, which is a beam on two supports.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import casadi as ca

from kinematics.coordinates import is_length
from kinematics.dynamics.proper_acceleration import ProperAcceleration
from kinematics.dynamics.stiffness import transmission
from kinematics.machine import Bodies, Cut, Material, Member, Section, Tube
from kinematics.model import Mechanism, Model


class MemberLoad(NamedTuple):
    """What a member bears at a cut, in c columns: all is linear in what the columns stand for.

    Attributes:
        member: its name.
        tube, material: what bears the load.
        along: (3,) unit direction, towards the platform.
        force: (3, c) that the platform's side exerts on the base's side [N].
        moment: (3, c) about the middle of the cut [N m]; without entries for a rod between ball joints.
        ends: of a rod, what it takes to move and to hold 1 kg at its start and end, (3, c) each [N/kg]; else none.
    """

    member: str
    tube: Tube
    material: Material
    along: ca.SX
    force: ca.SX
    moment: ca.SX
    ends: tuple[ca.SX, ...] = ()

    @property
    def length(self) -> ca.SX:
        """Of the tube [m]."""
        return ca.norm_2(self.tube.end - self.tube.start)

    @property
    def section(self) -> Section:
        """Of the tube."""
        return Section.of(self.tube)

    @property
    def per_length(self) -> ca.SX:
        """Mass per length [kg/m]."""
        return self.material.density * self.section.area

    def joint_forces(self) -> list[ca.SX]:
        """(3, c) what the joints at a rod's start and end bear towards the platform, or the root of an arm [N].

        Half of a rod's mass is at each end, as in the load on the platform; each joint bears its own half besides.
        """
        half = self.per_length * self.length / 2
        return [self.force + sign * half * end for sign, end in zip((-1, 1), self.ends, strict=False)] or [self.force]

    def tensions(self) -> list[ca.SX]:
        """(1, c) the force along the member where these joints are."""
        return [self.along.T @ force for force in self.joint_forces()]


class LoadCase(NamedTuple):
    """What the platform needs, and what passes it on; in the model's symbols `pose` and `geometry`.

    A limb's two rods count by their mean force and by half of their difference, which keeps W sparse.

    Attributes:
        wrenches: W (f, k) of the transmitted forces.
        compliance: C (k, k).
        needed: Q (f, c) on the platform's freedoms.
        cuts: what each cut bears of the transmitted forces.
        bearers: the member of each cut, with what its own mass needs in place of its load.
    """

    wrenches: ca.SX
    compliance: ca.SX
    needed: ca.SX
    cuts: list[Cut]
    bearers: list[MemberLoad]

    def shared(self) -> ca.SX:
        """(k, c) the transmitted forces."""
        f, k = self.wrenches.shape
        if f == k:
            return ca.solve(self.wrenches, self.needed)
        rigid = any(self.compliance[i, i].is_zero() for i in range(k))  # then the least norm
        giving = self.wrenches.T if rigid else ca.solve(self.compliance, self.wrenches.T)
        return giving @ ca.solve(self.wrenches @ giving, self.needed)

    def loads(self, transmitted: ca.SX) -> list[MemberLoad]:
        """The load of each cut under transmitted forces (k, c)."""
        return [
            own._replace(force=cut.force @ transmitted + own.force, moment=cut.moment @ transmitted + own.moment)
            for cut, own in zip(self.cuts, self.bearers, strict=True)
        ]


def case_in_motion(robot: Mechanism, payload: float | ca.SX, velocity: ca.SX, acceleration: ca.SX) -> LoadCase:
    """In one column.

    Args:
        robot: any mechanism; without the hook `statics` it has no cuts.
        payload: mass at the tool [kg].
        velocity, acceleration: (n,) symbols of the pose's time derivatives.
    """
    return _case(robot, payload, velocity, acceleration, lambda vector: vector)


def case_at_rest(robot: Mechanism) -> LoadCase:
    """Of the robot at rest with its own `load.payload`.

    The columns are those for an acceleration of 1 m/s^2 of the tool point along each axis in turn, without weights;
    the last one is for the weights.
    """
    return _case_at_rest(robot, robot.model())


@lru_cache(maxsize=16)
def _case_at_rest(robot: Mechanism, _: Model) -> LoadCase:
    """The model is in the key because its symbols are in the answer."""
    n = len(robot.pose_names)
    velocity, acceleration = (ca.SX.sym(name, n) for name in ("velocity", "acceleration"))
    axes = [i for i, name in enumerate(robot.pose_names) if is_length(name)]

    def columns(vector: ca.SX) -> ca.SX:
        still = ca.substitute(vector, velocity, ca.SX.zeros(n))
        weights = ca.substitute(still, acceleration, ca.SX.zeros(n))
        return ca.horzcat(ca.jacobian(still, acceleration)[:, axes], weights)

    return _case(robot, robot.load.payload, velocity, acceleration, columns)


def _case(
    robot: Mechanism,
    payload: float | ca.SX,
    velocity: ca.SX,
    acceleration: ca.SX,
    columns: Callable[[ca.SX], ca.SX],
) -> LoadCase:
    """`columns` makes matrices (r, c) of vectors (r,) that are linear in accelerations and weights."""
    model, felt = robot.model(), ProperAcceleration(robot, velocity, acceleration)
    bodies = robot.bodies(model.pose, model.joints, model.g, payload)
    members = {member.name: member for member in robot.members(model.pose, model.joints, model.g)}
    whole, width = transmission(robot), getattr(model.g, "parallelogram_width", None)
    counts = [limb.wrenches.shape[1] for limb in robot.statics(model.pose, model.joints, model.g)]
    needed = columns(felt.at_pose(_load_on_freedoms(robot, bodies, felt, whole.wrenches.shape[0])))
    cuts, bearers = [], []
    for k, cut in enumerate(whole.cuts):
        member, names = members[cut.member], [other.member for other in whole.cuts]
        tube, material = member.tube, robot.structure.of(member)
        rod, root = names.count(cut.member) == 1, cut.member not in names[:k]
        mass = (felt(tube.start), felt(tube.end)) if rod else _own(member, root, bodies, robot, felt)
        first, second = (columns(felt.at_pose(part)) for part in mass)
        none = ca.SX(*first.shape)
        own = {"force": none, "moment": none, "ends": (first, second)} if rod else {"force": first, "moment": second}
        along, start, end = (model.at_pose(part) for part in (cut.along, tube.start, tube.end))
        bearers.append(MemberLoad(member.name, tube._replace(start=start, end=end), material, along, **own))
        force, moment = (
            model.at_pose(_by_pairs(part, counts, None if rod else width)) for part in (cut.force, cut.moment)
        )
        cuts.append(Cut(member.name, along, force, moment))
    compliance, wrenches = (
        _by_pairs(_by_pairs(whole.compliance, counts).T, counts),
        _by_pairs(whole.wrenches, counts, width),
    )
    wrenches, compliance = (ca.sparsify(model.at_pose(v)) for v in (wrenches, compliance))
    return LoadCase(wrenches, compliance, needed, cuts, bearers)


def _by_pairs(matrix: ca.SX, counts: list[int], width: ca.SX | None = None) -> ca.SX:
    """(r, k) columns of single transmitted forces -> of the mean and half the difference of a limb's two rods.

    Two rods are half of a width to either side of their limb's middle. If both columns are one linear function of that,
    and `width` is given, their difference is a derivative: without the large parts that both rods share, which would
    not cancel in intervals.

    Args:
        matrix: (r, k).
        counts: how many forces each limb transmits.
        width: its symbol.
    """
    columns, first = [], 0
    for count in counts:
        own = matrix[:, first : first + count]
        if count == 2 and width is not None:
            slope = ca.jacobian(ca.densify(own[:, 0]), width)
            own = 2 * ca.horzcat(ca.substitute(own[:, 0], width, 0), width * slope)
        elif count == 2:
            own = ca.horzcat(own[:, 0] + own[:, 1], own[:, 0] - own[:, 1])
        columns.append(own)
        first += count
    return ca.sparsify(ca.horzcat(*columns))


def _load_on_freedoms(robot: Mechanism, bodies: Bodies, felt: ProperAcceleration, count: int) -> ca.SX:
    """(f,) what moves and holds the platform's masses, with the ends of the rods on it."""
    model = robot.model()
    n, by_twist = model.pose.numel(), robot.pose_rate_map(model.pose)
    limbs = {link: limb for limb, rod in enumerate(bodies.rods) for link in rod.links}
    further, load = ca.SX(count - n, 1), ca.SX(n, 1)
    for particle in bodies.all_particles():
        force = particle.mass * felt(particle.point)
        load += ca.jacobian(particle.point, model.pose).T @ force
        if count > n and not ca.depends_on(particle.point, model.joints):
            limb = limbs.get(particle.link)
            further += robot.beyond_twist(model.pose, model.g, limb, particle.point).T @ force
    swinging = [(k, rod) for k, rod in enumerate(bodies.rods) if not rod.split]
    for k, rod in swinging if count > n else []:
        middle = bodies.rod_particles(k)[1]
        end = rod.end if ca.depends_on(rod.start, model.joints) else rod.start
        velocity = robot.beyond_twist(model.pose, model.g, k, end) / 2
        further += velocity.T @ (middle.mass * felt(middle.point))
    for rotor in bodies.rotors:
        load += ca.jacobian(rotor.angle, model.pose).T * (rotor.inertia * felt.second(rotor.angle))
    result: ca.SX = ca.vertcat(by_twist.T @ load, further)
    return result


def _own(member: Member, root: bool, bodies: Bodies, robot: Mechanism, felt: ProperAcceleration) -> tuple[ca.SX, ca.SX]:
    """Force (3,) and moment (3,) that the masses beyond an arm's root or tip exert there: its own, if it is the root,
    and the rods' ends at its tip. A member whose mass is a rod's in `bodies` counts as one that is clamped at its root.
    """
    tube, link = member.tube, member.link or member.name
    force, moment = ca.SX(3, 1), ca.SX(3, 1)
    own: list[tuple[float | ca.SX, ca.SX]] = [
        (particle.mass, particle.point) for particle in bodies.particles if particle.link == link
    ]
    if root and not own:
        mass = robot.structure.of(member).density * tube.area * ca.norm_2(tube.end - tube.start)
        own = [(mass, (tube.start + tube.end) / 2)]
    for weight, point in own if root else []:
        force -= weight * felt(point)
        moment -= weight * ca.cross(point - tube.start, felt(point))
    for rotor in bodies.rotors if root else []:
        if rotor.link == link and rotor.axis is not None:
            moment -= rotor.inertia * felt.second(rotor.angle) * rotor.axis
    for k, rod in enumerate(bodies.rods):
        if link in rod.links:
            near, middle, far = bodies.rod_particles(k)
            end = (near, far)[rod.links.index(link)]
            hung = -end.mass * felt(end.point) - middle.mass / 2 * felt(middle.point)
            force += hung
            moment += ca.cross(tube.end - tube.start, hung) if root else 0
    return force, moment
