"""Derivatives by numbers alone, and what mechanics makes of them: oracles that know nothing of the models."""

import numpy as np


def slope(function, t, step):
    """Of a function of times (k,), item by item, to the fourth order."""
    near, far = (function(t + k * step) - function(t - k * step) for k in (1, 2))
    return (8 * near - far) / (12 * step)


def differences(function, at, step):
    """The derivative by the last axis, to the fourth order: (..., rows, columns)."""
    columns = [slope(lambda t, e=e: function(at + t * e), 0.0, step) for e in np.eye(at.shape[-1])]
    return np.stack(columns, axis=-1)


def lagrange(kinetic, potential, pose, velocity, acceleration):
    """d/dt dT/dv - dT/dx + dV/dx (k, n) of T(x, v) and V(x)."""

    def momentum(t):
        moved = pose + t * velocity
        return differences(lambda v: kinetic(moved, v), velocity + t * acceleration, 1e-2)

    conservative = differences(lambda x: potential(x) - kinetic(x, velocity), pose, 1e-4)
    return slope(momentum, 0.0, 1e-4) + conservative
