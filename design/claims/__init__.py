"""What has to be shown for a margin to be at least a bound."""

from design.claims.by_margin import Numbers, claims_of, defining_rows
from design.claims.reaching import reach_rows
from design.claims.statement import Statement

__all__ = [
    "Numbers",
    "Statement",
    "claims_of",
    "defining_rows",
    "reach_rows",
]
