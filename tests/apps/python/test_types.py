# SPDX-License-Identifier: Apache-2.0
"""Types and help, as editors and mypy read them."""
import inspect
import os
import subprocess
import sys

import pytest

import petzval
from petzval import _core

PROGRAM = """
import numpy as np
import petzval

camera = petzval.Camera(lens=petzval.Lens("takumar-50mm-f1.2"), fstop=2, pose=np.eye(4))
image = petzval.render(petzval.Scene("room.glb"), camera, samples=4, layers=["depth"], denoise=True)
wrong: str = image.pixels
petzval.render(petzval.Scene("room.glb"), fstp=2)
petzval.Camera(fstop={})
"""


def test_mypy_finds_what_is_wrong_and_nothing_else(tmp_path):
    pytest.importorskip("mypy")
    (tmp_path / "program.py").write_text(PROGRAM)
    folder = os.path.dirname(os.path.dirname(petzval.__file__))
    done = subprocess.run([sys.executable, "-m", "mypy", "--no-color-output", "--no-error-summary", "program.py"],
                          cwd=tmp_path, capture_output=True, text=True, env={**os.environ, "MYPYPATH": folder})
    errors = [line for line in done.stdout.splitlines() if ": error:" in line]
    assert [line.split(":")[1] for line in errors] == ["7", "8", "9"], done.stdout


def test_everything_has_a_docstring_and_keywords():
    for name in petzval.__all__:
        thing = getattr(petzval, name)
        assert isinstance(thing, (int, float)) or inspect.getdoc(thing), name
    keywords = inspect.signature(petzval.render).parameters
    for field in _core.fields():
        assert field["keyword"] in keywords and f"{field['keyword']}: " in (petzval.render.__doc__ or "")
