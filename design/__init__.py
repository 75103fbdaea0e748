"""Regions, requirements and the synthesis of geometries that meet them."""

from design.best_bound import BestBound, best_bound
from design.certificate import Certificate, certify
from design.certificate_file import certificate_bytes, load_certificate, save_certificate
from design.errors import (
    BrokenCertificate,
    InvalidRegion,
    OtherCertificate,
    SynthesisFailed,
    UnreadableCertificate,
)
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
    "UnreadableCertificate",
    "WorstPoses",
    "best_bound",
    "certificate_bytes",
    "certify",
    "load_certificate",
    "replay",
    "save_certificate",
    "sweep",
    "worst_poses",
]
