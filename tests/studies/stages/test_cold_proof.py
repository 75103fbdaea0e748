"""On a machine that never compiled the kernels of a proof, compiling them is not counted as proving."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.long
PROVE = """
import time
from pathlib import Path
from studies.stages import prove_claims, question_of
from studies.building import load_study, robot_of
from studies.study_file import read_toml
study = load_study(read_toml(Path("studies/heli4/study.toml")))
question = question_of(study, robot_of(study))
claims = [claim for claim in question.claims() if claim.margin == "J_q"]
worst = {"J_q": question.worst("J_q")}
started = time.perf_counter()
(proof,) = prove_claims(question, claims, worst, {}, lambda _: None)
print(time.perf_counter() - started, proof.seconds)
"""


def test_the_budget_of_the_proofs_starts_after_the_kernels_are_compiled(tmp_path: Path) -> None:
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    ran = subprocess.run([sys.executable, "-c", PROVE], env=environment, capture_output=True, text=True, check=True)
    took, proving = map(float, ran.stdout.split())
    assert proving < 0.3 * took
