#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Petzval against Blender Cycles: samples per CPU-second, and error at equal samples.

    peers.py CYCLES_SCRIPT SCENE --look-at ex,ey,ez,tx,ty,tz --fov DEG [--env HDR]

CYCLES_SCRIPT drives Blender (blender -b ... -P CYCLES_SCRIPT -- ...). Same camera, light, bounces
and box filter. Rates come from the CPU seconds between a short and a long render, so that loading
and building cancel; the programs take turns. Each error is against a converged picture of the same
program, as the two do not share a surface model: it measures noise, which is what sampling is.
"""
import argparse
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile

PETZVAL = os.path.join(os.path.dirname(__file__), "..", "..", "build", "bin", "petzval")
BOUNCES = 12


def petzval(a, size, spp, out, seed=0):
    stats = out + ".json"
    command = [PETZVAL, "render", a.scene, "--size", size, "--spp", str(spp), "--filter", "box",
               "--look-at", a.look_at, "--fov", str(a.fov), "--max-depth", str(BOUNCES + 1),
               "--threads", "2", "--seed", str(seed), "--quiet", "--stats", stats, "-o", out]
    subprocess.run(command + (["--env", a.env] if a.env else []), check=True)
    with open(stats) as file:
        return json.load(file)["render_cpu_s"]


def cycles(a, size, spp, out, seed=0):
    width, height = size.split("x")
    command = ["blender", "-b", "--factory-startup", "-noaudio", "-P", a.cycles, "--",
               "--gltf", a.scene, "--out", out, "--width", width, "--height", height,
               "--spp", str(spp), "--threads", "2", "--max-bounces", str(BOUNCES),
               "--look-at=" + a.look_at, "--yfov", str(a.fov), "--seed", str(seed)]
    # Blender looks for Python's modules beside the first python3 in the path.
    text = subprocess.run(command + (["--env", a.env] if a.env else []), text=True,
                          env=dict(os.environ, PATH="/usr/bin:/bin"), stdout=subprocess.PIPE, stderr=subprocess.STDOUT).stdout
    for line in text.splitlines():
        if line.startswith("CYCLES_RENDER render_cpu_s="):
            return float(line.split("=")[1])
    sys.exit("no render_cpu_s from Blender:\n" + text[-2000:])


def relative_mse(image, reference):
    text = subprocess.run([PETZVAL, "image", "diff", image, reference], check=True,
                          capture_output=True, text=True).stdout
    for line in text.splitlines():
        if line.startswith("RGB:"):
            return float(line.split("relative MSE ")[1].split(",")[0])
    sys.exit("no relative MSE in:\n" + text)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cycles")
    parser.add_argument("scene")
    parser.add_argument("--look-at", required=True)
    parser.add_argument("--fov", type=float, required=True)
    parser.add_argument("--env")
    parser.add_argument("--pairs", type=int, default=3)
    parser.add_argument("--reference-spp", type=int, default=1024)
    a = parser.parse_args()
    if not shutil.which("blender"):
        print("skipped: no blender here (apt-get install blender python3-numpy)")
        return
    with tempfile.TemporaryDirectory() as folder:
        out = lambda name: os.path.join(folder, name + ".exr")
        size, short, long = "640x480", 8, 40
        pixels = 640 * 480
        rates = {petzval: [], cycles: []}
        for _ in range(a.pairs):
            for program in rates:
                spent = program(a, size, long, out("t")) - program(a, size, short, out("t"))
                rates[program].append(pixels * (long - short) / spent)
        ratios = [p / c for p, c in zip(rates[petzval], rates[cycles])]
        print("million samples per CPU-second: petzval %.2f, cycles %.2f; ratio %.2f (%.2f to %.2f)" % (
            statistics.median(rates[petzval]) / 1e6, statistics.median(rates[cycles]) / 1e6,
            statistics.median(ratios), min(ratios), max(ratios)))
        errors = {}
        for program in rates:
            program(a, "320x240", a.reference_spp, out("reference"), seed=99)
            tries = []
            for seed in range(5):
                program(a, "320x240", 32, out("image"), seed=seed)
                tries.append(relative_mse(out("image"), out("reference")))
            errors[program] = tries
        middle = {program: statistics.median(tries) for program, tries in errors.items()}
        print("relative MSE at 32 samples, median of 5 seeds (least to most): "
              "petzval %.5f (%.5f to %.5f), cycles %.5f (%.5f to %.5f); ratio %.2f" % (
                  middle[petzval], min(errors[petzval]), max(errors[petzval]),
                  middle[cycles], min(errors[cycles]), max(errors[cycles]),
                  middle[petzval] / middle[cycles]))


if __name__ == "__main__":
    main()
