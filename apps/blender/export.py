# SPDX-License-Identifier: Apache-2.0
"""Writes the scene of a Blender file as a .glb, and lists what Petzval does not render.

    blender -b FILE.blend -P apps/blender/export.py -- OUT.glb
"""
import importlib
import os
import pathlib
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
scene = importlib.import_module(os.path.basename(HERE) + ".scene")

if __name__ == "__main__":
    words = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    if len(words) != 1:
        sys.exit("blender -b FILE.blend -P export.py -- OUT.glb")
    try:
        for line in scene.export(os.path.abspath(words[0])):
            print(f"petzval: not rendered: {line}")
    except (OSError, RuntimeError) as error:  # Blender's exporter gives a whole traceback
        for left in (words[0], os.path.splitext(words[0])[0] + ".sky.exr"):
            pathlib.Path(left).unlink(missing_ok=True)
        sys.exit(f"petzval: {([line for line in str(error).splitlines() if 'Error' in line] or [error])[-1]}")
