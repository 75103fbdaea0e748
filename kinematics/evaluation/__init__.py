"""Expressions evaluated over many poses at once, in numbers and in intervals."""

from kinematics.evaluation.affine_interpreter import AffineForms, affine_forms, bound_below
from kinematics.evaluation.block_interpreter import bulk, evaluate
from kinematics.evaluation.block_program import BlockProgram
from kinematics.evaluation.box_program import BoxProgram
from kinematics.evaluation.interval_interpreter import enclose
from kinematics.evaluation.program import Op, Program, run_through
from kinematics.evaluation.threads import CORES, over_spans

__all__ = [
    "CORES",
    "AffineForms",
    "BlockProgram",
    "BoxProgram",
    "Op",
    "Program",
    "affine_forms",
    "bound_below",
    "bulk",
    "enclose",
    "evaluate",
    "over_spans",
    "run_through",
]
