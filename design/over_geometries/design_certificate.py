"""The answer to whether any geometry within bounds is better than a target."""

from __future__ import annotations

from dataclasses import dataclass

from design.regions import Region
from kinematics import Array, Bound, Value


@dataclass(frozen=True, eq=False)
class DesignCertificate(Value):
    """Whether any geometry within the bounds of a problem has a better objective than a target.

    Attributes:
        mechanism, objective: names.
        digest: of the problem.
        target: the objective that no geometry reaches if this is proved; its sense is that of the objective.
        status: "proved", "refuted" or "undecided".
        better: (g,) the vector of a geometry that is proved to reach the target over the region, if refuted.
        region: the workspace.
        poses: (p, n) poses of it; the proof needs no others.
        counts: how many of the poses each part of the search had. What some exclude by weights, more may not find.
        used, unused: margins of the requirements that count in the proof, and of those that do not. Without the latter
            more geometries are allowed: the bound holds, but one that is tight with them may be out of its reach.
        together: variables that count only by a difference or another sum, in words.
        boxes: how many boxes of geometries were bounded.
        codes: (nodes,) how the box was cut; empty unless proved.
        left: (j, 2, k) the boxes that were not excluded.
        variables: (k,) the names of their columns.
        version: of this program.
    """

    mechanism: str
    objective: str
    digest: str
    target: Bound
    status: str
    better: Array | None
    region: Region
    poses: Array
    counts: tuple[int, ...]
    used: tuple[str, ...]
    unused: tuple[str, ...]
    together: tuple[str, ...]
    boxes: int
    codes: Array
    left: Array
    variables: tuple[str, ...]
    version: str

    def __str__(self) -> str:
        than = "above" if self.target.sense > 0 else "below"
        claim = f"{self.mechanism}: no geometry within the bounds has {self.objective} {than} {self.target.value:.7g}"
        without = f", without the requirements on {', '.join(self.unused)}" if self.unused else ""
        return f"{claim}: {self.status} with {self.boxes} boxes at {len(self.poses)} poses{without}"
