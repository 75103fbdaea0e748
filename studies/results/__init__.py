"""Folders of results, and the files that a run writes there."""

from studies.results.map_files import map_names, write_map
from studies.results.output_folder import OutputFolder, Written
from studies.results.outputs import (
    claim_file,
    optimum_names,
    report_names,
    run_names,
    write_model,
    write_proofs,
    write_report,
    write_run,
    write_setpoints,
)
from studies.results.resume import run_into

__all__ = [
    "OutputFolder",
    "Written",
    "claim_file",
    "map_names",
    "optimum_names",
    "report_names",
    "run_into",
    "run_names",
    "write_map",
    "write_model",
    "write_proofs",
    "write_report",
    "write_run",
    "write_setpoints",
]
