"""Compiled kernels release Python's lock, so plain threads share the poses among the cores."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise

import numpy as np

_THREADS = max(1, os.cpu_count() or 1)
_LEAST_PER_THREAD = 4096


def over_spans(count: int, work: Callable[[slice], None]) -> None:
    """Call `work` on slices that cover range(count) once, one a thread; small counts stay in this one."""
    if count == 0:
        return
    threads = min(_THREADS, max(1, count // _LEAST_PER_THREAD))
    edges = np.linspace(0, count, threads + 1).astype(int)
    spans = [slice(first, last) for first, last in pairwise(edges)]
    if threads == 1:
        work(spans[0])
        return
    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(work, spans))
