"""Mirrors: if a mirror maps a region onto itself, a proof on one side is enough.

A mechanism names, in `mirrors`, coordinates whose signs may change together. This is checked: a mirror is used only if
the Jacobians are shown to be the same on both sides, except for the limbs' order and signs,

    J_x(D pose) = P J_x(pose) D    and    |J_q(D pose)| = P' |J_q(pose)|,

with D = diag(+-1), P a permutation with signs and P' the same without signs. Each entry is compared as an exact form in
pose and geometry. Margins of the Jacobians are then equal. P and D are orthogonal, and D is diagonal, as is the scaling
of the rotations. So the lengths of rows, volumes, and the lengths of the pseudo-inverse's columns stay, in another
order.
"""

from __future__ import annotations

from functools import lru_cache

import casadi as ca

from design.certificates.normal_form import Form, NoForm, forms
from design.regions import Region
from kinematics import Array, Mechanism, Model

Mirrors = tuple[tuple[str, ...], ...]


def mirrors_of(robot: Mechanism, region: Region, margin: str) -> Mirrors:
    """The mirrors that keep the region and are shown to keep the margin. The first coordinate of each is halved."""
    if not robot.margins[margin].mirrored(robot):
        return ()
    kept = [names for names in robot.mirrors if _keeps(region, names) and _holds(type(robot), robot.model(), names)]
    halved = [names[0] for names in kept]
    return tuple(names for names in kept if sum(name in halved for name in names) == 1)


def one_side(low: Array, high: Array, mirrors: Mirrors, names: tuple[str, ...]) -> tuple[Array, Array]:
    """(1, n) bounds where the first coordinate of each mirror is at least 0."""
    low = low.copy()
    for mirror in mirrors:
        low[:, names.index(mirror[0])] = 0.0
    return low, high


def _keeps(region: Region, names: tuple[str, ...]) -> bool:
    """Whether the mirror maps the region onto itself: true if the intervals of these coordinates are symmetric."""
    intervals = [region.intervals[name] for name in names]
    return all(low == -high for low, high in intervals) and intervals[0][1] > 0.0


@lru_cache(maxsize=64)
def _holds(robot: type[Mechanism], model: Model, names: tuple[str, ...]) -> bool:
    """Whether the mirror holds for every geometry; the geometry is symbolic."""
    if not model.drives.is_eye() or len(robot.pose_names) != model.j_x_at_pose.shape[1]:
        return False
    signs = [-1 if name in names else 1 for name in robot.pose_names]
    scale = robot.scales(model.g)[0]
    rows = ca.horzcat(model.j_x_at_pose, model.j_q_at_pose, scale)
    symbols = [model.pose, model.geometry]
    pose = [Form.atom(("pose", name)) for name in robot.pose_names]
    fixed = [Form.atom(("geometry", i)) for i in range(model.geometry.numel())]
    try:
        here, defined_here = forms(symbols, rows, [*pose, *fixed])
        there, defined_there = forms(
            symbols, rows, [*(p if sign > 0 else -p for p, sign in zip(pose, signs, strict=True)), *fixed]
        )
    except NoForm:
        return False
    width = rows.shape[1]
    return defined_there <= defined_here and _matched(
        [here[i : i + width] for i in range(0, len(here), width)],
        [there[i : i + width] for i in range(0, len(there), width)],
        signs,
    )


def _matched(here: list[list[Form]], there: list[list[Form]], signs: list[int]) -> bool:
    """Whether each row [J_x, J_q, scale] of `there` is the mirror image of a row of `here`."""
    left = list(here)
    for row in there:
        match = next((i for i, other in enumerate(left) if _mirrored(other, row, signs)), None)
        if match is None:
            return False
        del left[match]
    return True


def _mirrored(here: list[Form], there: list[Form], signs: list[int]) -> bool:
    turned = [form if sign > 0 else -form for form, sign in zip(here[:-2], signs, strict=True)]
    same_rows = turned == there[:-2] or [-form for form in turned] == there[:-2]
    return same_rows and here[-2].signed()[1] == there[-2].signed()[1] and here[-1] == there[-1]
