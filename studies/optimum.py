"""`optimum.toml`: a geometry, the figures that it claims, and what made them."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import tomli_w

from design.search import WorstPoses
from kinematics import Mechanism
from kinematics.errors import LinkwrightError
from studies.mechanisms import mechanism_class, mechanism_names
from studies.pipeline import Outcome

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
        made_by: version, study digest, seed, solver status, sample size, characteristic length [m].
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

    def robot(self, path: Path) -> Mechanism:
        """The mechanism with this geometry; `path` is named where it is impossible.

        Raises:
            InvalidOptimum: an unknown mechanism or field.
            InvalidGeometry: an impossible value.
        """
        if self.mechanism not in mechanism_names():
            raise InvalidOptimum(path, "mechanism", self.mechanism, f"one of {', '.join(mechanism_names())}")
        kind = mechanism_class(self.mechanism)
        known = kind.Geometry.sizes()
        for field in self.geometry:
            if field not in known:
                raise InvalidOptimum(path, f"geometry.{field}", "an unknown field", f"one of {', '.join(known)}")
        return kind(kind.Geometry(**{k: tuple(v) if isinstance(v, list) else v for k, v in self.geometry.items()}))


def optimum_of(outcome: Outcome) -> Optimum:
    """What a run claims."""
    study, synthesis, objective = outcome.study, outcome.synthesis, outcome.problem.objective
    figures = {margin: worst.value for margin, worst in outcome.worst.items()}
    if outcome.prototype is not None:
        figures["prototype"] = outcome.prototype[objective].value
    return Optimum(
        mechanism=study.mechanism,
        geometry=outcome.robot.geometry.as_dict(),
        figures=figures,
        poses={margin: _plain(worst) for margin, worst in outcome.worst.items()},
        cycle=outcome.timing.figures() if outcome.timing else {},
        made_by={
            "version": version("linkwright"),
            "study_digest": study.digest,
            "seed": study.optimise.seed if study.optimise else 0,
            "solver_status": synthesis.status if synthesis else "geometry given by the study",
            "sampled_poses": outcome.worst[objective].sampled,
            "characteristic_length": outcome.problem.characteristic_length,
        },
        active=synthesis.active if synthesis else [],
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
    kinds = {"mechanism": str, "geometry": dict, "figures": dict, "made_by": dict, "worst_pose": dict, "cycle": dict}
    for key, kind in {**kinds, "active": list}.items():
        parts[key] = _of_kind(path, data, key, kind)
    for key, value in parts["figures"].items():
        if not isinstance(value, float | int) or isinstance(value, bool):
            raise InvalidOptimum(path, f"figures.{key}", value, "a number")
    _of_kind(path, parts["made_by"], "study_digest", str, "made_by.")
    return Optimum(
        mechanism=parts["mechanism"],
        geometry=parts["geometry"],
        figures=parts["figures"],
        poses=parts["worst_pose"],
        cycle=parts["cycle"],
        made_by=parts["made_by"],
        active=parts["active"],
    )


def _of_kind(path: Path, data: dict[str, Any], key: str, kind: type, prefix: str = "") -> Any:
    if not isinstance(data.get(key), kind):
        raise InvalidOptimum(path, f"{prefix}{key}", data.get(key, "nothing"), f"a {kind.__name__}")
    return data[key]


def _plain(worst: WorstPoses) -> list[float]:
    return [round(float(v), 9) + 0.0 for v in worst.pose]
