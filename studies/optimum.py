"""`optimum.toml`: a geometry, the figures that it claims, and what made them."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import tomli_w

from design.search import WorstPoses
from design.synthesis import Synthesis
from kinematics import Mechanism
from kinematics.errors import LinkwrightError
from studies.schema import Study

FILE = "optimum.toml"


class InvalidOptimum(LinkwrightError):
    """An `optimum.toml` that cannot be read or does not belong to its study."""

    def __init__(self, path: Path, key: str, found: object, expected: str) -> None:
        self.path, self.key, self.found, self.expected = path, key, found, expected
        super().__init__(f"{path}: {key}: found {found}; expected {expected}")


@dataclass(frozen=True)
class Optimum:
    """What the file holds.

    Attributes:
        mechanism: the class's name.
        geometry: by the fields' names.
        figures: worst value of each margin over the region by its name; the prototype's objective as `prototype`.
        poses: where each worst value is.
        cycle: figures of the timed cycle; empty where the study asks for none.
        made_by: version, study digest, seed, solver status, sample size.
        active: what holds the optimum back.
    """

    mechanism: str
    geometry: dict[str, Any]
    figures: dict[str, float]
    poses: dict[str, list[float]]
    cycle: dict[str, Any]
    made_by: dict[str, Any]
    active: list[str]

    def text(self) -> str:
        """The file."""
        header = "# Written by linkwright; `linkwright check` re-verifies every figure.\n"
        return header + tomli_w.dumps(
            {
                "mechanism": self.mechanism,
                "active": self.active,
                "made_by": self.made_by,
                "geometry": self.geometry,
                "figures": self.figures,
                "worst_pose": self.poses,
                "cycle": self.cycle,
            },
            multiline_strings=False,
        )

    def robot(self, kind: type[Mechanism]) -> Mechanism:
        """The mechanism with this geometry."""
        return kind(kind.Geometry(**{k: tuple(v) if isinstance(v, list) else v for k, v in self.geometry.items()}))


def optimum_of(study: Study, synthesis: Synthesis, objective: str, cycle: dict[str, Any]) -> Optimum:
    """What a run claims."""
    return Optimum(
        mechanism=study.mechanism,
        geometry=synthesis.robot.geometry.as_dict(),
        figures={
            "prototype": synthesis.before[objective].value,
            **{margin: worst.value for margin, worst in synthesis.after.items()},
        },
        poses={margin: _plain(worst) for margin, worst in synthesis.after.items()},
        cycle=cycle,
        made_by={
            "version": version("linkwright"),
            "study_digest": study.digest,
            "seed": study.optimise.seed if study.optimise else 0,
            "solver_status": synthesis.status,
            "sampled_poses": synthesis.sampled,
            "objective": objective,
        },
        active=synthesis.active,
    )


def read_optimum(path: Path) -> Optimum:
    """Read an `optimum.toml`.

    Raises:
        InvalidOptimum: missing, not TOML, or a part missing or of the wrong kind.
    """
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InvalidOptimum(path, "file", error.strerror, "a readable file, made by `linkwright run`") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InvalidOptimum(path, "TOML", error, "a TOML file in UTF-8") from error
    parts: dict[str, Any] = {}
    for key, kind in (("mechanism", str), ("geometry", dict), ("figures", dict), ("made_by", dict)):
        parts[key] = _of_kind(path, data, key, kind)
    for key, value in parts["figures"].items():
        if not isinstance(value, float | int) or isinstance(value, bool):
            raise InvalidOptimum(path, f"figures.{key}", value, "a number")
    for key, kind in (("study_digest", str), ("sampled_poses", int), ("objective", str)):
        _of_kind(path, parts["made_by"], key, kind, "made_by.")
    return Optimum(
        mechanism=parts["mechanism"],
        geometry=parts["geometry"],
        figures=parts["figures"],
        poses=_of_kind(path, data, "worst_pose", dict),
        cycle=_of_kind(path, data, "cycle", dict),
        made_by=parts["made_by"],
        active=_of_kind(path, data, "active", list),
    )


def _of_kind(path: Path, data: dict[str, Any], key: str, kind: type, prefix: str = "") -> Any:
    if not isinstance(data.get(key), kind):
        raise InvalidOptimum(path, f"{prefix}{key}", data.get(key, "nothing"), f"a {kind.__name__}")
    return data[key]


def _plain(worst: WorstPoses) -> list[float]:
    return [round(float(v), 9) + 0.0 for v in worst.pose]
