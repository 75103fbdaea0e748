"""Programs of a robot: expressions with the robot's numbers instead of the geometry's symbols, compiled once and kept.

The key of a program is the robot's value, the function that writes its expressions, and the other arguments of that
function. So no key can mean two expressions. A value that changes from call to call, such as a payload, is an input.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import casadi as ca

from kinematics.evaluation import BlockProgram, bulk

if TYPE_CHECKING:
    from kinematics.model.mechanism import Mechanism

Build = tuple[list[ca.SX], list[ca.SX]]  # inputs and outputs of a program
Write = Callable[..., Build]
_KEPT = 512


@lru_cache(maxsize=_KEPT)
def program_of(robot: Mechanism, write: Write, *given: Any) -> BlockProgram:
    """The program of `write(robot, model, *given)`.

    Args:
        write: a function of a module or class, from a robot, its model and further values to inputs and outputs.
        given: further values, which can be hashed.

    Raises:
        TypeError: `write` is made anew at each call, so that it could not be found again.
    """
    if "<" in write.__qualname__:
        raise TypeError(f"{write.__qualname__} is made at each call; a program needs a function of a module or class")
    model = robot.model()
    inputs, outputs = write(robot, model, *given)
    with_symbols = ca.Function("symbolic", [*inputs, model.geometry], outputs)
    numbers = with_symbols.call([*inputs, ca.SX(robot.geometry.vector())])
    return bulk(ca.Function(type(robot).__name__, inputs, numbers))
