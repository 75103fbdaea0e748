"""Jerk-limited moves and stops that do not follow a path."""

from trajectory.moves.approach_and_stop import Move, plan_move, plan_stop

__all__ = [
    "Move",
    "plan_move",
    "plan_stop",
]
