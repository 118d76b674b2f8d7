# SPDX-License-Identifier: Apache-2.0
"""The recipes of docs/guide/python.md, one after another, as they stand there."""
import re

import numpy as np
import pytest

from conftest import ROOT

PARTS = re.split(r"\n### ", (ROOT / "docs/guide/python.md").read_text())
NAMES = {}


def code_of(part):
    return "\n".join(re.findall(r"```python\n(.*?)```", part, re.DOTALL))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("recipes")
    (folder / "assets").symlink_to(ROOT / "assets")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        exec(code_of(PARTS[0]), NAMES)
    return folder


def test_there_are_ten():
    assert len(PARTS) == 11 and all(code_of(part) for part in PARTS)


@pytest.mark.parametrize("part", PARTS[1:], ids=[part.split("\n")[0] for part in PARTS[1:]])
def test_recipe_runs(part, folder, monkeypatch):
    code = code_of(part)
    for module in ("matplotlib", "scipy"):
        if module in code or (module == "matplotlib" and "pyplot" in code):
            pytest.importorskip(module)
    monkeypatch.chdir(folder)
    exec(code, NAMES)


def test_recipes_left_what_they_say(folder):
    pytest.importorskip("matplotlib")
    for name in ("room.exr", "room.png", "focus.gif", "spots.png", "colorchecker.png", "view19.npz"):
        assert (folder / name).stat().st_size > 500, name
    depth = np.load(folder / "view00.npz")["depth"]
    assert depth.shape == (48, 64) and depth.max() > 0.5
    if "found" in NAMES:
        assert abs(NAMES["found"].x - 0.9) < 0.05
