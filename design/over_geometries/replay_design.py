"""Check a proof over geometries again."""

from __future__ import annotations

from importlib.metadata import version

import numpy as np

from design.certificates import PROVED, leaves
from design.errors import BrokenCertificate, OtherCertificate
from design.over_geometries.design_certificate import DesignCertificate
from design.over_geometries.design_proof import DesignProof, digest_of
from design.over_geometries.geometry_search import excluded
from design.synthesis import Problem

_AT_ONCE = 4096  # boxes that are bounded together


def replay_design(certificate: DesignCertificate, problem: Problem) -> int:
    """Bound every part of the box of geometries again, at the certificate's poses.

    Returns:
        the number of parts.

    Raises:
        BrokenCertificate: it proves nothing, a pose is outside the region, or a part is not excluded.
        OtherCertificate: it was made for another problem, or by another version.
    """
    names = problem.robot.pose_names
    if certificate.digest != digest_of(problem) or certificate.version != version("linkwright"):
        expected = "this problem, with its robot, objective, variables, requirements and sums, and this version"
        raise OtherCertificate("problem", f"{certificate.digest}, version {certificate.version}", expected)
    if certificate.status != "proved" or not certificate.region.contains(certificate.poses, names).all():
        raise BrokenCertificate("it proves nothing, or a pose is outside its region")
    proof = DesignProof.of(problem, certificate.region, certificate.target, certificate.used, certificate.unused)
    bounds, count = [proof.bounds_at(certificate.poses[:some]) for some in certificate.counts], 0
    for codes, low, high in leaves(certificate.codes, proof.box.low[None], proof.box.high[None]):
        if (codes != PROVED).any():
            raise BrokenCertificate("a part of the box of geometries is left")
        for first in range(0, len(codes), _AT_ONCE):
            rest = np.arange(first, min(first + _AT_ONCE, len(codes)))
            count += len(rest)
            for some in bounds:
                rest = rest[~excluded(some, low[rest], high[rest])[0]]
            if len(rest):
                raise BrokenCertificate("a part of the box of geometries is not excluded", low[rest[0]])
    return count
