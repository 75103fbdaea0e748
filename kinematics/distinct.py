"""Which of several numerical solutions are one."""

from __future__ import annotations

import numpy as np

_EXACT = 1e-9  # distance of solutions that are one, where the equations are regular
_ROUNDING = 1e-14


def distinct(apart: np.ndarray, regularity: np.ndarray) -> list[int]:
    """Indices of solutions, each once.

    Args:
        apart: (k, k) distances of the solutions, over their size.
        regularity: (k,) determinant of the equations there, over its largest; towards 0, where a double solution is
            found as two near ones, solutions count as one from farther off.
    """
    blur = _EXACT + _ROUNDING / np.maximum(np.abs(regularity), 1e-8)
    return [i for i in range(len(apart)) if not (apart[i, :i] < blur[i]).any()]
