"""The report: one HTML file that opens offline. Every figure in it comes from the run's own data."""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from typing import Any

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined

from kinematics import JointMotion
from studies.report import plots
from studies.report.machine_rows import machine_rows
from studies.report.tables import (
    FRAME,
    LOADS,
    MEMBERS,
    PROOFS,
    frame_rows,
    load_rows,
    loads_title,
    margin_columns,
    margin_rows,
    member_rows,
    proof_rows,
)
from studies.stages import Outcome, Timing, became_worse
from trajectory import motion_of

Pictures = list[tuple[str, bytes]]  # title and PNG
_STATED = ("path", "limit", "payload", "period", "assumptions", "inertia")
_MAPPED = ("fvi", "internal_determinant")


def html_report(outcome: Outcome, pictures: Pictures, command: str) -> str:
    """The whole report as text; it names the `command` that made it."""
    environment = Environment(
        loader=PackageLoader("studies.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template("report.html").render(
        title=outcome.study.title,
        mechanism=outcome.study.mechanism,
        version=version("linkwright"),
        command=command,
        digest=outcome.study.digest,
        geometry_digest=outcome.robot.geometry.digest,
        characteristic_length=outcome.problem.characteristic_length,
        bounds=outcome.problem.fvi_bounds,
        region=repr(outcome.region),
        geometry=_geometry_rows(outcome),
        machine=machine_rows(outcome.robot, outcome.study),
        before=outcome.before,
        margin_columns=margin_columns(outcome),
        margins=margin_rows(outcome),
        margin_words=_margin_words(outcome),
        worse=[str(change) for change in became_worse(outcome)],
        proof_columns=PROOFS,
        proofs=proof_rows(outcome.proofs),
        sampled=next(iter(outcome.worst.values())).sampled,
        optimised=outcome.study.optimise is not None,
        solver_status=outcome.solver_status,
        synthesis=outcome.synthesis,
        active=outcome.active,
        on_cycle=outcome.on_cycle,
        pose_names=", ".join(outcome.robot.pose_names),
        pictures=[(title, _embedded(png)) for title, png in pictures],
        timings=_timing_rows(outcome),
        peaks=_peak_rows(outcome.timing) if outcome.timing else [],
        load_columns=LOADS,
        loads=load_rows(outcome),
        loads_title=loads_title(outcome),
        member_columns=MEMBERS,
        members=member_rows(outcome.timing) if outcome.timing else [],
        weakness=outcome.timing.weakness() if outcome.timing else "",
        frame_columns=FRAME,
        frame=frame_rows(outcome.timing) if outcome.timing else [],
        stated=_stated(outcome.timing.setpoints.header) if outcome.timing else [],
        timing=outcome.timing,
    )


def _margin_words(outcome: Outcome) -> list[tuple[str, str, str]]:
    """Name, unit and meaning of each margin in the table."""
    margins = outcome.robot.margins
    return [(name, margins[name].unit, margins[name].words) for name in outcome.worst | outcome.unasked]


def _geometry_rows(outcome: Outcome) -> list[tuple[str, str, str, str]]:
    """Rows of four texts: field, the study's own value, result, meaning."""
    before, after = outcome.problem.robot.geometry, outcome.robot.geometry
    return [
        (name, _numbers(getattr(before, name)), _numbers(getattr(after, name)), doc)
        for name, doc in after.descriptions().items()
    ]


def _timing_rows(outcome: Outcome) -> list[tuple[str, list[tuple[str, str]]]]:
    """For each cycle that was timed, its label and its figures."""
    timings = {"result": outcome.timing, outcome.before: outcome.prototype_timing}
    return [(label, _timing_figures(timing)) for label, timing in timings.items() if timing]


def _timing_figures(timing: Timing) -> list[tuple[str, str]]:
    figures = timing.figures()
    on_bus = figures["cycle_on_the_bus"]
    return [
        ("law", figures["law"]),
        (timing.half_cycle_name.replace("_", " ") + " [s]", f"{timing.half_cycle:.6f}"),
        ("least time of any motion on this path, even without a jerk limit [s]", f"{figures['lower_bound']:.6f}"),
        ("time over this least time", f"{timing.half_cycle / figures['lower_bound']:.4f}"),
        ("cycle on the bus [s]", f"{on_bus:.6f}"),
        ("cycles per second", f"{1 / on_bus:.3f}"),
        ("factor that stretched the time to keep the limits", f"{figures['repair_factor']:.6f}"),
        ("worst RMS over peak torque", f"{figures['worst_rms_over_peak_torque']:.3f}"),
    ]


def _peak_rows(timing: Timing) -> list[Sequence[str]]:
    rows: list[Sequence[str]] = []
    for way, found in (("there", timing.cycle.there), ("back", timing.cycle.back)):
        for k, piece in enumerate(found, start=1):
            name = f"{way}, piece {k}" if len(found) > 1 else way
            rows += [(name, *row) for row in piece.timed.verification.rows()]
    return rows


def pictures_of(outcome: Outcome) -> Pictures:
    """Pictures of the mechanism, the maps of its margins, the path and the joints' motion."""
    robots = {"result": outcome.robot}
    if outcome.prototype is not None:
        robots = {outcome.before: outcome.problem.robot, **robots}
    pictures = [("Mechanism in its workspace (green edges)", plots.mechanism_picture(robots, outcome.region))]
    bounds = {r.margin: r.bound.value for r in outcome.problem.requirements} | {outcome.problem.objective: 1.0}
    mapped = _MAPPED if plots.can_be_mapped(outcome.region, outcome.robot.pose_names) else ()
    for margin in (m for m in mapped if m in outcome.robot.margins):
        sections = {
            label: plots.section_of(outcome.problem, robot, outcome.region, margin) for label, robot in robots.items()
        }
        title = f"{outcome.robot.margins[margin].words}; worst over the other coordinates"
        pictures.append((title[0].upper() + title[1:], plots.map_picture(sections, margin, bounds.get(margin))))
    return pictures + (_motion_pictures(outcome.timing) if outcome.timing else [])


def _motion_pictures(timing: Timing) -> Pictures:
    cycle, robot = timing.cycle, timing.cycle.robot
    starts = np.cumsum([0.0, *(piece.duration for piece in cycle.there)])
    inside = [np.linspace(0.0, piece.duration, 1501) for piece in cycle.there]
    times = np.concatenate([start + t for start, t in zip(starts, inside, strict=False)])
    motions = [
        motion_of(robot, piece.motion.at(t), piece.payload) for piece, t in zip(cycle.there, inside, strict=True)
    ]
    joints = JointMotion(*(np.concatenate(parts) for parts in zip(*(m.joints for m in motions), strict=True)))
    torque = np.concatenate([m.torque for m in motions])
    pose = np.concatenate([m.tool.pose for m in motions])
    count = len(robot.joint_names)
    unit = "rad" if set(robot.actuator_units) == {"rad"} else "SI"
    rows: list[tuple[str, Any, Any]] = [
        (f"position [{unit}]", joints.position, None),
        (f"speed [{unit}/s]", joints.first, cycle.limits.of_joints("speed", count)),
        (f"acceleration [{unit}/s²]", joints.second, cycle.limits.of_joints("acceleration", count)),
        ("torque [N m]" if unit == "rad" else "effort [SI]", torque, cycle.limits.of_joints("torque", count)),
    ]
    return [
        (f"Path of the {timing.half_cycle_name.replace('_', ' ')}", plots.path_picture(pose, times, robot.pose_names)),
        ("Joints on the way there; limits are dotted", plots.motion_picture(times, rows, robot.actuator_names)),
    ]


def _stated(header: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Rows of the set-points' header about the path, the limits and the masses."""
    return [(name, _spelled(value)) for name, value in header.items() if name.startswith(_STATED)]


def _spelled(value: Any) -> str:
    """Plain data in words; empty data is "none", and a mass without a number is that of the members."""
    if isinstance(value, dict):
        return "; ".join(
            f"{name} ({_spelled(v)})" if isinstance(v, dict) else f"{name} {_spelled(v)}" for name, v in value.items()
        )
    if isinstance(value, list):
        return ", ".join(_spelled(v) for v in value) or "none"
    if value is None:
        return "as of the members"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _embedded(png: bytes) -> str:
    return "data:image/png;base64," + base64.b64encode(png).decode()


def _numbers(value: Any) -> str:
    """A number, a row of numbers, or rows with semicolons between them."""
    if not isinstance(value, tuple):
        return f"{value:.6g}"
    return ("; " if isinstance(value[0], tuple) else ", ").join(_numbers(v) for v in value)
