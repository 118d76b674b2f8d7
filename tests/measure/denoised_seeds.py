#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What several seeds of a view tell of denoising: whether bounds of regions hold, and how much frames flicker.

    denoised_seeds.py [--petzval PATH] [--scenes DIR] [--rows a,b] [--samples 64] [--size 160x120] [--seeds 8]

The bounds are those of `petzval image noise FILE.state`. The truth is known from two pictures of --reference samples,
or of as many as --time allows, with other seeds: the squared error of X is the mean of
(X - first) (X - second) / (m^2 + f^2), which has no bias (see denoised_regions.py). A bound counts as broken where
the true square is beyond it by more than two standard errors of the truth itself. Flicker is the deviation over the
seeds, of pixels and of means of 8 x 8 pixels: the root of the mean of its square over (m^2 + f^2), m being the mean
over the seeds. docs/design/denoise.md has the tables.
"""
import argparse
import math
import os
import re
import subprocess
import sys
import tempfile

import numpy

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import denoised as views_of  # noqa: E402
import denoised_regions as regions_of  # noqa: E402

VIEWS = {
    "first_light, Takumar f/2": (views_of.FIRST_LIGHT, "--lens", "takumar-50mm-f1.2", "--fstop", "2",
                                  "--focus", "1m"),
    "ornaments, double Gauss": (views_of.ORNAMENTS, "--lens", "double-gauss-100mm-f2"),
}
LINE = re.compile(r"(\d+),(\d+),(\d+),(\d+) +denoised (.*?) +without (.*)")


def bounds(said):
    """Lower and upper bound of what is said of a region."""
    number = r"([0-9.e+-]+) %"
    found = re.fullmatch("at most " + number, said)
    if found:
        return 0, float(found[1]) / 100
    found = re.fullmatch(number + r" \(" + number + " to " + number + r"\)", said)
    return float(found[2]) / 100, float(found[3]) / 100


def holding(regions, picture, truths, scale):
    """How many of the regions' bounds hold the true error, how many there are, and how many tell both bounds."""
    squares = ((picture - truths[0]) * (picture - truths[1]) / scale).mean(2)
    # (d - e)(d - e') with noise e, e' of deviation s has the variance 2 d^2 s^2 + s^4: about the square of this.
    noise = (abs(2 * picture - truths[0] - truths[1]) * abs(truths[0] - truths[1]) / 2 / scale).mean(2)
    held = both = 0
    for (x, y, width, height), (least, most) in regions:
        there = slice(y, y + height), slice(x, x + width)
        doubt = 2 * math.sqrt((noise[there] ** 2).sum()) / noise[there].size
        held += least ** 2 - doubt <= squares[there].mean() <= most ** 2 + doubt
        both += least > 0
    return numpy.array([held, len(regions), both])


def flicker(pictures, floor, block_px):
    def blocks(p):
        height, width = (n // block_px * block_px for n in p.shape[:2])
        return p[:height, :width].reshape(height // block_px, block_px, width // block_px, block_px, 3).mean((1, 3))
    small = numpy.array([blocks(p) for p in pictures])
    return math.sqrt((small.var(0, ddof=1) / (small.mean(0) ** 2 + floor ** 2)).mean())


def measure(a, name, words, folder):
    def file_of(name, seed, end):  # one of its own for each picture: OpenImageIO keeps what it read by its name
        return os.path.join(folder, "%s_%d%s" % (name.replace(os.sep, "_"), seed, end))
    truths = []
    for seed in (100, 200):
        path = file_of(name, seed, ".exr")
        regions_of.render(a, words, seed, ["--spp", str(a.reference), "--time-limit", a.time], path)
        truths.append(regions_of.channels(path)[0])
    pictures, counts = {"denoised.": [], "": []}, {"denoised.": 0, "": 0}
    for seed in range(1, a.seeds + 1):
        path = file_of(name, seed, ".exr")
        state = file_of(name, seed, ".state")
        regions_of.render(a, words, seed, ["--spp", str(a.samples), "--denoise", "-o", state], path)
        printed = subprocess.run([a.petzval, "image", "noise", state], capture_output=True, text=True, check=True)
        lines = [found.groups() for found in map(LINE.fullmatch, printed.stdout.splitlines()) if found]
        shown, spec = regions_of.channels(path, "denoised.")
        floor = spec.getattribute("petzval:denoisedFloor_nits")
        scale = regions_of.about(shown, 3) ** 2 + floor ** 2
        for which, prefix in ((4, "denoised."), (5, "")):
            picture = regions_of.channels(path, prefix)[0]
            pictures[prefix].append(picture)
            said = [(tuple(map(int, line[:4])), bounds(line[which])) for line in lines]
            counts[prefix] += holding(said, picture, truths, scale)
    held = ["%d of %d (%d)" % tuple(counts[p]) for p in ("denoised.", "")]
    return "| %s | %s | %s |" % (name, " | ".join(held), " | ".join(
        ", ".join("%.2g %%" % (100 * flicker(pictures[p], floor, block)) for p in ("", "denoised."))
        for block in (1, 8)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--petzval", default=os.path.join(views_of.HERE, "..", "..", "build", "bin", "petzval"))
    parser.add_argument("--scenes", metavar="DIR", help="folder of scenes that are not part of the project")
    parser.add_argument("--rows", help="names of views of denoised.py, with commas (default: two lenses, hotel-room, "
                        "many-lights)")
    parser.add_argument("--size", default="160x120")
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--reference", type=int, default=1024, help="samples of each of the two pictures of the truth")
    parser.add_argument("--time", default="40s", help="of each of the two pictures of the truth, at most")
    a = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        views = dict(views_of.wanted(a.rows or "hotel-room,many-lights", a.scenes, folder))
        if not a.rows:
            views = {**VIEWS, **views}
        print("| view | bounds that hold, denoised (of two sides) | the same, without | pixels: without, denoised | "
              "8x8 pixels |\n|%s" % ("---|" * 5), flush=True)
        for name, words in views.items():
            print(measure(a, name, words, folder), flush=True)


if __name__ == "__main__":
    main()
