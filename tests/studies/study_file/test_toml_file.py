"""Lines of keys in a TOML file, and files that cannot be read."""

import tomllib
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from studies.errors import StudyError
from studies.study_file.toml_file import key_lines, read_toml

Write = Callable[[str], Path]

TRICKY = '''\
# a comment with [table] and key = 1
plain = 1
"quoted.key" = 2 # trailing
'literal key' = 3
dotted . "x y" . z = 4
text = """
[not.a.table]
fake = 1
"""
raw = \'\'\'
fake = "2"
\'\'\'
quotes = """a "quoted" word\\""" and ""more"""""
after = 5

[table]
array = [ # comment ] }
  1,
  [2, 3], { inner = 4,  b = "]" },

  5,
]
last = 1979-05-27T07:32:00.5Z

[[row]]
a = 1.5
[row.sub]
b = 1
[[row.deep]]
c = { d = { e = [
  { f = 1 },
] } }
[[row]]
a = 2
[[ row . "deep" ]]
c = 3
'''


def paths_of(node: object, path: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    """Every key and array entry of parsed TOML data."""
    match node:
        case dict():
            below = [paths_of(value, (*path, key)) for key, value in node.items()]
        case list():
            below = [paths_of(value, (*path, i)) for i, value in enumerate(node)]
        case _:
            below = []
    return [path, *(inner for group in below for inner in group)]


@pytest.mark.parametrize(
    ("path", "line"),
    [
        (("plain",), 2),
        (("quoted.key",), 3),
        (("literal key",), 4),
        (("dotted", "x y", "z"), 5),
        (("text",), 6),
        (("raw",), 10),
        (("quotes",), 13),
        (("after",), 14),
        (("table",), 16),
        (("table", "array"), 17),
        (("table", "array", 0), 18),
        (("table", "array", 1, 1), 19),
        (("table", "array", 2, "b"), 19),
        (("table", "array", 3), 21),
        (("table", "last"), 23),
        (("row", 0), 25),
        (("row", 0, "a"), 26),
        (("row", 0, "sub", "b"), 28),
        (("row", 0, "deep", 0, "c", "d", "e"), 30),
        (("row", 0, "deep", 0, "c", "d", "e", 0, "f"), 31),
        (("row", 1), 33),
        (("row", 1, "a"), 34),
        (("row", 1, "deep", 0, "c"), 36),
    ],
)
def test_the_line_of_a_key_is_where_it_is_written(path: tuple[str | int, ...], line: int) -> None:
    assert key_lines(TRICKY)[path] == line


def test_every_key_has_a_line_and_no_other_has() -> None:
    assert set(key_lines(TRICKY)) == set(paths_of(tomllib.loads(TRICKY))) - {()}


def test_windows_line_ends_count_once() -> None:
    assert key_lines(TRICKY.replace("\n", "\r\n")) == key_lines(TRICKY)


@given(st.lists(st.sampled_from([*TRICKY.splitlines(keepends=True), "\n", "x.y = {a=1}\n"])))
def test_every_key_of_a_valid_text_has_a_line(parts: list[str]) -> None:
    text = "".join(parts)
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        return
    assert set(key_lines(text)) == set(paths_of(data)) - {()}


@given(st.text(alphabet="ab=.[]{},\"'#\n \\1"))
def test_the_scan_never_fails_even_on_invalid_text(text: str) -> None:
    assert all(1 <= line <= text.count("\n") + 1 for line in key_lines(text).values())


def test_a_key_that_is_absent_takes_its_tables_line(write: Write) -> None:
    file = read_toml(write("a = 1\n[b]\nc = 2\n"))
    assert file.line(("b", "missing")) == 2
    assert file.line(("missing",)) == 1


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("a = 1\nb =\n", 2),
        ("a = 1\n\nb = 2 3\n", 3),
        ("a = 1\na = 2\n", 2),
        ("[a\n", 1),
        ('a = 1\nb = """\nno end\n', 3),
    ],
)
def test_a_syntax_error_names_its_line(write: Write, text: str, line: int) -> None:
    path = write(text)
    with pytest.raises(StudyError, match="syntax error") as caught:
        read_toml(path)
    assert (caught.value.file, caught.value.line, caught.value.expected) == (path, line, "valid TOML")


@pytest.mark.parametrize("text", ["a = " + "[" * 5000, "a = " + "1" * 5000], ids=["depth", "digits"])
def test_what_the_parser_gives_up_on_is_a_study_error(write: Write, text: str) -> None:
    with pytest.raises(StudyError) as caught:
        read_toml(write(text))
    assert caught.value.line is None


def test_a_byte_that_is_not_utf8_is_named_with_its_line(tmp_path: Path) -> None:
    path = tmp_path / "study.toml"
    path.write_bytes(b"a = 1\nb = '\xff'\n")
    with pytest.raises(StudyError) as caught:
        read_toml(path)
    assert (caught.value.line, caught.value.found, caught.value.expected) == (2, "byte 0xff", "UTF-8 text")


def test_a_missing_file_is_a_study_error(tmp_path: Path) -> None:
    with pytest.raises(StudyError, match="found no such file or directory") as caught:
        read_toml(tmp_path / "study.toml")
    assert (caught.value.file, caught.value.line) == (tmp_path / "study.toml", None)


def test_a_directory_is_a_study_error(tmp_path: Path) -> None:
    with pytest.raises(StudyError, match="found is a directory"):
        read_toml(tmp_path)


def test_an_unreadable_file_is_a_study_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def deny(_: Path) -> bytes:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "read_bytes", deny)
    with pytest.raises(StudyError, match="found permission denied; expected a readable TOML file"):
        read_toml(tmp_path / "study.toml")


def test_a_path_that_no_system_takes_is_a_study_error() -> None:
    with pytest.raises(StudyError):
        read_toml(Path("a\0b"))


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.binary())
def test_any_bytes_are_read_or_are_a_study_error(tmp_path: Path, raw: bytes) -> None:
    path = tmp_path / "study.toml"
    path.write_bytes(raw)
    with suppress(StudyError):
        read_toml(path)
