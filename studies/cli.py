"""The command line. Heavy imports wait until a command runs, so that help comes at once."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from kinematics import Mechanism
    from studies.pipeline import Outcome
    from studies.schema import Study

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Design fast parallel robots, verify the design, and write the set-points that their drives run.",
    epilog="Exit status: 0 all holds, 1 a requirement fails, 2 the input is wrong.",
)

StudyArgument = Annotated[
    str, typer.Argument(metavar="STUDY", help="A study's name (see `linkwright list`), or a path to a study.toml.")
]
OutOption = Annotated[
    Path | None, typer.Option("--out", help="Folder for the results. [default: out/ and the study's name]")
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print one JSON object for machines, and nothing else.")]
PrototypeOption = Annotated[
    bool, typer.Option("--prototype", help="Use the study's own geometry, not its committed optimum.")
]


@app.command("list")
def list_(json: JsonOption = False) -> None:
    """List the mechanisms and the studies that come with Linkwright."""
    from kinematics import MECHANISMS
    from studies import console
    from studies.load import load_study
    from studies.locate import FOLDER, study_names

    titles = {name: load_study(FOLDER / name / "study.toml").title for name in study_names()}
    mechanisms = {name: (kind.__doc__ or "").splitlines()[0] for name, kind in MECHANISMS.items()}
    if json:
        console.print_json({"mechanisms": mechanisms, "studies": titles})
        return
    console.print_table("Mechanisms", ("name", "pose and joints"), list(mechanisms.items()))
    console.print_table("Studies", ("name", "question"), list(titles.items()))


@app.command()
def run(
    study: StudyArgument,
    out: OutOption = None,
    json: JsonOption = False,
    commit: Annotated[
        bool,
        typer.Option("--commit", help="Also put optimum.toml beside the study, for `check` to verify from now on."),
    ] = False,
) -> None:
    """The whole way: optimise, search densely, time the cycle, verify, write set-points and report."""
    from studies import console
    from studies.outputs import write_run

    asked = _load(study)
    folder = out or Path("out") / asked.name
    beside = _study_file(study).parent if commit else None
    _require_writable(folder, beside)
    outcome = _outcome(asked, None)
    files = write_run(outcome, folder, f"linkwright run {study}", beside)
    console.print_outcome(outcome, files, json)


@app.command()
def optimise(study: StudyArgument, json: JsonOption = False) -> None:
    """Optimise the geometry and print what was found; writes nothing."""
    from kinematics.errors import InvalidValue
    from studies import console

    asked = _load(study).model_copy(update={"trajectory": None})
    if asked.optimise is None:
        raise InvalidValue(f"study {asked.name}", "no [optimise] table", "one with the variables to optimise")
    console.print_outcome(_outcome(asked, None), [], json)


@app.command()
def trajectory(
    study: StudyArgument,
    json: JsonOption = False,
    out: OutOption = None,
    prototype: PrototypeOption = False,
    law: Annotated[
        str | None, typer.Option("--law", help="Timing law, in place of the study's: jerk or toppra.")
    ] = None,
) -> None:
    """Time and verify the study's cycle on its committed optimum; with --out, write the set-points."""
    from kinematics.errors import InvalidValue
    from studies import console
    from studies.outputs import write_setpoints
    from studies.pipeline import time_cycle
    from studies.schema import LAWS

    asked = _load(study)
    if law is not None and law not in LAWS:
        raise InvalidValue("--law", law, f"one of {', '.join(LAWS)}")
    if asked.trajectory is None:
        raise InvalidValue(f"study {asked.name}", "no [trajectory] table", "one with the cycle to time")
    robot = _robot(study, asked, prototype)
    _require_writable(out)
    with console.progress() as tell:
        tell("cycle")
        timing = time_cycle(asked.trajectory.model_copy(update={"law": law or asked.trajectory.law}), robot)
    console.print_timing(timing, write_setpoints(timing, out) if out else [], json)


@app.command()
def report(
    study: StudyArgument, out: OutOption = None, json: JsonOption = False, prototype: PrototypeOption = False
) -> None:
    """Write the report and the set-points of the committed optimum; nothing is optimised."""
    from studies import console
    from studies.outputs import write_report

    asked = _load(study)
    robot = _robot(study, asked, prototype)
    folder = out or Path("out") / asked.name
    _require_writable(folder)
    outcome = _outcome(asked, robot)
    files = write_report(outcome, folder, f"linkwright report {study}")
    console.print_outcome(outcome, files, json)


@app.command()
def check(
    studies: Annotated[
        list[str] | None,
        typer.Argument(metavar="[STUDY ...]", help="Names or paths. [default: all that have an optimum]"),
    ] = None,
    json: JsonOption = False,
) -> None:
    """Verify committed optimum.toml files again, figure by figure; for CI."""
    from studies import console
    from studies.check import check_study
    from studies.locate import FOLDER, study_names
    from studies.optimum import FILE

    names = studies or [name for name in study_names() if (FOLDER / name / FILE).is_file()]
    with console.progress() as tell:
        found = {}
        for name in names:
            tell(f"check {name}")
            found[name] = check_study(_study_file(name))
    console.print_checks(found, json)
    if not all(row.holds for rows in found.values() for row in rows):
        raise typer.Exit(1)


def main() -> None:
    """Entry point: an error on purpose becomes its message and its exit status, never a traceback."""
    signal.signal(signal.SIGINT, _interrupted)
    try:
        app()
    except Exception as error:
        from kinematics.errors import LinkwrightError

        if not isinstance(error, LinkwrightError):
            raise
        print(f"linkwright: {error}", file=sys.stderr)
        sys.exit(error.exit_status)


def _interrupted(*_: object) -> None:
    """Stop at once: an exception would be swallowed inside the solver, which then answers as if nothing had been."""
    show_cursor = "\x1b[?25h" if sys.stderr.isatty() else ""
    os.write(2, f"{show_cursor}\nlinkwright: interrupted, nothing was left half-written\n".encode())
    os._exit(130)


def _study_file(given: str) -> Path:
    from studies.locate import study_path

    return study_path(given)


def _load(given: str) -> Study:
    from studies.load import load_study
    from studies.setup import require_cycle_inside

    study = load_study(_study_file(given))
    require_cycle_inside(study, _study_file(given))
    return study


def _require_writable(*folders: Path | None) -> None:
    from trajectory import require_writable

    for folder in folders:
        if folder is not None:
            require_writable(folder)


def _robot(given: str, asked: Study, prototype: bool) -> Mechanism:
    """The committed optimum beside the study, or the study's own geometry."""
    from studies import setup
    from studies.optimum import committed

    return (None if prototype else committed(asked, _study_file(given).parent)) or setup.robot_of(asked)


def _outcome(asked: Study, robot: Any) -> Outcome:
    from studies import console, pipeline

    with console.progress() as tell:
        return pipeline.run(asked, robot, tell)
