"""What a study needs to know of a mechanism; `kinematics` is loaded only when it is asked for."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from importlib import import_module
from typing import TYPE_CHECKING, Any

from kinematics import LinkwrightError

if TYPE_CHECKING:
    from kinematics import Mechanism


class UnknownMechanism(LinkwrightError):
    """No mechanism is called `name`; `known` are the names."""

    def __init__(self, name: str, known: tuple[str, ...]) -> None:
        super().__init__(name, known)
        self.name, self.known = name, known

    def __str__(self) -> str:
        return f"unknown mechanism {self.name!r}; known: {', '.join(self.known)}"


@dataclasses.dataclass(frozen=True)
class GeometryField:
    """A field of a mechanism's geometry: `shape` () for a number, (4,) for four.

    Every number is above `minimum` [SI]; None allows any sign. No pitch is zero.
    """

    dimension: str
    shape: tuple[int, ...]
    minimum: float | None

    def allows(self, low: float, high: float) -> bool:
        """Whether the field may hold every number from `low` to `high` [SI]."""
        without_zero = self.dimension != "length_per_turn" or not low <= 0 <= high
        return without_zero and (self.minimum is None or low > self.minimum)


def mechanism_names() -> tuple[str, ...]:
    """The names that a study's `mechanism` may have."""
    return tuple(_mechanisms())


def mechanism_class(name: str) -> type[Mechanism]:
    """The class called `name`. Raises UnknownMechanism."""
    try:
        return _mechanisms()[name]
    except KeyError:
        raise UnknownMechanism(name, mechanism_names()) from None


def geometry_fields(mechanism: type[Mechanism]) -> dict[str, GeometryField]:
    """The geometry's fields by name; the prototype's values give the shapes."""
    prototype = mechanism.Geometry()
    return {
        field.name: GeometryField(
            dimension=field.metadata["dimension"],
            shape=shape(getattr(prototype, field.name)),
            minimum=field.metadata.get("minimum"),
        )
        for field in dataclasses.fields(mechanism.Geometry)
    }


def shape(value: object) -> tuple[int, ...]:
    """The shape of nested tuples of numbers, () for a number; -1 where entries differ."""
    if not isinstance(value, tuple):
        return ()
    inner = {shape(entry) for entry in value}
    return (len(value), *inner.pop()) if len(inner) == 1 else (len(value), -1)


def _mechanisms() -> Mapping[str, type[Mechanism]]:
    kinematics: Any = import_module("kinematics")
    mechanisms: Mapping[str, type[Mechanism]] = kinematics.MECHANISMS
    return mechanisms
