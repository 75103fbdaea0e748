"""The Adept cycle: up, across and down, with rounded corners. The tool turns all the way."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np

from kinematics import Array, InvalidField, InvalidValue
from trajectory.paths.path import SCHOENFLIES, Path, PathBox, Reversed
from trajectory.paths.rounded_path import RoundedPath

STANDARD_SIZES: dict[str, tuple[float, float, float]] = {
    "25/305/25": (0.025, 0.305, 0.025),
    "25/300/25": (0.025, 0.300, 0.025),
    "25/700/25": (0.025, 0.700, 0.025),
}
"""The usual names, in millimetres up, across and down, and their lift, span and place lift [m]."""


@dataclass(frozen=True)
class AdeptCycle:
    """Half of a pick-and-place cycle, from the pick pose to the place pose; `reversed()` is the way back.

    Attributes:
        lift: height of the vertical leg above the pick [m].
        span: horizontal distance to the place [m].
        blend: length that a corner takes off each of its legs [m].
        turn: change of theta, or yaw, from pick to place [rad].
        pick: (3,) where the cycle starts [m].
        heading: direction of the span in the xy plane, from x [rad].
        start_angle: theta, or yaw, at the pick [rad].
        place_lift: height of the vertical leg above the place [m]; the lift when None.
        rise: how much higher the place is than the pick [m].
        tilt: (2,) roll and pitch at the place, from level at the pick [rad]; only of a pose that has them.
        pose_names: x, y, z and the robot's angles.

    Raises:
        InvalidValue: a field is not finite, corners do not fit, or the pose has no angle for a turn or tilt.
    """

    lift: float = 0.025
    span: float = 0.305
    blend: float = 0.0249
    turn: float = math.pi
    pick: tuple[float, float, float] = (-0.1525, 0.0, -0.8)
    heading: float = 0.0
    start_angle: float = 0.0
    place_lift: float | None = None
    rise: float = 0.0
    tilt: tuple[float, float] = (0.0, 0.0)
    pose_names: tuple[str, ...] = SCHOENFLIES

    def __post_init__(self) -> None:
        for name, expected in (("pick", "three coordinates (x, y, z) [m]"), ("tilt", "roll and pitch [rad]")):
            value = tuple(float(v) for v in getattr(self, name))
            object.__setattr__(self, name, value)
            if len(value) != (3 if name == "pick" else 2):
                raise InvalidField("AdeptCycle", name, value, expected)
        given = {f.name: getattr(self, f.name) for f in fields(self) if f.name != "pose_names"}
        given = {name: value for name, value in given.items() if value is not None}
        for name, value in given.items():
            if not np.all(np.isfinite(value)):
                raise InvalidField("AdeptCycle", name, value, "finite")
            if name in ("lift", "place_lift", "span", "blend") and value <= 0:
                raise InvalidField("AdeptCycle", name, value, "a length > 0 m")
        self._require_angles()
        self._require_corners()

    def _require_angles(self) -> None:
        if self.pose_names[:3] != SCHOENFLIES[:3]:
            raise InvalidField("AdeptCycle", "pose_names", self.pose_names, "x, y, z and then angles")
        angles = set(self.pose_names[3:])
        for name, missing in (("turn", not angles & {"theta", "yaw"}), ("tilt", not {"roll", "pitch"} <= angles)):
            if missing and np.any(getattr(self, name)):
                what = f"0, as the pose is {', '.join(self.pose_names)}"
                raise InvalidField("AdeptCycle", name, getattr(self, name), what)

    def _require_corners(self) -> None:
        across = math.hypot(self.span, self.rise + self.down - self.lift)
        for size, what in ((self.lift, "the lift"), (self.down, "the place lift"), (across / 2, "half of the span")):
            if self.blend > size:
                raise InvalidField("AdeptCycle", "blend", self.blend, f"at most {what}, {size:.9g} m")

    @property
    def down(self) -> float:
        """Height of the vertical leg above the place [m]."""
        return self.lift if self.place_lift is None else self.place_lift

    @classmethod
    def of_size(cls, size: str, **others: Any) -> AdeptCycle:
        """A standard size, such as "25/305/25".

        Args:
            size: one of `STANDARD_SIZES`.
            others: further fields of the cycle.

        Raises:
            InvalidValue: there is no such size.
        """
        if size not in STANDARD_SIZES:
            raise InvalidValue("size of the Adept cycle", size, f"one of {', '.join(STANDARD_SIZES)}")
        lift, span, place_lift = STANDARD_SIZES[size]
        return cls(lift=lift, span=span, place_lift=place_lift, **others)

    @classmethod
    def centred(cls, centre: tuple[float, float, float], span: float = 0.305, **others: Any) -> AdeptCycle:
        """The cycle whose pick and place lie symmetrically about a point at the pick's height.

        Args:
            centre: (3,) halfway between pick and place [m].
            span: distance across [m].
            others: further fields of the cycle.
        """
        heading = others.get("heading", 0.0)
        x, y, z = centre
        pick = (x - span / 2 * math.cos(heading), y - span / 2 * math.sin(heading), z)
        return cls(span=span, pick=pick, **others)

    @classmethod
    def between(cls, pick: tuple[float, float, float], place: tuple[float, float, float], **others: Any) -> AdeptCycle:
        """The cycle from one point to another [m], which must not lie above it; `others` are further fields."""
        across, along = place[0] - pick[0], place[1] - pick[1]
        heading, rise = math.atan2(along, across), place[2] - pick[2]
        return cls(span=math.hypot(across, along), pick=pick, heading=heading, rise=rise, **others)

    @property
    def place(self) -> tuple[float, float, float]:
        """(3,) where the half cycle ends [m]."""
        x, y, z = self.pick
        return x + self.span * math.cos(self.heading), y + self.span * math.sin(self.heading), z + self.rise

    @cached_property
    def rounded(self) -> RoundedPath:
        """The path through pick, the points above pick and place, and place."""
        (x, y, z), (u, v, w) = self.pick, self.place
        start = {"theta": self.start_angle, "yaw": self.start_angle}
        end = dict.fromkeys(start, self.start_angle + self.turn)
        end |= {"roll": self.tilt[0], "pitch": self.tilt[1]}
        angles = self.pose_names[3:]
        free = (None,) * len(angles)
        poses = (
            (x, y, z, *(start.get(name, 0.0) for name in angles)),
            (x, y, z + self.lift, *free),
            (u, v, w + self.down, *free),
            (u, v, w, *(end[name] for name in angles)),
        )
        return RoundedPath(self.pose_names, poses, (self.blend, self.blend))

    @property
    def knots(self) -> tuple[float, ...]:
        """As `Path.knots`: leg, corner, leg, corner, leg [m]."""
        return self.rounded.knots

    @property
    def length(self) -> float:
        """Arc length of the half cycle [m]."""
        return self.rounded.length

    def reversed(self) -> Path:
        """The way back."""
        return Reversed(self)

    @property
    def stops(self) -> tuple[float, ...]:
        """As `Path.stops`: none, as its corners are rounded."""
        return self.rounded.stops

    def waypoint(self, s: float) -> int | None:  # noqa: ARG002
        """None, as an Adept cycle has no waypoints."""
        return None

    def as_dict(self) -> dict[str, object]:
        """The fields, with lists for tuples and the place's own lift."""
        fields_ = asdict(self) | {"place_lift": self.down}
        return {name: list(v) if isinstance(v, tuple) else v for name, v in fields_.items()}

    def evaluate(self, s: Array, order: int = 3) -> tuple[Array, ...]:
        """As `Path.evaluate`."""
        return self.rounded.evaluate(s, order)

    def enclose(self, low: Array, high: Array) -> PathBox:
        """As `Path.enclose`."""
        return self.rounded.enclose(low, high)

    def steepest(self, s: Array, order: int) -> Array:
        """As `Path.steepest`."""
        return self.rounded.steepest(s, order)
