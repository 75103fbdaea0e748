"""Numbers in millimetres, degrees and turns a minute as SI: the double nearest to the exact product.

So 41.3 mm is the very number that 0.0413 m is, wherever it is read.
"""

from __future__ import annotations

from decimal import Decimal, localcontext

_PI = Decimal("3.14159265358979323846264338327950288419716939937510582097494459")
_DIGITS = 60
FACTORS = {"": (Decimal(1), 1), "mm": (Decimal(1), 1000), "deg": (_PI, 180), "rpm": (_PI, 30)}
"""By suffix: what a number is multiplied by, and then divided by."""


def in_si(number: float | str, suffix: str) -> float:
    """A number, or the text that a file has of it, in the unit of the suffix, in SI.

    Raises:
        ValueError: the text is no number.
        KeyError: there is no such suffix.
    """
    float(number)  # refuses with ValueError what is no number
    times, over = FACTORS[suffix]
    with localcontext() as context:
        context.prec = _DIGITS
        return float(Decimal(number if isinstance(number, str) else repr(float(number))) * times / over)
