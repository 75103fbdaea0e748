"""`optimum.toml`: a geometry, the figures that it claims, and what made them."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import tomli_w

from design import Certificate
from kinematics import InvalidGeometry, Mechanism
from studies.building import robot_of
from studies.committed.committed_proofs import known_certificates, proof_entries
from studies.errors import Fault, KeyPath, StudyError, spelled
from studies.stages import Outcome
from studies.study_file import Study, TomlFile, changes, cycle_question, design_question, digest_of, read_toml

FILE = "optimum.toml"
_TABLES = ("made_by", "asked", "geometry", "figures", "worst_pose")


@dataclass(frozen=True)
class Optimum:
    """The file's content.

    Attributes:
        data: `mechanism`, `active` (the constraints that limit the optimum) and the tables `made_by`, `asked` (the
            questions `design` and `cycle`, by key), `geometry` (by field), `figures` (worst value of each margin; the
            prototype's objective as `prototype`), `worst_pose` (the pose of each worst value) and, if the study asks
            for them, `certificate` (by margin) and `cycle`.
        file: the path that it was read from.
    """

    data: dict[str, Any]
    file: TomlFile | None = None

    def text(self) -> str:
        """The file's text."""
        header = "# Written by linkwright; `linkwright check` verifies it again, figure by figure.\n"
        return header + tomli_w.dumps(self.data, multiline_strings=False)

    def error_at(self, path: KeyPath, found: str, expected: str) -> StudyError:
        """An error at a key of the file."""
        assert self.file is not None
        return StudyError([self.file.fault(path, found, expected)])

    @property
    def certificates(self) -> dict[str, dict[str, Any]]:
        """The entry of each claim to prove, by margin."""
        entries: dict[str, dict[str, Any]] = self.data.get("certificate", {})
        return entries

    def asked(self, which: str) -> dict[str, Any]:
        """The question that the file answers, "design" or "cycle": its values by key."""
        question = self.data["asked"].get(which, {})
        if not isinstance(question, dict):
            raise self.error_at(("asked", which), spelled(question), "a table")
        return question

    def answers_design(self, study: Study) -> bool:
        """Whether its geometry answers this study's design question."""
        question = design_question(study)
        return self.asked("design") == question and self.data["made_by"].get("design_digest") == digest_of(question)

    def robot(self, study: Study) -> Mechanism:
        """The study's mechanism with this geometry, and the study's masses and joint ranges.

        Raises:
            StudyError: another mechanism, a missing or unknown field, or an impossible value, with its line.
        """
        if self.data["mechanism"] != study.mechanism:
            raise self.error_at(
                ("mechanism",), spelled(self.data["mechanism"]), f"the study's mechanism, {study.mechanism}"
            )
        kind = study.mechanism_class
        given, known = self.data["geometry"], kind.Geometry.sizes()
        for field in given:
            if field not in known:
                raise self.error_at(("geometry", field), "an unknown field", f"one of {', '.join(known)}")
        for field in known:
            if field not in given:
                raise self.error_at(("geometry",), f"no {field}", f"all of {', '.join(known)}")
        try:
            geometry = kind.Geometry(**{name: _tuples(value) for name, value in given.items()})
        except InvalidGeometry as error:
            raise self.error_at(("geometry", error.field), spelled(given[error.field]), error.expected) from error
        return robot_of(study, geometry)


def optimum_of(outcome: Outcome) -> Optimum:
    """The optimum that a run claims."""
    study, objective = outcome.study, outcome.problem.objective
    design, cycle = design_question(study), cycle_question(study)
    figures = {margin: worst.value for margin, worst in outcome.worst.items()}
    if outcome.prototype is not None:
        figures["prototype"] = outcome.prototype[objective].value
    return Optimum(
        {
            "mechanism": study.mechanism,
            "active": outcome.active,
            "made_by": {
                "version": version("linkwright"),
                "design_digest": digest_of(design),
                "cycle_digest": digest_of(cycle),
                "seed": study.optimise.seed if study.optimise else 0,
                "solver_status": outcome.solver_status,
                "sampled_poses": outcome.worst[objective].sampled,
                "characteristic_length": outcome.problem.characteristic_length,
                "geometry_hash": outcome.robot.geometry.digest,
            },
            "asked": {"design": design, "cycle": cycle},
            "geometry": outcome.robot.geometry.as_dict(),
            "figures": figures,
            "worst_pose": {m: [round(float(v), 9) + 0.0 for v in w.pose] for m, w in outcome.worst.items()},
            **({"certificate": proof_entries(outcome.proofs, study.certify.most_boxes)} if outcome.proofs else {}),
            **({"cycle": figures_of_cycle} if (figures_of_cycle := outcome.cycle_figures()) else {}),
        }
    )


def read_optimum(path: Path) -> Optimum:
    """Read an `optimum.toml`.

    Raises:
        StudyError: missing, not TOML, or a part missing or of the wrong kind, with its line.
    """
    if not path.is_file():
        how = "`linkwright run STUDY --commit` writes it; --prototype works without it"
        raise StudyError([Fault(path, "", None, "no such file", f"the study's committed optimum: {how}")])
    optimum = Optimum((file := read_toml(path)).data, file)
    for key, kind, words in (("mechanism", str, "a name"), ("active", list, "a list"), *_tables()):
        if not isinstance(optimum.data.get(key), kind):
            raise optimum.error_at((key,), spelled(optimum.data[key]) if key in optimum.data else "nothing", words)
    for name, value in optimum.data["figures"].items():
        if isinstance(value, bool) or not isinstance(value, float | int):
            raise optimum.error_at(("figures", name), spelled(value), "a number")
    certificates = optimum.data.get("certificate", {})
    if not isinstance(certificates, dict):
        raise optimum.error_at(("certificate",), spelled(certificates), "a table")
    for name, value in certificates.items():
        if not isinstance(value, dict):
            raise optimum.error_at(("certificate", name), spelled(value), "a table")
    return optimum


def committed(study: Study, folder: Path) -> Mechanism | None:
    """The robot of the optimum beside a study; None where the study optimises nothing.

    Raises:
        StudyError: the file is missing, cannot be used, or was made for another design question.
    """
    if study.optimise is None:
        return None
    optimum = read_optimum(folder / FILE)
    if not optimum.answers_design(study):
        was, now = optimum.asked("design"), design_question(study)
        found = "; ".join(told_change(key, *values) for key, values in changes(was, now).items())
        mended = "this study's design question; run it again with --commit, or use --prototype"
        raise optimum.error_at(
            ("asked", "design"), f"an answer to another question ({found or 'changed by hand'})", mended
        )
    return optimum.robot(study)


def committed_certificates(study: Study, folder: Path, robot: Mechanism) -> dict[str, Certificate]:
    """The certificates beside a study, by margin, not replayed yet; none if the optimum is not that of `robot`.

    Raises:
        StudyError, UnreadableCertificate: a file cannot be used.
    """
    if not (folder / FILE).is_file():
        return {}
    optimum = read_optimum(folder / FILE)
    if not optimum.answers_design(study) or optimum.data["made_by"].get("geometry_hash") != robot.geometry.digest:
        return {}
    return known_certificates(optimum.certificates, folder)


def told_change(key: str, was: object, now: object) -> str:
    """A changed key in words."""
    return f"{key} was {told(was)} and is {told(now)}"


def told(value: object) -> str:
    """The value of a key as text; "not given" for None."""
    return "not given" if value is None else spelled(value)


def _tables() -> list[tuple[str, type, str]]:
    return [(name, dict, "a table") for name in _TABLES]


def _tuples(value: Any) -> Any:
    return tuple(_tuples(v) for v in value) if isinstance(value, list) else value
