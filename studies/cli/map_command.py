"""`linkwright map`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from studies.cli.inputs import load, output_folder, robot_for
from studies.cli.options import (
    AllowCodeOption,
    ForceOption,
    JsonOption,
    OutOption,
    PrototypeOption,
    SecondsOption,
    StudyArgument,
)

MarginOption = Annotated[
    str | None,
    typer.Option("--margin", help="The margin to map (default: fvi)."),
]
SectionOption = Annotated[
    str | None,
    typer.Option("--section", metavar="A,B", help="The plane, such as y,z (default: the first two that vary)."),
]
AtOption = Annotated[
    list[str] | None,
    typer.Option(
        "--at",
        metavar="NAME=VALUE[,...]",
        help="Fix another coordinate, such as theta_deg=0. Several values take the worst of them "
        "(default: the worst over the coordinate's interval).",
    ),
]
OverOption = Annotated[
    list[str] | None,
    typer.Option(
        "--over",
        metavar="NAME=LOW:HIGH",
        help="Replace bounds of the study's region, such as z_mm=-800:800, or radius=0.7 for a cylinder.",
    ),
]
AtLeastOption = Annotated[
    float | None,
    typer.Option(
        "--at-least",
        metavar="C",
        help="Show where the margin is at least C (default: the study's requirement; 1 for fvi; "
        "else the whole part in reach).",
    ),
]
AtMostOption = Annotated[
    float | None,
    typer.Option(
        "--at-most", metavar="C", help="The same for a margin that is better smaller, such as position_accuracy."
    ),
]
CertifiedOption = Annotated[
    bool,
    typer.Option(
        "--certified", help="Also prove the bound: in the largest possible cylinder, or in cells of the plane."
    ),
]
ToleranceOption = Annotated[float, typer.Option("--tolerance", help="Stop refining below this relative change.")]


def map_(
    study: StudyArgument,
    margin: MarginOption = None,
    section: SectionOption = None,
    at: AtOption = None,
    over: OverOption = None,
    at_least: AtLeastOption = None,
    at_most: AtMostOption = None,
    certified: CertifiedOption = False,
    tolerance: ToleranceOption = 1e-3,
    out: OutOption = None,
    json: JsonOption = False,
    prototype: PrototypeOption = False,
    seconds: SecondsOption = None,
    force: ForceOption = False,
    allow_code: AllowCodeOption = False,
) -> None:
    """Map a margin over a plane of the workspace: area, mean, deviation, boundary, picture and numbers.

    Exits 1 if the last refinement still changed the figures by more than the tolerance.

    linkwright map heli4 --certified

    linkwright map redundant_3t1r --over y=-0.3187:0.3187 --over z=-0.8:0.8 --at theta_deg=0
    """
    from studies.cli import console
    from studies.cli.map_console import print_map
    from studies.results import map_names, write_map
    from studies.stages import map_request, run_map

    file, asked, _ = load(study, allow_code, seconds=seconds)
    robot = robot_for(file, asked, prototype)
    request = map_request(asked, robot, margin, section, at or (), over or (), at_least, at_most)
    folder = output_folder(out or Path("out") / asked.name, map_names(request), force)
    with console.progress() as tell:
        outcome = run_map(request, tolerance, certified, tell, asked.budget.map)
    print_map(outcome, write_map(outcome, asked, folder), json)
    if not outcome.found.settled:
        raise typer.Exit(1)
