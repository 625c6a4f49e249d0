import dataclasses
import json

import numpy as np
import pytest

from seatlook.io.export.result import read_result, write_result
from seatlook.model import Curve, TextureMaps
from support.io_samples import solution


def assert_equal(a, b, at="solution"):
    """Equal to the last bit, types included."""
    assert type(a) is type(b), at
    if dataclasses.is_dataclass(a):
        for f in dataclasses.fields(a):
            assert_equal(getattr(a, f.name), getattr(b, f.name), f"{at}.{f.name}")
    elif isinstance(a, np.ndarray):
        assert a.dtype == b.dtype, at
        assert a.shape == b.shape, at
        assert a.tobytes() == b.tobytes(), at
    elif isinstance(a, tuple):
        assert len(a) == len(b), at
        for i, (u, v) in enumerate(zip(a, b, strict=True)):
            assert_equal(u, v, f"{at}[{i}]")
    elif hasattr(a, "items"):
        assert list(a) == list(b), at
        for key in a:
            assert_equal(a[key], b[key], f"{at}[{key}]")
    else:
        assert a == b, at


@pytest.mark.parametrize("status", ["converged", "not converged"])
def test_round_trip_is_exact(tmp_path, status):
    a = solution(status)
    write_result(a, tmp_path / "r.npz")
    assert_equal(a, read_result(str(tmp_path / "r.npz")))


def test_unloading_curves_and_their_history_come_back(tmp_path):
    a = solution()
    material = a.cover.materials[0]
    fabric = dataclasses.replace(material.fabric, warp_unloading=Curve.linear(1e5))
    materials = (dataclasses.replace(material, fabric=fabric), *a.cover.materials[1:])
    peaks = np.full((len(a.cover.faces), 2), -np.inf)
    peaks[0] = 0.03
    a = dataclasses.replace(
        a, cover=dataclasses.replace(a.cover, materials=materials), strain_peak=peaks
    )
    write_result(a, tmp_path / "r.npz")
    assert_equal(a, read_result(tmp_path / "r.npz"))


def test_panels_share_their_texture_maps_in_the_file_and_after_it(tmp_path):
    a = solution()
    pixels = np.random.default_rng(0).integers(0, 255, (64, 64, 3)).astype(np.uint8)
    maps = TextureMaps(folder="linen", width=0.1, height=0.1, albedo=pixels)
    materials = tuple(
        dataclasses.replace(m, appearance=dataclasses.replace(m.appearance, maps=maps))
        for m in a.cover.materials
    )
    a = dataclasses.replace(a, cover=dataclasses.replace(a.cover, materials=materials))
    write_result(a, tmp_path / "r.npz")
    with np.load(tmp_path / "r.npz") as file:
        assert [name for name in file.files if name.endswith("maps.albedo")] == [
            "cover.materials.0.appearance.maps.albedo"
        ]
    b = read_result(tmp_path / "r.npz")
    assert_equal(a, b)
    first, second = (m.appearance.maps for m in b.cover.materials)
    assert first is second


def test_cover_without_foam(tmp_path):
    a = solution()
    a = dataclasses.replace(a, cover=dataclasses.replace(a.cover, foam=None, anchors=()))
    write_result(a, tmp_path / "r.npz")
    assert_equal(a, read_result(tmp_path / "r.npz"))


def test_same_solution_gives_the_same_bytes(tmp_path):
    for name in ("a.npz", "b.npz"):
        write_result(solution(), tmp_path / name)
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def test_the_arrays_are_readable_without_seatlook(tmp_path):
    write_result(solution(), tmp_path / "r.npz")
    with np.load(tmp_path / "r.npz", allow_pickle=False) as archive:
        assert archive["positions"].shape == (7, 3)
        assert archive["cover.faces"].tolist() == [[0, 1, 2], [0, 2, 3], [4, 5, 6]]
        meta = json.loads(str(archive["meta"]))
    assert meta["solution"]["cover"]["panel_names"] == ["insert", "Wange links"]


def test_interrupted_write_leaves_the_old_file(tmp_path, monkeypatch):
    path = tmp_path / "r.npz"
    write_result(solution(), path)
    before = path.read_bytes()
    bad = dataclasses.replace(solution(), figures={"what": object()})
    with pytest.raises(TypeError, match=r"figures\.what: object has no place in a result file"):
        write_result(bad, path)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["r.npz"]


def test_truncated_file(tmp_path, problems):
    path = tmp_path / "r.npz"
    write_result(solution(), path)
    whole = path.read_bytes()
    for length in range(0, len(whole), 97):
        path.write_bytes(whole[:length])
        (message,) = problems(read_result, path)
        assert message.startswith("r.npz: file: got ")
        assert message.endswith("expected a whole result file of seatlook")


def test_damaged_byte_is_noticed(tmp_path, problems):
    path = tmp_path / "r.npz"
    write_result(solution(), path)
    whole = bytearray(path.read_bytes())
    at = whole.index(b"positions.npy") + 60
    whole[at] ^= 0xFF
    path.write_bytes(whole)
    (message,) = problems(read_result, path)
    assert message.endswith("expected a whole result file of seatlook")


def test_foreign_archive(tmp_path, problems):
    np.savez(tmp_path / "r.npz", positions=np.zeros(3))
    (message,) = problems(read_result, tmp_path / "r.npz")
    assert message.endswith("expected a whole result file of seatlook")
    np.savez(tmp_path / "r.npz", meta=np.array('{"format": "x", "format_version": 1}'))
    assert problems(read_result, tmp_path / "r.npz") == [
        "r.npz: file: got format 'x', expected a whole result file of seatlook"
    ]


def test_pickled_content_is_never_loaded(tmp_path, problems):
    np.savez(tmp_path / "r.npz", meta=np.array([{"format": "x"}], dtype=object))
    (message,) = problems(read_result, tmp_path / "r.npz")
    assert message.endswith("expected a whole result file of seatlook")


def changed_meta(path, change):
    with np.load(path, allow_pickle=False) as archive:
        arrays = {k: archive[k] for k in archive.files}
    meta = json.loads(str(arrays.pop("meta")))
    change(meta)
    np.savez(path, meta=np.array(json.dumps(meta)), **arrays)


def test_newer_format(tmp_path, problems):
    write_result(solution(), tmp_path / "r.npz")
    changed_meta(tmp_path / "r.npz", lambda meta: meta.update(format_version=2))
    assert problems(read_result, tmp_path / "r.npz") == [
        "r.npz: format_version: got 2, expected at most 1 "
        "(the file was written by a newer seatlook)"
    ]


@pytest.mark.parametrize(
    "change",
    [
        lambda meta: meta["solution"].update(type="Popen"),
        lambda meta: meta["solution"].update(unknown=1),
        lambda meta: meta["solution"].pop("positions"),
        lambda meta: meta["solution"]["positions"].update(array="velocitie"),
        lambda meta: meta["solution"]["positions"].update(array="cover.rest"),
        lambda meta: meta.update(solution=[1]),
    ],
)
def test_content_that_is_no_solution(tmp_path, problems, change):
    write_result(solution(), tmp_path / "r.npz")
    changed_meta(tmp_path / "r.npz", change)
    (message,) = problems(read_result, tmp_path / "r.npz")
    assert message.startswith(("r.npz: file: got ", "r.npz: Solution.positions: got "))


@pytest.mark.parametrize(
    "text",
    [
        "[" * 100_000,
        "9" * 5000,
        "7",
        '{"format": "seatlook result", "format_version": Infinity}',
        '{"format": "seatlook result", "format_version": "1"}',
        '{"format": "seatlook result", "format_version": 1}',
        '{"format": "seatlook result", "format_version": 1, "solution": {"map": 1}}',
        '{"format": "seatlook result", "format_version": 1, "solution": {"type": []}}',
        f'{{"format": "seatlook result", "format_version": 1, "solution": {"[" * 900}{"]" * 900}}}',
    ],
    ids=lambda text: text[:60],
)
def test_meta_of_another_kind(tmp_path, problems, text):
    np.savez(tmp_path / "r.npz", meta=np.array(text))
    (message,) = problems(read_result, tmp_path / "r.npz")
    assert message.startswith("r.npz: file: got ")
    assert message.endswith("expected a whole result file of seatlook")


def test_missing_file(tmp_path, problems):
    assert problems(read_result, tmp_path / "r.npz") == [
        "r.npz: file: got no such file, expected a file"
    ]
