"""Optimal geometry: nonlinear programs over few poses; worse poses are added until the answer holds everywhere."""

from design.synthesis.errors import ImpossibleSum, SynthesisFailed
from design.synthesis.exchange import worst_of
from design.synthesis.nlp import Problem, active_sets
from design.synthesis.random_starts import STARTS
from design.synthesis.synthesis import Synthesis, synthesise

__all__ = [
    "STARTS",
    "ImpossibleSum",
    "Problem",
    "Synthesis",
    "SynthesisFailed",
    "active_sets",
    "synthesise",
    "worst_of",
]
