"""Committed optima: the file, its proofs, and their check from scratch."""

from studies.committed.check import check_study
from studies.committed.committed_proofs import file_of, proof_files
from studies.committed.optimum import FILE, Optimum, committed, committed_certificates, optimum_of, read_optimum

__all__ = [
    "FILE",
    "Optimum",
    "check_study",
    "committed",
    "committed_certificates",
    "file_of",
    "optimum_of",
    "proof_files",
    "read_optimum",
]
