"""A file that holds no certificate is named, whatever is in it, and no file takes much memory or time."""

from __future__ import annotations

import io
import json
import math
import resource
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from design import (
    Box,
    BrokenCertificate,
    UnreadableCertificate,
    certificate_bytes,
    certify,
    load_certificate,
    replay,
    save_certificate,
)
from design.certificates.box_tree import MOST_NODES, PROVED, leaves
from kinematics import Heli4, LinkwrightError

ROBOT = Heli4()
SMALL = Box(x=(-0.1, 0.1), y=(-0.1, 0.1), z=(-0.72, -0.7), theta=(-0.5, 0.5))
PROOF = certify(ROBOT, SMALL, "J_q", at_least=0.85585)  # close to the worst, so that it has boxes
REFUTATION = certify(ROBOT, SMALL, "J_q", at_least=0.9)
Parts = dict[str, Any]  # the four arrays by name


def test_the_samples_are_a_proof_and_a_refutation() -> None:
    assert (PROOF.status, REFUTATION.status) == ("proved", "refuted")


def _parts(certificate: Any) -> Parts:
    with np.load(io.BytesIO(certificate_bytes(certificate))) as archive:
        return {name: archive[name] for name in archive.files}


def _answer(path: Path) -> str:
    """What reading and replaying a file comes to: "replayed", or the class of a named error with its exit status."""
    try:
        replay(load_certificate(path), ROBOT)
        return "replayed"
    except LinkwrightError as error:
        found = error
    assert "np." not in str(found)
    assert len(str(found)) < 2000
    return f"{type(found).__name__} {found.exit_status}"


def _with_header(**changes: Any) -> Callable[[Parts], Parts]:
    return lambda parts: {**parts, "header": np.array(json.dumps({**json.loads(str(parts["header"])), **changes}))}


def _with(**changes: Any) -> Callable[[Parts], Parts]:
    return lambda parts: {**parts, **changes}


def _without(name: str) -> Callable[[Parts], Parts]:
    return lambda parts: {key: part for key, part in parts.items() if key != name}


BOX = {"kind": "Box", "intervals": {n: list(v) for n, v in SMALL.intervals.items()}}
FAULTS: dict[str, Callable[[Parts], Parts]] = {
    "no codes": _without("codes"),
    "no header": _without("header"),
    "another part": _with(more=np.zeros(3)),
    "codes of two bytes": _with(codes=np.zeros(3, np.int16)),
    "codes of floats": _with(codes=np.zeros(3)),
    "codes in a table": _with(codes=np.zeros((3, 3), np.int8)),
    "objects": _with(codes=np.array([None, {}], dtype=object)),
    "boxes left of one bound": _with(left=np.zeros((2, 1, 4))),
    "boxes left that are NaN": _with(left=np.full((2, 2, 4), math.nan)),
    "a pose that is NaN": _with(counterexample=np.full(4, math.nan)),
    "a pose of a proof": _with(counterexample=np.zeros(4)),
    "a header of numbers": _with(header=np.zeros(3)),
    "a header that is no JSON": _with(header=np.array("{")),
    "a header that is a list": _with(header=np.array("[1, 2]")),
    "a header far too deep": _with(header=np.array("[" * 9000)),
    "fewer boxes than none": _with_header(boxes=-1),
    "boxes in words": _with_header(boxes="12"),
    "boxes and a half": _with_header(boxes=1.5),
    "a bound that is NaN": _with_header(at_least=math.nan),
    "a bound that is true": _with_header(at_least=True),
    "a bound in words": _with_header(at_least="0.4"),
    "a bound without end": _with_header(at_least=10**400),
    "an infinite length": _with_header(characteristic_length=math.inf),
    "a status of its own": _with_header(status="certain"),
    "refuted without a pose": _with_header(status="refuted"),
    "a margin that is a number": _with_header(margin=3),
    "an edition in words": _with_header(edition="2"),
    "within reach in words": _with_header(within_reach="false"),
    "no region": _with_header(region=None),
    "a region of no kind": _with_header(region={**BOX, "kind": "Ball"}),
    "a region that is NaN": _with_header(region={**BOX, "intervals": {**BOX["intervals"], "x": [0, math.nan]}}),  # type: ignore[dict-item]
    "a region upside down": _with_header(region={**BOX, "intervals": {**BOX["intervals"], "x": [1, 0]}}),  # type: ignore[dict-item]
    "a region named self": _with_header(region={**BOX, "intervals": {"self": [0, 1]}}),
    "a region of true": _with_header(region={**BOX, "intervals": {**BOX["intervals"], "x": [False, True]}}),  # type: ignore[dict-item]
    "a circle in words": _with_header(region={"kind": "Cylinder", "radius": "0.5", "intervals": {"z": [-0.8, -0.7]}}),
    "FVI bounds of a list": _with_header(bounds=[1, 2, 3, 4]),
    "FVI bounds of their own": _with_header(bounds={"colour": 1.0}),
    "FVI bounds that overflow": _with_header(bounds={**vars(PROOF.bounds), "force": 1e200}),
    "mirrors that are a number": _with_header(mirrors=7),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_file_whose_part_is_not_what_it_should_be_is_named(fault: str, tmp_path: Path) -> None:
    np.savez_compressed(tmp_path / "c.npz", **FAULTS[fault](_parts(PROOF)))
    assert _answer(tmp_path / "c.npz") == "UnreadableCertificate 2"


@pytest.mark.parametrize("numbers", [1, 3, 5])
def test_a_counterexample_of_another_length_is_no_pose(numbers: int, tmp_path: Path) -> None:
    save_certificate(replace(REFUTATION, counterexample=np.full(numbers, 0.1)), tmp_path / "c.npz")
    assert _answer(tmp_path / "c.npz") == "BrokenCertificate 1"


def test_a_refutation_says_truly_whether_its_pose_is_within_reach() -> None:
    with pytest.raises(BrokenCertificate, match="within reach; it says otherwise"):
        replay(replace(REFUTATION, within_reach=False), ROBOT)


def test_a_part_that_stands_twice_is_refused(tmp_path: Path) -> None:
    (tmp_path / "c.npz").write_bytes(certificate_bytes(PROOF))
    with zipfile.ZipFile(tmp_path / "c.npz", "a") as archive, pytest.warns(UserWarning, match="Duplicate"):
        archive.writestr("codes.npy", archive.read("codes.npy"))
    assert _answer(tmp_path / "c.npz") == "UnreadableCertificate 2"


def _archived(path: Path, **content: bytes) -> None:
    """A certificate's file with other bytes in some of its parts."""
    with (
        zipfile.ZipFile(io.BytesIO(certificate_bytes(PROOF))) as whole,
        zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive,
    ):
        for name in whole.namelist():
            archive.writestr(name, content.get(name.removesuffix(".npy"), whole.read(name)))


def test_the_head_of_an_array_cut_anywhere_is_named(tmp_path: Path) -> None:
    buffer = io.BytesIO()
    np.save(buffer, PROOF.codes)
    for length in range(0, 130, 3):
        _archived(tmp_path / "c.npz", codes=buffer.getvalue()[:length])
        assert _answer(tmp_path / "c.npz") == "UnreadableCertificate 2", length


@pytest.mark.parametrize(
    "shape", ["(1000000000000,)", "(-1,)", "(2.5,)", "(10**9,)", "()", "(4, 4)", "('a',)", "(", "1"]
)
def test_a_shape_that_its_bytes_do_not_fill_is_named(shape: str, tmp_path: Path) -> None:
    head = f"{{'descr': '|i1', 'fortran_order': False, 'shape': {shape}, }}".ljust(117) + "\n"
    _archived(tmp_path / "c.npz", codes=b"\x93NUMPY\x01\x00" + len(head).to_bytes(2, "little") + head.encode())
    assert _answer(tmp_path / "c.npz") == "UnreadableCertificate 2"


def _peak() -> int:
    """Of this process, in bytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def _whole_tree(depth: int) -> np.ndarray:
    """Codes of a tree that is cut along x in every node."""
    codes = np.zeros(2 ** (depth + 1) - 1, dtype=np.int8)
    codes[2**depth - 1 :] = PROVED
    return codes


def test_a_small_file_that_unpacks_to_much_is_refused_before_it_does(tmp_path: Path) -> None:
    path, before = tmp_path / "c.npz", _peak()
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, part in (("header", 100), ("counterexample", 100), ("left", 100), ("codes", 10**8)):
            with archive.open(f"{name}.npy", "w") as member:
                for first in range(0, part, 1 << 20):
                    member.write(bytes(min(1 << 20, part - first)))
    assert path.stat().st_size < 110_000
    assert _answer(path) == "UnreadableCertificate 2"
    assert _peak() - before < 30e6


def test_more_boxes_than_a_tree_may_have_are_refused() -> None:
    with pytest.raises(BrokenCertificate, match="more than"):
        next(leaves(np.full(MOST_NODES + 1, PROVED, dtype=np.int8), np.zeros((1, 4)), np.ones((1, 4))))


def test_a_wide_tree_is_walked_a_few_boxes_at_a_time(tmp_path: Path) -> None:
    """Two million leaves in one level, in a file of a few kilobytes."""
    save_certificate(replace(PROOF, codes=_whole_tree(21), boxes=2**21), tmp_path / "c.npz")
    assert (tmp_path / "c.npz").stat().st_size < 20_000
    before = _peak()
    assert _answer(tmp_path / "c.npz") == "BrokenCertificate 1"
    assert _peak() - before < 100e6


def test_a_tree_is_walked_whole_and_its_leaves_fill_the_root() -> None:
    rng = np.random.default_rng(7)
    for _ in range(30):
        levels, open_ = [], 1
        for level in range(14):
            codes = np.where(rng.random(open_) < (0.55 if level < 13 else 0.0), rng.integers(0, 3, open_), PROVED)
            levels.append(codes.astype(np.int8))
            open_ = 2 * int((codes >= 0).sum())
            if not open_:
                break
        codes = np.concatenate(levels)
        found = list(leaves(codes, np.zeros((1, 3)), np.ones((1, 3))))
        assert sum(len(code) for code, _, _ in found) == (codes < 0).sum(), "seed 7"
        assert sum(float((high - low).prod(axis=1).sum()) for _, low, high in found) == pytest.approx(1.0)


def test_a_chain_of_cuts_without_end_is_refused() -> None:
    chain = np.tile(np.array([PROVED, 0], dtype=np.int8), 200_000)
    codes = np.concatenate([[0], chain, [PROVED, PROVED]]).astype(np.int8)
    with pytest.raises(BrokenCertificate, match="cut more than"):
        list(leaves(codes, np.zeros((1, 4)), np.ones((1, 4))))


def test_a_file_holds_the_first_boxes_left_and_no_endless_list(tmp_path: Path) -> None:
    undecided = certify(ROBOT, SMALL, "J_q", at_least=0.62, most_boxes=20)
    save_certificate(undecided, tmp_path / "c.npz")
    assert (load_certificate(tmp_path / "c.npz").left == undecided.left).all()
    many = np.random.default_rng(2).random((10**5, 2, 4))
    save_certificate(replace(undecided, left=many), tmp_path / "c.npz")
    assert (load_certificate(tmp_path / "c.npz").left == many[: 1 << 16]).all()


def _damaged(rng: np.random.Generator, whole: bytes) -> bytes:
    """Bytes changed, cut out, doubled or cut off."""
    content = bytearray(whole)
    for _ in range(int(rng.integers(1, 5))):
        if not content:
            break
        first = int(rng.integers(len(content)))
        last = min(len(content), first + int(rng.integers(1, 40)))
        match int(rng.integers(4)):
            case 0:
                content[first] ^= int(rng.integers(1, 256))
            case 1:
                del content[first:last]
            case 2:
                content[first:first] = content[first:last]
            case 3:
                content = content[: max(1, first)]
    return bytes(content)


WILD = (
    "",
    "x" * 100,
    -1,
    0,
    1,
    2**70,
    1e308,
    -1e-320,
    math.nan,
    math.inf,
    True,
    None,
    [],
    [[]],
    {},
    {"a": 1},
    ["x", "y"],
)


def _wild(rng: np.random.Generator, node: Any, depth: int = 0) -> Any:
    """The header with one value or key changed."""
    if isinstance(node, dict) and node and depth < 3 and rng.random() < 0.8:
        key = list(node)[int(rng.integers(len(node)))]
        if rng.random() < 0.1:
            return {k: v for k, v in node.items() if k != key}
        return {**node, key: _wild(rng, node[key], depth + 1)}
    return WILD[int(rng.integers(len(WILD)))]


def _fuzz(rng: np.random.Generator, path: Path, count: int, seed: str) -> None:
    before = _peak()
    for k in range(count):
        parts = _parts((PROOF, REFUTATION)[k % 2])
        match k % 3:
            case 0:
                path.write_bytes(_damaged(rng, certificate_bytes((PROOF, REFUTATION)[k % 2])))
            case 1:
                header = _wild(rng, json.loads(str(parts["header"])))
                np.savez_compressed(path, **{**parts, "header": np.array(json.dumps(header))})
            case 2:
                codes = parts["codes"].copy() if parts["codes"].size else np.zeros(3, np.int8)
                codes[rng.integers(len(codes), size=2)] = rng.integers(-4, 6, 2)
                _archived(path, codes=_damaged(rng, _npy(codes)) if k % 2 else _npy(codes))
        assert _answer(path), f"{seed}: {k}"
    assert _peak() - before < 200e6, seed


def _npy(array: np.ndarray) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, array)
    return buffer.getvalue()


def test_no_damage_gives_anything_but_a_named_error_or_a_certificate_that_replays(tmp_path: Path) -> None:
    _fuzz(np.random.default_rng(41), tmp_path / "c.npz", 150, "seed 41")


@pytest.mark.long
def test_no_damage_of_thousands_gives_anything_else(tmp_path: Path) -> None:
    _fuzz(np.random.default_rng(42), tmp_path / "c.npz", 6000, "seed 42")


def test_a_file_that_is_none_is_named(tmp_path: Path) -> None:
    for path in (tmp_path, tmp_path / "none.npz"):
        with pytest.raises(UnreadableCertificate, match="cannot be read"):
            load_certificate(path)
