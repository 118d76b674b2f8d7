#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the sharpness of rendered edges with the bench's: ISO 12233's slanted edge against `lens mtf --wave`.

    tests/measure/slanted_edge.py build/bin/petzval [--spp 1024] [LENS...]

A bright half plane with an edge that leans by 5 degrees stands in the plane of focus on the axis, 100 focal lengths
away, and is rendered at 550 nm with pixels of 3 micrometres and a box filter. The edge's derivative is transformed; the
filter, the bins of a quarter of a pixel and the derivative are divided out. Printed: the largest difference of the
contrast up to 100 cycles/mm, with diffraction and without, from the bench's by waves.
"""
import argparse
import csv
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile

import numpy as np
import OpenImageIO as oiio

LENSES = ["takumar-50mm-f1.2", "double-gauss-100mm-f2", "biotar-58mm-f1.4", "petzval-portrait-100mm-f3.6",
          "canon-14mm-f2.8-asph"]
PITCH_MM, SIDE_PX, LEAN_DEG = 0.003, 96, 5.0
CYCLES = np.arange(10, 101, 10)


def scene(path, distance_m, width_m):
    """A glTF file of a glowing half plane, square to the axis; its edge leans against the vertical."""
    a, w = math.radians(LEAN_DEG), width_m
    along, across = (math.sin(a) * w, math.cos(a) * w), (math.cos(a) * w, -math.sin(a) * w)
    corners = [(-along[0], -along[1]), (along[0], along[1]), (along[0] + across[0], along[1] + across[1]),
               (across[0] - along[0], across[1] - along[1])]
    data = b"".join(struct.pack("<3f", x, y, -distance_m) for x, y in corners) + struct.pack("<6H", 0, 2, 1, 0, 3, 2)
    data += b"\0" * (-len(data) % 4)
    (path.parent / "edge.bin").write_bytes(data)
    xs, ys = zip(*corners)
    path.write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0}, {"camera": 0}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.01}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"emissiveFactor": [1, 1, 1], "doubleSided": True, "pbrMetallicRoughness":
                       {"baseColorFactor": [0, 0, 0, 1]}}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                       "min": [min(xs), min(ys), -distance_m], "max": [max(xs), max(ys), -distance_m]},
                      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48},
                        {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "buffers": [{"uri": "edge.bin", "byteLength": len(data)}]}))


def run(words):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, words))}\n{done.stderr}")
    return done.stdout


def edge_contrast(values):
    """Contrast of an edge by CYCLES, of values by row and column."""
    rows = np.arange(values.shape[0])
    # The lean is known; where the edge lies is told by its light.
    lean = math.tan(math.radians(LEAN_DEG)) * (1 if values[-1].sum() < values[0].sum() else -1)
    level = np.sort(values, axis=None)[-values.size // 8:].mean()
    dark = values.shape[1] - (values / level).sum(axis=1)
    if values[:, 0].sum() > values[:, -1].sum():
        values = values[:, ::-1]
        lean = -lean
    start = (dark - lean * rows).mean() - 0.5
    x = (np.arange(values.shape[1])[None, :] - (start + lean * rows)[:, None]) * math.cos(math.atan(lean))
    bins, reach = 4, 40
    index = np.floor(x * bins).astype(int) + reach * bins
    inside = (index >= 0) & (index < 2 * reach * bins)
    spread = np.bincount(index[inside], values[inside], 2 * reach * bins) / np.bincount(
        index[inside], minlength=2 * reach * bins)
    line = np.diff(spread)
    at = (np.arange(len(line)) - len(line) / 2) / bins * PITCH_MM
    # What lies beyond the window is lost; a window that falls off slowly keeps most of it.
    found = np.array([abs((line * np.exp(-2j * math.pi * f * at)).sum()) for f in CYCLES]) / line.sum()
    pixel = np.sinc(CYCLES * PITCH_MM * math.cos(math.radians(LEAN_DEG))) * np.sinc(
        CYCLES * PITCH_MM * math.sin(math.radians(LEAN_DEG)))
    return found / pixel / np.sinc(CYCLES * PITCH_MM / bins) ** 2


def bench_contrast(program, lens, fstop, distance_m, folder):
    table = folder / "mtf.csv"
    run([program, "lens", "mtf", lens, "--wave", "--light", "550", "--field", "0", "--fstop", fstop, "--focus",
         f"{distance_m}m", "--cycles", 100, "-o", folder / "mtf.svg", "--csv", table])
    with open(table) as file:
        rows = list(csv.DictReader(file))
    return np.interp(CYCLES, [float(r["cycles_per_mm"]) for r in rows], [float(r["tangential"]) for r in rows])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("lenses", nargs="*", default=LENSES)
    parser.add_argument("--spp", type=int, default=1024)
    parser.add_argument("--verbose", action="store_true")
    parser.add_argument("--fstops", default="8,16,22")
    options = parser.parse_args()
    program = options.program.resolve()
    print("| lens | f-number | with diffraction | without |\n|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for lens in options.lenses:
            distance_m = 5.0
            scene(folder / "edge.gltf", distance_m, 1.0)
            for fstop in options.fstops.split(","):
                wanted = bench_contrast(program, lens, fstop, distance_m, folder)
                differences = []
                for use in ("auto", "off"):
                    size = 800
                    at = size // 2 - SIDE_PX // 2
                    picture = folder / "edge.exr"
                    run([program, "render", folder / "edge.gltf", "--lens", lens, "--fstop", fstop, "--focus",
                         f"{distance_m}m", "--size", f"{size}x{size}", "--sensor", f"{size * PITCH_MM}x{size * PITCH_MM}",
                         "--crop", f"{at},{at},{SIDE_PX},{SIDE_PX}", "--spp", options.spp, "--bins", "549:551:2",
                         "--method", "filter=box", "--background", "0,0,0", "--diffraction", use, "--quiet", "-o",
                         picture])
                    source = oiio.ImageInput.open(str(picture))
                    names, pixels = source.spec().channelnames, source.read_image(oiio.FLOAT)
                    band = next(i for i, n in enumerate(names) if n.startswith("S0."))
                    found = edge_contrast(pixels[:, :, band])
                    if options.verbose:
                        print(use, np.round(found, 3), np.round(wanted, 3), file=sys.stderr)
                    differences.append(max(abs(found - wanted)))
                print(f"| {lens} | {fstop} | {differences[0]:.3f} | {differences[1]:.3f} |", flush=True)


if __name__ == "__main__":
    main()
