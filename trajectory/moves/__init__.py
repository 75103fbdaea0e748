"""Jerk-limited moves and stops off the path."""

from trajectory.moves.moves import Move, plan_move, plan_stop

__all__ = [
    "Move",
    "plan_move",
    "plan_stop",
]
