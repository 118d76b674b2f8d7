#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what rays to targets bring: pictures with `--method targets=off` and `auto`, by turns, against the mean of
other pictures with targets.

    gain.py [--seeds N] [--others N] PETZVAL NAME -- ARGUMENTS OF RENDER

Prints the gain in efficiency, 1 / (squared error x CPU time), of `auto` over `off`, and in brackets the smallest and the
largest of what sets without one seed give. The error of a pixel is relative: over the squared mean plus a hundredth of
the frame's squared grey.
frame     mean over all pixels
trimmed   without the worst 0.1 % of them
discs     mean over pixels that are twice as bright as the median of what lies around them, 96 pixels wide
cells     root of the mean of each 16 x 16 pixels, then the mean of the roots, squared: what the pilot lowers
typical   the median of all pixels
The spread over seeds would not do: it does not see what every seed misses.
"""
import argparse
import math
import os
import resource
import subprocess
import sys
import tempfile

import numpy
import OpenImageIO

AROUND, CELL = 48, 16


def render(program, arguments, targets, seed, folder):
    # A name is read once: a second picture of the same second would be the first.
    picture = os.path.join(folder, "%s %d.exr" % (targets, seed))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([program, "render", *arguments, "--seed", str(seed), "--method", "targets=" + targets, "-o", picture, "--quiet"],
                   check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    pixels = OpenImageIO.ImageBuf(picture).get_pixels(OpenImageIO.FLOAT)[..., :3].astype(float)
    return pixels, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def median_around(grey):
    """The median of every eighth pixel of what lies around each block of eight pixels."""
    out = numpy.empty_like(grey)
    for y in range(0, grey.shape[0], 8):
        for x in range(0, grey.shape[1], 8):
            part = grey[max(0, y - AROUND):y + AROUND, max(0, x - AROUND):x + AROUND]
            out[y:y + 8, x:x + 8] = numpy.median(part)
    return out


def measures(picture, mean, discs):
    """Squared errors of a picture: frame, trimmed, discs, cells, typical."""
    dark = .01 * (mean.mean((0, 1)) ** 2).sum()
    error = ((picture - mean) ** 2).sum(-1) / ((mean ** 2).sum(-1) + dark)
    in_order = numpy.sort(error.ravel())
    rows, columns = (size // CELL for size in error.shape)
    cells = error[:rows * CELL, :columns * CELL].reshape(rows, CELL, columns, CELL).mean((1, 3))
    return [in_order.mean(), in_order[:len(in_order) - math.ceil(.001 * len(in_order))].mean(),
            error[discs].mean() if discs.any() else math.nan, numpy.sqrt(cells).mean() ** 2, numpy.median(in_order)]


def main(program, name, arguments, seeds, others):
    errors, cpu_s, light = ({"off": [], "auto": []} for _ in range(3))
    with tempfile.TemporaryDirectory() as folder:
        mean = numpy.mean([render(program, arguments, "auto", seeds + seed, folder)[0]
                           for seed in range(1, others + 1)], axis=0)
        grey = mean.mean(-1)
        discs = grey > 2 * median_around(grey)
        for seed in range(1, seeds + 1):
            for targets in (("off", "auto"), ("auto", "off"))[seed % 2]:
                picture, seconds = render(program, arguments, targets, seed, folder)
                errors[targets].append(measures(picture, mean, discs))
                cpu_s[targets].append(seconds)
                light[targets].append(picture.mean())
    cost = float(numpy.median(numpy.array(cpu_s["auto"]) / numpy.array(cpu_s["off"])))

    def gains(kept):
        off, auto = (numpy.mean([errors[t][i] for i in kept], axis=0) for t in ("off", "auto"))
        return off / auto / cost

    every = gains(range(seeds))
    some = [gains([i for i in range(seeds) if i != out]) for out in range(seeds)]
    print("%s: CPU time %.2f, mean auto / off %.4f, discs %.1f %% of the frame" % (
        name, cost, numpy.mean(light["auto"]) / numpy.mean(light["off"]), 100 * discs.mean()))
    for i, kind in enumerate(("frame", "trimmed", "discs", "cells", "typical")):
        print("  %s %.3g (%.3g to %.3g)" % (
            kind, every[i], min(s[i] for s in some), max(s[i] for s in some)), flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--others", type=int, default=16)
    parser.add_argument("program")
    parser.add_argument("name")
    parser.add_argument("arguments", nargs="+")
    given = parser.parse_args()
    main(given.program, given.name, given.arguments, given.seeds, given.others)
