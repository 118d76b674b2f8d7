#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures ghosts in pictures: noise of their layer, and what they cost.

    tests/measure/ghosts.py build/bin/petzval [--spp 256] [--size 144x96]

The scene low_sun.glb with the sun 10 degrees beyond the upper edge of the frame, and inside it at half of the height.
Error: of the layer at the samples asked for, by two renders with other seeds; of each cell of 16x16 pixels whose light
is above 1 % of the layer's mean, relative to it: root of the mean square, and the largest. Time: CPU of a render with
ghosts over one without, by turns; before the first sample apart.
"""
import argparse
import json
import math
import pathlib
import resource
import subprocess
import sys
import tempfile

import numpy as np
import OpenImageIO as oiio

ROOT = pathlib.Path(__file__).resolve().parents[2]
LENSES = ["takumar-50mm-f1.2", "noct-nikkor-58mm-f0.95", "petzval-portrait-100mm-f3.6", "canon-14mm-f2.8-asph",
          "schneider-anamorphic-31mm"]
CELL = 16


def cpu_s(words):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, words))}\n{done.stderr}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime


def layer(path, names):
    picture = oiio.ImageInput.open(str(path))
    channels = list(picture.spec().channelnames)
    return picture.read_image("float")[..., [channels.index(n) for n in names]] @ [0.2126, 0.7152, 0.0722]


def half_height_deg(program, lens, folder):
    out = folder / "probe.exr"
    cpu_s([program, "render", ROOT / "assets/scenes/low_sun.glb", "--lens", lens, "--focus", "9m", "--size", "24x16",
           "--spp", "1", "--quiet", "-o", out])
    facts = oiio.ImageInput.open(str(out)).spec()
    height, focal = (facts.get_float_attribute("petzval:" + n) for n in ("sensorHeight_mm", "focalLength_mm"))
    return math.degrees(math.atan(height / 2 / focal))


def cells(picture):
    h, w = picture.shape
    return picture.reshape(h // CELL, CELL, w // CELL, CELL).mean((1, 3))


def case(options, lens, fstop, up_deg, folder):
    scene = folder / "sun.glb"
    subprocess.run([sys.executable, ROOT / "assets/scenes/make/low_sun.py", scene, "0", str(up_deg)], check=True)

    def render(name, spp, *more):
        return cpu_s([options.program, "render", scene, "--background", "900,1100,1500", "--lens", lens, "--focus", "9m",
                      "--method", "coating=uncoated", "--method", "dispersion=hero", "--size", options.size, "--spp",
                      str(spp), "--threads", "1", "--quiet", *fstop, *more, "-o", folder / name])

    setup = render("s.exr", 1) - render("s.exr", 1, "--ghosts", "off")
    off = render("off.exr", options.spp, "--ghosts", "off")
    on = render("a.exr", options.spp, "--aov", "ghosts")
    render("b.exr", options.spp, "--aov", "ghosts", "--seed", "1")
    a, b = (cells(layer(folder / n, ["ghosts.R", "ghosts.G", "ghosts.B"])) for n in ("a.exr", "b.exr"))
    mean = (a + b) / 2
    lit = mean > 0.01 * mean.mean()
    error = np.abs(a - b)[lit] / math.sqrt(2) / mean[lit]
    return {"error": math.sqrt((error**2).mean()), "worst": error.max(), "setup_s": setup, "times": (on - setup) / off,
            "share": mean.mean() / cells(layer(folder / "off.exr", "RGB")).mean()}


def main():
    words = argparse.ArgumentParser()
    words.add_argument("program")
    words.add_argument("--spp", type=int, default=256)
    words.add_argument("--size", default="144x96")
    words.add_argument("--lenses", default=",".join(LENSES))
    options = words.parse_args()
    print("| lens | iris | sun | error of a cell | largest | time | before the first sample | ghosts over picture |")
    print("|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for lens in options.lenses.split(","):
            half = half_height_deg(options.program, lens, folder)
            for fstop in ([], ["--fstop", "8"]):
                for where, up in (("outside", half + 10), ("inside", half / 2)):
                    r = case(options, lens, fstop, up, folder)
                    print(f"| `{lens}` | {'f/8' if fstop else 'open'} | {where} | {100 * r['error']:.1f} % | "
                          f"{100 * r['worst']:.1f} % | {r['times']:.2f} | {r['setup_s']:.1f} s | {r['share']:.2f} |",
                          flush=True)


if __name__ == "__main__":
    main()
