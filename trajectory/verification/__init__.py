"""Independent verification of a motion. It imports nothing from the timing laws."""

from trajectory.verification.path_certificate import PathCertificate, Way, certify_path, worst_of
from trajectory.verification.sampling import integrals, parts_of
from trajectory.verification.verification import Peak, Verification, verify

__all__ = [
    "PathCertificate",
    "Peak",
    "Verification",
    "Way",
    "certify_path",
    "integrals",
    "parts_of",
    "verify",
    "worst_of",
]
