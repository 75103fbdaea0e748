"""Certificates as files: an npz archive of plain arrays with a JSON header; nothing in it is ever executed."""

from __future__ import annotations

import io
import json
import struct
import zipfile
import zlib
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from design.certificate import Certificate
from design.errors import UnreadableCertificate
from design.region import Box, Cylinder, Region
from kinematics import FviBounds
from kinematics.errors import LinkwrightError

_PLAIN: dict[str, type] = {
    "mechanism": str,
    "digest": str,
    "ranges": str,
    "margin": str,
    "at_least": float,
    "characteristic_length": float,
    "version": str,
    "edition": int,
    "status": str,
    "within_reach": bool,
    "boxes": int,
}
# All that numpy, zipfile and json raise on bytes that they did not write.
_FAULTS = (
    OSError,
    ValueError,
    LookupError,
    TypeError,
    AttributeError,
    ArithmeticError,
    EOFError,
    MemoryError,
    RuntimeError,
    SyntaxError,
    struct.error,
    zipfile.BadZipFile,
    zlib.error,
    LinkwrightError,
)


def certificate_bytes(certificate: Certificate) -> bytes:
    """The file's content; the same certificate gives the same bytes."""
    header: dict[str, Any] = {key: getattr(certificate, key) for key in _PLAIN}
    header |= {
        "region": _region_record(certificate.region),
        "bounds": asdict(certificate.bounds),
        "mirrors": certificate.mirrors,
    }
    pose = certificate.counterexample
    buffer = io.BytesIO()
    np.savez_compressed(
        buffer,
        header=np.array(json.dumps(header)),
        counterexample=np.empty(0) if pose is None else pose,
        codes=certificate.codes,
        left=certificate.left,
    )
    return buffer.getvalue()


def save_certificate(certificate: Certificate, path: Path) -> None:
    """Write it; the name should end in .npz. Numbers keep every bit."""
    path.write_bytes(certificate_bytes(certificate))


def load_certificate(path: Path) -> Certificate:
    """Read it back; what it claims is still to be checked by `replay`.

    Raises:
        UnreadableCertificate: no such archive, or a part of it is missing or not what it should be.
    """
    try:
        return _certificate(path)
    except _FAULTS as error:
        found = error.strerror if isinstance(error, OSError) else None
        raise UnreadableCertificate(path, found or str(error) or type(error).__name__) from error


def _certificate(path: Path) -> Certificate:
    with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
        header = json.loads(str(archive["header"]))
        pose, codes, left = (archive[key] for key in ("counterexample", "codes", "left"))
    if codes.dtype != np.int8 or codes.ndim != 1:
        raise ValueError(f"codes of type {codes.dtype} and shape {codes.shape}")
    if pose.dtype != float or pose.ndim != 1:
        raise ValueError(f"a counterexample of type {pose.dtype} and shape {pose.shape}")
    return Certificate(
        **{key: kind(header[key]) for key, kind in _PLAIN.items()},
        region=_region(header["region"]),
        bounds=FviBounds(**{key: float(value) for key, value in header["bounds"].items()}),
        counterexample=pose if pose.size else None,
        codes=codes,
        left=left,
        mirrors=tuple(tuple(str(name) for name in mirror) for mirror in header["mirrors"]),
    )


def _region_record(region: Region) -> dict[str, Any]:
    if isinstance(region, Cylinder):
        rest = {name: list(v) for name, v in region.intervals.items() if name not in ("x", "y")}
        return {"kind": "Cylinder", "radius": region.radius, "intervals": rest}
    return {"kind": "Box", "intervals": {name: list(v) for name, v in region.intervals.items()}}


def _region(record: dict[str, Any]) -> Region:
    intervals = {name: (float(low), float(high)) for name, (low, high) in record["intervals"].items()}
    if record["kind"] == "Cylinder":
        return Cylinder(radius=record["radius"], **intervals)
    if record["kind"] == "Box":
        return Box(**intervals)
    raise ValueError(f"a region of kind {record['kind']}")
