"""Geometry records: one frozen dataclass holds the prototype's numbers and defines the symbols of the model."""

from __future__ import annotations

import hashlib
import json
import math
from dataclasses import Field, dataclass, fields, replace
from types import SimpleNamespace
from typing import Any, Self

import casadi as ca
import numpy as np

from kinematics.errors import InvalidGeometry
from kinematics.machine.geometry_fields import FieldKind, Vector


@dataclass(frozen=True)
class GeometryRecord:
    """Base of every mechanism's `Geometry`: named numbers, tuples of numbers, or tuples of rows of numbers.

    In a vector, a field of rows is stored row by row.

    Raises:
        InvalidGeometry: a value is not finite, has the wrong number of items, or is not a possible length; or a tube's
            wall is thicker than its radius.
    """

    def __post_init__(self) -> None:
        for f in fields(self):
            given, wanted = getattr(self, f.name), _shape(f)
            words = " rows of ".join(str(k) for k in wanted) + " numbers" if wanted else "a number"
            array = numbers_of(given)
            if array is None or array.shape != wanted:
                raise self.invalid(f.name, given, words)
            if not np.isfinite(array).all():
                raise self.invalid(f.name, given, "finite numbers")
            kind = kind_of(f)
            if not kind.allows(array, array):
                raise self.invalid(f.name, given, kind.expected)
            object.__setattr__(self, f.name, frozen(array))
        for wall, radius in self.walls().items():
            most = getattr(self, radius)
            if getattr(self, wall) > most:
                raise self.invalid(wall, getattr(self, wall), f"at most {radius}, {most:g} m")

    @classmethod
    def invalid(cls, name: str, found: object, expected: str) -> InvalidGeometry:
        """The error that names a field."""
        return InvalidGeometry(cls.__qualname__.split(".")[0].removesuffix("Geometry"), name, found, expected)

    @classmethod
    def walls(cls) -> dict[str, str]:
        """The radius of each tube's wall, which cannot be thicker: `arm_radius` of `arm_wall`."""
        names = {f.name: f.name.removesuffix("_wall") + "_radius" for f in fields(cls)}
        return {wall: radius for wall, radius in names.items() if wall != radius and wall.endswith("_wall")}

    @classmethod
    def sizes(cls) -> dict[str, int]:
        """The number of numbers in each field, in the order of `vector`."""
        return {f.name: math.prod(_shape(f)) for f in fields(cls)}

    @classmethod
    def symbols(cls) -> tuple[ca.SX, SimpleNamespace]:
        """The symbol vector (k,), and the same symbols by the fields' names."""
        named = {name: ca.SX.sym(name, size) for name, size in cls.sizes().items()}
        return ca.vertcat(*named.values()), SimpleNamespace(**named)

    def vector(self) -> Vector:
        """(k,) all numbers, in the order of `symbols`."""
        return np.concatenate([np.asarray(getattr(self, f.name), float).reshape(-1) for f in fields(self)])

    @classmethod
    def from_vector(cls, values: Vector) -> Self:
        """The geometry with these numbers (k,); the inverse of `vector`."""
        items: dict[str, Any] = {}
        start = 0
        for f in fields(cls):
            size = math.prod(_shape(f))
            items[f.name] = frozen(np.asarray(values[start : start + size], dtype=float).reshape(_shape(f)))
            start += size
        return cls(**items)

    def with_values(self, **changes: Any) -> Self:
        """A copy with some fields changed."""
        return replace(self, **changes)

    def as_dict(self) -> dict[str, Any]:
        """Plain numbers, lists or lists of rows by the fields' names, for files."""
        return {f.name: np.asarray(getattr(self, f.name)).tolist() for f in fields(self)}

    @classmethod
    def descriptions(cls) -> dict[str, str]:
        """The description of each field, by its name."""
        return {f.name: f.metadata["doc"] for f in fields(cls)}

    @property
    def size(self) -> float:
        """The largest of its lengths [m]. Tolerances scale with it."""
        lengths = [np.abs(getattr(self, f.name)).max() for f in fields(self) if kind_of(f).dimension == "length"]
        return float(max(lengths))

    @property
    def digest(self) -> str:
        """SHA-256 of the numbers. Files state it, so that it is known which geometry they are for."""
        return hashlib.sha256(json.dumps(self.as_dict(), sort_keys=True).encode()).hexdigest()


def kind_of(f: Field[Any]) -> FieldKind:
    """Of a field of a geometry record."""
    kind: FieldKind = f.metadata["kind"]
    return kind


def _shape(f: Field[Any]) -> tuple[int, ...]:
    return np.shape(f.default)  # type: ignore[arg-type]


def numbers_of(given: object) -> Vector | None:
    """The values as an array of floats; None if one of them is not a number (text of a number is not one)."""
    try:
        array = np.asarray(given)
    except ValueError:  # ragged
        return None
    return array.astype(float) if array.dtype.kind in "iuf" else None


def frozen(array: Vector) -> Any:
    """The array as a number, a tuple, or a tuple of tuples, which can be hashed."""
    return tuple(frozen(row) for row in array) if array.ndim else float(array)
