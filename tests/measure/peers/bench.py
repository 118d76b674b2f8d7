#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Petzval against Blender Cycles: error and CPU time at equal samples, as a table.

    bench.py [--scenes DIR] [--petzval PATH] [--peer PATH]... [--rows a,b] [--seeds N] -o FOLDER

Each program has its own defaults, less what biases; camera, light, bounces, samples and the box filter
are the same. The programs take turns, seed by seed. FOLDER/bench.json holds all numbers, FOLDER/bench.md
the table. Rows that bench.json already holds, measured with the same settings, are not measured again.
docs/measured/against_cycles.md explains the numbers.
"""
import argparse
import json
import os
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
try:
    import numpy
    import OpenImageIO
except ImportError as missing:
    sys.exit("%s: apt-get install python3-numpy python3-openimageio, and run with /usr/bin/python3" % missing)

import noise
import scenes
import table
from programs import Blender, Petzval

REFERENCE_SEED = 1000003


def pixels(path):
    """The linear r, g, b of a picture, (pixels, 3)."""
    # Not by ImageBuf: its cache would give an earlier picture of the same name.
    file = OpenImageIO.ImageInput.open(path)
    values = file.read_image(OpenImageIO.FLOAT) if file else None
    if values is None:
        sys.exit("%s: %s" % (path, file.geterror() if file else OpenImageIO.geterror()))
    return values[..., :3].reshape(-1, 3)


def write_means(path, means, size):
    """Writes the programs' mean pictures side by side as PNG, at one exposure."""
    width, height = map(int, size.split("x"))
    white = max(numpy.quantile(means[0].mean(-1), .95), 1e-30)
    shown = numpy.concatenate([m.reshape(height, width, 3) for m in means], 1) / white
    out = OpenImageIO.ImageBuf(OpenImageIO.ImageSpec(shown.shape[1], height, 3, OpenImageIO.FLOAT))
    out.set_pixels(OpenImageIO.ROI(), numpy.ascontiguousarray(shown.clip(0, 1) ** (1 / 2.2), dtype=numpy.float32))
    out.write(path, "uint8")


def measure(a, row, programs, folder):
    """Renders one row with all programs; returns its numbers."""
    scene = scenes.prepare(row, folder)
    output = os.path.join(folder, "picture.exr")
    pictures = {p.name: [] for p in programs}
    cost = {p.name: {"sample_cpu_s": [], "whole_cpu_s": []} for p in programs}
    for seed in range(1, a.seeds + 1):
        for p in programs:
            long_s = p.render(a, row, scene, a.samples, seed, output)
            pictures[p.name].append(pixels(output))
            cost[p.name]["whole_cpu_s"].append(long_s)
            if seed <= a.timed_seeds:
                short_s = p.render(a, row, scene, a.short_samples, seed, output)
                if short_s >= long_s:
                    sys.exit("%s: %s took no less CPU time for %d samples than for %d, so this machine is too busy to "
                             "tell. The rows before are kept: run the same command again." %
                             (row.name, p.name, a.short_samples, a.samples))
                cost[p.name]["sample_cpu_s"].append((long_s - short_s) / (a.samples - a.short_samples))
    numbers = {}
    for p in programs:
        mean = numpy.mean(pictures[p.name], 0, dtype=float)
        numbers[p.name] = {**cost[p.name], **noise.noise(pictures[p.name]), "mean": mean.mean(),
                           "median": float(numpy.median(mean.mean(-1)))}
        if a.reference_samples:
            p.render(a, row, scene, a.reference_samples, REFERENCE_SEED, output)
            numbers[p.name]["against_reference"] = noise.error_against(pictures[p.name], pixels(output).astype(float))
    write_means(os.path.join(a.output, row.name + ".png"),
                [numpy.mean(pictures[p.name], 0, dtype=float) for p in programs], a.size)
    return numbers


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--petzval", default=os.path.join(HERE, "..", "..", "..", "build", "bin", "petzval"))
    parser.add_argument("--peer", action="append", metavar="PATH", help="a Blender; may be given more than once")
    parser.add_argument("--scenes", metavar="DIR", help="folder of scenes that are not part of the project")
    parser.add_argument("--rows", help="names of rows, with commas (default: all)")
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--timed-seeds", type=int,
                        help="seeds that are rendered short too, for the cost (default: all)")
    parser.add_argument("--size", default="320x240")
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--short-samples", type=int, default=4)
    parser.add_argument("--reference-samples", type=int, default=0,
                        help="also the error against a converged picture of each program's own")
    parser.add_argument("--bounces", type=int, default=12)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--pattern", help="another sampling pattern of Blender than the best that was found")
    parser.add_argument("-o", "--output", required=True, metavar="FOLDER")
    a = parser.parse_args()
    a.timed_seeds = a.timed_seeds or a.seeds
    if a.seeds < 2 or not 0 < a.short_samples < a.samples:
        parser.error("needs two seeds or more, and fewer short samples than samples")
    return a


def peers(a):
    found = []
    for path in a.peer or ["blender"]:
        try:
            found.append(Blender(path, a.pattern))
        except FileNotFoundError:
            print("skipped: no %s here (apt-get install blender)" % path)
    return found


def wanted_rows(a, folder):
    rows = scenes.all_rows(a.scenes and os.path.abspath(a.scenes), folder)
    names = a.rows.split(",") if a.rows else list(rows)
    for name in names:
        if name not in rows:
            sys.exit("--rows: no row %s; there are %s" % (name, ", ".join(rows)))
        if not rows[name]:
            print("skipped: %s, not in the folder of --scenes" % name)
    return [rows[name] for name in names if rows[name]]


def earlier(path, settings):
    """The rows of the file, if it was measured with the same settings."""
    if not os.path.exists(path):
        return {}
    with open(path) as file:
        found = json.load(file)
    if found["settings"] != settings:
        sys.exit("%s was measured with other settings: delete it, or say another folder" % path)
    return found["rows"]


def main():
    a = arguments()
    programs = [Petzval(a.petzval), *peers(a)]
    if len(programs) < 2:
        return
    keys = ("size", "samples", "short_samples", "seeds", "timed_seeds", "bounces", "threads", "reference_samples")
    settings = {**{key: getattr(a, key) for key in keys}, "programs": {p.name: p.version for p in programs}}
    os.makedirs(a.output, exist_ok=True)
    path = os.path.join(a.output, "bench.json")
    done = earlier(path, settings)
    with tempfile.TemporaryDirectory() as folder:
        for row in wanted_rows(a, os.path.join(folder, "rooms")):
            if row.name not in done:
                done[row.name] = measure(a, row, programs, folder)
                with open(path, "w") as file:
                    json.dump({"settings": settings, "rows": done}, file, indent=1)
                print("measured: " + row.name, flush=True)
    if done:
        text = table.markdown(done, [p.name for p in programs])
        with open(os.path.join(a.output, "bench.md"), "w") as file:
            file.write(text)
        print(text)


if __name__ == "__main__":
    main()
