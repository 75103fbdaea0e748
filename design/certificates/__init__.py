"""Proofs over whole regions, their files, and their check."""

from design.certificates.best_bound import BestBound, best_bound
from design.certificates.box_tree import PROVED, Part, Tree, halves, known, leaves, taken
from design.certificates.certificate import MOST_BOXES, Certificate, answer, answer_by_boxes, certify, checked_boxes
from design.certificates.certificate_file import certificate_bytes, load_certificate, save_certificate
from design.certificates.largest_region import CertifiedRegion, certified_cylinder
from design.certificates.lower_bounds import LowerBounds
from design.certificates.nonlinear_error import NonlinearError, nonlinear_error
from design.certificates.refutation import Refuter
from design.certificates.replay import replay

__all__ = [
    "MOST_BOXES",
    "PROVED",
    "BestBound",
    "Certificate",
    "CertifiedRegion",
    "LowerBounds",
    "NonlinearError",
    "Part",
    "Refuter",
    "Tree",
    "answer",
    "answer_by_boxes",
    "best_bound",
    "certificate_bytes",
    "certified_cylinder",
    "certify",
    "checked_boxes",
    "halves",
    "known",
    "leaves",
    "load_certificate",
    "nonlinear_error",
    "replay",
    "save_certificate",
    "taken",
]
