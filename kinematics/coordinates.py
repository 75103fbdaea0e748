"""The pose's coordinates by name: which are lengths, and which are angles."""

LENGTHS = ("x", "y", "z")


def is_length(name: str) -> bool:
    """Whether a coordinate of a pose is a length [m]; every other one is an angle [rad]."""
    return name in LENGTHS
