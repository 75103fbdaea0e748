"""Products of many polynomials at once."""

from __future__ import annotations

import numpy as np


def product(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """(k, a + 1) and (k or 1, b + 1) coefficients -> (k, a + b + 1), row by row."""
    result = np.zeros((len(first), first.shape[1] + second.shape[1] - 1))
    for i in range(second.shape[1]):
        result[:, i : i + first.shape[1]] += first * second[:, i : i + 1]
    return result
