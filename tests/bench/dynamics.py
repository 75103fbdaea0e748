"""The rigid-body model against MuJoCo; `python -m tests.bench.dynamics` writes the table of docs/dynamics.md."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np

from kinematics import inverse_dynamics
from tests.kinematics.multibody.mujoco_model import MAIN, OpenTree, cycle, loaded, with_rods

PAGE = Path(__file__).parents[2] / "docs" / "dynamics.md"
START, END = "<!-- written by `python -m tests.bench.dynamics` -->", "<!-- /dynamics -->"
PAYLOAD, HALF, STEP = 1.0, 0.2, 1e-4


def main() -> None:
    """The table, into the page."""
    lines = [
        f"There and back along the Adept cycle in {2 * HALF:g} s with {PAYLOAD:g} kg, s by the septic smoothstep;",
        "the hexapod a shorter one, level, its rods 0.3 m long.",
        "",
        "| robot | split rods: error of the torque, of its peak | torque against MuJoCo's, of its peak "
        "| way in MuJoCo under these torques alone, largest error [m] | energy let go, drift |",
        "| --- | --- | --- | --- | --- |",
    ]
    for kind in MAIN:
        uniform = with_rods(kind(), True)
        motion = cycle(kind, HALF, np.arange(round(2 * HALF / STEP) + 1) * STEP)
        split, torque = (inverse_dynamics(robot, PAYLOAD, *motion) for robot in (kind(), uniform))
        error = np.abs(split - torque).max() / np.abs(torque).max()
        cells = (_against_mujoco(uniform, motion, torque), _way(uniform, motion, torque), _drift(uniform))
        numbers = " | ".join(f"{value:.1e}" for value in cells)
        lines.append(f"| {kind.__name__} | {100 * error:.2f} % | {numbers} |")
    before, rest = PAGE.read_text().split(START)
    PAGE.write_text(f"{before}{START}\n" + "\n".join(lines) + f"\n{END}{rest.split(END)[1]}")


def _against_mujoco(robot, motion, torque) -> float:
    """What our torques do on the twist less what MuJoCo's forces do, over the largest."""
    tree, steps = OpenTree(robot, motion[0][0], PAYLOAD), range(0, len(torque), 40)
    wrench = np.array([tree.wrench(*(part[k] for part in motion)) for k in steps])
    ours = np.einsum("kmn,km->kn", robot.actuator_jacobian(motion[0][::40]), torque[::40])
    return float(np.abs(ours - wrench).max() / np.abs(wrench).max())


def _way(robot, motion, torque) -> float:
    model, data = loaded(robot, motion[0][0], PAYLOAD)
    where, error = [model.joint(name).qposadr[0] for name in robot.pose_names[:3]], 0.0
    for k in range(len(torque) - 1):
        data.ctrl[:] = (torque[k] + torque[k + 1]) / 2
        mujoco.mj_step(model, data)
        error = max(error, float(np.linalg.norm(data.qpos[where] - motion[0][k + 1, :3])))
    return error


def _drift(robot) -> float:
    """Of the energy in 0.1 s from home, over the largest kinetic energy."""
    model, data = loaded(robot, np.array(robot.home), PAYLOAD)
    mujoco.mj_forward(model, data)
    before, kinetic = data.energy.sum(), 0.0
    for _ in range(1000):
        mujoco.mj_step(model, data)
        kinetic = max(kinetic, float(data.energy[1]))
    return abs(data.energy.sum() - before) / kinetic


if __name__ == "__main__":
    main()
