"""The certificates beside an `optimum.toml`: one file for each margin, and its entry in the table `[certificate]`."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from design import Certificate, certificate_bytes, load_certificate
from kinematics import Bound, LinkwrightError
from studies.stages import Claim, Proof, Question, Row, same, same_digest

WORTH = 0.5  # share of the worst value found: a best bound below it (or above its inverse) says too little
FOLDER = "certificates"


def file_of(margin: str) -> str:
    """Path of a margin's certificate, relative to the optimum's folder."""
    return f"{FOLDER}/{margin}.npz"


def proof_files(proofs: Sequence[Proof]) -> dict[str, str | bytes]:
    """The proved certificates as files, by their paths."""
    return {file_of(p.certificate.margin): certificate_bytes(p.certificate) for p in proofs if _proved(p.certificate)}


def proof_entries(proofs: Sequence[Proof], most_boxes: int) -> dict[str, dict[str, Any]]:
    """The optimum's entry for each claim, by margin. An undecided claim has no file."""
    return {p.certificate.margin: _entry(p.certificate, most_boxes) for p in proofs}


def _entry(certificate: Certificate, most_boxes: int) -> dict[str, Any]:
    entry: dict[str, Any] = {certificate.bound.word: certificate.bound.value, "status": certificate.status}
    if not _proved(certificate):
        return entry | {"most_boxes": most_boxes}
    digest = hashlib.sha256(certificate_bytes(certificate)).hexdigest()
    return entry | {"boxes": certificate.boxes, "file": file_of(certificate.margin), "sha256": digest}


def _proved(certificate: Certificate) -> bool:
    return certificate.status == "proved"


def known_certificates(entries: Mapping[str, Mapping[str, Any]], folder: Path) -> dict[str, Certificate]:
    """The certificates that the entries name, by margin. They are not replayed yet.

    Raises:
        UnreadableCertificate: a file that an entry names cannot be read.
    """
    return {m: load_certificate(folder / file_of(m)) for m, entry in entries.items() if entry.get("status") == "proved"}


def proof_rows(
    question: Question, entries: Mapping[str, Mapping[str, Any]], worst: Mapping[str, float], folder: Path
) -> list[Row]:
    """Compare every claim of the study with its entry in the optimum, and replay each certificate.

    Args:
        entries: the optimum's entries, by margin.
        worst: the worst poses that a dense search found, by margin, where known. A proof above them would be false.

    Raises:
        UnreadableCertificate: a file is missing or cannot be read.
    """
    claims = {claim.margin: claim for claim in question.claims()}
    rows = [
        _off(f"certificate.{name}", "no claim of the study", "in the file") for name in entries if name not in claims
    ]
    for margin, claim in claims.items():
        if margin not in entries:
            rows.append(_off(f"certificate.{margin}", "an answer", "none in the file"))
        elif entries[margin].get("status") == "undecided":
            rows += _undecided(question, claim, entries[margin])
        else:
            rows += _replayed(question, claim, entries[margin], worst, folder)
    return rows


def _undecided(question: Question, claim: Claim, entry: Mapping[str, Any]) -> list[Row]:
    """Rows of an undecided claim: it claims nothing, so only the record of the attempt is compared."""
    bound = question.bound_of(claim)
    expected = bound | {"status": "undecided", "most_boxes": question.study.certify.most_boxes}
    rows = _entry_rows(claim.margin, entry, expected)
    what = f"{claim.margin} {question.required(claim)} everywhere"
    return [*rows, Row(what, "not claimed", "undecided, sampled only", 0.0)]


def _replayed(
    question: Question, claim: Claim, entry: Mapping[str, Any], worst: Mapping[str, float], folder: Path
) -> list[Row]:
    path = folder / file_of(claim.margin)
    certificate = load_certificate(path)
    expected = _entry(certificate, 0) | {"status": "proved", "sha256": hashlib.sha256(path.read_bytes()).hexdigest()}
    rows = _entry_rows(claim.margin, entry, expected)
    what = f"{claim.margin} {certificate.bound.shown(7)} everywhere"
    try:
        boxes = question.replay(certificate, claim)
    except LinkwrightError as error:
        return [*rows, _off(what, "proved", str(error))]
    if not _proved(certificate):
        return [*rows, _off(what, "proved", certificate.status)]
    found = worst[claim.margin] if claim.margin in worst else question.worst(claim.margin).value
    bound = certificate.bound
    rows.append(Row(what, "proved", f"{boxes} boxes replayed", bound.room(found)))
    if claim.required is None:  # no bound is required, so the best bound must be near the worst value found
        share = WORTH if bound.sense > 0 else 1 / WORTH
        says = f"a bound {'above' if bound.sense > 0 else 'below'} {share:g} of the worst found, {found:.6g}"
        room = Bound(share * found, bound.sense).room(bound.value)
        rows.append(Row(f"{claim.margin}, best bound", says, bound.shown(6), room))
    return rows


def _entry_rows(margin: str, entry: Mapping[str, Any], expected: Mapping[str, Any]) -> list[Row]:
    rows = []
    for key in dict.fromkeys([*expected, *entry]):
        compare = same_digest if key == "sha256" else same
        rows.append(compare(f"certificate.{margin}.{key}", entry.get(key), expected.get(key)))
    return rows


def _off(what: str, expected: str, found: str) -> Row:
    return Row(what, expected, found, -1.0)
