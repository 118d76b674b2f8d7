#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares two builds on a frosted pane: what a pixel gets, its noise and its CPU time, by roughness.

    frosted_pane.py BEFORE/bin/petzval AFTER/bin/petzval

A pane of glass of index 1.5, 10 mm thick, stands before a chequered wall, under a grey sky and a lamp. The programs
render by turns, one thread, eight seeds each. Noise is the variance over the seeds over the squared mean, both summed
over the pixels. Efficiency is 1 / (noise x CPU time); its error is the spread of leave-one-out sets.
"""
import os
import resource
import subprocess
import sys
import tempfile

import numpy
import OpenImageIO

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "targets"))
from scenes import Gltf, quad  # noqa: E402

SEEDS, ROUGHNESSES = 8, (0, .1, .3, .5, .7, 1)


def box(low, high):
    """Corners and triangles, facing outwards."""
    corners, faces = [], []
    for axis in range(3):
        for side in (0, 1):
            turn = [(0, 0), (1, 0), (1, 1), (0, 1)] if side else [(0, 0), (0, 1), (1, 1), (1, 0)]
            at = len(corners)
            for u, v in turn:
                corner = [0, 0, 0]
                corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3] = side, u, v
                corners.append(tuple(h if bit else l for l, h, bit in zip(low, high, corner)))
            faces += [(at, at + 1, at + 2), (at, at + 2, at + 3)]
    return corners, faces


def write_scene(path, roughness):
    file = Gltf()
    for parity, colour in enumerate(((.8, .7, .5), (.1, .15, .3))):
        paint, corners, faces = file.add_material(colour, 0, 1), [], []
        for x in range(-8, 8):
            for y in range(-8, 8):
                if (x + y) % 2 == parity:
                    square = [(.1 * (x + u), .1 * (y + v), -.5) for u, v in ((0, 0), (1, 0), (1, 1), (0, 1))]
                    faces += [tuple(len(corners) + i for i in face) for face in ((0, 1, 2), (0, 2, 3))]
                    corners += square
        file.add_node(mesh=file.add_mesh(paint, corners, faces))
    shining = file.add_material((0, 0, 0), 0, 1, emissiveFactor=[1, .9, .7], extensions={
        "KHR_materials_emissive_strength": {"emissiveStrength": 20}})
    file.add_node(mesh=file.add_mesh(shining, *quad((-.2, .9, -.2), (.2, .9, -.2), (.2, .9, .2), (-.2, .9, .2))))
    extensions = {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.5},
                  "KHR_materials_volume": {"thicknessFactor": .01}}
    glass = file.add_material((1, 1, 1), 0, roughness, extensions=extensions)
    file.add_node(mesh=file.add_mesh(glass, *box((-.5, -.5, -.01), (.5, .5, 0))))
    file.json["extensionsUsed"] = sorted({*extensions, "KHR_materials_emissive_strength"})
    file.write(path)


def render(program, scene, seed, arguments):
    """Pixels and CPU seconds."""
    with tempfile.TemporaryDirectory() as folder:
        picture = os.path.join(folder, "picture.exr")
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([program, "render", scene, "--seed", str(seed), "--threads", "1", "--quiet", *arguments,
                        "-o", picture], check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        pixels = OpenImageIO.ImageBuf(picture).get_pixels(OpenImageIO.FLOAT)[..., :3].astype(float)
    return pixels, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def noise(pictures):
    return numpy.var(pictures, axis=0, ddof=1).sum() / (pictures.mean(0)**2).sum()


def compare(cases):
    """cases: (program, scene, arguments) of before and of after. Light, noise, CPU time and efficiency of after over
    before, each with its spread, as cells of a table."""
    pictures, cpu_s = ([], []), ([], [])
    for seed in range(1, SEEDS + 1):
        for which in ((0, 1), (1, 0))[seed % 2]:
            program, scene, arguments = cases[which]
            pixels, seconds = render(program, scene, seed, arguments)
            pictures[which].append(pixels)
            cpu_s[which].append(seconds)
    sets = [[seed for seed in range(SEEDS) if seed != left_out] for left_out in (None, *range(SEEDS))]
    rows = []
    for chosen in sets:
        a, b = (numpy.array([pictures[which][seed] for seed in chosen]) for which in (0, 1))
        light, ratio = b.mean() / a.mean(), noise(b) / noise(a)
        time = sum(cpu_s[1][seed] for seed in chosen) / sum(cpu_s[0][seed] for seed in chosen)
        rows.append((light, ratio, time, 1 / (ratio * time)))
    spread = numpy.std(rows[1:], axis=0) * (SEEDS - 1)**.5
    return " | ".join("%.3g ± %.2g" % pair for pair in zip(rows[0], spread))


def main(programs):
    arguments = ["--spp", "128", "--size", "64x64", "--look-at", "0.1,0.1,0.9,0,0,0", "--fov", "40",
                 "--background", "0.5,0.5,0.5"]
    print("| roughness | light | noise | CPU time | efficiency |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "pane.gltf")
        for roughness in ROUGHNESSES:
            write_scene(scene, roughness)
            print("| %g | %s |" % (roughness, compare([(p, scene, arguments) for p in programs])), flush=True)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1:])
