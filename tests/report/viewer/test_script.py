"""Modules joined into one classic script."""

from __future__ import annotations

import re

import pytest

from seatlook.report.viewer.script import joined


def write(folder, **modules):
    for name, text in modules.items():
        (folder / f"{name}.js").write_text(text)


def test_each_module_stands_once_after_those_it_needs(tmp_path):
    write(
        tmp_path,
        main='import { a } from "./one.js";\nimport { b } from "./two.js";\na(b);\n',
        one='import { b } from "./two.js";\nexport const a = (x) => x + b;\n',
        two="export const b = 2;\n",
    )
    text = joined("main", tmp_path)
    assert re.findall(r"const \w+|a\(b\)", text) == ["const b", "const a", "a(b)"]
    assert text.startswith('"use strict";\n(() => {\n')
    assert "import" not in text
    assert "export" not in text


def test_modules_in_folders_are_found_from_where_they_are_named(tmp_path):
    (tmp_path / "deep").mkdir()
    write(tmp_path, main='import { a } from "./deep/one.js";\na();\n')
    write(
        tmp_path / "deep",
        one='import { b } from "./two.js";\nexport const a = () => b;\n',
        two="export const b = 1;\n",
    )
    assert "const b = 1;\n\nconst a" in joined("main", tmp_path)


def test_modules_of_another_page_are_found_above(tmp_path):
    for name in ("page/deep", "shared"):
        (tmp_path / name).mkdir(parents=True)
    write(tmp_path / "page", main='import { a } from "./deep/one.js";\na();\n')
    write(
        tmp_path / "page/deep",
        one='import { b } from "../../shared/two.js";\nexport const a = () => b;\n',
    )
    write(tmp_path / "shared", two="export const b = 1;\n")
    assert "const b = 1;\n\nconst a" in joined("main", tmp_path / "page")


@pytest.mark.failure
@pytest.mark.parametrize(
    ("other", "said"),
    [
        ("export const a = 1;\nconst x = 2;\n", "x is also given by"),
        ('import { y } from "./main.js";\nexport const a = y;\n', "circle: main > other > main"),
        ("const b = 1;\nexport { b as a };\n", "cannot join 'export { b as a };'"),
        ("export const a = '</script>';\n", "what would end it"),
    ],
)
def test_what_cannot_be_joined_is_refused(tmp_path, other, said):
    write(tmp_path, main='import { a } from "./other.js";\nconst x = a;\n', other=other)
    with pytest.raises(ValueError, match=re.escape(said)):
        joined("main", tmp_path)


@pytest.mark.failure
def test_an_import_may_not_rename(tmp_path):
    write(
        tmp_path, main='import { a as z } from "./other.js";\nz();\n', other="export const a = 1;\n"
    )
    with pytest.raises(ValueError, match="renames what it imports"):
        joined("main", tmp_path)


def test_the_viewer_is_one_script_without_what_a_content_policy_refuses():
    text = joined()
    assert text == joined()
    assert not re.search(r"\beval\(|new Function|\bfetch\(|new Worker|innerHTML|https?:", text)
    assert not re.search(r"setAttribute\(\s*[\"']style", text)
