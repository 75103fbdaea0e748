"""Regions, requirements and the synthesis of geometries that meet them."""

from design.best_bound import BestBound, best_bound
from design.certificate import Certificate, certify
from design.certificate_file import certificate_bytes, load_certificate, save_certificate
from design.certified import CertifiedRegion, certified_cylinder
from design.certified_cells import certified_cells
from design.errors import (
    BrokenCertificate,
    InvalidRegion,
    InvalidSection,
    OtherCertificate,
    OutOfTime,
    SynthesisFailed,
    UnreadableCertificate,
)
from design.index import Index, index_names, index_of
from design.level_sets import LevelSet, level_set
from design.maps import Map, map_of
from design.region import Box, Cylinder, Region
from design.replay import replay
from design.requirement import Bounds, Requirement, SumLimit
from design.search import WorstPoses, worst_poses
from design.section import Section
from design.sweep import Sweep, sweep

__all__ = [
    "BestBound",
    "Bounds",
    "Box",
    "BrokenCertificate",
    "Certificate",
    "CertifiedRegion",
    "Cylinder",
    "Index",
    "InvalidRegion",
    "InvalidSection",
    "LevelSet",
    "Map",
    "OtherCertificate",
    "OutOfTime",
    "Region",
    "Requirement",
    "Section",
    "SumLimit",
    "Sweep",
    "SynthesisFailed",
    "UnreadableCertificate",
    "WorstPoses",
    "best_bound",
    "certificate_bytes",
    "certified_cells",
    "certified_cylinder",
    "certify",
    "index_names",
    "index_of",
    "level_set",
    "load_certificate",
    "map_of",
    "replay",
    "save_certificate",
    "sweep",
    "worst_poses",
]
