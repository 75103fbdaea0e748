"""The decorator of the functions that numba compiles here. They are kept on disk until a file of this room changes.

numba checks only the function's own file for changes, although a compiled function contains the functions that it
calls.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from numba import njit

_SOURCES = hashlib.sha256(b"".join(file.read_bytes() for file in sorted(Path(__file__).parent.glob("*.py"))))


def compiled(function: Callable[..., Any]) -> Any:
    """The function, to be compiled at its first call."""
    dispatcher: Any = njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc", "nsz", "arcp"})(function)
    dispatcher._cache._cache_file._source_stamp = _SOURCES.hexdigest()
    return dispatcher
