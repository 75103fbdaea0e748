"""Whatever a file holds, it gives a Study or a StudyError."""

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from studies.building.load import load_study
from studies.errors import StudyError
from studies.study_file.study import Study
from studies.study_file.toml_file import read_toml

Write = Callable[[str], Path]


def load_or_fault(path: Path) -> None:
    """Reads `path`; any exception but a StudyError escapes, as does a message with a stray line."""
    with suppress(StudyError):
        try:
            assert isinstance(load_study(read_toml(path)), Study)
        except StudyError as error:
            lines = str(error).split("\n")
            if len(lines) != len(error.faults) or not all(line.startswith(str(path)) for line in lines):
                raise AssertionError(lines) from error
            raise


garbage = settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
VALUES = [
    "nan",
    "-inf",
    "[]",
    "{}",
    "[[]]",
    "[{}]",
    "0x" + "f" * 400,
    "''",
    "true",
    "1e308",
    "1979-05-27",
    "[1, '']",
]


@garbage
@given(st.text())
def test_any_text_gives_a_study_or_a_study_error(write: Write, text: str) -> None:
    load_or_fault(write(text.encode("utf-8", "replace").decode()))


@garbage
@given(st.data())
def test_a_study_with_values_replaced_gives_a_study_or_a_study_error(
    write: Write, study_text: str, data: st.DataObject
) -> None:
    lines = study_text.splitlines()
    places = [i for i, line in enumerate(lines) if " = " in line]
    for i in data.draw(st.lists(st.sampled_from(places), min_size=1, max_size=8)):
        lines[i] = f"{lines[i].partition(' = ')[0]} = {data.draw(st.sampled_from(VALUES))}"
    load_or_fault(write("\n".join(lines)))


@garbage
@given(st.data())
def test_a_study_with_lines_shuffled_and_cut_gives_a_study_or_a_study_error(
    write: Write, study_text: str, data: st.DataObject
) -> None:
    blocks = study_text.split("\n[")
    chosen = data.draw(st.lists(st.sampled_from(blocks), unique=True))
    text = "\n[".join(chosen)
    cut = data.draw(st.integers(0, len(text)))
    load_or_fault(
        write(text[:cut] + data.draw(st.sampled_from(["", "_mm", "\n", "]", "=1\n", " = {}\n"])) + text[cut:])
    )
