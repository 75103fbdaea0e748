"""The report: tables and pictures."""

from studies.report.map_plot import bound_label, map_picture
from studies.report.report import html_report, pictures_of
from studies.report.tables import (
    FRAME,
    LOADS,
    MEMBERS,
    PROOFS,
    frame_rows,
    load_rows,
    loads_title,
    margin_columns,
    margin_rows,
    member_rows,
    proof_rows,
)

__all__ = [
    "FRAME",
    "LOADS",
    "MEMBERS",
    "PROOFS",
    "bound_label",
    "frame_rows",
    "html_report",
    "load_rows",
    "loads_title",
    "map_picture",
    "margin_columns",
    "margin_rows",
    "member_rows",
    "pictures_of",
    "proof_rows",
]
