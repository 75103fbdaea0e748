"""The mechanism that a study names: one of Linkwright, of an installed package, or a class in a user's module.

A user's module must be allowed to run: a study from a stranger must not run code when it is read.
"""

from __future__ import annotations

import hashlib
import inspect
import re
import sys
import traceback
from collections.abc import Callable, Mapping
from importlib import import_module, util
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple, TypeGuard

import kinematics
from kinematics import CLEARANCE, InvalidValue, LinkwrightError, Mechanism
from studies.errors import spelled
from studies.study_file import Key

GROUP = "linkwright.mechanisms"  # the group of entry points
_IN_MODULE = re.compile(r"([^\W\d]\w*(?:\.[^\W\d]\w*)*):([^\W\d]\w*)")


class MechanismRefused(LinkwrightError):
    """The name that a study gives leads to no usable mechanism; it says what was found and what would be right."""

    def __init__(self, name: str, found: str, expected: str) -> None:
        self.name, self.found, self.expected = name, found, expected
        super().__init__(f"mechanism {name!r}: found {found}; expected {expected}")


class NamedMechanism(NamedTuple):
    """A mechanism's class, and the SHA-256 of the file that defines it; "" for one of Linkwright's own."""

    mechanism_class: type[Mechanism]
    code: str


def mechanism_names() -> tuple[str, ...]:
    """The names that need no module: Linkwright's own mechanisms, and those of installed packages."""
    return (*_own(), *installed_mechanisms())


def installed_mechanisms() -> dict[str, EntryPoint]:
    """The entry points of mechanisms by name. None is loaded."""
    return {point.name: point for point in entry_points(group=GROUP) if point.name not in _own()}


def mechanism_named(name: str, folder: Path, allow_code: bool) -> NamedMechanism:
    """The mechanism that a study in a folder names.

    Args:
        name: one of `mechanism_names`, or "module:Class". A file `module.py` in the folder is preferred to a module on
            Python's path.
        folder: the study's folder.
        allow_code: whether such a module may run.

    Raises:
        MechanismRefused: there is no such mechanism, its module may not run, or it cannot be used.
    """
    if name in (own := _own()):
        return NamedMechanism(own[name], "")
    if name in (installed := installed_mechanisms()):
        point = installed[name]
        return _usable(name, _ran(name, point.value, point.load))
    match = _IN_MODULE.fullmatch(name)
    if match is None:
        expected = Key('"module:Class", or one of', choices=mechanism_names()).describe(found=name)
        raise MechanismRefused(name, spelled(name), expected)
    module_name, attribute = match.groups()
    beside = folder / f"{module_name}.py"
    where = f"{beside.name} beside the study" if beside.is_file() else f"the module {module_name}"
    if not allow_code:
        expected = f"--allow-code with the command, if you trust {where}; or one of {', '.join(mechanism_names())}"
        raise MechanismRefused(name, f"{spelled(name)}, code of {where}, which may not run", expected)
    if beside.is_file():
        module = _ran(name, where, lambda: _module_of(beside))
    else:
        module = _ran(name, where, lambda: import_module(module_name))
    if not hasattr(module, attribute):
        its = [key for key, value in vars(module).items() if _is_mechanism(value) and value is not Mechanism]
        expected = Key("one of", choices=tuple(its)).describe(found=attribute) if its else "a mechanism there"
        raise MechanismRefused(name, f"no {attribute} in {where}", expected)
    return _usable(name, getattr(module, attribute))


def _own() -> Mapping[str, type[Mechanism]]:
    return kinematics.MECHANISMS


def _module_of(file: Path) -> ModuleType:
    """The module in a file. The same file with the same content runs once."""
    digest = hashlib.sha256(str(file.resolve()).encode() + file.read_bytes()).hexdigest()
    unique = f"{file.stem}_{digest[:16]}"  # another study may have another file of the same name beside it
    if unique in sys.modules:
        return sys.modules[unique]
    spec = util.spec_from_file_location(unique, file)
    assert spec is not None
    assert spec.loader is not None
    module = sys.modules[unique] = util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[unique]
        raise
    return module


def _ran(name: str, where: str, run: Callable[[], Any]) -> Any:
    """The result of someone else's code.

    Raises:
        MechanismRefused: the code raises an error; the message has its line.
    """
    try:
        return run()
    except ModuleNotFoundError as error:
        if error.name and f"{name.partition(':')[0]}.".startswith(f"{error.name}."):
            expected = f"{error.name}.py beside the study, or a module on Python's path"
            raise MechanismRefused(name, f"no module {error.name}", expected) from error
        raise _raising(name, where, error) from error
    except (Exception, SystemExit) as error:
        raise _raising(name, where, error) from error


def _raising(name: str, where: str, error: BaseException) -> MechanismRefused:
    last = traceback.extract_tb(error.__traceback__)[-1]
    place = f"{error.filename}:{error.lineno}" if isinstance(error, SyntaxError) else f"{last.filename}:{last.lineno}"
    found = f"{where} that raises {type(error).__name__}: {error} ({place})"
    return MechanismRefused(name, found, "code that runs without an error")


def _usable(name: str, kind: object) -> NamedMechanism:
    """The class, after a check that its prototype and its symbolic model can be built."""
    if not _is_mechanism(kind):
        raise MechanismRefused(name, f"{kind!r:.60}", "a class derived from kinematics.Mechanism")
    if lacking := kind.lacking():
        raise MechanismRefused(name, f"a mechanism without {', '.join(lacking)}", "all hooks of docs/new_mechanism.md")
    _ran(name, f"a prototype of {kind.__name__}", lambda: kind().model())
    try:
        CLEARANCE.places(kind())  # it looks at all members
    except InvalidValue as error:
        raise MechanismRefused(name, f"{error.what} {error.found}", error.expected) from error
    source = inspect.getsourcefile(kind)
    code = "" if source is None else hashlib.sha256(Path(source).read_bytes()).hexdigest()
    return NamedMechanism(kind, code)


def _is_mechanism(value: object) -> TypeGuard[type[Mechanism]]:
    return isinstance(value, type) and issubclass(value, Mechanism)
