"""Each law of the registry needs and refuses the limits that its entry says."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from kinematics import Heli4, InvalidValue
from trajectory import LAWS, LIMITS, AdeptCycle, Limits, PoseBounds, law_named

FULL = Limits(20.0, 450.0, 127.0, jerk=1e5)
MORE = {"jerk": 1e5, "stall_torque": 150.0, "rms_torque": 90.0}
ANYWHERE = PoseBounds((-9.0,) * 4, (9.0,) * 4, 3)


@pytest.mark.parametrize("law", LAWS.values(), ids=list(LAWS))
def test_a_law_refuses_to_work_without_what_it_needs_and_with_what_it_refuses(law) -> None:
    timing, cycle = law.timing(1000, ANYWHERE), AdeptCycle()
    refused = [limit.fields[0].name for limit in LIMITS if limit.kind in law.refuses]
    assert set(law.leaves_out) <= set(refused) <= set(MORE)
    for name in (limit.fields[0].name for limit in law.needs):
        with pytest.raises(InvalidValue, match=f"Limits {name} for the {law.name} law"):
            timing(Heli4(), cycle, replace(FULL, **{name: None}), 1.0)
    for name in refused:
        more = {"jerk": None, name: MORE[name]} | ({"no_load_speed": 30.0} if name == "stall_torque" else {})
        with pytest.raises(InvalidValue, match=f"Limits {name} for the {law.name} law"):
            timing(Heli4(), cycle, replace(FULL, **more), 1.0)


def test_an_unknown_law_is_told_with_those_that_there_are() -> None:
    with pytest.raises(InvalidValue, match=re.escape("timing law: found fast; expected one of jerk (the fastest")):
        law_named("fast")
