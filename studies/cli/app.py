"""The command line. Heavy modules are imported only when a command runs, so that help appears at once."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

from studies.cli.ending import ended_by
from studies.cli.inputs import load, output_folder, robot_for
from studies.cli.map_command import map_
from studies.cli.options import (
    AllowCodeOption,
    ForceOption,
    FormatOption,
    JsonOption,
    OutOption,
    PrototypeOption,
    SecondsOption,
    StudyArgument,
)
from studies.cli.run_command import optimise, run

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Design fast parallel robots, verify the design, and write the set-points that their drives run.",
    epilog="Exit status: 0 if all holds, 1 if a requirement fails, 2 if the input is wrong.",
)


def _version(asked: bool) -> None:
    if asked:
        from importlib.metadata import version

        print(f"linkwright {version('linkwright')}")
        raise typer.Exit


@app.callback()
def _top(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Design fast parallel robots, verify the design, and write the set-points that their drives run."""


@app.command("list")
def list_(json: JsonOption = False) -> None:
    """List the mechanisms, the studies, the timing laws and the formats of drive files.

    linkwright list --json
    """
    from kinematics import MECHANISMS
    from studies.building import installed_mechanisms, load_study
    from studies.cli import console
    from studies.study_file import read_toml, study_names, study_path
    from trajectory import LAWS
    from trajectory.drive_files import FORMATS

    titles = {name: load_study(read_toml(study_path(name))).title for name in study_names()}
    mechanisms = {name: (kind.__doc__ or "").splitlines()[0] for name, kind in MECHANISMS.items()}
    mechanisms |= {name: f"installed: {point.value}" for name, point in installed_mechanisms().items()}
    laws = {law.name: law.title for law in LAWS.values()}
    formats = {name: form.title for name, form in FORMATS.items()}
    if json:
        console.print_json({"mechanisms": mechanisms, "studies": titles, "laws": laws, "formats": formats})
        return
    console.print_table("Mechanisms", ("name", "pose and joints"), list(mechanisms.items()))
    console.print_table("Studies", ("name", "question"), list(titles.items()))
    console.print_table("Timing laws", ("--law", "what it does"), list(laws.items()))
    console.print_table("Drive files", ("--format", "what it writes"), list(formats.items()))


app.command()(run)
app.command()(optimise)
app.command("map")(map_)


@app.command()
def certify(
    study: StudyArgument,
    margin: Annotated[
        str | None,
        typer.Option("--margin", help="Prove only this margin (default: those that the study names)."),
    ] = None,
    at_least: Annotated[
        float | None,
        typer.Option("--at-least", help="Prove this bound of --margin (default: the required bound, else the best)."),
    ] = None,
    at_most: Annotated[
        float | None,
        typer.Option("--at-most", help="The same for a margin that is better smaller, such as position_accuracy."),
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", help="Folder for the certificates (default: none are written).")
    ] = None,
    json: JsonOption = False,
    prototype: PrototypeOption = False,
    seconds: SecondsOption = None,
    force: ForceOption = False,
    allow_code: AllowCodeOption = False,
) -> None:
    """Prove the requirements of the committed optimum at every pose of the region. Exits 1 if one is not proved.

    linkwright certify heli4 --out results

    linkwright certify gough_stewart --margin joint_travel --at-least 0.02
    """
    from studies.cli import console
    from studies.cli.proof_console import print_proofs
    from studies.results import Written, claim_file, write_proofs
    from studies.stages import prove_claims, question_of

    file, asked, _ = load(study, allow_code, seconds=seconds)
    question = question_of(asked, robot_for(file, asked, prototype))
    claims = question.only(margin, at_least, at_most)
    folder = output_folder(out, [claim_file(claim.margin) for claim in claims], force)
    with console.progress() as tell:
        proofs = prove_claims(question, claims, {}, {}, tell)
    written = write_proofs(question, proofs, folder) if folder else Written()
    print_proofs(question, proofs, written, json)
    if not all(proof.certificate.status == "proved" for proof in proofs):
        raise typer.Exit(1)


@app.command()
def trajectory(
    study: StudyArgument,
    json: JsonOption = False,
    out: Annotated[
        Path | None, typer.Option("--out", help="Folder for the set-points (default: none are written).")
    ] = None,
    prototype: PrototypeOption = False,
    law: Annotated[
        str | None, typer.Option("--law", help="Timing law, in place of the study's (see `linkwright list`).")
    ] = None,
    formats: FormatOption = None,
    force: ForceOption = False,
    allow_code: AllowCodeOption = False,
) -> None:
    """Time and verify the cycle of the study's committed optimum. With --out, also write the set-points.

    linkwright trajectory cycle_reference --law toppra

    linkwright trajectory heli4 --out results --format csv --format ros2
    """
    from kinematics import InvalidValue
    from studies.cli import console
    from studies.cli.run_console import print_timing
    from studies.results import Written, write_setpoints
    from studies.stages import Lasting, require_on_cycle, stage, time_cycle
    from studies.study_file import told_at_key
    from trajectory import LAWS
    from trajectory.drive_files import format_named

    if law is not None and law not in LAWS:
        raise InvalidValue("--law", law, f"one of {', '.join(LAWS)}")
    if formats and out is None:
        raise InvalidValue("--format", f"{', '.join(formats)} without --out", "--out with the folder for the files")
    for name in formats or ():
        format_named(name)
    file, asked, drives = load(study, allow_code, formats)
    if asked.trajectory is None:
        raise InvalidValue(
            f"study {asked.name}", "no [trajectory] table", "a [trajectory] table with a cycle or a path"
        )
    robot = robot_for(file, asked, prototype)
    folder = output_folder(out, drives, force)
    if law is not None:
        asked = asked.model_copy(update={"trajectory": asked.trajectory.model_copy(update={"law": law})})
    with told_at_key(file), console.progress() as tell, stage("cycle", tell):
        timing = time_cycle(asked, robot)
        if weakness := timing.weakness():
            tell(Lasting(weakness))
        require_on_cycle(asked, timing)
    print_timing(timing, write_setpoints(timing, asked, folder) if folder else Written(), json)


@app.command()
def report(
    study: StudyArgument,
    out: OutOption = None,
    json: JsonOption = False,
    prototype: PrototypeOption = False,
    seconds: SecondsOption = None,
    force: ForceOption = False,
    allow_code: AllowCodeOption = False,
) -> None:
    """Write the report and the set-points of the committed optimum. Proofs are checked again; nothing is optimised.

    linkwright report heli4 --out results
    """
    from studies.cli import console
    from studies.cli.run_console import print_outcome
    from studies.committed import committed_certificates
    from studies.results import report_names, write_report
    from studies.stages import certified, run, with_unasked
    from studies.study_file import told_at_key

    file, asked, drives = load(study, allow_code, seconds=seconds)
    robot = robot_for(file, asked, prototype)
    names = report_names(drives)
    folder = output_folder(out or Path("out") / asked.name, names, force)
    known = committed_certificates(asked, file.path.parent, robot)
    with told_at_key(file), console.progress() as tell:
        outcome = certified(with_unasked(run(asked, robot, tell), tell), known, tell)
    print_outcome(outcome, write_report(outcome, folder, f"linkwright report {study}"), json)


@app.command()
def export(
    study: StudyArgument,
    out: Annotated[Path, typer.Option("--out", help="The file to write.")],
    format_: Annotated[Literal["mjcf"], typer.Option("--format", help="The file's format: MJCF, for MuJoCo.")] = "mjcf",  # noqa: ARG001
    rods: Annotated[
        Literal["split", "uniform"] | None,
        typer.Option(
            "--rods",
            help="split: half of a rod's mass at each end; uniform: each rod is a body (default: the study's choice).",
        ),
    ] = None,
    json: JsonOption = False,
    prototype: PrototypeOption = False,
    force: ForceOption = False,
    allow_code: AllowCodeOption = False,
) -> None:
    """Write a simulator's model of the committed optimum. It stands at the cycle's start, or at home without a cycle.

    linkwright export heli4 --out heli4.xml --rods uniform
    """
    from kinematics import UNIFORM
    from studies.cli import console
    from studies.results import Written, write_model
    from studies.study_file import told_at_key
    from trajectory import require_writable

    file, asked, _ = load(study, allow_code)
    robot = robot_for(file, asked, prototype)
    require_writable(out.parent)
    rod_middle = None if rods is None else {"split": 0.0, "uniform": UNIFORM}[rods]
    with told_at_key(file):
        written = write_model(robot, asked, rod_middle, out, force)
    console.print_files(Written((written,)), json)


@app.command()
def check(
    studies: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[STUDY ...]", help="Names or paths of studies (default: all with a committed optimum)."
        ),
    ] = None,
    json: JsonOption = False,
    verbose: Annotated[bool, typer.Option("--verbose", help="Also show the claims that hold.")] = False,
    allow_code: AllowCodeOption = False,
) -> None:
    """Compute every figure of committed optimum.toml files again and compare. Exits 1 if one differs.

    linkwright check heli4 my_robot/study.toml --json
    """
    from studies.cli import console
    from studies.cli.proof_console import print_checks
    from studies.committed import FILE, check_study
    from studies.study_file import FOLDER, read_toml, study_names, study_path

    names = studies or [name for name in study_names() if (FOLDER / name / FILE).is_file()]
    with console.progress() as tell:
        found = {}
        for name in names:
            tell(f"check {name}")
            found[name] = check_study(read_toml(study_path(name)), allow_code)
    print_checks(found, json, verbose)
    if not all(row.holds for rows in found.values() for row in rows):
        raise typer.Exit(1)


def main() -> None:
    """Entry point. A `LinkwrightError` is shown as a message and an exit status, never as a traceback."""
    ended_by(app)
