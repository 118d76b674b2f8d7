#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares a glazed window before and after a change of the program, and with the open window.

    glazed_room.py BEFORE/bin/petzval AFTER/bin/petzval

A white room of 4 m has a window of 1 m. Its light comes from a lamp of 2 m outside, which the window faces, or from a
sun. The window is open, or has one or two thin panes. Rows compare before with after, and then the open window with
the glazed one, both after. Noise, CPU time and efficiency are those of frosted_pane.py; a mean of 0 has none.
"""
import os
import sys
import tempfile

from frosted_pane import compare, render

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "targets"))
from scenes import Gltf, quad  # noqa: E402

ARGUMENTS = ["--spp", "64", "--size", "48x32", "--look-at", "0,0,1.9,0,-0.2,-2", "--fov", "70",
             "--background", "0,0,0"]


def rectangle(axis, level, low, high):
    """Corners and triangles of a sheet across an axis; low and high: of the two axes after it."""
    corners = []
    for s, t in ((0, 0), (1, 0), (1, 1), (0, 1)):
        p = [0, 0, 0]
        p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = level, (low, high)[s][0], (low, high)[t][1]
        corners.append(tuple(p))
    return quad(*corners)


def write_scene(path, light, panes):
    file = Gltf()
    used = {"KHR_materials_transmission", "KHR_materials_emissive_strength"}
    white = file.add_material((.8, .8, .8), 0, 1, doubleSided=True)
    sheets = [rectangle(axis, level, (-2, -2), (2, 2)) for axis, level in ((1, -2), (1, 2), (2, -2), (2, 2), (0, 2))]
    # The wall with the window, about (y, z) = (0, 0), half a metre to each side.
    sheets += [rectangle(0, -2, low, high) for low, high in (((-2, -2), (-.5, 2)), ((.5, -2), (2, 2)),
                                                             ((-.5, -2), (.5, -.5)), ((-.5, .5), (.5, 2)))]
    for corners, faces in sheets:
        file.add_node(mesh=file.add_mesh(white, corners, faces))
    glass = file.add_material((1, 1, 1), 0, 0, doubleSided=True,
                              extensions={"KHR_materials_transmission": {"transmissionFactor": 1}})
    for i in range(panes):
        # The first one fills the window, so that nothing comes in beside it.
        half = .5 + .1 * i
        file.add_node(mesh=file.add_mesh(glass, *rectangle(0, -2 - .02 * i, (-half, -half), (half, half))))
    if light == "lamp":
        shining = file.add_material((0, 0, 0), 0, 1, emissiveFactor=[1, 1, 1], doubleSided=True, extensions={
            "KHR_materials_emissive_strength": {"emissiveStrength": 20}})
        file.add_node(mesh=file.add_mesh(shining, *rectangle(0, -3.5, (-1, -1), (1, 1))))
    else:
        used.add("KHR_lights_punctual")
        file.json["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 20}]}}
        # It shines along -z of its node: here along (1, -0.5, 0).
        file.add_node(extensions={"KHR_lights_punctual": {"light": 0}},
                      rotation=[-.1624598, -.6881910, -.1624598, .6881910])
    file.json["extensionsUsed"] = sorted(used)
    file.write(path)


def main(before, after):
    print("| light | panes | compared | light | noise | CPU time | efficiency |\n|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for light in ("lamp", "sun"):
            scenes = []
            for panes in (0, 1, 2):
                scenes.append(os.path.join(folder, "%s%d.gltf" % (light, panes)))
                write_scene(scenes[-1], light, panes)
            for panes in (1, 2):
                if render(before, scenes[panes], 1, ARGUMENTS)[0].max() > 0:
                    cells = compare([(program, scenes[panes], ARGUMENTS) for program in (before, after)])
                else:
                    cells = "it was black | | | "
                print("| %s | %d | after / before | %s |" % (light, panes, cells), flush=True)
                cells = compare([(after, scenes[0], ARGUMENTS), (after, scenes[panes], ARGUMENTS)])
                print("| %s | %d | glazed / open | %s |" % (light, panes, cells), flush=True)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
