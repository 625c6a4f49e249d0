"""What ``check`` says of the pattern file beside what it says of the scene."""

import json

from seatlook import io
from seatlook.cli import run
from support.scene_files import write_two_panels


def test_what_is_read_of_the_pattern_is_said(tmp_path, capsys):
    scene = write_two_panels(tmp_path)
    pattern = tmp_path / "pattern.dxf"
    stray = "  0\nLINE\n  8\n15\n 10\n1.0\n 20\n1.0\n 11\n9.0\n 21\n9.0\n  0\nENDBLK"
    pattern.write_text(pattern.read_text().replace("  0\nENDBLK", stray, 1))
    assert run(["check", str(scene), "--json"]) == 0
    printed = capsys.readouterr()
    lines = json.loads(printed.out)["pattern"]
    assert lines == io.report_pattern(scene).lines()
    assert lines[0] == "2 pieces, a unit is 1 mm"
    assert lines[-1] == "not read: 1 LINE on layer 15 (annotation)"
    assert all(line in printed.err for line in lines)


def test_the_report_reads_as_the_scene_says(tmp_path):
    scene = write_two_panels(tmp_path)
    report = io.report_pattern(scene, changes=['pattern.layers={"2"="INTERNAL"}'])
    assert dict(report.pieces[0].layers)["8"] == 4
