"""Set-ups that no solve can mend are refused by check, with file, line and both places."""

import dataclasses
import re

import numpy as np
import pytest

from seatlook import io, mesh
from seatlook.assembly import assemble
from seatlook.assembly.contradictions import contradictions
from seatlook.chain.case import Case
from seatlook.chain.start import init
from seatlook.errors import InputError
from seatlook.mesh.closest import closest_places
from seatlook.seats import write_demo
from support.boxes import rounded_block
from support.scenes import two_panels


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    folder = tmp_path_factory.mktemp("demo")
    write_demo(folder, element_size_mm=20.0)
    return folder


def part_frames(folder):
    """Give every edge of the border a frame and a curve of its own, named after its panel."""
    scene = io.load_scene(folder / "scene.toml")
    (frame,) = scene.frames
    curves = dict(scene.foam.curves)
    border = curves.pop(frame.curve)
    stops = np.searchsorted(mesh.arc_length(border), np.array(frame.junctions) - 1e-6)
    tables = []
    for edge, start, end in zip(frame.edges, stops, stops[1:], strict=False):
        name = edge.split(".")[0].lower()
        curves[name] = border[start : end + 1]
        tables.append(
            f'[[frame]]\nname = "frame {name}"\nedges = "{edge}"\ncurve = "{name}"\n'
            'stage = "cover"\n\n'
        )
    io.write_curves(curves, folder / "curves.toml")
    text = (folder / "scene.toml").read_text()
    head, rest = text.split("[[frame]]", 1)
    (folder / "scene.toml").write_text(
        head + "".join(tables) + "# Lights" + rest.split("# Lights", 1)[1]
    )


@pytest.fixture
def edited(demo, tmp_path):
    """Copy the demo's files, one of them changed; return the path of the scene."""

    def edit(name, change):
        for file in demo.iterdir():
            (tmp_path / file.name).write_bytes(file.read_bytes())
        if name == "curves.toml":
            part_frames(tmp_path)
        text = (tmp_path / name).read_text()
        new = change(text)
        assert new != text
        (tmp_path / name).write_text(new)
        return tmp_path / "scene.toml"

    return edit


def exchange(one, two):
    return lambda text: text.replace(one, "?").replace(two, one).replace("?", two)


def problems(scene):
    """What a check refuses."""
    with pytest.raises(InputError) as caught:
        Case(scene).check()
    return caught.value.problems


def named(scene, name):
    """Problems of one kind, by the name under which they can be allowed."""
    return [p for p in problems(scene) if f'allow = ["{name}"]' in p.hint]


def assert_on_the_foam(path):
    """The second place of what lies inside is that of the foam's surface."""
    scene = io.load_scene(path)
    for one in contradictions(scene, assemble(scene)):
        (inside, surface) = one.places
        foam = scene.foam
        on = closest_places(surface[None], foam.vertices, foam.faces, reach=np.inf)
        assert np.linalg.norm(on.offset) < 1e-9
        assert np.linalg.norm(inside - surface) > 5e-3


def line_of(path, text, *, after=0):
    lines = path.read_text().splitlines()
    return next(k for k, line in enumerate(lines, 1) if k > after and line.startswith(text))


def moved(curve, change):
    """Change of the curves file that moves the points of one curve."""

    def apply(text):
        head, rest = text.split(f'[curve."{curve}"]', 1)
        part, *others = re.split(r"(?=\n\[curve)", rest, maxsplit=1)
        numbers = re.findall(r"\[(-?[\d.e-]+), (-?[\d.e-]+), (-?[\d.e-]+)\]", part)
        points = change(np.array(numbers, dtype=float)).tolist()
        return f'{head}[curve."{curve}"]\npoints_mm = {points}\n' + "".join(others)

    return apply


def test_the_demo_and_two_panels_contradict_nothing(demo):
    Case(io.load_scene(demo / "scene.toml")).check()
    assert contradictions(two_panels(), assemble(two_panels())) == ()


def test_hooks_to_the_wire_of_the_other_side(edited):
    path = edited("scene.toml", exchange('wire = "trench_left"', 'wire = "trench_right"'))
    left, right = named(io.load_scene(path), "hook far")
    assert left.file == path
    assert left.line == line_of(path, "wire = ")
    assert right.line == line_of(path, "wire = ", after=left.line)
    assert re.match(
        r"'trench_right', 2\d\d mm from line 'INSERT-BOLSTER_L': \(.*\) mm goes to \(.*\) mm; "
        r"'trench_left' is \d\d mm away",
        left.got,
    )


def test_a_twisted_seam(edited):
    path = edited("seams.toml", lambda text: text.replace("reverse = true", "reverse = false", 1))
    (problem,) = named(io.load_scene(path), "twisted seam")
    assert problem.file == path.with_name("seams.toml")
    assert problem.line == line_of(problem.file, "[[seam]]")
    assert problem.got.startswith("'INSERT-REAR', whose ties cross: ")


@pytest.mark.parametrize("seam", range(13))
def test_every_seam_of_the_demo_can_be_found_twisted(demo, seam):
    scene = io.load_scene(demo / "scene.toml")
    seams = list(scene.pattern.seams)
    seams[seam] = dataclasses.replace(seams[seam], reverse=False)
    pattern = dataclasses.replace(scene.pattern, seams=tuple(seams))
    (problem,) = named(dataclasses.replace(scene, pattern=pattern), "twisted seam")
    assert repr(seams[seam].name) in problem.got


def test_exchanged_partners(edited):
    one, two = "BOLSTER_L.INSERT", "BOLSTER_R.INSERT"
    path = edited("seams.toml", exchange(f'b = ["{one}"]', f'b = ["{two}"]'))
    (problem,) = named(io.load_scene(path), "exchanged seams")
    assert problem.file == path.with_name("seams.toml")
    assert re.match(
        r"'INSERT-BOLSTER_R' and 'INSERT-BOLSTER_L', \d+ and \d+ mm from side to side at \(.*\) mm "
        r"and \(.*\) mm; with each other's partners \d+ mm",
        problem.got,
    )


@pytest.mark.parametrize("apart", [32.0, 40.0])
def test_frame_curves_that_part_where_panels_are_sewn(edited, apart):
    path = edited("curves.toml", moved("front", lambda points: points - [0, apart, 0]))
    ties = named(io.load_scene(path), "ties apart")
    assert len(ties) == 2
    for problem in ties:
        assert f", {apart:.1f} mm away" in problem.got
        assert "'frame front'" in problem.got
        assert problem.got.count(" mm") == 3
        assert problem.line in {
            k for k, line in enumerate(path.read_text().splitlines(), 1) if line == "[[frame]]"
        }


def test_hooks_that_contradict_by_two_millimetres():
    scene = two_panels()
    (hook,) = scene.hooks
    wire = scene.foam.curves[hook.wire] + [0.0, 0.0, 0.002]
    curves = {**scene.foam.curves, "second": wire}
    scene = dataclasses.replace(
        scene,
        foam=dataclasses.replace(scene.foam, curves=curves),
        hooks=(hook, dataclasses.replace(hook, name="again", wire="second")),
    )
    (problem,) = named(scene, "ties apart")
    assert ", 2.0 mm away" in problem.got
    assert problem.line is None


def test_a_frame_curve_through_the_foam(edited):
    def inward(points):
        middle = np.sin(np.pi * np.linspace(0.0, 1.0, len(points)))
        return points + 60.0 * middle[:, None] * [0, 1, 0]

    path = edited("curves.toml", moved("front", inward))
    (problem,) = problems(io.load_scene(path))
    assert re.match(r"'front', \d\d mm inside the foam at \(.*where its surface is at", problem.got)
    assert_on_the_foam(path)
    assert problem.line == line_of(path, "curve = ")


def test_a_scene_that_was_guessed_contradicts_nothing(tmp_path):
    """Guessed curves lie round a foam of long faces, not only round its corners at that height."""
    write_demo(tmp_path, element_size_mm=30.0, surface_size=0.04)
    files = {name: tmp_path / name for name in ("pattern.dxf", "foam.obj", "seams.toml")}
    init(files["pattern.dxf"], files["foam.obj"], tmp_path / "guess", seams=files["seams.toml"])
    Case(io.load_scene(tmp_path / "guess" / "scene.toml")).check()


@pytest.mark.parametrize("radius", [0.03, 0.05])
def test_a_scene_guessed_on_a_foam_of_long_faces_contradicts_nothing(demo, tmp_path, radius):
    vertices, faces = rounded_block((0.53, 0.56, 0.12), radius, 0.06)
    lines = [f"v {x:.6f} {y:.6f} {z:.6f}\n" for x, y, z in vertices]
    lines += [f"f {a} {b} {c}\n" for a, b, c in faces + 1]
    (tmp_path / "foam.obj").write_text("".join(lines))
    init(
        demo / "pattern.dxf",
        tmp_path / "foam.obj",
        tmp_path / "guess",
        seams=demo / "seams.toml",
        foam_unit="m",
    )
    changes = ["mesh.element_size_mm=30"]
    Case(io.load_scene(tmp_path / "guess" / "scene.toml", changes=changes)).check()


@pytest.mark.parametrize(("factor", "ratio"), [(0.1, r"0\.005\d*"), (10.0, r"5\d\.\d")])
def test_a_pattern_out_of_scale(demo, factor, ratio):
    """It is refused before it is meshed: ten times larger it has a hundred times the triangles."""
    scene = io.load_scene(demo / "scene.toml")
    pattern = scene.pattern
    panels = tuple(
        dataclasses.replace(panel, outline=factor * panel.outline) for panel in pattern.panels
    )
    scene = dataclasses.replace(scene, pattern=dataclasses.replace(pattern, panels=panels))
    (problem,) = problems(scene)
    assert problem.key == "pattern.file"
    assert problem.line == line_of(demo / "scene.toml", "file = ")
    assert re.match(rf"panels of \d+.* cm2, {ratio} times the foam's area", problem.got)


def test_a_panel_that_starts_inside(edited):
    def lower(text):
        head, rest = text.split("[placement.INSERT]", 1)
        return f"{head}[placement.INSERT]" + rest.replace("142.09", "40.09", 1)

    path = edited("scene.toml", lower)
    (problem,) = named(io.load_scene(path), "start inside")
    assert problem.key == "placement.INSERT"
    assert problem.line == line_of(path, "[placement.INSERT]")
    assert re.match(r"\d+ % of the panel more than 20 mm inside the foam, \d+ mm at", problem.got)
    assert_on_the_foam(path)


def test_a_contradiction_can_be_allowed_by_name(edited):
    allow = '[check]\nallow = ["hook far"]\n\n[pattern]'
    swap = exchange('wire = "trench_left"', 'wire = "trench_right"')
    path = edited("scene.toml", lambda text: swap(text).replace("[pattern]", allow))
    scene = io.load_scene(path)
    assert scene.allowed == ("hook far",)
    Case(scene).check()
    unknown = path.read_text().replace('"hook far"', '"hooks far"')
    path.write_text(unknown)
    with pytest.raises(InputError, match=r"check.allow: got .*hooks far"):
        io.load_scene(path)
