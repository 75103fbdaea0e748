"""The true error of the tool, not only its first order: a bound of what the first order leaves out.

Let a = C q be the actuators, J = da / d pose, and p the pose where the actuators are off by e, |e_i| <= E_i. On the
line from the pose p0 to p = p0 + t the inverse model gives e = (J(p0) + D) t. With |t_k| <= d_k and H_ijk the largest
|dJ_ij / d pose_k| around, |D_ij| <= N_ij = sum_k H_ijk d_k / 2. So t is the first order J(p0)^-1 e and no more than
|J(p0)^-1| N |t| beside it. If that gives |t| < d, and J has no singularity as far as d, then t follows e from 0 without
leaving d: such a pose exists, and it is the one that the robot takes.

With more encoders than freedoms t is the error of the best fit, J(p)^T (a(p) - a(p0) - e) = 0. There J changes in J^T
too.

All bounds over boxes of poses are interval arithmetic; sums and products of them are made larger by `_UP`.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca
import numpy as np

from design.certificates.box_tree import halves, outside, root
from design.regions import Region
from kinematics import Array, BoxProgram, InvalidValue, Mechanism, Program, enclose, whole

_UP = 1.0 + 1e-9  # far more than the rounding of some hundred sums and products
_SMALL = _UP - 1.0
_FIRST = 2.0  # a first guess of d over the first order
_TRIES = 3  # guesses of d, each from the last result
_ROOM = 1.2
_BATCH = 4096  # boxes that are bounded together


@dataclass(frozen=True)
class NonlinearError:
    """What must be added to `position_accuracy` and `angle_accuracy`, so that they bound the true error in a region.

    Attributes:
        position, angle: [m], [rad]; 0 without an angle.
        boxes: the number of boxes that the region was cut into.
    """

    position: float
    angle: float
    boxes: int


def nonlinear_error(
    robot: Mechanism, region: Region, *, share: float = 0.01, most_boxes: int = 1_000_000
) -> NonlinearError | None:
    """Bound what the first order leaves out, at every pose of a region; None if it could not be bounded.

    Args:
        robot: its drives have errors, its joints no play.
        region: it is cut until the bound of each box is at most `share` of the first order in its middle, coordinate by
            coordinate.
        most_boxes: the most boxes that are bounded. At their end, boxes above `share` count as they are.

    Raises:
        InvalidRegion: the region does not have the robot's coordinates.
        InvalidValue: the pose has Euler angles, the joints have play, or `most_boxes` is below 1.
    """
    region.check(robot.pose_names)
    if not robot.pose_rate_map(robot.model().pose).is_eye():
        raise InvalidValue(f"{type(robot).__name__} pose", "Euler angles", "a robot with at most one rotation")
    if robot.structure.joint_play:
        raise InvalidValue("joint_play", robot.structure.joint_play, "0: the bound is for the actuators' errors alone")
    bounds, most = _Bounds(robot, region.extent(robot.pose_names)), whole("most_boxes", most_boxes, 1)
    stack, worst, count = [root(region, robot.pose_names)], np.zeros(2), 0
    while stack:
        low, high = stack.pop()
        kept = ~outside(region, low, high, robot.pose_names)
        low, high = low[kept], high[kept]
        if len(low) > _BATCH:
            stack.append((low[_BATCH:], high[_BATCH:]))
            low, high = low[:_BATCH], high[:_BATCH]
        rest, typical, spread = bounds.rest(low, high)
        count += len(low)
        final = (count >= most) | (low == high).all(axis=1)
        done = np.isfinite(rest).all(axis=1) & (final | (rest <= share * typical).all(axis=1))
        if (final & ~done).any():
            return None
        for k, chosen in enumerate((bounds.lengths, bounds.angles)):
            sizes = np.linalg.norm(rest[done][:, chosen], axis=1)
            worst[k] = max(worst[k], _UP * sizes.max(initial=0.0))
        if not done.all():
            stack.append(halves(low[~done], high[~done], spread[~done].argmax(axis=1)))
    return NonlinearError(float(worst[0]), float(worst[1]), count)


class _Bounds:
    """Bounds over boxes of poses.

    Attributes:
        lengths, angles: places of the coordinates in a pose.
    """

    def __init__(self, robot: Mechanism, extent: Array) -> None:
        model = robot.model()
        jacobian, n = model.actuator_jacobian, len(robot.pose_names)
        self._shape = jacobian.shape
        slopes = ca.vertcat(*(ca.jacobian(jacobian[i, :], model.pose) for i in range(self._shape[0])))
        fixed = list(robot.geometry.vector())
        self._jacobian, self._slopes = (
            BoxProgram.of(Program.of(ca.Function("bound", [model.pose, model.geometry], [ca.cse(rows)])), fixed)
            for rows in (_listed(jacobian), _listed(slopes))
        )
        self._errors = robot.inertia.drive_train.position_errors(self._shape[0])
        self._extent = np.where(extent > 0.0, extent, 1.0)
        self.angles = list(robot.rotations)
        self.lengths = [k for k in range(n) if k not in robot.rotations]

    @np.errstate(invalid="ignore", over="ignore")  # of numbers that are infinite, as they are unknown
    def rest(self, low: Array, high: Array) -> tuple[Array, Array, Array]:
        """(k, n) what the first order leaves out, inf if unknown; and two estimates: (k, n) the first order in the
        middle, (k, n) how much each coordinate's width spreads J, or the widths over the region's.
        """
        m, n = self._shape
        point = 0.5 * (low + high)
        least, most = (bound.reshape(-1, m, n) for bound in enclose(self._jacobian, point, point))
        middle = np.nan_to_num(0.5 * (least + most), posinf=np.nan)
        inverse = np.linalg.pinv(np.where(np.isfinite(middle), middle, 0.0))
        typical = np.abs(inverse) @ self._errors
        rest, moved, spread = np.full(low.shape, np.inf), _FIRST * typical, np.full(low.shape, np.inf)
        half = _UP * np.maximum(high - point, point - low)
        for _ in range(_TRIES):
            sizes = self._slope_sizes(low - moved, high + moved)
            spread = (np.abs(inverse)[:, :, :, None, None] * (sizes * half[:, None, None])[:, None]).sum(axis=(1, 2, 3))
            good = np.flatnonzero(np.isfinite(sizes).all(axis=(1, 2, 3)) & np.isfinite(middle).all(axis=(1, 2)))
            sizes = sizes[good]
            radius = _UP * ((sizes @ half[good][:, None, :, None])[..., 0] + (most - least)[good])
            ways = _Ways.of(middle[good], radius)
            found, total = ways.beside(sizes, moved[good], self._errors)
            holds = ((total < moved[good]) | ((total == 0.0) & (moved[good] == 0.0))).all(axis=1)
            rest[good] = np.where(holds[:, None], np.minimum(rest[good], found), rest[good])
            moved[good] = np.where(holds[:, None], np.minimum(_ROOM * total, moved[good]), 2.0 * moved[good])
        unknown = ~(np.isfinite(spread).all(axis=1) & (spread > 0.0).any(axis=1))
        spread[unknown] = (half / self._extent)[unknown]
        return rest, typical, spread

    def _slope_sizes(self, low: Array, high: Array) -> Array:
        """(k, m, n, n) H over boxes."""
        m, n = self._shape
        sizes: Array = np.maximum(*(np.abs(bound) for bound in enclose(self._slopes, low, high)))
        return sizes.reshape(-1, m, n, n)


@dataclass(frozen=True)
class _Ways:
    """Moduli of matrices at every pose of each box.

    Attributes:
        jacobian, pseudo_inverse, gram_inverse: (k, m, n), (k, n, m), (k, n, n) upper bounds of |J|, |J^+|,
            |(J^T J)^-1|; inf where J may be singular.
    """

    jacobian: Array
    pseudo_inverse: Array
    gram_inverse: Array

    @classmethod
    def of(cls, middle: Array, radius: Array) -> _Ways:
        """Of all J (k, m, n) within a radius (k, m, n) of a middle."""
        m, n = middle.shape[1:]
        turned, turned_radius = np.swapaxes(middle, 1, 2), np.swapaxes(radius, 1, 2)
        jacobian = np.abs(middle) + radius
        gram = turned @ middle
        spread = np.abs(turned) @ radius + turned_radius @ np.abs(middle) + turned_radius @ radius
        inverse = _inverted(gram)
        grown = _resolvent(_off(inverse, gram) + np.abs(inverse) @ spread)
        gram_inverse = _UP * grown @ np.abs(inverse)
        if m == n:
            inverse = _inverted(middle)
            pseudo = _UP * _resolvent(_off(inverse, middle) + np.abs(inverse) @ radius) @ np.abs(inverse)
        else:
            pseudo = _UP * grown @ (np.abs(inverse @ turned) + np.abs(inverse) @ turned_radius)
        return cls(jacobian, pseudo, gram_inverse)

    def beside(self, sizes: Array, moved: Array, errors: Array) -> tuple[Array, Array]:
        """(k, n) what the first order leaves out, and (k, n) |t|, if |t| is below `moved`; inf where unknown.

        Args:
            sizes: (k, m, n, n) H.
            moved: (k, n) d.
            errors: (m,) E.
        """
        m, n = self.jacobian.shape[1:]
        first = self.pseudo_inverse @ errors
        change = 0.5 * (sizes @ moved[:, None, :, None])[..., 0]  # N; J itself changes by 2 N at most
        factor, alone = self.pseudo_inverse @ change, np.zeros_like(first)
        singular = 2.0 * factor
        if m > n:
            turned = np.swapaxes(change, 1, 2)
            along = self.jacobian + change
            factor = factor + 2.0 * self.gram_inverse @ turned @ along
            alone = 2.0 * (self.gram_inverse @ turned @ errors)
            residual = errors + (along @ moved[..., None])[..., 0]
            bent = (residual[:, :, None, None] * sizes).sum(axis=1)
            both = 2.0 * (turned @ self.jacobian + np.swapaxes(self.jacobian, 1, 2) @ change) + 4.0 * turned @ change
            singular = self.gram_inverse @ (both + bent)
        total = _UP * (_resolvent(_UP * factor) @ (first + alone)[..., None])[..., 0]
        total = np.where(np.isfinite(_resolvent(_UP * singular)).all(axis=(1, 2))[:, None], total, np.inf)
        rest = _UP * (alone + (factor @ total[..., None])[..., 0])
        return np.nan_to_num(rest, nan=np.inf), np.nan_to_num(total, nan=np.inf)


def _listed(matrix: ca.SX) -> ca.SX:
    """The entries row by row."""
    return ca.densify(ca.vec(matrix.T))


def _inverted(matrices: Array) -> Array:
    """(k, n, n) an approximate inverse; zeros where there is none."""
    regular = np.isfinite(matrices).all(axis=(1, 2)) & (np.abs(np.linalg.det(matrices)) > 0.0)
    result = np.zeros_like(matrices)
    result[regular] = np.linalg.inv(matrices[regular])
    return result


def _off(inverse: Array, matrix: Array) -> Array:
    """|I - inverse matrix|, and what rounding may hide of it."""
    eye = np.eye(matrix.shape[-1])
    result: Array = np.abs(eye - inverse @ matrix) + 1e-14 * (np.abs(inverse) @ np.abs(matrix))
    return result


def _resolvent(matrices: Array) -> Array:
    """(k, n, n) sum of all powers of matrices >= 0, (I - A)^-1; inf where the sum is not finite.

    It is finite if and only if A x < x for some x > 0; x = (I - A)^-1 1 is tried. The inverse F is off by no more than
    F |I - (I - A) F|.
    """
    n = matrices.shape[-1]
    finite = np.isfinite(matrices).all(axis=(1, 2))
    usable = np.where(finite[:, None, None], matrices, 0.5 * np.eye(n))
    regular = np.abs(np.linalg.det(np.eye(n) - usable)) > 1e-12
    found = np.linalg.inv(np.where(regular[:, None, None], np.eye(n) - usable, np.eye(n)))
    x = found.sum(axis=2)
    found = np.maximum(found, 0.0)
    off = np.abs(np.eye(n) - (np.eye(n) - usable) @ found) <= 1e-2 * _SMALL * found
    shown = finite & regular & ((usable @ x[..., None])[..., 0] * _UP < x).all(axis=1) & off.all(axis=(1, 2))
    result: Array = np.where(shown[:, None, None], found * _UP + _SMALL * found @ found, np.inf)
    return result
