# SPDX-License-Identifier: Apache-2.0
"""What the tests of Petzval from Python share."""
import json
import os
import subprocess
import struct
from pathlib import Path

import numpy as np
import pytest

import petzval

ROOT = Path(__file__).resolve().parents[3]
PROGRAM = os.environ["PETZVAL_PROGRAM"]


def run_program(*words):
    """Runs the command line; returns what it printed."""
    # New memory is filled, so that a number that nobody set is never 0 by chance.
    environment = {**os.environ, "OCIO": "", "MALLOC_PERTURB_": "77"}
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stderr
    return done.stdout


def save_everything(path):
    """A .glb with what fields choose from: two scenes, cameras, variants and animations, and a point."""
    arrays = [np.array([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], "<f4"), np.array([0, 1], "<f4"),
              np.array([[0, 0, 0], [1, 0, 0]], "<f4")]
    views, accessors, data = [], [], b""
    for array, kind in zip(arrays, ("VEC3", "SCALAR", "VEC3")):
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": array.nbytes})
        bounds = {"min": np.atleast_1d(array.min(axis=0)).tolist(), "max": np.atleast_1d(array.max(axis=0)).tolist()}
        accessors.append({"bufferView": len(views) - 1, "componentType": 5126, "count": len(array), "type": kind, **bounds})
        data += array.tobytes()
    shown = {"attributes": {"POSITION": 0}, "material": 0,
             "extensions": {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0]}]}}}
    cameras = [{"name": name, "type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1}}
               for name in ("left", "right")]
    moves = [{"name": name, "samplers": [{"input": 1, "output": 2}],
              "channels": [{"sampler": 0, "target": {"node": 0, "path": where}}]}
             for name, where in (("shift", "translation"), ("turn", "scale"))]
    scene = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}] * 2,
        "extensionsUsed": ["KHR_materials_variants"],
        "extensions": {"KHR_materials_variants": {"variants": [{"name": "red"}]}},
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 4]}, {"camera": 1, "translation": [0.5, 0, 4]}],
        "meshes": [{"primitives": [shown, {"attributes": {"POSITION": 0}, "mode": 0}]}],
        "materials": [{"name": "plain"}, {"pbrMetallicRoughness": {"baseColorFactor": [0.8, 0, 0, 1]}}],
        "cameras": cameras, "animations": moves, "bufferViews": views, "accessors": accessors,
        "buffers": [{"byteLength": len(data)}]}
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body)
    return path


@pytest.fixture(scope="session")
def everything(tmp_path_factory):
    return save_everything(tmp_path_factory.mktemp("scene") / "everything.glb")


@pytest.fixture(scope="session")
def room():
    return petzval.Scene(ROOT / "assets/scenes/first_light.glb")
