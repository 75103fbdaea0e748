"""Regions, requirements and the synthesis of geometries that meet them."""

from design.certificate import BestBound, Certificate, best_bound, certify
from design.certificate_file import load_certificate, save_certificate
from design.errors import BrokenCertificate, InvalidRegion, OtherCertificate, SynthesisFailed
from design.region import Box, Cylinder, Region
from design.replay import replay
from design.requirement import Bounds, Requirement, SumLimit
from design.search import WorstPoses, worst_poses
from design.sweep import Sweep, sweep

__all__ = [
    "BestBound",
    "Bounds",
    "Box",
    "BrokenCertificate",
    "Certificate",
    "Cylinder",
    "InvalidRegion",
    "OtherCertificate",
    "Region",
    "Requirement",
    "SumLimit",
    "Sweep",
    "SynthesisFailed",
    "WorstPoses",
    "best_bound",
    "certify",
    "load_certificate",
    "replay",
    "save_certificate",
    "sweep",
    "worst_poses",
]
