#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what `render --noise` keeps and brings: true errors over printed ones, and CPU time against fixed samples.

    kept.py PETZVAL FILE [--target 5%] [--size 160x120] [--seeds 5] [--only NAME ...] [--keep FOLDER] [--no-gain]

FILE has a line NAME: ARGUMENTS OF RENDER for each scene. Prints a row for each.

The true squared error of a cell is the mean over its pixels and R, G, B of ((X - Y)^2 - V) / (Y^2 + f^2): X the
picture, Y the mean of REFERENCES others with fixed samples, ten times those of X together, V the variance of Y, f the
floor that the render states. The gain is the CPU time of fixed samples with the same 95th percentile of the cells'
errors, between those of a ladder of counts by powers, over that of `--noise`. With --keep pictures of fixed samples and
their times stay in a folder for the next run; then only the gain in samples tells something.
"""
import argparse
import json
import math
import os
import resource
import shlex
import subprocess
import tempfile
import time

import numpy
import OpenImageIO

REFERENCES, CELL_PX, MOST = 8, 16, 16384


def render(program, arguments, seed, folder, more, status=(0,)):
    """Pixels, CPU seconds, what the file of statistics says, and the exit status."""
    # A name is read once: a second picture of the same second would be the first.
    picture = os.path.join(folder, "%d.exr" % time.monotonic_ns())
    stats = os.path.join(folder, "stats.json")
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([program, "render", *arguments, "--seed", str(seed), *more, "-o", picture, "--stats", stats, "--quiet"],
                          stderr=subprocess.PIPE, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode not in status:
        raise RuntimeError(done.stderr)
    with open(stats) as file:
        said = json.load(file)
    image = OpenImageIO.ImageBuf(picture)
    said["floor_nits"] = image.spec().getattribute("petzval:noiseFloor_nits")
    pixels = image.get_pixels(OpenImageIO.FLOAT)
    return pixels[..., :3].astype(float), after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, said


def of_fixed_samples(program, name, arguments, seed, folder, more, keep):
    """render() of a number of samples, or what is kept of it."""
    path = keep and os.path.join(keep, "%s, %d%s.npz" % (name.replace("/", "_"), seed, "".join(more)))
    if path and os.path.exists(path):
        kept = numpy.load(path)
        return kept["pixels"].astype(float), float(kept["cpu_s"])
    pixels, cpu_s, _ = render(program, arguments, seed, folder, more)
    if path:
        numpy.savez(path, pixels=pixels.astype(numpy.float32), cpu_s=cpu_s)
    return pixels, cpu_s


def by_cell(values):
    """Means over the cells of a frame, whose edges lie at side * i / cells."""
    height, width = values.shape[:2]
    down, across = max(1, height // CELL_PX), max(1, width // CELL_PX)
    return numpy.array([values[height * j // down:height * (j + 1) // down,
                               width * i // across:width * (i + 1) // across].mean()
                        for j in range(down) for i in range(across)])


class Truth:
    def __init__(self, pictures, floor):
        self.mean = numpy.mean(pictures, axis=0)
        self.variance = numpy.var(pictures, axis=0, ddof=1) / len(pictures)
        self.scale = self.mean ** 2 + floor ** 2
        self.own = math.sqrt((self.variance / self.scale).mean())

    def squares(self, picture):
        return ((picture - self.mean) ** 2 - self.variance) / self.scale


def root(value):
    return math.sqrt(max(value, 0))


def measure(program, name, arguments, options, folder):
    size = ["--size", options.size]
    target = float(options.target.rstrip("%")) / 100
    runs = [render(program, arguments, seed, folder, [*size, "--noise", options.target], (0, 5)) for seed in range(1, options.seeds + 1)]
    said = [run[2]["noise"] for run in runs]
    samples = numpy.mean([s["mean_samples_per_pixel"] for s in said])
    each = 2 ** math.ceil(math.log2(min(MOST, max(8, 10 * samples / REFERENCES))))
    fixed = lambda seed, count: of_fixed_samples(program, name, arguments, seed, folder, [*size, "--spp", str(count)], options.keep)
    others = [fixed(1000 + k, each)[0] for k in range(REFERENCES)]
    truth = Truth(others, runs[0][2]["floor_nits"] or 1e-30)  # black: none is stated
    whole = [root(truth.squares(run[0]).mean()) for run in runs]
    cells = numpy.array([by_cell(truth.squares(run[0])) for run in runs])
    # Over the seeds: of one seed the squares of a cell alone are noisy.
    rms = numpy.sqrt(numpy.maximum(cells.mean(0), 0))
    high = root(numpy.percentile(cells, 95, axis=1).mean())
    ratios = [w / s["picture"] for w, s in zip(whole, said)]
    cpu = float(numpy.median([run[1] for run in runs]))
    row = [name, options.target, "%.3g" % samples, "%.2f" % (100 * numpy.mean([s["picture"] for s in said])),
           "%.2f" % (100 * root(numpy.mean(numpy.square(whole)))), "%.2f to %.2f" % (min(ratios), max(ratios)),
           "%.2f" % (100 * high), "%.2f" % (100 * rms.max()), "%.1f" % (100 * (cells > (1.1 * target) ** 2).mean()),
           "%d of %d" % (sum(s["cells_at_least"] > 0 for s in said), len(said)), "%.2f" % (100 * truth.own)]
    if options.gain:
        def step(count):
            """Error, CPU time and number of samples of fixed ones."""
            some = [fixed(2000 + k, count) for k in range(2)]
            error = root(numpy.mean([numpy.percentile(by_cell(truth.squares(pixels)), 95) for pixels, _ in some]))
            return error, some[0][1], count

        low = step(2 ** max(0, math.floor(math.log2(samples))))
        while low[0] < high and low[2] > 1:
            low = step(low[2] // 2)
        more = step(2 * low[2])
        while more[0] >= high and more[2] < MOST:
            low, more = more, step(2 * more[2])
        along = (math.log(low[0]) - math.log(high)) / (math.log(low[0]) - math.log(more[0]))
        between = [low[i] * (more[i] / low[i]) ** along for i in (1, 2)]
        row += ["%.2f" % (between[0] / cpu), "%.2f" % (between[1] / samples)]
    row += ["%.1f" % cpu]
    print("| " + " | ".join(row) + " |", flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("file")
    parser.add_argument("--target", default="5%")
    parser.add_argument("--size", default="160x120")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--only", nargs="*")
    parser.add_argument("--keep")
    parser.add_argument("--no-gain", dest="gain", action="store_false")
    options = parser.parse_args()
    heads = ["scene", "target", "samples", "printed, %", "true, %", "true over printed", "95 % of cells below, %", "worst cell of all seeds, %",
             "cells above 1.1 targets, %", "at least", "reference, %", *(("gain, CPU", "gain, samples") if options.gain else ()), "CPU s"]
    print("| " + " | ".join(heads) + " |\n|" + "---|" * len(heads), flush=True)
    with open(options.file) as file, tempfile.TemporaryDirectory() as folder:
        for line in file:
            name, arguments = line.rstrip().split(":", 1)
            if options.only and name not in options.only:
                continue
            try:
                measure(options.program, name, shlex.split(arguments, comments=True), options, folder)
            except RuntimeError as error:
                print("| %s | %s |" % (name, str(error).strip().replace("\n", " ")), flush=True)


if __name__ == "__main__":
    main()
