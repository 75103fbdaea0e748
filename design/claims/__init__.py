"""What has to be shown for a margin to be at least a bound."""

from design.claims.reaching import reach_rows
from design.claims.statement import Statement
from design.claims.with_reach import to_show

__all__ = ["Statement", "reach_rows", "to_show"]
