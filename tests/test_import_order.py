"""Imports run one way: kinematics, then design and trajectory side by side, then studies."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
ALLOWED = {
    "kinematics": set(),
    "design": {"kinematics"},
    "trajectory": {"kinematics"},
    "studies": {"kinematics", "design", "trajectory"},
}


def imported(tree: ast.AST) -> set[str]:
    """First names of every absolute import, inside functions and under TYPE_CHECKING too."""
    names = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names.add(node.module.split(".")[0] if node.module and not node.level else ".")
    return names


@pytest.mark.parametrize("package", ALLOWED)
def test_a_package_imports_only_those_before_it(package):
    files = sorted((ROOT / package).rglob("*.py"))
    assert files
    for file in files:
        ours = imported(ast.parse(file.read_text())) & {*ALLOWED, "tests", "."}
        assert ours <= ALLOWED[package] | {package}, file


def test_the_check_sees_imports_wherever_they_hide():
    code = "def f():\n    import design.region\n    from studies import x\n    from . import y\n"
    assert imported(ast.parse(code)) == {"design", "studies", "."}
