"""A stage of a command: its name, its time budget, and the time that it took."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Progress = Callable[[str], None]
LONG = 2.0  # s: a stage that takes longer is also reported in a pipe


class Lasting(str):
    """A line of progress that is also printed in a pipe."""

    __slots__ = ()


@contextmanager
def stage(name: str, progress: Progress, seconds: float = math.inf) -> Iterator[None]:
    """Report that a stage starts, with its budget [s] if it has one, and the time that it took if that was long."""
    start = f"{name}: at most {seconds:g} s" if seconds < math.inf else f"{name} runs"
    progress(start)
    waiting = threading.Timer(LONG, progress, [Lasting(start)])
    waiting.daemon = True
    waiting.start()
    started = time.perf_counter()
    try:
        yield
    finally:
        waiting.cancel()
        if (took := time.perf_counter() - started) > LONG:
            budget = f" of {seconds:g} s" if seconds < math.inf else ""
            progress(Lasting(f"{name} took {took:.1f} s{budget}"))
