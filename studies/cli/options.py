"""Arguments and options that commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

StudyArgument = Annotated[
    str, typer.Argument(metavar="STUDY", help="A study's name (see `linkwright list`), or a path to a study.toml.")
]
OutOption = Annotated[
    Path | None, typer.Option("--out", help="Folder for the results (default: out/ and the study's name).")
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print one JSON object for machines, and nothing else.")]
PrototypeOption = Annotated[
    bool, typer.Option("--prototype", help="Use the study's own geometry, not its committed optimum.")
]
FormatOption = Annotated[
    list[str] | None,
    typer.Option(
        "--format",
        help="A format of drive files (see `linkwright list`). Repeat for more. Needs --out (default: the study's, "
        "else csv).",
    ),
]
ForceOption = Annotated[
    bool,
    typer.Option(
        "--force", help="Also replace files that this program did not write, or that changed since it wrote them."
    ),
]
AllowCodeOption = Annotated[
    bool, typer.Option("--allow-code", help="Allow the Python module to run that the study names for its mechanism.")
]
SecondsOption = Annotated[
    float | None,
    typer.Option("--seconds", help="The seconds for each long stage, in place of the study's table \\[budget]."),
]
