"""Expressions (16)-(35) of Heli4's paper, as printed or with its slips mended one by one."""

from types import SimpleNamespace

import numpy as np

from tests.kinematics.by_hand import UPPER, ByHand


def spheres(hand: ByHand, joints, printed: bool = False) -> np.ndarray:
    """s_i (4, 3) of (18); printed, it leaves out the height of actuators 3 and 4."""
    g = hand.g
    arms = hand.arms(joints) - hand.actuators
    height = g.plate_offset + UPPER * g.height_step  # h_i of (7)
    own = 0.0 if printed else g.height_step * UPPER
    return (g.platform_radius - g.base_radius) * hand.u + (height - own)[:, None] * [0, 0, 1] - arms


def conics(hand: ByHand, joints, slips=()) -> tuple[SimpleNamespace, SimpleNamespace]:
    """Coefficients of (21), and those of the planes z = k x + l y + m of (19) and (20); 18 to 25 in `slips` stay."""
    s = spheres(hand, joints, "18" in slips)
    a, b, c = s[:, 2], s[:, 0], s[:, 1]
    d = (s * s).sum(axis=-1) - hand.g.rod_length**2
    result = []
    for j, k in ((0, 1), (2, 3)):
        da = a[j] - a[k]
        db, dc, dd = (b[k] - b[j]) / da, (c[k] - c[j]) / da, (d[k] - d[j]) / da
        twice = 1 if "19" in slips else 2
        result.append(
            SimpleNamespace(
                plane=(db, dc, dd / twice),
                alpha=db**2 + 1,
                beta=dc**2 + 1,
                chi=(1 if "22" in slips else 2) * db * dc,
                delta=(2 if "23" in slips else 1) * dd * db + 2 * a[j] * db + 2 * b[j],
                epsilon=(2 if "24" in slips else 1) * dd * dc + 2 * a[j] * dc + 2 * c[j],
                phi=(2 * dd**2 + 2 * a[j] * dd if "25" in slips else dd**2 / 4 + a[j] * dd) + d[j],
            )
        )
    return result[0], result[1]


def conic_values(conic: SimpleNamespace, x, y):
    """Left side of (21)."""
    return conic.alpha * x**2 + conic.beta * y**2 + conic.chi * x * y + conic.delta * x + conic.epsilon * y + conic.phi


def eliminated(first: SimpleNamespace, second: SimpleNamespace, slips=()) -> tuple[list[float], list[float]]:
    """(26)-(33): the quartic's coefficients, highest power first, and v_0 to v_10."""
    names = ("alpha", "beta", "chi", "delta", "epsilon", "phi")
    (a1, b1, c1, d1, e1, f1), (a2, b2, c2, d2, e2, f2) = (tuple(getattr(s, n) for n in names) for s in (first, second))
    v = [
        a1 * c2 - a2 * c1, a1 * b2 - a2 * b1, a1 * d2 - a2 * d1, a1 * e2 - a2 * e1, a1 * f2 - a2 * f1,
        c1 * b2 - c2 * b1, c1 * e2 - c2 * e1, c1 * f2 - c2 * f1, b1 * d2 - b2 * d1, d1 * e2 - d2 * e1,
        d1 * f2 - d2 * f1,
    ]  # fmt: skip
    in_u4 = v[3] if "29 u4" in slips else v[5]
    in_u3 = 2 * v[3] if "29 u3" in slips else v[5]
    return [
        v[0] * in_u4 - v[1] ** 2,
        v[0] * (v[6] - v[8]) + v[2] * in_u3 - 2 * v[1] * v[3],
        v[0] * (v[7] + v[9]) + v[2] * (v[6] - v[8]) - v[3] ** 2 - 2 * v[1] * v[4],
        v[0] * v[10] + v[2] * (v[7] + v[9]) - 2 * v[3] * v[4],
        v[2] * v[10] - v[4] ** 2,
    ], v


def poses_by_elimination(hand: ByHand, joints, roots_of) -> np.ndarray:
    """(k, 4) every real pose with these joints by the mended expressions; `roots_of` solves the quartic in y."""
    first, second = conics(hand, joints)
    coefficients, v = eliminated(first, second)
    poses = []
    for y in roots_of(coefficients):
        x = -(v[1] * y**2 + v[3] * y + v[4]) / (v[0] * y + v[2])
        lower, upper = (np.dot(conic.plane, [x, y, 1.0]) for conic in (first, second))
        poses.append([x, y, lower, (upper - lower) / hand.pitch])
    return np.array(poses).reshape(-1, 4)
