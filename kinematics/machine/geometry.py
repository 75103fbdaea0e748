"""Geometry records: one frozen dataclass serves the prototype's numbers and the symbols of the model."""

from __future__ import annotations

import hashlib
import json
import math
from dataclasses import Field, dataclass, field, fields, replace
from types import SimpleNamespace
from typing import Any, Self

import casadi as ca
import numpy as np

from kinematics.errors import InvalidGeometry

Vector = np.ndarray
Points = tuple[tuple[float, ...], ...]  # rows of numbers
TURN = 2.0 * math.pi


def length(default: float | tuple[float, ...] | Points, *, minimum: float | None = 0.0, doc: str) -> Any:
    """A length in metres, greater than `minimum` (None: any sign)."""
    metadata = {"dimension": "length", "minimum": minimum, "doc": doc}
    return field(default=default, metadata=metadata)


def angle(default: float | tuple[float, ...], *, doc: str) -> Any:
    """An angle in radians."""
    return field(default=default, metadata={"dimension": "angle", "minimum": None, "doc": doc})


def screw_pitch(default: float | tuple[float, ...], *, doc: str) -> Any:
    """A screw's pitch in metres per turn, of either hand; never zero."""
    return field(default=default, metadata={"dimension": "length_per_turn", "minimum": None, "doc": doc})


def ratio(default: float, *, doc: str) -> Any:
    """A number > 0 without unit."""
    return field(default=default, metadata={"dimension": "none", "minimum": 0.0, "doc": doc})


def frame(*, doc: str) -> Any:
    """A homogeneous transform (4, 4), rotation without unit and translation in metres; the identity by default."""
    identity = tuple(tuple(float(i == j) for j in range(4)) for i in range(4))
    return field(default=identity, metadata={"dimension": "frame", "minimum": None, "doc": doc})


@dataclass(frozen=True)
class GeometryRecord:
    """Base of every mechanism's `Geometry`: named numbers, tuples of numbers, or tuples of rows of numbers.

    In a vector, a field of rows lies row by row.

    Raises:
        InvalidGeometry: a value is not finite, has the wrong number of items, or is not a possible length.
    """

    def __post_init__(self) -> None:
        for f in fields(self):
            given, wanted = getattr(self, f.name), _shape(f)
            words = " rows of ".join(str(k) for k in wanted) + " numbers" if wanted else "a number"
            array = numbers_of(given)
            if array is None or array.shape != wanted:
                raise self._invalid(f.name, given, words)
            if not np.isfinite(array).all():
                raise self._invalid(f.name, given, "finite values")
            minimum = f.metadata["minimum"]
            if minimum is not None and np.any(array <= minimum):
                raise self._invalid(
                    f.name,
                    given,
                    f"a length > {minimum:g} m" if f.metadata["dimension"] == "length" else f"a number > {minimum:g}",
                )
            if f.metadata["dimension"] == "length_per_turn" and np.any(array == 0.0):
                raise self._invalid(f.name, given, "a pitch other than 0 m/turn")
            object.__setattr__(self, f.name, frozen(array))

    @classmethod
    def _invalid(cls, name: str, found: object, expected: str) -> InvalidGeometry:
        return InvalidGeometry(cls.__qualname__.split(".")[0].removesuffix("Geometry"), name, found, expected)

    @classmethod
    def sizes(cls) -> dict[str, int]:
        """How many numbers each field holds, in the order of `vector`."""
        return {f.name: math.prod(_shape(f)) for f in fields(cls)}

    @classmethod
    def symbols(cls) -> tuple[ca.SX, SimpleNamespace]:
        """The symbol vector (k,) and the same symbols under the fields' names."""
        named = {name: ca.SX.sym(name, size) for name, size in cls.sizes().items()}
        return ca.vertcat(*named.values()), SimpleNamespace(**named)

    def vector(self) -> Vector:
        """(k,) all numbers, in the order of `symbols`."""
        return np.concatenate([np.asarray(getattr(self, f.name), float).reshape(-1) for f in fields(self)])

    @classmethod
    def from_vector(cls, values: Vector) -> Self:
        """Inverse of `vector`."""
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
        """Field names to plain numbers, lists or lists of rows, for files."""
        return {f.name: np.asarray(getattr(self, f.name)).tolist() for f in fields(self)}

    @classmethod
    def descriptions(cls) -> dict[str, str]:
        """What each field means, by its name."""
        return {f.name: f.metadata["doc"] for f in fields(cls)}

    @property
    def size(self) -> float:
        """The largest of its lengths [m]: what makes a distance large or small for this robot."""
        lengths = [np.abs(getattr(self, f.name)).max() for f in fields(self) if f.metadata["dimension"] == "length"]
        return float(max(lengths))

    @property
    def digest(self) -> str:
        """SHA-256 of the numbers, to tell which geometry a file was made for."""
        return hashlib.sha256(json.dumps(self.as_dict(), sort_keys=True).encode()).hexdigest()


def _shape(f: Field[Any]) -> tuple[int, ...]:
    return np.shape(f.default)  # type: ignore[arg-type]


def numbers_of(given: object) -> Vector | None:
    """As an array of floats; None where any of it is not a number, such as text that only looks like one."""
    try:
        array = np.asarray(given)
    except ValueError:  # ragged
        return None
    return array.astype(float) if array.dtype.kind in "iuf" else None


def frozen(array: Vector) -> Any:
    """A number, a tuple, or a tuple of tuples: hashable."""
    return tuple(frozen(row) for row in array) if array.ndim else float(array)
