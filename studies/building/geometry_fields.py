"""The fields of a mechanism's geometry that a study may set."""

from __future__ import annotations

import dataclasses

from kinematics import Mechanism


@dataclasses.dataclass(frozen=True)
class GeometryField:
    """A field of a mechanism's geometry; its `shape` is () for one number, (4,) for four numbers.

    Every number is above `minimum` [SI]; None allows any sign. A pitch is never zero.
    """

    dimension: str
    shape: tuple[int, ...]
    minimum: float | None

    def allows(self, low: float, high: float) -> bool:
        """Whether the field may hold every number from `low` to `high` [SI]."""
        without_zero = self.dimension != "length_per_turn" or not low <= 0 <= high
        return without_zero and (self.minimum is None or low > self.minimum)


def geometry_fields(mechanism: type[Mechanism]) -> dict[str, GeometryField]:
    """The geometry's fields by name. Their shapes are those of the prototype's values."""
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
    """The shape of nested tuples of numbers: () for a number, -1 on an axis whose entries differ in shape."""
    if not isinstance(value, tuple):
        return ()
    inner = {shape(entry) for entry in value}
    return (len(value), *inner.pop()) if len(inner) == 1 else (len(value), -1)
