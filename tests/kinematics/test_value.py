"""Records that hold arrays compare by value, and equal ones have equal hashes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pytest

from design import Cylinder, certify
from kinematics import Heli4, Value
from trajectory import AdeptCycle, Limits, there_and_back, time_optimal


@dataclass(frozen=True, eq=False)
class Record(Value):
    name: str
    numbers: np.ndarray
    pairs: tuple[np.ndarray, ...] = ()


def test_equal_fields_make_equal_records_and_one_other_number_does_not() -> None:
    one = Record("a", np.array([0.0, np.nan]), (np.arange(3),))
    same = Record("a", np.array([-0.0, np.nan]), (np.arange(3),))
    assert one == same
    assert hash(one) == hash(same)
    others = [
        replace(one, name="b"),
        replace(one, numbers=np.array([0.0, 1.0])),
        replace(one, numbers=np.zeros((2, 1))),
        replace(one, pairs=(np.arange(3), np.arange(3))),
        replace(one, pairs=(np.arange(1, 4),)),
    ]
    assert all(one != other for other in others)


@pytest.mark.long
def test_a_proof_and_a_cycle_made_twice_are_equal() -> None:
    region = Cylinder(radius=0.2, z=(-0.75, -0.7), theta=(-1.0, 1.0))
    proofs = [certify(Heli4(), region, "J_q", at_least=0.3) for _ in range(2)]
    assert proofs[0].status == "proved"
    assert proofs[0] == proofs[1]
    limits = Limits(20.0, 450.0, 127.0)
    coarse = partial(time_optimal, intervals=300)
    cycles = [there_and_back(Heli4(), AdeptCycle(), limits, 1.0, coarse) for _ in range(2)]
    assert cycles[0] == cycles[1]
    assert cycles[0] != there_and_back(Heli4(), AdeptCycle(), limits, 1.1, coarse)
