"""The starts of a synthesis: geometries within the bounds that reach the region."""

from __future__ import annotations

import numpy as np

from design.synthesis.errors import ImpossibleSum, SynthesisFailed
from design.synthesis.nlp import Problem
from kinematics import Array, InvalidGeometry, Mechanism, UnreachablePose

STARTS = 3  # by default: the prototype and two random geometries
_ATTEMPTS = 200  # random geometries for each wanted start


def require_possible_sums(problem: Problem) -> None:
    """Check that each sum can hold.

    Raises:
        ImpossibleSum: the sum of its variables' lower bounds is above the limit.
    """
    lowest = problem.robot.geometry.vector()
    lowest[problem.places()] = problem.bounds()[0]
    for number, limit in enumerate(problem.sums):
        least = max(float(lowest[places].sum()) for places in problem.summed(limit))
        if least > limit.at_most:
            reason = f"{limit} cannot hold: with every variable at its lower bound the sum is {least:g}"
            raise ImpossibleSum(number, reason)


def reaching_starts(problem: Problem, poses: Array, seed: int, count: int) -> list[Array]:
    """Variables of geometries that reach every pose, the prototype's first. From others IPOPT would start with NaN.

    Raises:
        SynthesisFailed: none of many geometries reaches all poses; the message describes the nearest one.
    """
    low, high = problem.bounds()
    rng, tries = np.random.default_rng(seed), _ATTEMPTS * count
    found: list[Array] = []
    nearest: Mechanism | None = None
    shortest, refusal = -np.inf, ""
    prototype = np.clip(problem.robot.geometry.vector()[problem.places()], low, high)
    for attempt in range(tries):
        values = prototype if attempt == 0 else np.array(problem.from_unit(rng.random(len(low))))
        try:
            robot = problem.robot_with(values)
        except InvalidGeometry as error:
            refusal = str(error)
            continue
        margin = float(np.nan_to_num(robot.margin("reach", poses), nan=-np.inf).min())
        if margin > 0.0:
            found.append(values)
        elif nearest is None or margin > shortest:
            nearest, shortest = robot, margin
        if len(found) == count:
            break
    if found:
        return found
    if nearest is None:
        raise SynthesisFailed(
            f"none of {tries} random choices within the bounds is a possible geometry; the last: {refusal}",
            "not started",
        )
    try:
        nearest.require_reachable(poses)
    except UnreachablePose as error:
        refusal = str(error)
    what = f"none of {tries} geometries within the bounds reaches the region"
    raise SynthesisFailed(f"{what}; the nearest: {refusal or 'exactly at the end of its reach'}", "not started")
