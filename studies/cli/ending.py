"""How a command ends: the message of an error, and the exit status. Heavy imports wait, as in `app`."""

from __future__ import annotations

import json
import os
import signal
import sys
import warnings
from typing import Any, NoReturn

import typer


def ended_by(app: typer.Typer) -> None:
    """Run the command line, and leave the process with its exit status."""
    if not sys.warnoptions:
        # Warnings of libraries are for programmers; our own checks find the faults and report them.
        warnings.simplefilter("ignore")
    signal.signal(signal.SIGINT, _interrupted)
    signal.signal(signal.SIGTERM, _interrupted)
    try:
        status = app(standalone_mode=False)
    except Exception as error:
        from kinematics import LinkwrightError

        if isinstance(error, LinkwrightError):
            _fail(str(error), error.exit_status, _data(error))
        if not hasattr(error, "format_message"):  # typer's errors of a wrong command line have it
            raise
        _fail(error.format_message(), 2, {"kind": type(error).__name__})
    sys.exit(status if isinstance(status, int) else 0)


def _fail(message: str, status: int, data: dict[str, Any]) -> NoReturn:
    """Print the message on standard error. With --json, also print an object on standard output."""
    if message:  # none where the help is all that there is to say
        print(f"linkwright: {message}", file=sys.stderr)
    if "--json" in sys.argv:
        try:
            print(json.dumps({"error": message, "exit_status": status, **data}, indent=2), flush=True)
        except BrokenPipeError:  # the reader has read enough; Python would complain again at the end
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    sys.exit(status)


def _data(error: Exception) -> dict[str, Any]:
    """The data of an error: its kind, its faults with file and key, the requirements that fail."""
    kind = {"kind": type(error).__name__}
    lists = {
        "problems": [vars(fault) for fault in getattr(error, "faults", ())],
        "failed": [one.as_data() for one in getattr(error, "failed", ())],
    }
    return kind | {name: _plain(found) for name, found in lists.items() if found}


def _plain(value: Any) -> Any:
    match value:
        case float():
            return value if abs(value) < float("inf") else None  # JSON has neither infinity nor NaN
        case str() | int() | bool() | None:
            return value
        case dict():
            return {key: _plain(v) for key, v in value.items()}
        case list() | tuple():
            return [_plain(v) for v in value]
        case _:
            return str(value)


def _interrupted(kind: int, _: object) -> None:
    """Stop at once. The solver would catch an exception and return an answer as if it had finished."""
    show_cursor = "\x1b[?25h" if sys.stderr.isatty() else ""
    os.write(2, f"{show_cursor}\nlinkwright: interrupted; no file is half-written\n".encode())
    os._exit(128 + kind)
