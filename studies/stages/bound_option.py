"""The options `--at-least` and `--at-most` of the command line."""

from __future__ import annotations

import math

from kinematics import Bound, LinkwrightError, Margin


class InvalidOption(LinkwrightError):
    """An option of the command line has a value that cannot be used."""

    def __init__(self, option: str, found: object, expected: str) -> None:
        self.option, self.found, self.expected = option, found, expected
        super().__init__(f"{option}: found {found}; expected {expected}")


def bound_option(margin: Margin, at_least: float | None, at_most: float | None) -> Bound | None:
    """The bound that `--at-least` or `--at-most` gives; None without one.

    Raises:
        InvalidOption: it is not finite, or the wrong option for the margin.
    """
    if at_least is None and at_most is None:
        return None
    given = {"at_least": at_least, "at_most": at_most}
    for word, value in given.items():
        option = f"--{word.replace('_', '-')}"
        if value is not None and word != margin.word:
            raise InvalidOption(option, value, f"--{margin.right_word.replace('_', '-', 1)}")
        if value is not None and not math.isfinite(value):
            raise InvalidOption(option, value, "a finite number")
    return margin.bound(**given)
