"""The example of docs/drive_files.md runs, and its stop rests within the limits that it asks for."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

TEXT = (Path(__file__).parents[3] / "docs" / "drive_files.md").read_text()


def test_the_example_of_a_stop_runs() -> None:
    (code,) = re.findall(r"```python\n(.*?)```", TEXT, re.S)
    found: dict[str, Any] = {}
    exec(compile(code, "docs/drive_files.md", "exec"), found)
    assert found["stop"].start == 0.05
    assert found["stop"].verification.ok
    assert max(found["stop"].verification.peak_over_limit.values()) <= 1.0
