#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what rays to targets bring: pictures with `--method targets=off` and `auto`, five seeds of each, by turns.
Five more of each, of other seeds, are the mean to which noise is put in proportion.

    gain.py PETZVAL NAME -- ARGUMENTS OF RENDER

Prints the ratios of noise, of CPU time, and the gain in efficiency, 1 / (noise x CPU time), of the whole frame and of its
discs, with the smallest and the largest of what five leave-one-out sets give. Noise is the mean over pixels of the
variance over seeds, over the squared mean plus a hundredth of the frame's squared grey. (A mean of the same pictures
would hold their own single bright pixels, and those would count less where they are.) Discs are the pixels whose
median over the seeds with targets is twice as bright as the median of what lies around them, 96 pixels wide: there
lamps are over half of the light. (By the mean, single bright pixels would count as discs.)
"trimmed" leaves out the worst 0.1 % of the pixels.
"""
import math
import os
import resource
import subprocess
import sys
import tempfile

import numpy
import OpenImageIO

SEEDS, AROUND = 5, 48


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


def noise(pictures, mean, where):
    variance = numpy.var(pictures, axis=0, ddof=1).sum(-1)
    dark = .01 * (mean.mean((0, 1)) ** 2).sum()
    relative = numpy.sort((variance / ((mean ** 2).sum(-1) + dark))[where])
    return relative.mean(), relative[:len(relative) - math.ceil(.001 * len(relative))].mean()


def main(program, name, arguments):
    pictures, cpu_s = {"off": [], "auto": []}, {"off": [], "auto": []}
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(1, SEEDS + 1):
            for targets in (("off", "auto"), ("auto", "off"))[seed % 2]:
                picture, seconds = render(program, arguments, targets, seed, folder)
                pictures[targets].append(picture)
                cpu_s[targets].append(seconds)
        others = [render(program, arguments, targets, SEEDS + seed, folder)[0]
                  for seed in range(1, SEEDS + 1) for targets in pictures]
    mean = numpy.mean(others, axis=0)
    grey = numpy.median(pictures["auto"], axis=0).mean(-1)
    discs = grey > 2 * median_around(grey)
    cost = float(numpy.median(numpy.array(cpu_s["auto"]) / numpy.array(cpu_s["off"])))
    print("%s: mean auto / off %.4f, CPU time %.2f, discs %.1f %% of the frame" % (
        name, numpy.mean(pictures["auto"]) / numpy.mean(pictures["off"]), cost, 100 * discs.mean()))
    for place, where in (("frame", numpy.ones_like(discs)), ("discs", discs)):
        if not where.any():
            continue
        for kind in (0, 1):
            def gain(kept):
                ratio = [noise([pictures[t][i] for i in kept], mean, where)[kind] for t in ("off", "auto")]
                return ratio[0] / ratio[1] / cost
            every = list(range(SEEDS))
            some = [gain([i for i in every if i != out]) for out in every]
            print("  %s%s: efficiency %.3g (%.3g to %.3g)" % (
                place, " trimmed" if kind else "", gain(every), min(some), max(some)), flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 5 or sys.argv[3] != "--":
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], sys.argv[4:])
