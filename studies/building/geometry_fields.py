"""The fields of a mechanism's geometry that a study may set."""

from __future__ import annotations

from dataclasses import dataclass, fields

from kinematics import FieldKind, Mechanism, kind_of


@dataclass(frozen=True)
class GeometryField:
    """A field of a mechanism's geometry: its kind, and its `shape`, () for a number, (4,) for four."""

    kind: FieldKind
    shape: tuple[int, ...]


def geometry_fields(mechanism: type[Mechanism]) -> dict[str, GeometryField]:
    """The geometry's fields by name. Their shapes are those of the prototype's values."""
    prototype = mechanism.Geometry()
    return {f.name: GeometryField(kind_of(f), shape(getattr(prototype, f.name))) for f in fields(prototype)}


def shape(value: object) -> tuple[int, ...]:
    """The shape of nested tuples of numbers: () for a number, -1 on an axis whose entries differ in shape."""
    if not isinstance(value, tuple):
        return ()
    inner = {shape(entry) for entry in value}
    return (len(value), *inner.pop()) if len(inner) == 1 else (len(value), -1)
