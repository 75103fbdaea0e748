"""`linkwright run` and `linkwright optimise`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from studies.cli.inputs import load, output_folder
from studies.cli.options import AllowCodeOption, ForceOption, JsonOption, OutOption, SecondsOption, StudyArgument


def run(
    study: StudyArgument,
    out: OutOption = None,
    json: JsonOption = False,
    commit: Annotated[
        bool,
        typer.Option(
            "--commit", help="Also write the optimum and its proofs beside the study, where `check` finds them."
        ),
    ] = False,
    fresh: Annotated[
        bool, typer.Option("--fresh", help="Optimise again, even if the folder has the optimum of an earlier run.")
    ] = False,
    seconds: SecondsOption = None,
    force: ForceOption = False,
    allow_code: AllowCodeOption = False,
) -> None:
    """Do all steps: optimise, search for worse poses, time the cycle, verify, prove, write set-points and report.

    The optimum is written as soon as it is found. The next run of the same study into the same folder starts from it.

    linkwright run heli4 --out results

    linkwright run my_robot/study.toml --commit
    """
    from studies.cli import console
    from studies.cli.run_console import print_outcome
    from studies.results import optimum_names, run_into, run_names, write_run
    from studies.study_file import told_at_key

    file, asked, drives = load(study, allow_code, seconds=seconds)
    names = run_names(asked, drives)
    folder = output_folder(out or Path("out") / asked.name, names, force)
    beside = output_folder(file.path.parent, optimum_names(asked), force) if commit else None
    with told_at_key(file), console.progress() as tell:
        outcome = run_into(folder, asked, fresh, tell)
    print_outcome(outcome, write_run(outcome, folder, f"linkwright run {study}", beside), json)


def optimise(
    study: StudyArgument, json: JsonOption = False, seconds: SecondsOption = None, allow_code: AllowCodeOption = False
) -> None:
    """Optimise the geometry and print the result. Nothing is written.

    linkwright optimise heli4 --json
    """
    from kinematics import InvalidValue
    from studies.cli import console
    from studies.cli.run_console import print_outcome
    from studies.results import Written
    from studies.stages import designed
    from studies.study_file import told_at_key

    file, asked, _ = load(study, allow_code, seconds=seconds)
    asked = asked.model_copy(update={"trajectory": None})
    if asked.optimise is None:
        raise InvalidValue(f"study {asked.name}", "no [optimise] table", "an [optimise] table with variables")
    with told_at_key(file), console.progress() as tell:
        outcome = designed(asked, None, tell)
    print_outcome(outcome, Written(), json)
