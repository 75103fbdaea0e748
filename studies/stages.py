"""A stage of a command: its name, the time that it may take, and the time that it took."""

from __future__ import annotations

import inspect
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

Progress = Callable[[str], None]


@contextmanager
def stage(name: str, progress: Progress, seconds: float | None = None) -> Iterator[None]:
    """Tell when a stage starts, and when it ends, with its budget in seconds where it has one."""
    progress(f"{name}: at most {seconds:g} s" if seconds is not None else f"{name}: started")
    started = time.perf_counter()
    yield
    of = f" of {seconds:g} s" if seconds is not None else ""
    progress(f"{name} ended: {time.perf_counter() - started:.1f} s{of}")


def budget_of(function: Callable[..., Any], seconds: float) -> dict[str, Any]:
    return {"seconds": seconds} if "seconds" in inspect.signature(function).parameters else {}
