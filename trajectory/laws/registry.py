"""The timing laws by name: what a study's `law` and the command line's `--law` choose from; loaded at first use."""

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
        name: in a study, and of the motions that it makes.
        title: what it does, for people.
        function: "module:function", a `TimingLaw` that may take more arguments.
        takes: those of "intervals" and "within" that it takes, too.
        needs: limits that must be set, and what is expected of each.
        refuses: kinds of limits that it cannot keep, and why.
        leaves_out: fields of the limits that it refuses, but without which a cycle is timed; the cycle names them.
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
            intervals: of the path, to start from.
            within: where every pose must stay.
        """
        module, _, function = self.function.partition(":")
        given: dict[str, Any] = {"intervals": intervals, "within": within}
        return partial(getattr(import_module(module), function), **{name: given[name] for name in self.takes})

    def require_kept(self, limits: Limits) -> None:
        """Check that the law can keep the limits.

        Raises:
            InvalidField: naming one that it needs, or refuses.
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
        "the fastest on the path that keeps all limits, jerk among them",
        "trajectory.laws.jerk:jerk_limited",
        needs={JOINT_JERK: "a limit; without one the toppra law is the fastest"},
    ),
    Law(
        "toppra",
        "the fastest on the path without a limit of jerk",
        "trajectory.laws.toppra:time_optimal",
        takes=("intervals",),
        refuses={
            Third: "its s'' is bang-bang",
            Sloped: "a limit that falls with the speed is not linear in u and x",
            Squared: "it is a limit of the whole way, not of an instant",
        },
        leaves_out=("jerk",),  # it makes a motion smooth; what else the law cannot keep rates the drives
    ),
    Law(
        "free",
        "path and timing together, all limits kept, jerk among them",
        "trajectory.laws.free:free_motion",
        takes=("within",),
        needs={JOINT_JERK: "a limit: it keeps the jerk"},
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
