"""A stage of a command: its name, the time that it may take, and the time that it took."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Progress = Callable[[str], None]
LONG = 2.0  # s: a stage that takes longer is told in a pipe, too


class Lasting(str):
    """A line of progress that is told in a pipe, too."""

    __slots__ = ()


@contextmanager
def stage(name: str, progress: Progress, seconds: float = math.inf) -> Iterator[None]:
    """Tell that a stage runs and, where it was long, when it ends; with its budget in seconds where it has one."""
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
