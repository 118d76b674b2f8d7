#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the light of pictures with rays to targets and without, over many seeds and through several lenses.

    means.py PETZVAL FOLDER NAME... [--lenses LENS,...] [--seeds N]

FOLDER: where scenes.py wrote its scenes; NAME: of one of those below. Frames of 96 x 64, 8 samples with targets and 64
without. Prints the ratio of the means of all pixels and z, their difference over its standard error (Welch 1947), for each
lens. Then the largest z that chance leaves to one in a hundred of so many (Sidak 1967).
"""
import argparse
import os
import statistics
import sys
import tempfile

import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import gain

# One meeting with a surface: what is compared is what rays to targets change. The light that surfaces hand on to each
# other would add noise to both.
SCENES = {
    "night": "--look-at 0,0,0,0,0,-1 --focus 1m --method max-depth=1",
    "fairy": "--look-at 0,0,0,0,0,-1 --focus 1m --method max-depth=1",
    "workshop": "--look-at 0,0,0,0,-0.12,-1 --focus 0.6m --method max-depth=1",
}
LENSES = ["takumar-50mm-f1.2", "minolta-fisheye-16mm-f2.8", "schneider-anamorphic-31mm", "double-gauss-100mm-f2",
          "petzval-portrait-100mm-f3.6"]


def light(given, scene, lens, targets, first_seed, samples, folder):
    arguments = [os.path.join(given.folder, scene + ".gltf"), *SCENES[scene].split(), "--lens", lens, "--size", "96x64",
                 "--spp", str(samples)]
    return numpy.array([gain.render(given.program, arguments, targets, first_seed + seed, folder)[0].mean()
                        for seed in range(given.seeds)])


def main(given):
    pairs = [(scene, lens) for scene in given.scenes for lens in given.lenses.split(",")]
    largest = 0
    with tempfile.TemporaryDirectory() as folder:
        for scene, lens in pairs:
            sent = light(given, scene, lens, "auto", 1, 8, folder)
            plain = light(given, scene, lens, "off", 1001, 64, folder)
            z = (sent.mean() - plain.mean()) / numpy.hypot(sent.std(ddof=1), plain.std(ddof=1)) * given.seeds ** .5
            largest = max(largest, abs(z))
            print("%s, %s: ratio %.4f, of which %.4f is chance, z %.2f" % (
                scene, lens, sent.mean() / plain.mean(),
                numpy.hypot(sent.std(ddof=1), plain.std(ddof=1)) / given.seeds ** .5 / plain.mean(), z), flush=True)
    bound = statistics.NormalDist().inv_cdf((1 + .99 ** (1 / len(pairs))) / 2)
    print("largest |z| %.2f; chance leaves %.2f to one in a hundred" % (largest, bound))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("scenes", nargs="+", choices=SCENES)
    parser.add_argument("--lenses", default=",".join(LENSES))
    parser.add_argument("--seeds", type=int, default=48)
    main(parser.parse_args())
