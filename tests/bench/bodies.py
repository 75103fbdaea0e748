"""Masses and clearances at home of the ten mechanisms; `python -m tests.bench.bodies` writes docs/bodies.md."""

from __future__ import annotations

import casadi as ca
import numpy as np

from kinematics import MECHANISMS, Mechanism
from kinematics.machine import MATERIALS
from studies.building.load import load_study
from studies.building.objects import robot_of
from studies.stages import time_cycle
from studies.study_file.locate import study_path
from studies.study_file.toml_file import read_toml
from tests.bench.page import ROOT, write_between
from tests.kinematics.weighed import GOUGH_STEWART, HELI4, PEPPERMILL, REDUNDANT

WEIGHED = {
    "cycle_reference": HELI4,
    "redundant_3t1r": REDUNDANT,
    "peppermill": PEPPERMILL,
    "gough_stewart": GOUGH_STEWART,
}
PAGE, BY = ROOT / "docs" / "bodies.md", "python -m tests.bench.bodies"


def main() -> None:
    """Write the page's tables."""
    write_between(PAGE, "materials", _materials(), BY)
    write_between(PAGE, "masses", _masses(), BY)
    write_between(PAGE, "cycles", _cycles(), BY)


def _materials() -> str:
    rows = [
        f"| {name} | {m.density:g} | {m.modulus / 1e9:g} | {m.shear_modulus / 1e9:g} | {m.strength / 1e6:g} |"
        for name, m in MATERIALS.items()
    ]
    head = "| material | density [kg/m^3] | modulus [GPa] | shear modulus [GPa] | strength [MPa] |"
    return "\n".join([head, "| --- | --- | --- | --- | --- |", *rows, ""])


def _masses() -> str:
    rows = [_row(name, kind()) for name, kind in MECHANISMS.items()]
    head = "| mechanism | members | moving mass [kg] | of it from sections [kg] | clearance at home [mm] | between |"
    return "\n".join([head, "| --- | --- | --- | --- | --- | --- |", *rows, ""])


def _row(name: str, robot: Mechanism) -> str:
    model = robot.model()
    members = robot.all_members(model.pose, model.joints, model.g)
    mass, clearance = (float(robot.margin(margin, robot.home)) for margin in ("mass", "clearance"))
    light = mass - _mass_without_sections(robot)
    where = robot.margin_place("clearance", robot.home)
    return f"| {name} | {len(members)} | {mass:.3f} | {light:.3f} | {1e3 * clearance:.1f} | {where} |"


def _mass_without_sections(robot: Mechanism) -> float:
    """The mass at a wall of next to nothing, and a plate or a screw as thin."""
    changes = {
        field: tuple(1e-12 for _ in value) if isinstance(value, tuple) else 1e-12
        for field, value in robot.geometry.as_dict().items()
        if field.endswith(("_wall", "_thickness")) or field == "screw_radius"
    }
    thin = robot.with_geometry(robot.geometry.with_values(**changes))
    model = thin.model()
    bodies = thin.bodies(model.pose, model.joints, model.g, 0.0)
    total = ca.sum1(ca.vertcat(*(particle.mass for particle in bodies.all_particles())))
    return float(np.array(ca.Function("mass", [model.geometry], [total])(thin.geometry.vector())).item())


def _cycles() -> str:
    lines = ["| study, own geometry | half cycle, given masses [s] | masses of its bodies [s] | change |"]
    lines.append("| --- | --- | --- | --- |")
    for name, weighed in WEIGHED.items():
        study = load_study(read_toml(study_path(name)))
        own = study.mechanism_class.Inertia()
        robots = (robot_of(study).with_inertia(inertia) for inertia in (weighed, own))
        given, found = (time_cycle(study, robot).half_cycle for robot in robots)
        lines.append(f"| {name} | {given:.5f} | {found:.5f} | {100 * (found / given - 1):+.2f} % |")
    return "\n".join([*lines, ""])


if __name__ == "__main__":
    main()
