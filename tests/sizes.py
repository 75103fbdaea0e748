"""Sizes of a random test: a small one for `make test`, and a large one for `make test-long`."""

from __future__ import annotations

import pytest


def few_or_many(few: int, many: int) -> pytest.MarkDecorator:
    """Run a test with `count` of both sizes."""
    return pytest.mark.parametrize("count", [few, pytest.param(many, marks=pytest.mark.long)])
