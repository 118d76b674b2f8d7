#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Denoised pictures against the truth: what is said of their error, and what denoising does by class of region.

    denoised_regions.py [--petzval PATH] [--scenes DIR] [--rows a,b] [--samples 64] [--size 192x108]
                        [--reference 1024] [--time 25s] [--keep FOLDER]

The truth is known from two pictures of --reference samples, or of as many as --time allows, with other seeds. The
squared error of X is the mean of (X - first) (X - second) / (m^2 + f^2), which has no bias: m is the mean of the
denoised picture over 7 x 7 pixels, f a quarter of its mid-grey. Lamps are pixels more than twice as bright as the
15 x 15 about them, edges others whose 3 x 3 differ by half of their brightness. Where an error is less than two of its
standard errors, its ratio is "?". docs/design/denoise.md has the table. --keep: the references stay for the next run.
"""
import argparse
import math
import os
import subprocess
import sys
import tempfile

import numpy
import OpenImageIO

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import denoised as views_of  # noqa: E402

LUMINANCE = numpy.array([0.2126, 0.7152, 0.0722])
BLOCK_PX = 16


def channels(path, prefix=""):
    image = OpenImageIO.ImageBuf(path)
    names = image.spec().channelnames
    pixels = image.get_pixels(OpenImageIO.FLOAT).astype(float)
    return pixels[..., [names.index(prefix + c) for c in "RGB"]], image.spec()


def render(a, words, seed, more, path):
    done = subprocess.run([a.petzval, "render", *words, "--size", a.size, "--seed", str(seed), *more, "--quiet",
                           "-o", path], stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode not in (0, 5):
        sys.exit("exit status %d of %s:\n%s" % (done.returncode, " ".join(words), done.stderr))


def about(values, radius_px, of=numpy.mean):
    """Means, or what else, over the squares about pixels, as far as they lie in the picture."""
    height, width = values.shape[:2]
    return numpy.array([[of(values[max(0, y - radius_px):y + radius_px + 1, max(0, x - radius_px):x + radius_px + 1],
                            axis=(0, 1)) for x in range(width)] for y in range(height)])


def classes(truth):
    """Masks of lamps, edges and the rest."""
    bright = truth @ LUMINANCE
    lamps = bright > 2 * about(bright, 7)
    edges = ~lamps & (about(bright, 1, numpy.ptp) > 0.5 * about(bright, 1))
    return {"lamps": lamps, "edges": edges, "even": ~lamps & ~edges}


def by_block(values, mask):
    height, width = values.shape
    return numpy.array([(values * mask)[y:y + BLOCK_PX, x:x + BLOCK_PX].sum()
                        for y in range(0, height, BLOCK_PX) for x in range(0, width, BLOCK_PX)])


def ratio(over, under, mask):
    """Ratio of two sums over a mask, in words; "?" where blocks do not tell both."""
    sums = [by_block(v, mask) for v in (over, under)]
    known = all(s.sum() > 2 * math.sqrt(max((s ** 2).sum() - s.sum() ** 2 / len(s), 0)) for s in sums)
    return "%.2g" % (sums[0].sum() / sums[1].sum()) if known else "?"


def percent(squares):
    return "%.2g %%" % (100 * math.sqrt(max(squares.mean(), 0)))


def measure(a, name, words, folder):
    key = name.replace(" ", "_")
    truths = []
    for seed in (100, 200):
        path = os.path.join(a.keep or folder, "%s_%d.exr" % (key, seed))
        if not os.path.exists(path):
            render(a, words, seed, ["--spp", str(a.reference), "--time-limit", a.time], path)
        truths.append(channels(path)[0])
    path = os.path.join(folder, key + ".exr")
    render(a, words, 7, ["--spp", str(a.samples), "--denoise"], path)
    shown, spec = channels(path, "denoised.")
    noisy, _ = channels(path)
    floor = spec.getattribute("petzval:denoisedFloor_nits")
    said, most = (spec.getattribute("petzval:" + s) for s in ("denoisedError", "denoisedErrorAtMost"))
    scale = about(shown, 3) ** 2 + floor ** 2

    def squares(picture):
        return ((picture - truths[0]) * (picture - truths[1]) / scale).mean(2)
    over, under = squares(shown), squares(noisy)
    truth = (truths[0] + truths[1]) / 2
    symmetric = [(p - truths[0]) * (p - truths[1]) / ((p ** 2 + truth ** 2) / 2 + floor ** 2) for p in (shown, noisy)]
    masks = classes(truth)
    everywhere = numpy.ones(over.shape, bool)
    return symmetric[0].mean() / symmetric[1].mean(), "| %s | %s | %s | %s | %s | %.2f | %s |" % (
        name, percent(under), percent(over),
        "at most %.2g %%" % (100 * most) if said == most else "%.2g %% (at most %.2g %%)" % (100 * said, 100 * most),
        ratio(over, under, everywhere), symmetric[0].mean() / symmetric[1].mean(),
        " | ".join("%s (%.0f %%)" % (ratio(over, under, mask), 100 * mask.mean()) for mask in masks.values()))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--petzval", default=os.path.join(views_of.HERE, "..", "..", "build", "bin", "petzval"))
    parser.add_argument("--scenes", metavar="DIR", help="folder of scenes that are not part of the project")
    parser.add_argument("--rows", help="names of views, with commas (default: all)")
    parser.add_argument("--size", default="192x108")
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--reference", type=int, default=1024, help="samples of each of the two pictures of the truth")
    parser.add_argument("--time", default="25s", help="of each of the two pictures of the truth, at most")
    parser.add_argument("--keep", metavar="FOLDER", help="where the pictures of the truth stay")
    a = parser.parse_args()
    lines = []
    with tempfile.TemporaryDirectory() as folder:
        if a.keep:
            os.makedirs(a.keep, exist_ok=True)
        for name, words in views_of.wanted(a.rows, a.scenes, folder):
            lines.append(measure(a, name, words, folder))
            print(lines[-1][1], flush=True)
    print("\n| view | error without | error, true | said | squares, ratio | symmetric, ratio | lamps (pixels) | "
          "edges | even |\n|%s" % ("---|" * 9))
    print("\n".join(text for _, text in sorted(lines, reverse=True)))
    views_of.say_mean(lines, "symmetric ratios")


if __name__ == "__main__":
    main()
