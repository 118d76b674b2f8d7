#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes petzval/_fields.py: classes and functions with a keyword for each field of a request.

    make_fields.py CORE_MODULE _fields.py
"""
import importlib.util
import sys
import textwrap

TYPES = {"NUMBER": "Number", "WORD": "str", "FILE": "File", "TEXT": "Value", "LIST": "Words", "SWITCH": "bool"}

HEAD = '''# Made by apps/python/make_fields.py from the table of fields.
from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

from ._keywords import File, Number, Value, Words
from ._lens import Lens
from ._render import (CameraBase, Image, OnProgress, SceneBase, chart_fields, plan_fields,
                      render_fields)
'''


def load(path):
    spec = importlib.util.spec_from_file_location("_core", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.fields()


def keywords(fields):
    types = {field["keyword"]: TYPES[field["kind"]] for field in fields}
    if "lens" in types:
        types["lens"] = "str | os.PathLike[str] | Lens"
    return ", ".join(f"{keyword}: {kind} | None = None" for keyword, kind in types.items())


def docs(text, fields, indent):
    lines = [text, ""]
    for field in fields:
        lines += textwrap.wrap(f"{field['keyword']}: {field['help']}", 100, subsequent_indent="    ")
    body = "\n".join(" " * indent + line if line else "" for line in lines).strip()
    return f'{" " * indent}"""{body}\n{" " * indent}"""\n'


def function(name, result, before, call, text, fields):
    return (f"\n\ndef {name}(scene: Scene, camera: Camera | None = None, *, {before}{keywords(fields)}) -> {result}:\n"
            + docs(text, fields, 4) + f"    return {call}\n")


def main():
    fields = load(sys.argv[1])
    of_scene, of_camera = ([field for field in fields if field["owner"] == owner] for owner in ("scene", "camera"))
    text = HEAD + "\n\nclass Scene(SceneBase):\n"
    text += docs("A glTF scene, loaded at the first render and kept for the next ones. Each thread of Python needs one "
                 "of its own. threads: that render; 0: one for each core.", of_scene, 4)
    text += ("    def __init__(self, file: str | os.PathLike[str], *, threads: int = 0, "
             f"{keywords(of_scene)}) -> None:\n"
             "        super().__init__(file, threads, locals())\n\n\nclass Camera(CameraBase):\n")
    text += docs("Where a picture is taken from, and through which lens; what is not given is as the scene's file has "
                 'it. pose may be an array (4, 4), camera to world; axes="gltf" looks along -z with y up, "opencv" along '
                 "z with y down.", of_camera, 4)
    text += (f'    def __init__(self, *, axes: str = "gltf", {keywords(of_camera)}) -> None:\n'
             "        super().__init__(axes, locals())\n")
    text += function("render", "Image", "progress: OnProgress | None = None, ",
                     "render_fields(scene, camera, progress, locals())",
                     "Renders the scene. What is given here goes before what the camera and the scene were given. "
                     "progress is called ten times a second with a Progress; where it raises, or Ctrl-C is pressed, the "
                     "render ends, and the next one of the same picture goes on with its samples.", fields)
    text += function("plan", "dict[str, Any]", "", "plan_fields(scene, camera, locals())",
                     "The cheapest way to render within tolerance, as `petzval plan --json` has it. Its \"fields\" are "
                     "all keywords of the request with what was chosen: render(petzval.Scene(file), **fields) follows it. "
                     "Ctrl-C takes effect when it is done.", [one for one in fields if "plan" in one["takers"]])
    text += function("chart", "dict[str, Any]",
                     'axes: Sequence[str] = (), budget: Number = "10m", seeds: int = 5, '
                     "folder: str | os.PathLike[str] | None = None, ",
                     "chart_fields(scene, camera, axes, budget, seeds, folder, locals())",
                     "Error against CPU time, measured along these axes, as points.json of `petzval chart` has it. "
                     "folder keeps the report with its plots.", [one for one in fields if "chart" in one["takers"]])
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write(text)


if __name__ == "__main__":
    main()
