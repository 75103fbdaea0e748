"""The wall-clock time that a search or a proof may take."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Iterator
from numbers import Real
from typing import TypeVar

from kinematics import InvalidValue

Item = TypeVar("Item")


class Budget:
    """A number of seconds from now; infinity for no limit.

    Raises:
        InvalidValue: the number is not above 0.
    """

    def __init__(self, seconds: float) -> None:
        usable = isinstance(seconds, Real) and not isinstance(seconds, bool) and seconds > 0.0  # NaN is not
        if not usable:
            raise InvalidValue("seconds", repr(seconds) if isinstance(seconds, str) else seconds, "a number > 0")
        self.seconds = float(seconds)
        self._end = time.perf_counter() + self.seconds

    @property
    def left(self) -> float:
        """The time that is left [s], never below 0."""
        return max(0.0, self._end - time.perf_counter())

    @property
    def spent(self) -> bool:
        """Whether no time is left."""
        return self.left == 0.0

    def share(self, parts: int) -> Budget:
        """One of `parts` equal parts of the time that is left."""
        return Budget(max(self.left / parts, 1e-9))

    def during(self, items: Iterable[Item]) -> Iterator[Item]:
        """Items until the time is spent. The first one always comes."""
        for k, item in enumerate(items):
            if k and self.spent:
                return
            yield item

    def __str__(self) -> str:
        return "no time limit" if math.isinf(self.seconds) else f"{self.seconds:g} s"
