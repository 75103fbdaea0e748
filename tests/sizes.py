"""Which cases of a test `make test` runs, and which ones are for `make test-long`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import pytest


def later(*values: Any) -> Any:
    """A case for `make test-long` alone."""
    return pytest.param(*values, marks=pytest.mark.long)


def few_or_many(few: int, many: int) -> pytest.MarkDecorator:
    """Run a test with `count` of both sizes."""
    return pytest.mark.parametrize("count", [few, later(many)])


def few_of(cases: Iterable[tuple[Any, ...]], quick: Callable[..., bool]) -> list[Any]:
    """The cases of a claim about many; those that are not quick are for `make test-long`."""
    return [case if quick(*case) else later(*case) for case in cases]


QUICK = ("Heli4", "Redundant3T1R", "Peppermill", "Delta", "Planar3RRR")


def every_mechanism(names: Iterable[str]) -> list[Any]:
    """The names of all mechanisms; those of six freedoms, and those that are like another, are for `make test-long`."""
    return [name if name in QUICK else later(name) for name in names]
