"""The Adept cycle: up, across and down, with corners whose curvature starts and ends at zero with zero slope.

In a corner of arc length l the tangent turns from one leg to the other by phi = (pi/2) S5(s / l), S5 the quintic
smoothstep: the curvature and its derivative vanish at both ends, so the path is G3. Along either leg a corner takes
l I with I = integral of sin((pi/2) S5(u)) over [0, 1]; S5(1 - u) = 1 - S5(u) makes both legs' shares equal, and l
follows from the wanted blend. The tool turns by turn S7(s / length), S7 the septic smoothstep.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, fields
from functools import cache, cached_property

import casadi as ca
import numpy as np

from kinematics import InvalidValue
from kinematics.block_program import BlockProgram
from kinematics.interpreter import bulk, evaluate
from kinematics.motion import derivatives_along
from trajectory.path import Array, Path, Reversed, checked_arc_length

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(32)  # exact to rounding: the integrands are entire functions
_NODES, _WEIGHTS = (_NODES + 1) / 2, _WEIGHTS / 2


@dataclass(frozen=True)
class AdeptCycle:
    """Half of a pick-and-place cycle, from the pick pose to the place pose; `reversed()` is the way back.

    Attributes:
        lift: height of the vertical legs [m].
        span: distance across [m].
        blend: what a corner takes off each of its legs [m]; at most the lift and half of the span.
        turn: rotation of the tool from pick to place [rad].
        pick: (3,) where the cycle starts [m].
        heading: direction of the span in the xy plane, from x [rad].
        start_angle: theta at the pick [rad].

    Raises:
        InvalidValue: a field that is not finite, or out of these bounds.
    """

    lift: float = 0.025
    span: float = 0.305
    blend: float = 0.0249
    turn: float = math.pi
    pick: tuple[float, float, float] = (-0.1525, 0.0, -0.8)
    heading: float = 0.0
    start_angle: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "pick", tuple(float(v) for v in self.pick))
        if len(self.pick) != 3:
            raise InvalidValue("AdeptCycle pick", self.pick, "three coordinates (x, y, z) [m]")
        for field in fields(self):
            if not np.all(np.isfinite(getattr(self, field.name))):
                raise InvalidValue(f"AdeptCycle {field.name}", getattr(self, field.name), "finite")
        for name in ("lift", "span"):
            if getattr(self, name) <= 0:
                raise InvalidValue(f"AdeptCycle {name}", getattr(self, name), "a length > 0 m")
        if self.blend <= 0:
            raise InvalidValue("AdeptCycle blend", self.blend, "a length > 0 m")
        if self.blend > self.lift:
            raise InvalidValue("AdeptCycle blend", self.blend, f"at most the lift, {self.lift} m")
        if 2 * self.blend > self.span:
            raise InvalidValue("AdeptCycle blend", self.blend, f"at most half of the span, {self.span} m")

    @classmethod
    def centred(cls, centre: tuple[float, float, float], span: float = 0.305, **others: float) -> AdeptCycle:
        """The cycle whose pick and place lie symmetrically about a point at their own height.

        Args:
            centre: (3,) halfway between pick and place [m].
            span: distance across [m].
            others: further fields of the cycle.
        """
        heading = others.get("heading", 0.0)
        x, y, z = centre
        pick = (x - span / 2 * math.cos(heading), y - span / 2 * math.sin(heading), z)
        return cls(span=span, pick=pick, **others)

    @property
    def corner_length(self) -> float:
        """Arc length l of a corner [m]."""
        return self.blend / float(_turned(np.array(1.0))[1])

    @cached_property
    def knots(self) -> tuple[float, ...]:
        """(6,) arc lengths where the pieces meet: leg, corner, leg, corner, leg [m]."""
        pieces = [self.lift - self.blend, self.corner_length, self.span - 2 * self.blend]
        return tuple(float(v) for v in np.cumsum([0.0, *pieces, *pieces[1::-1]]))

    @property
    def length(self) -> float:
        """Arc length of the half cycle [m]."""
        return self.knots[-1]

    def reversed(self) -> Path:
        """The way back."""
        return Reversed(self)

    def as_dict(self) -> dict[str, object]:
        """The fields, the pick as a list."""
        return {**asdict(self), "pick": list(self.pick)}

    def evaluate(self, s: Array, order: int = 3) -> tuple[Array, ...]:
        """As `Path.evaluate`."""
        s = checked_arc_length(s, self.length, order)
        in_corner = [np.clip((s - start) / self.corner_length, 0.0, 1.0) for start in (self.knots[1], self.knots[3])]
        states = np.stack([*in_corner, s / self.length], axis=-1)
        rates = np.broadcast_to([1 / self.corner_length, 1 / self.corner_length, 1 / self.length], states.shape)
        tangent = evaluate(_tangent_program(), states, rates)
        across, up = self._position(s, *in_corner)
        pose = self._placed(across, up, tangent[3][..., 0])
        pose[..., :3] += self.pick
        pose[..., 3] += self.start_angle
        orders = zip(tangent[:3], tangent[4:], strict=True)
        derivatives = [self._placed(t[..., 0], t[..., 1], turned[..., 0]) for t, turned in orders]
        return (pose, *derivatives[:order])

    def _position(self, s: Array, first: Array, second: Array) -> tuple[Array, Array]:
        """Distances across and up from the pick, (...,) each [m]; `first` and `second` are how far into the corners."""
        _, rising, spanning, falling, down, _ = self.knots
        rise, veer = _turned(first)
        carry, fall = _turned(second)
        across = self.corner_length * (veer + carry) + np.clip(s - spanning, 0.0, falling - spanning)
        straight = np.clip(s, 0.0, rising) - np.maximum(s - down, 0.0)
        return across, straight + self.corner_length * (rise - fall)

    def _placed(self, across: Array, up: Array, turned: Array) -> Array:
        """(..., 4) along the heading, up, and by the turn."""
        c, d = math.cos(self.heading), math.sin(self.heading)
        return np.stack([across * c, across * d, up, self.turn * turned], axis=-1)


def _turned(u: Array) -> tuple[Array, Array]:
    """Integrals of cos and sin of (pi/2) S5 over [0, u], (...,) each, by Gauss-Legendre quadrature."""
    at = u[..., None] * _NODES
    angle = math.pi / 2 * at**3 * (10 + at * (-15 + 6 * at))
    return u * (np.cos(angle) @ _WEIGHTS), u * (np.sin(angle) @ _WEIGHTS)


@cache
def _tangent_program() -> BlockProgram:
    """(u1, u2, w) and their rates by s -> tangent (across, up) to its second, turned fraction to its third derivative.

    How far into a corner, u, is held at 0 before it and 1 after it; there the first two derivatives of S5 vanish, so
    the held value has the right derivatives and no knot is differentiated.
    """
    state, rate = ca.SX.sym("state", 3), ca.SX.sym("rate", 3)
    quintic = [u**3 * (10 + u * (-15 + 6 * u)) for u in (state[0], state[1])]
    septic = state[2] ** 4 * (35 + state[2] * (-84 + state[2] * (70 - 20 * state[2])))
    angle = math.pi / 2 * (quintic[0] + quintic[1])
    none = ca.SX(3, 1)
    tangent = derivatives_along(ca.vertcat(ca.sin(angle), ca.cos(angle)), state, [rate, none])
    turned = derivatives_along(septic, state, [rate, none, none])
    return bulk(ca.Function("tangent", [state, rate], [*tangent, *turned]))
