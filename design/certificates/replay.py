"""Check a certificate again, without the search that made it: the boxes cover the region, and each is proved.

Only the leaves are bounded and nothing is searched, so this takes about half of the time of the proof.
"""

from __future__ import annotations

from importlib.metadata import version

from design.certificates.box_tree import LEFT, OUTSIDE, halves, leaves, outside, root
from design.certificates.certificate import EDITION, Certificate
from design.certificates.lower_bounds import LowerBounds
from design.certificates.refutation import Refuter
from design.certificates.symmetry import mirrors_of, one_side
from design.errors import BrokenCertificate, OtherCertificate
from design.regions import Region
from kinematics import Array, Bound, FviBounds, Mechanism

_CUTS = 2  # a box that was just proved may need a cut if another library rounds its scaling differently


def replay(
    certificate: Certificate,
    robot: Mechanism,
    *,
    region: Region | None = None,
    margin: str | None = None,
    at_least: float | None = None,
    at_most: float | None = None,
    bounds: FviBounds | None = None,
    characteristic_length: float | None = None,
) -> int:
    """Check the answer of a certificate for this robot.

    Args:
        region, margin, at_least, at_most, bounds, characteristic_length: the question that it must answer, as far as
            given. A certificate of a stronger bound is accepted.

    Returns:
        The number of boxes that were bounded again; 1 for the pose of a refutation.

    Raises:
        OtherCertificate: it is for another mechanism, geometry, joint range, working mode, version, edition, region,
            margin, FVI bounds or length, or for a weaker bound; or masses, materials or loads that count are others.
        BrokenCertificate: its boxes do not cover the region, their number is wrong, or one is not proved; its pose does
            not refute the claim; or it is undecided.
    """
    _same("mechanism", certificate.mechanism, type(robot).__name__)
    _same("geometry", certificate.digest, robot.geometry.digest)
    asked = robot.margin_named(certificate.margin)
    conditions = " or ".join(["joint ranges", "working mode", *asked.records])
    _same(conditions, certificate.conditions, robot.conditions_digest(asked.records))
    _same("version", certificate.version, version("linkwright"))
    _same("edition", certificate.edition, EDITION)
    if region is not None:
        _same("region", repr(certificate.region), repr(region))
    if margin is not None:
        _same("margin", certificate.margin, margin)
    if bounds is not None:
        _same("FVI bounds", certificate.bounds, bounds)
    if characteristic_length is not None:
        _same("characteristic length", certificate.characteristic_length, characteristic_length)
    _same("kind of bound", certificate.bound.sign, Bound.weakest(asked.sense).sign)
    if at_least is not None or at_most is not None:
        wanted = asked.bound(at_least, at_most)
        if not wanted.room(certificate.bound.value) >= 0.0:
            words = f"{wanted.word.replace('_', ' ')} {wanted.value}"
            raise OtherCertificate("bound", certificate.bound.value, words)
    if certificate.status == "proved":
        return _replay_proof(certificate, robot)
    if certificate.status == "refuted" and certificate.counterexample is not None:
        return _replay_refutation(certificate, robot, certificate.counterexample)
    raise BrokenCertificate(f"its status is {certificate.status!r}, so it decides nothing")


def _same(what: str, found: object, expected: object) -> None:
    if found != expected:
        raise OtherCertificate(what, found, expected)


def _replay_proof(certificate: Certificate, robot: Mechanism) -> int:
    names, region, mirrors = robot.pose_names, certificate.region, certificate.mirrors
    region.check(names)
    if certificate.boxes != (bounded := int((certificate.codes != OUTSIDE).sum())):
        raise BrokenCertificate(f"it says {certificate.boxes} boxes and lists {bounded}")
    lower = LowerBounds(certificate.statement(robot), region)
    count = 0
    shown = mirrors_of(robot, region, certificate.margin)
    if not set(mirrors) <= set(shown):
        raise BrokenCertificate(f"it relies on the mirrors {mirrors}; shown to hold: {shown}")
    for code, low, high in leaves(certificate.codes, *one_side(*root(region, names), mirrors, names)):
        if (code == LEFT).any():
            raise BrokenCertificate("a box is undecided", low[code == LEFT][0])
        off = code == OUTSIDE
        if not outside(region, low[off], high[off], names).all():
            raise BrokenCertificate("a box that it calls outside the region is not outside", low[off][0])
        low, high = low[~off], high[~off]
        for cuts in range(_CUTS + 1):
            lowest, spread = lower.lowest(low, high)
            count += len(low)
            rest = ~(lowest >= 0.0)
            if not rest.any():
                break
            if cuts == _CUTS:
                raise BrokenCertificate("a box is not proved", low[rest][0])
            axis = lower.axis(low[rest], high[rest], spread[rest])
            low, high = halves(low[rest], high[rest], axis)
    return count


def _replay_refutation(certificate: Certificate, robot: Mechanism, pose: Array) -> int:
    if pose.shape != (len(robot.pose_names),):
        raise BrokenCertificate(f"its pose has {pose.size} numbers; expected {len(robot.pose_names)}")
    certificate.region.check(robot.pose_names)
    found = Refuter(certificate.statement(robot)).refutation(certificate.region, pose[None])
    if found is None:
        raise BrokenCertificate("its pose does not refute the claim", pose)
    if found.within_reach != certificate.within_reach:
        raise BrokenCertificate(f"its pose is {'within' if found.within_reach else 'out of'} reach; it says otherwise")
    return 1
