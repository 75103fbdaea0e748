"""The box of geometries that a problem allows, with as few variables as its rows need."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import casadi as ca
import numpy as np

from design.over_geometries.affine_dependence import Direction, free_directions
from design.over_geometries.necessary_rows import NecessaryRows
from design.synthesis import Problem
from kinematics import Array, Mechanism, Program


@dataclass(frozen=True, eq=False)
class DesignBox:
    """Variables of the search, and the geometry that they stand for.

    A variable that follows from others, as only a difference counts, keeps one value. The others take up its range.

    Attributes:
        names: of the variables that are cut, such as "arm_length" or "rod_lengths[1]".
        low, high: (k,) their bounds.
        symbols: (k,) the variables.
        geometry: the model's geometry, in `symbols` and `fixed`.
        fixed: symbols of the numbers that do not change.
        numbers: their values.
        directions: in which the problem's own variables that move may change together without any change of the rows.
        held: the variable, among those that move, that each direction keeps at one value.
        start: (j,) the values of these variables where `symbols` do not say otherwise.
        problem: what is asked.
    """

    names: tuple[str, ...]
    low: Array
    high: Array
    symbols: ca.SX
    geometry: ca.SX
    fixed: ca.SX
    numbers: tuple[float, ...]
    directions: tuple[Direction, ...]
    held: tuple[int, ...]
    start: Array
    problem: Problem

    @classmethod
    def of(cls, problem: Problem, necessary: NecessaryRows) -> DesignBox:
        """The smallest box whose rows are those of every geometry within the problem's bounds."""
        moving = [k for k, moves in enumerate(problem.moving()) if moves]
        places = [problem.places()[k] for k in moving]
        directions = _directions(problem, necessary, places)
        low, high = ([Fraction(v) for v in bounds[moving]] for bounds in problem.bounds())
        kept, all_held = list(range(len(moving))), []
        values = problem.robot.geometry.vector()
        for direction in directions:
            held = next(k for k, part in enumerate(direction) if part == 1 and _alone(k, direction, directions))
            kept.remove(held)
            all_held.append(held)
            value = min(max(Fraction(values[places[held]]), low[held]), high[held])
            for k in kept:
                ends = sorted(-direction[k] * (end - value) for end in (low[held], high[held]))
                low[k], high[k] = low[k] + ends[0], high[k] + ends[1]
            low[held] = high[held] = value
        vector = values.copy()
        for k, place in enumerate(places):
            vector[place] = float(low[k])  # of a variable that is held; the others are symbols
        symbols, geometry = ca.SX.sym("x", len(kept)), ca.SX.sym("fixed", len(vector))
        rest = [place for place in range(len(vector)) if place not in [places[k] for k in kept]]
        fixed = geometry[rest]
        for position, k in enumerate(kept):
            geometry[places[k]] = symbols[position]
        return cls(
            names=tuple(_name(problem, moving[k]) for k in kept),
            low=np.array([_down(low[k]) for k in kept]),
            high=np.array([-_down(-high[k]) for k in kept]),
            symbols=symbols,
            geometry=geometry,
            fixed=fixed,
            numbers=tuple(vector[rest].tolist()),
            directions=tuple(directions),
            held=tuple(all_held),
            start=np.array([float(v) for v in low]),
            problem=problem,
        )

    @property
    def together(self) -> tuple[str, ...]:
        """Each direction in words, such as "+1 base_radius +1 platform_radius": along it nothing changes."""
        moving = [k for k, moves in enumerate(self.problem.moving()) if moves]
        return tuple(
            " ".join(f"{float(part):+g} {_name(self.problem, moving[k])}" for k, part in enumerate(direction) if part)
            for direction in self.directions
        )

    def robot(self, values: Array) -> Mechanism:
        """The robot at values (k,) of the box's variables, moved along the directions into the problem's bounds.

        Raises:
            InvalidGeometry: no robot has these numbers.
        """
        found = self.start.copy()
        found[[k for k in range(len(found)) if k not in self.held]] = values
        moving = self.problem.moving() > 0.0
        low, high = (bounds[moving] for bounds in self.problem.bounds())
        for direction in self.directions:
            along = np.array([float(part) for part in direction])
            ends = np.stack([low - found, high - found])[:, along != 0.0] / along[along != 0.0]
            found += along * np.clip(0.0, ends.min(axis=0).max(), ends.max(axis=0).min())
        whole = self.problem.bounds()[0]
        whole[moving] = np.clip(found, low, high)
        return self.problem.robot_with(whole)


def _directions(problem: Problem, necessary: NecessaryRows, places: list[int]) -> list[Direction]:
    """The directions of the variables at these places of the geometry in which no row changes, at any pose."""
    model = problem.robot.model()
    first = ca.vertcat(*(model.geometry[place] for place in places))
    others = ca.vertcat(*(model.geometry[k] for k in range(model.geometry.numel()) if k not in places))
    symbols = [first, others, model.pose, necessary.scaling, *necessary.claims]
    function = ca.Function("rows", symbols, [ca.densify(ca.vertcat(necessary.rows, necessary.sums))])
    return free_directions(Program.of(function), len(places))


def _alone(k: int, direction: Direction, directions: list[Direction]) -> bool:
    """Whether a variable moves in this direction only."""
    return all(other is direction or not other[k] for other in directions)


def _down(value: Fraction) -> float:
    """A double that is not above it."""
    near = float(value)
    return near if Fraction(near) <= value else float(np.nextafter(near, -np.inf))


def _name(problem: Problem, variable: int) -> str:
    bound = problem.variables[variable]
    return f"{bound.field}[{bound.item}]" if problem.robot.geometry.sizes()[bound.field] > 1 else bound.field
