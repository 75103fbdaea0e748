"""The study file: its tables, their units, and the lines of its keys."""

from studies.study_file.at_key import refused_field, told_at_key, travelled
from studies.study_file.conversion import LARGEST, Conversion, Finding
from studies.study_file.keys import Key, Table
from studies.study_file.limits_table import LimitsTable
from studies.study_file.locate import FILE, FOLDER, study_names, study_path
from studies.study_file.machine_tables import InertiaTable, MaterialTable, StructureTable, SurroundingsTable
from studies.study_file.path_tables import CycleTable, WaypointPathTable, WaypointTable, adept_cycle
from studies.study_file.questions import changes, cycle_question, design_question, digest_of
from studies.study_file.study import (
    REGION_KINDS,
    BoxTable,
    BudgetTable,
    CertifyTable,
    CylinderTable,
    OptimiseTable,
    RequirementTable,
    Study,
    SumTable,
)
from studies.study_file.table import table_of
from studies.study_file.toml_file import TomlFile, read_toml
from studies.study_file.trajectory_tables import ApproachTable, DriveTable, TrajectoryTable
from studies.study_file.units import Dimension

__all__ = [
    "FILE",
    "FOLDER",
    "LARGEST",
    "REGION_KINDS",
    "ApproachTable",
    "BoxTable",
    "BudgetTable",
    "CertifyTable",
    "Conversion",
    "CycleTable",
    "CylinderTable",
    "Dimension",
    "DriveTable",
    "Finding",
    "InertiaTable",
    "Key",
    "LimitsTable",
    "MaterialTable",
    "OptimiseTable",
    "RequirementTable",
    "StructureTable",
    "Study",
    "SumTable",
    "SurroundingsTable",
    "Table",
    "TomlFile",
    "TrajectoryTable",
    "WaypointPathTable",
    "WaypointTable",
    "adept_cycle",
    "changes",
    "cycle_question",
    "design_question",
    "digest_of",
    "read_toml",
    "refused_field",
    "study_names",
    "study_path",
    "table_of",
    "told_at_key",
    "travelled",
]
