"""Regions, requirements, the optimal geometry that meets them, maps, and proofs."""

from __future__ import annotations

from design.budget import Budget
from design.certificates import (
    MOST_BOXES,
    BestBound,
    Certificate,
    CertifiedRegion,
    best_bound,
    certificate_bytes,
    certified_cylinder,
    certify,
    load_certificate,
    replay,
    save_certificate,
)
from design.errors import (
    BrokenCertificate,
    InvalidRegion,
    InvalidSection,
    OtherCertificate,
    OutOfTime,
    UnreadableCertificate,
)
from design.maps import (
    Index,
    LevelSet,
    Map,
    Section,
    boundary,
    certified_cells,
    index_of,
    level_set,
    map_of,
)
from design.regions import Box, Cylinder, Region
from design.requirement import Bounds, Requirement, SumLimit
from design.sampling import DENSE, Sweep, WorstPoses, sweep, worst_poses
from design.synthesis import (
    STARTS,
    ImpossibleSum,
    Problem,
    Synthesis,
    SynthesisFailed,
    active_sets,
    synthesise,
    worst_of,
)

__all__ = [
    "DENSE",
    "MOST_BOXES",
    "STARTS",
    "BestBound",
    "Bounds",
    "Box",
    "BrokenCertificate",
    "Budget",
    "Certificate",
    "CertifiedRegion",
    "Cylinder",
    "ImpossibleSum",
    "Index",
    "InvalidRegion",
    "InvalidSection",
    "LevelSet",
    "Map",
    "OtherCertificate",
    "OutOfTime",
    "Problem",
    "Region",
    "Requirement",
    "Section",
    "SumLimit",
    "Sweep",
    "Synthesis",
    "SynthesisFailed",
    "UnreadableCertificate",
    "WorstPoses",
    "active_sets",
    "best_bound",
    "boundary",
    "certificate_bytes",
    "certified_cells",
    "certified_cylinder",
    "certify",
    "index_of",
    "level_set",
    "load_certificate",
    "map_of",
    "replay",
    "save_certificate",
    "sweep",
    "synthesise",
    "worst_of",
    "worst_poses",
]
