"""Certificates as files: an npz archive of plain arrays with a JSON header. Nothing in it is ever executed.

A file is not trusted. No part of it is unpacked before its size is known, and each part has a largest size.
"""

from __future__ import annotations

import io
import json
import math
import struct
import tokenize
import zipfile
import zlib
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from design.certificates.box_tree import MOST_NODES
from design.certificates.certificate import Certificate
from design.errors import UnreadableCertificate
from design.regions import Box, Cylinder, Region
from kinematics import Array, Bound, FviBounds, LinkwrightError

_PLAIN: dict[str, type] = {
    "mechanism": str,
    "digest": str,
    "conditions": str,
    "margin": str,
    "characteristic_length": float,
    "version": str,
    "edition": int,
    "status": str,
    "within_reach": bool,
    "boxes": int,
}
_MOST_WORDS = 300
_SENSES = {"at_least": 1, "at_most": -1}
_LARGEST_FILE = 1 << 23  # bytes; a hundred times the largest known file
_MOST_LEFT = 1 << 16  # boxes that were not proved; they show where the proof failed
# Largest number of bytes of each part, including the header of its array.
_LARGEST = {
    "header": 1 << 16,
    "counterexample": 1 << 12,
    "codes": MOST_NODES + 256,
    "left": _MOST_LEFT * 2 * 6 * 8 + 256,
}
# All errors that numpy, zipfile and json raise for bytes that they did not write.
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
    tokenize.TokenError,
    zipfile.BadZipFile,
    zlib.error,
    LinkwrightError,
)


def certificate_bytes(certificate: Certificate) -> bytes:
    """The file's content; the same certificate gives the same bytes. At most 65,536 of the boxes left are kept."""
    header: dict[str, Any] = {key: getattr(certificate, key) for key in _PLAIN}
    header |= {
        certificate.bound.word: certificate.bound.value,
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
        left=certificate.left[:_MOST_LEFT],
    )
    return buffer.getvalue()


def save_certificate(certificate: Certificate, path: Path) -> None:
    """Write a certificate; the name should end in .npz. Numbers keep every bit. See `certificate_bytes`."""
    path.write_bytes(certificate_bytes(certificate))


def load_certificate(path: Path) -> Certificate:
    """Read a certificate. Its claim is not checked yet: `replay` does that.

    Raises:
        UnreadableCertificate: there is no such archive, or a part of it is missing or wrong.
    """
    try:
        return _certificate(path)
    except _FAULTS as error:
        found = error.strerror if isinstance(error, OSError) else None
        words = str(error)[:_MOST_WORDS]  # a library may quote the whole file
        raise UnreadableCertificate(path, found or words or type(error).__name__) from error


def _certificate(path: Path) -> Certificate:
    parts = _members(path)
    header = json.loads(str(_array(parts["header"], "U", 0)))
    pose, codes, left = (
        _array(parts[k], d, n) for k, d, n in (("counterexample", "f8", 1), ("codes", "i1", 1), ("left", "f8", 3))
    )
    if not (np.isfinite(pose).all() and np.isfinite(left).all() and left.shape[1] == 2):
        raise ValueError("a counterexample or a box left with numbers that are not finite")
    plain = {key: _of_kind(key, header[key], kind) for key, kind in _PLAIN.items()}
    words = [word for word in _SENSES if word in header]
    if len(words) != 1:
        raise ValueError(f"the bounds {words}")
    if plain["boxes"] < 0:
        raise ValueError(f"{plain['boxes']} boxes")
    if plain["status"] not in ("proved", "refuted", "undecided"):
        raise ValueError(f"the status {plain['status']!r}"[:200])
    if (plain["status"] == "refuted") != bool(pose.size):
        raise ValueError(f"{pose.size} numbers of a counterexample for the status {plain['status']!r}")
    return Certificate(
        **plain,
        bound=Bound(_of_kind(words[0], header[words[0]], float), _SENSES[words[0]]),
        region=_region(header["region"]),
        bounds=FviBounds(**{key: _of_kind(key, value, float) for key, value in header["bounds"].items()}),
        counterexample=pose if pose.size else None,
        codes=codes,
        left=left,
        mirrors=tuple(tuple(str(name) for name in mirror) for mirror in header["mirrors"]),
    )


def _members(path: Path) -> dict[str, bytes]:
    """The archive's parts by name. Each is there once and is not too large."""
    if (size := path.stat().st_size) > _LARGEST_FILE:
        raise ValueError(f"{size} bytes")
    with zipfile.ZipFile(path) as archive:
        infos = archive.infolist()
        names = sorted(info.filename for info in infos)
        if names != sorted(f"{name}.npy" for name in _LARGEST):
            raise ValueError(f"the parts {', '.join(names)[:200]}")
        for info in infos:
            if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
                raise ValueError(f"{info.filename} compressed in another way")
            if info.file_size > _LARGEST[info.filename.removesuffix(".npy")]:
                raise ValueError(f"{info.filename} of {info.file_size} bytes")
        return {info.filename.removesuffix(".npy"): archive.read(info) for info in infos}


def _array(content: bytes, kind: str, dimensions: int) -> Array:
    """The array of one part, after a check of its type, its number of dimensions, and its number of bytes."""
    stream = io.BytesIO(content)
    if np.lib.format.read_magic(stream) != (1, 0):
        raise ValueError("an array of another format")
    shape, _, dtype = np.lib.format.read_array_header_1_0(stream)
    wanted = dtype.kind == "U" if kind == "U" else dtype == np.dtype(kind)
    body = content[stream.tell() :]
    if (
        not wanted
        or len(shape) != dimensions
        or any(k < 0 for k in shape)
        or math.prod(shape) * dtype.itemsize != len(body)
    ):
        raise ValueError(f"an array of type {dtype} and shape {shape}")
    return np.frombuffer(body, dtype).reshape(shape)


def _of_kind(key: str, value: object, kind: type) -> Any:
    """A value of the header, after a check of its type. A whole number is accepted for a float."""
    if isinstance(value, bool) == (kind is bool) and isinstance(value, (int, float) if kind is float else kind):
        number = kind(value)
        if kind is not float or math.isfinite(number):
            return number
    raise ValueError(f"{key} = {value!r}"[:200])


def _region_record(region: Region) -> dict[str, Any]:
    if isinstance(region, Cylinder):
        rest = {name: list(v) for name, v in region.intervals.items() if name not in ("x", "y")}
        return {"kind": "Cylinder", "radius": region.radius, "intervals": rest}
    return {"kind": "Box", "intervals": {name: list(v) for name, v in region.intervals.items()}}


def _region(record: dict[str, Any]) -> Region:
    intervals = {
        name: (_of_kind(name, low, float), _of_kind(name, high, float))
        for name, (low, high) in record["intervals"].items()
    }
    if record["kind"] == "Cylinder":
        return Cylinder(radius=_of_kind("radius", record["radius"], float), **intervals)
    if record["kind"] == "Box":
        return Box(**intervals)
    raise ValueError(f"a region of kind {record['kind']}")
