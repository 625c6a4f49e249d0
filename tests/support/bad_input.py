"""The page of wrong input: every format, what is wrong with it, the message, the exit code.

From the folder of the tests: ``python -m support.bad_input`` writes docs/reference/bad-input.md.
"""

from __future__ import annotations

import re
import tempfile
import warnings
from collections.abc import Iterator
from pathlib import Path

from seatlook import exr, files
from seatlook.errors import InputError
from seatlook.files import MIB
from seatlook.io import npz, panorama, texture_maps, toml
from support.fuzz.formats import FORMATS
from support.lab_files import IN_NEWTON, STRIP

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "bad-input.md"
_TEXT = """# Wrong input

What is said of files that cannot be used. Each message names the file, and the line and the key
where there are such. All ends are exit code 2, before anything is solved or written.
The lists are made by `python -m support.bad_input`, in the folder of the tests.

## Limits

Sizes are asked before anything is unpacked. Within them no file takes more than 1 GB or 10 s.

| what | limit |
|---|---|
{limits}

## Messages

Names of folders are left out.

| format | what is wrong | message | exit code |
|---|---|---|---|
{rows}
"""
_FOLDER = "(a folder)"
_ABSENT = "(no file)"
# format -> (what is wrong, what is replaced in a whole file, by what)
_WRONG: dict[str, tuple[tuple[str, str, str], ...]] = {
    "scene": (
        ("a key mistyped", "element_size_mm", "element_size"),
        ("a text for a number", "element_size_mm = 20.0", 'element_size_mm = "small"'),
        ("a number of 400 digits", "element_size_mm = 20.0", f"element_size_mm = {'9' * 400}"),
        ("a file that is not there", '"foam.obj"', '"foan.obj"'),
        ("a light of 1e308 lm", "lumen = 800.0", "lumen = 1e308"),
        ("two textures of one name", '["pvc", "suede"]', '["suede", "suede"]'),
        ("arrays in arrays", "size = [96, 54]", f"size = {'[' * 50}1{']' * 50}"),
    ),
    "seams": (
        ("an unknown key", "pitch_mm", "pich_mm"),
        ("an edge of another name", 'a = "LEFT', 'a = "LEFR'),
        ("a point far away", "from_mm = [", "from_mm = [1e9, "),
    ),
    "curves": (
        ("one point", "[1, 2, 3],\n", ""),
        ("a point of two numbers", "[1, 2, 3]", "[1, 2]"),
        ("a place at 1e308", "[1, 2, 3]", "[1, 2, 1e308]"),
    ),
    "material": (
        ("a key mistyped", "roughness", "roughnes"),
        ("no thickness", "thickness_mm", "# thickness_mm"),
        ("a negative density", "density_kg_per_m2 = ", "density_kg_per_m2 = -"),
    ),
    "foam material": (
        ("a curve that falls", "stress_kpa = [0", "stress_kpa = [9"),
        ("a Poisson ratio of 3", "poisson = 0", "poisson = 3"),
        ("no curve", "strain", "# strain"),
    ),
    "tests": (
        ("a key mistyped", "direction", "direktion"),
        ("a direction missing", 'direction = "warp"', ""),
        ("a kind that there is not", '"shear"', '"sheer"'),
        ("a unit that there is not", 'unit = "%"', 'unit = "percent"'),
        ("a column that there is not", '"strain"', '"stroke"'),
        ("a file that is not there", '"strip.csv"', '"stripe.csv"'),
        ("N for N/m", 'unit = "N/m" } # force', 'unit = "N" }'),
        ("sides not said", 'sides = "held"', ""),
        ("strain in parts, not in %", 'unit = "%"', 'unit = "1"'),
        ("swapped columns", '"strain", unit = "%" }\nforce = { column = "force"',
         '"force", unit = "%" }\nforce = { column = "strain"'),
        ("the pretension not said", "pretension_n_per_m = 9.8", ""),
        ("G without its angles", "g_between_deg = [0.5, 2.5]", ""),
        ("2HB without its curvature", "hb_at_per_cm = 1.0", ""),
        ("no laboratory", "laboratory", "# laboratory"),
    ),
    "curve": (
        ("a number that is none", "1.0,", "1.O,"),
        ("a cell missing", "2.0,150.0", "2.0,"),
        ("a unit in the head that is another one", "force", "force [N]"),
        ("a curve that falls", STRIP[STRIP.index("10.0,") :], "10.0,300\n11.0,280\n12.0,250\n"),
        ("seven points", STRIP[STRIP.index("7.0,") :], ""),
        ("N that are called N/m", STRIP.partition("\n")[2], IN_NEWTON),
    ),
    "sweep": (
        ("no scene", 'scene = "scene.toml"', ""),
        ("a scene that is not there", '"scene.toml"', '"seat.toml"'),
        ("a spread of nothing", "spread = 1.0", "spread = 0"),
    ),
    "votes": (
        ("of another questionnaire", '"questionnaire": "', '"questionnaire": "x'),
        ("a choice that there is not", '"choice": "left"', '"choice": "both"'),
        ("no name", '"judge": "', '"jdge": "'),
    ),
    "foam OBJ": (
        ("a number that is none", "v ", "v x"),
        ("an index beyond all", "f ", "f 99"),
        ("an open surface", "f ", "# "),
    ),
    "design OBJ": (
        ("a face before its group", "g A\n", ""),
        ("a number that is none", "v ", "v x"),
        ("an index beyond all", "f ", "f 99"),
    ),
    "DXF": (
        ("no unit", "Units: METRIC", "Units: FURLONGS"),
        ("no pieces", "BLOCK", "BLOX"),
        ("a section without end", "ENDSEC", "ENDSE"),
        ("no end", "EOF", "EO"),
        ("a coordinate of nan", " 10\n", " 10\nnan\n999\n"),
    ),
    "deck": (
        ("a number that is none", "*NODE\n", "*NODE\n       x       0.0\n"),
        ("no shells", "*ELEMENT_SHELL", "*ELEMENT_BEAM"),
        ("no strains", "*INITIAL_STRAIN_SHELL", "*INITIAL_STRAIN_SOLID"),
    ),
    "fabric card": (
        ("another material", "*MAT_FABRIC_TITLE", "*MAT_ELASTIC_TITLE"),
        ("a form without curves", "       -14", "         4"),
        ("a curve that is not there", "       100       101", "       999       101"),
        ("a field that is no number", "       -14", "       abc"),
        ("no thickness", "*SECTION_SHELL", "*SECTION_SOLID"),
        ("no curve along warp", "       100       101", "         0       101"),
    ),
    "HDR": (
        ("not twice as wide as high", "+X 16", "+X 12"),
        ("upside down", "-Y 8", "+Y 8"),
        ("a million pixels wide", "-Y 8 +X 16", "-Y 99999 +X 199998"),
    ),
    "set": (),
}  # fmt: skip
_SETS = (
    "mesh.sed=3", "mesh.seed=x", "mesh.seed=-1", 'rig."²".ev100=3', "rig=3", "=3", "name=\udcff",
    "gallery.textures.0.x=1", "stage.0.end_s=1e308", "wrinkle.c_threshold_per_mm=1e-320",
)  # fmt: skip
_MAPS = (
    ("empty", ""),
    ("a height map alone", "a_Height.png"),
    ("two colours", "a_Color.png\na_diff.png"),
    ("two roughnesses", "a_Roughness.png\nb_rough.png"),
    ("two metalnesses", "a_Metalness.png\nb_metal.png"),
    ("two normal maps", "a_NormalGL.png\nb_nor_gl.png"),
    ("a coloured roughness", "a_Roughness.png"),
    ("a coloured metalness", "a_Metalness.png"),
    ("a grey normal map", "a_Color.png\na_NormalGL.png"),
    ("a grey picture of occlusion, roughness, metalness", "a_Color.png\na_arm.png"),
)
_BINARY = (
    ("one byte changed near the head", lambda b: b[:9] + bytes([b[9] ^ 0xFF]) + b[10:]),
    ("its middle missing", lambda b: b[: len(b) // 3] + b[2 * len(b) // 3 :]),
    ("twice the first half", lambda b: b[: len(b) // 2] * 2),
)


def _cases(name: str, whole: bytes) -> Iterator[tuple[str, bytes | str]]:
    """Yield what is wrong, and the content or one of the marks."""
    if name == "set":
        words = [(ascii(w)[1:-1], w.encode("utf-8", "surrogateescape")) for w in _SETS]
        yield from words
        return
    if name == "texture folder":
        yield from ((what, names.encode()) for what, names in _MAPS)
        return
    yield from (("no such file", _ABSENT), ("a folder", _FOLDER), ("an empty file", b""))
    yield from (("the first third only", whole[: len(whole) // 3]), ("zeros", bytes(600)))
    wrong = _WRONG.get(name, ())
    if not wrong:
        yield from ((what, change(whole)) for what, change in _BINARY)
        yield "text", b"Dear colleague, here is the seat.\n"
    for what, old, new in wrong:
        assert old.encode() in whole, (name, old)
        yield what, whole.replace(old.encode(), new.encode(), 1)
    if name in ("scene", "seams", "curves", "material", "foam material", "sweep", "tests"):
        yield "UTF-16", whole.decode().encode("utf-16")
        yield "Latin-1", whole + b"\n# \xe4\n"


def rows() -> Iterator[str]:
    """Yield the rows of the table."""
    with tempfile.TemporaryDirectory() as top:
        for number, (name, form) in enumerate(FORMATS.items()):
            folder = Path(top) / str(number)
            folder.mkdir()
            whole, path = form.seeds(folder)[0], folder / form.file
            before = path.read_bytes() if path.exists() else None
            for what, content in _cases(name, whole):
                _put(path, content)
                message = _message(form.read, path, folder)
                if message:
                    yield f"| {name} | {what} | {message} | {InputError.exit_code} |"
            if before is not None:
                _put(path, before)


def _put(path: Path, content: bytes | str) -> None:
    if path.is_dir():
        path.rmdir()
    path.unlink(missing_ok=True)
    if content == _FOLDER:
        path.mkdir()
    elif isinstance(content, bytes):
        path.write_bytes(content)


def _message(read, path: Path, folder: Path) -> str:
    """First message, and how many follow; empty where the file could be read."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            read(path)
    except InputError as error:
        text = str(error.problems[0]).replace(f"{folder}/", "").replace(str(folder), "maps")
        # How far a compressed file is read depends on its last bits, and they on the processor.
        text = re.sub(r"(?<=seek value )-\d+", "-N", text)
        text = (
            " ".join(re.sub(r"[\x00-\x1f]", " ", text).split())
            .replace("|", "\\|")
            .replace("<", "&lt;")
        )
        text = text if len(text) <= 200 else f"{text[:197]}..."
        more = len(error.problems) - 1
        return text + (f" (and {more} more)" if more else "")
    return ""


def limits() -> Iterator[str]:
    """Yield the rows of the limits."""
    for what, limit in (
        ("any file that is read at once", f"{files.LARGEST_FILE // MIB} MiB"),
        ("scene, seams, curves, material, tests, sweep, votes", f"{files.LARGEST_TEXT // MIB} MiB"),
        ("tables and arrays in each other", f"{toml.DEEPEST}"),
        ("arrays of a result, unpacked", f"{npz.LARGEST // MIB} MiB"),
        ("picture of a texture", f"{texture_maps.LARGEST_PIXELS} pixels"),
        ("texture as it is kept, longer side", f"{texture_maps.LARGEST} pixels"),
        ("panorama (HDR)", f"{panorama.LARGEST_PIXELS} pixels"),
        ("panorama as it is kept", f"{panorama.FINEST_ROWS} rows"),
        ("OpenEXR picture, unpacked", f"{exr.LARGEST_FILE // MIB} MiB"),
        ("d3plot", "none: states are read one by one"),
    ):
        yield f"| {what} | {limit} |"


def page() -> str:
    """Return the whole page."""
    return _TEXT.format(limits="\n".join(limits()), rows="\n".join(rows()))


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
