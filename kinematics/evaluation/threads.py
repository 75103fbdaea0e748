"""Compiled kernels release Python's lock, so plain threads share the poses among the cores."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache

# Those that this process may use, where the system tells.
CORES = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
_LEAST_PER_THREAD = 4096
CHUNK = 1 << 15  # poses of one piece of work: what it copies stays in the second cache


def over_spans(count: int, work: Callable[[slice], None]) -> None:
    """Call `work` on slices that cover range(count) once, shared among the threads; small counts stay in this one."""
    threads = min(CORES, max(1, count // _LEAST_PER_THREAD))
    size = max(1, min(CHUNK, -(-count // threads)))
    spans = [slice(first, min(first + size, count)) for first in range(0, count, size)]
    if threads == 1:
        for span in spans:
            work(span)
    else:
        list(_pool(threads).map(work, spans))


@cache
def _pool(threads: int) -> ThreadPoolExecutor:
    """Kept for the next call: to start threads costs more than a small piece of work."""
    return ThreadPoolExecutor(threads)


if hasattr(os, "register_at_fork"):  # not on Windows, which does not fork
    os.register_at_fork(after_in_child=_pool.cache_clear)  # a child has the pool but not its threads
