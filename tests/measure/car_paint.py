#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares a painted ball with a clear coat, by the coat's roughness, and without: light, noise, CPU time, efficiency.

    car_paint.py bin/petzval [SKY.hdr...]

Under the CIE's overcast sky, in the built-in studio, and under each sky that is named, on a grey floor and without it. Rows compare the bare paint
with the coated one, as frosted_pane.py compares two programs.
"""
import math
import os
import sys
import tempfile

from frosted_pane import compare

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "targets"))
from scenes import Gltf, ball, quad  # noqa: E402

COAT = "KHR_materials_clearcoat"


def write_overcast(path):
    """Radiance picture of the CIE standard overcast sky: CIE S 011/E:2003, type 1 in its older form,
    (1 + 2 sin elevation) / 3; a dark ground."""
    width, height = 64, 32
    rows = b""
    for y in range(height):
        up = math.sin(math.pi * (.5 - (y + .5) / height))
        value = (1 + 2 * up) / 3 if up > 0 else .1
        mantissa, exponent = math.frexp(value)
        rows += bytes([int(mantissa * 256)] * 3 + [exponent + 128]) * width
    with open(path, "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width) + rows)


def write_scene(path, roughness=None, floor=False):
    """A ball of metallic paint; roughness: of its coat, None for none."""
    file = Gltf()
    coat = {} if roughness is None else {COAT: {"clearcoatFactor": 1, "clearcoatRoughnessFactor": roughness}}
    paint = file.add_material((.5, .02, .03), .5, .5, extensions=coat)
    corners, faces, normals, uv = ball(.5, 5)
    file.add_node(mesh=file.add_mesh(paint, corners, faces, normals, uv))
    if floor:
        grey = file.add_material((.4, .4, .4), 0, 1)
        file.add_node(mesh=file.add_mesh(grey, *quad((-3, -.5, 3), (3, -.5, 3), (3, -.5, -3), (-3, -.5, -3))))
    if coat:
        file.json["extensionsUsed"] = [COAT]
    file.write(path)


def main(program, skies):
    print("| sky | floor | coat's roughness | light | noise | CPU time | efficiency |\n|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        bare, coated = (os.path.join(folder, name + ".gltf") for name in ("bare", "coated"))
        overcast = os.path.join(folder, "overcast.hdr")
        write_overcast(overcast)
        for sky in (overcast, "studio", *skies):
            arguments = ["--spp", "128", "--size", "64x64", "--look-at", "0,0.6,2.2,0,0,0", "--fov", "26", "--env", sky]
            for floor in (False, True):
                write_scene(bare, None, floor)
                for roughness in (0, .05, .1, .3, .6):
                    write_scene(coated, roughness, floor)
                    cells = compare([(program, scene, arguments) for scene in (bare, coated)])
                    print("| %s | %s | %g | %s |" % (os.path.basename(sky), ("no", "yes")[floor], roughness, cells),
                          flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2:])
