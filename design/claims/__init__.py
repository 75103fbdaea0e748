"""The claims behind "a margin keeps a bound": expressions that must be at least 0."""

from design.claims.reaching import reach_rows
from design.claims.statement import Statement
from design.claims.with_reach import to_show

__all__ = ["Statement", "reach_rows", "to_show"]
