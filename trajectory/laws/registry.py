"""The timing laws by name: what a study's `law` and the command line's `--law` choose from; loaded at first use."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from typing import Any

from kinematics import InvalidValue, Mechanism
from trajectory.limits import Limits
from trajectory.motions import TimedMotion
from trajectory.paths import Path, PoseBounds

TimingLaw = Callable[[Mechanism, Path, Limits, float], TimedMotion]


@dataclass(frozen=True)
class Law:
    """A timing law.

    Attributes:
        name: in a study, and of the motions that it makes.
        title: what it does, for people.
        function: "module:function", a `TimingLaw` that may take more arguments.
        takes: those of "intervals" and "within" that it takes, too.
        needs: fields of the limits without which it refuses to work.
        refuses: fields of the limits that it cannot keep, and refuses.
        leaves_out: those of them without which a cycle is timed all the same; the cycle names them.
    """

    name: str
    title: str
    function: str
    takes: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()
    refuses: tuple[str, ...] = ()
    leaves_out: tuple[str, ...] = ()

    def timing(self, intervals: int, within: PoseBounds) -> TimingLaw:
        """The law as a function; this loads its solver.

        Args:
            intervals: of the path, to start from.
            within: where every pose must stay.
        """
        module, _, function = self.function.partition(":")
        given: dict[str, Any] = {"intervals": intervals, "within": within}
        return partial(getattr(import_module(module), function), **{name: given[name] for name in self.takes})


_ALL = (
    Law(
        "jerk",
        "the fastest on the path that keeps all limits, jerk among them",
        "trajectory.laws.jerk:jerk_limited",
        needs=("jerk",),
    ),
    Law(
        "toppra",
        "the fastest on the path without a limit of jerk",
        "trajectory.laws.toppra:time_optimal",
        takes=("intervals",),
        refuses=("jerk", "stall_torque", "rms_torque"),
        leaves_out=("jerk",),  # it makes a motion smooth; what else the law cannot keep rates the drives
    ),
    Law(
        "free",
        "path and timing together, all limits kept, jerk among them",
        "trajectory.laws.free:free_motion",
        takes=("within",),
        needs=("jerk",),
    ),
)
LAWS = {law.name: law for law in _ALL}


def law_named(name: str) -> Law:
    """One of `LAWS`.

    Raises:
        InvalidValue: there is none of this name; all are listed.
    """
    if name not in LAWS:
        known = ", ".join(f"{law.name} ({law.title})" for law in LAWS.values())
        raise InvalidValue("timing law", name, f"one of {known}")
    return LAWS[name]
