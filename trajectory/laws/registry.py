"""The timing laws by name, for a study's `law` and the command line's `--law`. They are loaded at first use."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from importlib import import_module
from typing import Any

from kinematics import InvalidField, InvalidValue, Mechanism
from trajectory.limits import JOINT_JERK, Constraint, Limit, Limits, Sloped, Squared, Third
from trajectory.motions import TimedMotion
from trajectory.paths import Path, PoseBounds

TimingLaw = Callable[[Mechanism, Path, Limits, float], TimedMotion]


@dataclass(frozen=True)
class Law:
    """A timing law.

    Attributes:
        name: the law's name in a study and in the motions that it makes.
        title: a description for people.
        function: "module:function", a `TimingLaw` that may take more arguments.
        takes: which of the arguments "intervals" and "within" it takes.
        needs: limits that must be set, and the words of the error without them.
        refuses: kinds of limits that it cannot keep, and why.
        leaves_out: fields of limits that it cannot keep, but that a cycle may have. The cycle names them as not kept.
    """

    name: str
    title: str
    function: str
    takes: tuple[str, ...] = ()
    needs: Mapping[Limit, str] = field(default_factory=dict)
    refuses: Mapping[type[Constraint], str] = field(default_factory=dict)
    leaves_out: tuple[str, ...] = ()

    def timing(self, intervals: int, within: PoseBounds) -> TimingLaw:
        """The law as a function; this loads its solver.

        Args:
            intervals: number of intervals of the path at the start.
            within: bounds of every pose.
        """
        module, _, function = self.function.partition(":")
        given: dict[str, Any] = {"intervals": intervals, "within": within}
        return partial(getattr(import_module(module), function), **{name: given[name] for name in self.takes})

    def require_kept(self, limits: Limits) -> None:
        """Check that the law can keep the limits.

        Raises:
            InvalidField: a limit that the law needs is not set, or one that it refuses is set.
        """
        use = f"for the {self.name} law"
        for limit, expected in self.needs.items():
            if not limit.is_set(limits):
                raise InvalidField("Limits", limit.fields[0].name, None, expected, use)
        for limit in limits:
            if limit.kind in self.refuses:
                name, why = limit.fields[0].name, self.refuses[limit.kind]
                raise InvalidField("Limits", name, getattr(limits, name), f"no such limit, or another law: {why}", use)


_ALL = (
    Law(
        "jerk",
        "the fastest law on the path that keeps all limits, with the jerk limit",
        "trajectory.laws.jerk:jerk_limited",
        needs={JOINT_JERK: "a jerk limit; without one use the law toppra"},
    ),
    Law(
        "toppra",
        "the fastest law on the path without a jerk limit",
        "trajectory.laws.toppra:time_optimal",
        takes=("intervals",),
        refuses={
            Third: "its acceleration steps from one extreme to the other",
            Sloped: "its equations cannot hold a limit that falls with the speed",
            Squared: "it limits the whole way, not each instant",
        },
        leaves_out=("jerk",),  # without a jerk limit a motion is only less smooth; the other limits protect the drives
    ),
    Law(
        "free",
        "finds path and timing together and keeps all limits, with the jerk limit",
        "trajectory.laws.free:free_motion",
        takes=("within",),
        needs={JOINT_JERK: "a jerk limit, which this law always keeps"},
    ),
)
LAWS = {law.name: law for law in _ALL}


def law_named(name: str) -> Law:
    """One of `LAWS`.

    Raises:
        InvalidValue: there is no law of this name; the message lists all.
    """
    if name not in LAWS:
        known = ", ".join(f"{law.name} ({law.title})" for law in LAWS.values())
        raise InvalidValue("timing law", name, f"one of {known}")
    return LAWS[name]
