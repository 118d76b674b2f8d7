#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""CPU time until a picture is good to an error: Petzval with --noise, denoised and not; Cycles, not denoised.

    until.py [--scenes DIR] [--petzval PATH] [--peer PATH] [--rows a,b] [--error 0.05] -o FOLDER

Each renders anew with ever smaller targets until the true error is small enough, or the next render would take more
than --longest-cpu-s; a quarter of it where nothing is denoised. There the same samples everywhere count too, if they
are quicker to the error. The true error comes from two other pictures of the same program. FOLDER/until.json holds all
numbers; rows that it holds already are not measured again. docs/measured/against_cycles.md explains the table.
"""
import argparse
import dataclasses
import json
import os
import statistics
import sys
import tempfile

import bench
import noise
import OpenImageIO
import scenes
import table
from programs import Blender, Petzval

ROWS = ("cornell-box", "hotel-room", "many-lights", "lowpoly-village", "house-foliage-thin", "first-light-thin",
        "damaged-helmet", "sun-room")
MOST_SAMPLES = 65536


def layer(path, name):
    """R, G and B of a layer of the picture, or of the picture itself where `name` is empty: (height, width, 3)."""
    file = OpenImageIO.ImageInput.open(path)
    while file:
        names = list(file.spec().channelnames)
        wanted = [(name + "." if name else "") + c for c in "RGB"]
        if all(w in names for w in wanted):
            return file.read_image(OpenImageIO.FLOAT)[..., [names.index(w) for w in wanted]].astype(float)
        if not file.seek_subimage(file.current_subimage() + 1, 0):
            break
    sys.exit("%s has no layer %r" % (path, name))


class PetzvalToNoise:
    """Petzval until its noise, or the bound of its denoised picture, is the target."""
    first_target = .32

    def __init__(self, program, denoises):
        self.program, self.denoises = program, denoises
        self.name = "petzval denoised" if denoises else "petzval"

    def render(self, a, row, scene, target, seed, output):
        options = (*row.petzval, *(("--denoise",) if self.denoises else ()), "--noise", "%.6g%%" % (100 * target),
                   "--time-limit", "%gs" % (a.longest_cpu_s / a.threads))
        cpu_s = self.program.render(a, dataclasses.replace(row, petzval=options), scene, MOST_SAMPLES, seed, output)
        return cpu_s, layer(output, "denoised" if self.denoises else "")


class AdaptiveBlender:
    """Cycles with its noise threshold."""
    first_target, name, denoises = .4, "cycles", False

    def __init__(self, program):
        self.program = program

    def render(self, a, row, scene, target, seed, output):
        cpu_s = self.program.render(a, row, scene, MOST_SAMPLES, seed, output, noise_threshold=target)
        return cpu_s, layer(output, "")


def others_of(a, row, scene, program, output):
    """Two pictures of as many samples everywhere, what they took, and the time of a start (the median of three)."""
    start_s = statistics.median(program.render(a, row, scene, 1, seed, output) for seed in (1, 2, 3))
    pictures, cpu_s = [], []
    for seed in (bench.REFERENCE_SEED, bench.REFERENCE_SEED + 1):
        cpu_s.append(program.render(a, row, scene, a.reference_samples, seed, output) - start_s)
        pictures.append(layer(output, ""))
    return pictures, start_s, {"cpu_s": sum(cpu_s) / 2, **noise.error_of_each(*pictures)}


def measure(a, row, programs, folder):
    """The points of all programs in one row."""
    scene, output, numbers = scenes.prepare(row, folder), os.path.join(folder, "picture.exr"), {}
    known = {}
    for p in programs:
        if p.program not in known:
            known[p.program] = others_of(a, row, scene, p.program, output)
        others, start_s, even = known[p.program]
        points, target = [], p.first_target
        while True:
            renders = [p.render(a, row, scene, target, seed, output) for seed in range(1, a.seeds + 1)]
            cpu_s = statistics.mean(max(whole_s - start_s, .01) for whole_s, _ in renders)
            points.append({"target": target, "cpu_s": cpu_s,
                           **noise.true_error([picture for _, picture in renders], *others)})
            print(row.name, p.name, points[-1], flush=True)
            if points[-1]["all"] <= a.error or 4 * cpu_s > a.longest_cpu_s / (1 if p.denoises else 4):
                break
            target /= 2
        numbers[p.name] = {"start_s": start_s, "points": points, "even": even}
    return numbers


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--petzval", default=os.path.join(bench.HERE, "..", "..", "..", "build", "bin", "petzval"))
    parser.add_argument("--peer", default="blender", metavar="PATH", help="a Blender")
    parser.add_argument("--scenes", metavar="DIR", help="folder of scenes that are not part of the project")
    parser.add_argument("--rows", default=",".join(ROWS))
    parser.add_argument("--error", type=float, default=.05)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--size", default="160x120")
    parser.add_argument("--reference-samples", type=int, default=1024)
    parser.add_argument("--longest-cpu-s", type=float, default=240, help="no render that is likely to take longer")
    parser.add_argument("--bounces", type=int, default=12)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("-o", "--output", required=True, metavar="FOLDER")
    a = parser.parse_args()
    petzval = Petzval(a.petzval)
    try:
        programs = [PetzvalToNoise(petzval, True), PetzvalToNoise(petzval, False),
                    AdaptiveBlender(Blender(a.peer, None))]
    except FileNotFoundError:
        print("skipped: no %s here (apt-get install blender)" % a.peer)
        return
    settings = {key: getattr(a, key) for key in ("size", "error", "seeds", "reference_samples", "longest_cpu_s",
                                                 "bounces", "threads")}
    settings["programs"] = {p.name: p.program.version for p in programs}
    os.makedirs(a.output, exist_ok=True)
    path = os.path.join(a.output, "until.json")
    done = bench.earlier(path, settings)
    with tempfile.TemporaryDirectory() as folder:
        for row in bench.wanted_rows(a, os.path.join(folder, "rooms")):
            if row.name not in done:
                done[row.name] = measure(a, row, programs, folder)
                with open(path, "w") as file:
                    json.dump({"settings": settings, "rows": done}, file, indent=1)
    print(table.until(done, a.error))


if __name__ == "__main__":
    main()
