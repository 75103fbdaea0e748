"""The report: tables and pictures."""

from studies.report.map_plot import bound_label, map_picture
from studies.report.report import html_report, pictures_of
from studies.report.tables import (
    FRAME,
    MEMBERS,
    PROOFS,
    frame_rows,
    margin_columns,
    margin_rows,
    member_rows,
    proof_rows,
)

__all__ = [
    "FRAME",
    "MEMBERS",
    "PROOFS",
    "bound_label",
    "frame_rows",
    "html_report",
    "map_picture",
    "margin_columns",
    "margin_rows",
    "member_rows",
    "pictures_of",
    "proof_rows",
]
