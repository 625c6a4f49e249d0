"""Small files that would unpack to much are read or refused within 1 GB and 10 s."""

import json
import subprocess
import sys
import zipfile

import numpy as np
import pytest

GB, SECONDS = 1e6, 10.0  # kB of the process, user CPU time
# A parent's peak is a child's as well, so each reads in a process that a small one starts.
CODE = """
import json, resource, subprocess, sys
code = '''
import json, resource, sys, time
from pathlib import Path
from seatlook.errors import InputError
from seatlook.io.export.result import read_result
from seatlook.io.panorama import read_panorama
from seatlook.io.curves import read_curves
from seatlook.io.surface.foam import read_foam_surface
from seatlook.io.texture_maps import read_texture_maps
path, began = Path(sys.argv[1]), time.process_time()
readers = {".npz": read_result, ".hdr": read_panorama, ".exr": read_panorama,
           ".toml": read_curves, "": lambda p: read_texture_maps(p, width=0.1)}
end = "read"
try:
    readers.get(path.suffix, read_foam_surface)(path)
except InputError:
    end = "refused"
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
print(json.dumps([end, peak, time.process_time() - began]))
'''
sys.stdout.write(subprocess.run([sys.executable, "-c", code, sys.argv[1]],
                                capture_output=True, check=True, text=True).stdout)
"""


def picture(folder, size, mode="RGB", kind="png"):
    from PIL import Image

    (folder / "maps").mkdir()
    Image.new(mode, size).save(folder / "maps" / f"a_Color.{kind}")
    return folder / "maps"


def hdr(folder, height, width):
    runs = bytearray([2, 2, width >> 8, width & 255])
    for _ in range(4):
        left = width
        while left:
            runs += bytes([128 + min(127, left), 130])
            left -= min(127, left)
    head = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode()
    (folder / "a.hdr").write_bytes(head + bytes(runs) * height)
    return folder / "a.hdr"


def array(folder, size):
    """Zeros, which pack a thousandfold."""
    path = folder / "a.npz"
    with (
        zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive,
        archive.open("a.npy", "w", force_zip64=True) as member,
    ):
        head = {"descr": "|u1", "fortran_order": False, "shape": (size,)}
        np.lib.format.write_array_header_1_0(member, head)
        for _ in range(size >> 20):
            member.write(bytes(1 << 20))
    return path


def exr(folder, height, width):
    import OpenEXR

    pixels = np.zeros((height, width, 3), np.float16)
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, {"RGB": pixels}) as file:
        file.write(str(folder / "a.exr"))
    return folder / "a.exr"


def text(folder, name, content):
    (folder / name).write_bytes(content)
    return folder / name


BOMBS = {
    "png of 177 million pixels": (lambda f: picture(f, (13300, 13300)), "refused"),
    "png of 8192 x 8192": (lambda f: picture(f, (8192, 8192)), "read"),
    "png with alpha, at the limit": (lambda f: picture(f, (11585, 11585), "RGBA"), "read"),
    "jpeg of 8192 x 8192": (lambda f: picture(f, (8192, 8192), kind="jpg"), "read"),
    "hdr of 8192 x 4096": (lambda f: hdr(f, 4096, 8192), "read"),
    "hdr of 32766 x 16383": (lambda f: hdr(f, 16383, 32766), "refused"),
    "exr of 8192 x 4096": (lambda f: exr(f, 4096, 8192), "read"),
    "npz of 3 GiB": (lambda f: array(f, 3 << 30), "refused"),
    "npz of 600 MiB that is no result": (lambda f: array(f, 600 << 20), "refused"),
    "toml, 2 million parts of a key": (lambda f: text(f, "a.toml", b"a." * 2_000_000), "refused"),
    "toml, 4 million brackets": (lambda f: text(f, "a.toml", b"x=" + b"[" * 4_000_000), "refused"),
    "toml of 5 MiB": (lambda f: text(f, "a.toml", b"# a\n" * 1_400_000), "refused"),
    "toml, one wrong key in 8,000 lines": (
        lambda f: text(f, "a.toml", b'x = [ # """\n' + b"[1, 2, 3],\n" * 8000 + b"]\n"), "refused",
    ),
    "toml, 8,000 wrong keys": (
        lambda f: text(f, "a.toml", b"".join(b"k%d = 1\n" % k for k in range(8000))), "refused",
    ),
    "stl of 4 billion faces": (
        lambda f: text(f, "a.stl", bytes(80) + b"\xff" * 4 + bytes(500)), "refused",
    ),
    "ply of 10^12 vertices": (
        lambda f: text(f, "a.ply", b"ply\nformat binary_little_endian 1.0\nelement vertex "
                       b"1000000000000\nproperty float x\nend_header\n" + bytes(99)), "refused",
    ),
    "glb of an accessor of 10^9": (lambda f: text(f, "a.gltf", json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"componentType": 5126, "count": 10**9, "type": "VEC3"}]}).encode()),
        "refused"),
}  # fmt: skip


@pytest.mark.validate
@pytest.mark.parametrize("name", BOMBS)
def test_bombs(tmp_path, name):
    make, expected = BOMBS[name]
    done = subprocess.run(
        [sys.executable, "-c", CODE, str(make(tmp_path))], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    end, peak, seconds = json.loads(done.stdout)
    assert end == expected
    assert peak < GB
    assert seconds < SECONDS
