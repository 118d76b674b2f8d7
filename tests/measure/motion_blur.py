#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares a motion-blurred picture with the average of still frames: another way to the same picture.

    motion_blur.py PETZVAL SCENE --at 0.1 --shutter 0.0208 [--frames 256] [--spp 256] [--keep FOLDER] -- OPTIONS

Renders SCENE once with --shutter, with as many samples as all still frames have together, and `frames` stills whose
times lie evenly in the exposure, each with a seed of its own (--frames 0: none). Prints the relative difference of the pictures' means,
the root mean square of the difference over the picture beside what noise alone gives (from two independent blurred
pictures and two independent halves of the stills), and the worst of 16 x 16 pixel blocks in standard errors. Last the
noise of a still in the middle of the exposure with as many samples as a blurred picture, and the ratio of their CPU
times: both are rendered three times, in turns.
Needs numpy and OpenImageIO (python3-openimageio).
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

import numpy as np
import OpenImageIO as oiio


def read_rgb(path):
    picture = oiio.ImageInput.open(path)
    if not picture:
        raise SystemExit("%s: %s" % (path, oiio.geterror()))
    pixels = picture.read_image(0, 3, oiio.FLOAT)
    picture.close()
    return np.asarray(pixels, dtype=np.float64)


def render(o, out, at_s, spp, seed, more):
    command = [o.petzval, "render", o.scene, "--at", repr(at_s), "--spp", str(spp), "--seed", str(seed), "-o", out,
               "--quiet", *o.options, *more]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit("%s\n%s" % (" ".join(command), done.stderr))
    return read_rgb(out)


def cost_of_blur(o, folder):
    """Noise of stills and of blurred pictures in shares of the mean, and the ratio of their CPU times."""
    name, stats = os.path.join(folder, "a.exr"), os.path.join(folder, "a.json")
    pictures, cpu_s = ([], []), ([], [])
    for seed in (1, 2, 3):
        for kind, more in enumerate(([], ["--shutter", repr(o.shutter)])):
            pictures[kind].append(render(o, name, o.at, o.spp, seed, [*more, "--stats", stats]))
            with open(stats, encoding="utf-8") as file:
                cpu_s[kind].append(json.load(file)["render_cpu_s"])
    noise = [float(np.sqrt(np.var(p, axis=0, ddof=1).mean()) / np.mean(p)) for p in map(np.array, pictures)]
    return noise, [b / a for a, b in zip(*cpu_s)]


def blocks(picture, size=16):
    """Means of square blocks; what is left over at the edges is dropped."""
    h, w = (n // size * size for n in picture.shape[:2])
    return picture[:h, :w].reshape(h // size, size, w // size, size, 3).mean(axis=(1, 3))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("petzval")
    parser.add_argument("scene")
    parser.add_argument("--at", type=float, required=True, help="seconds")
    parser.add_argument("--shutter", type=float, required=True, help="seconds")
    parser.add_argument("--frames", type=int, default=256)
    parser.add_argument("--spp", type=int, default=256, help="of each of the two blurred pictures")
    parser.add_argument("--keep", help="folder for the pictures")
    words = sys.argv[1:]
    ours = words.index("--") if "--" in words else len(words)
    o = parser.parse_args(words[:ours])
    o.options = words[ours + 1:]  # of petzval render
    with tempfile.TemporaryDirectory() as folder:
        (of_still, of_blur), times = cost_of_blur(o, folder)
    print("noise with %d samples: still %.2f %%, blurred %.2f %% of the mean; CPU time of blurred ones: %s times that" %
          (o.spp, 100 * of_still, 100 * of_blur, ", ".join("%.2f" % t for t in sorted(times))))
    if o.frames == 0:
        return
    each = max(1, o.spp // (o.frames // 2))
    with tempfile.TemporaryDirectory() as folder:
        name = os.path.join(folder, "a.exr")
        blurred = [render(o, name, o.at, o.spp, seed, ["--shutter", repr(o.shutter)]) for seed in (1, 2)]
        halves = [0, 0]
        for i in range(o.frames):
            at_s = o.at + ((i + 0.5) / o.frames - 0.5) * o.shutter
            halves[i % 2] = halves[i % 2] + render(o, name, at_s, each, 1000 + i, []) / (o.frames / 2)
    blur, still = sum(blurred) / 2, sum(halves) / 2
    if o.keep:
        os.makedirs(o.keep, exist_ok=True)
        for label, picture in (("blurred", blur), ("stills", still), ("difference", abs(blur - still))):
            out = oiio.ImageOutput.create(os.path.join(o.keep, label + ".exr"))
            out.open(os.path.join(o.keep, label + ".exr"),
                     oiio.ImageSpec(picture.shape[1], picture.shape[0], 3, oiio.FLOAT))
            out.write_image(picture.astype(np.float32))
            out.close()

    def rms(picture):
        return float(np.sqrt((picture ** 2).mean()))
    of_blur, of_stills = (rms(pair[0] - pair[1]) / 2 for pair in (blurred, halves))
    noise = np.hypot(of_blur, of_stills)
    # Errors of blocks: from the pixels' spread between halves, which are independent.
    spread = ((blurred[0] - blurred[1]) / 2) ** 2 + ((halves[0] - halves[1]) / 2) ** 2
    error = np.sqrt(blocks(spread)) / 16
    apart = blocks(blur - still) / np.maximum(error, 1e-6 * still.mean())
    print("mean: blurred / stills - 1 = %+.4f %%" % (100 * (blur.mean() / still.mean() - 1)))
    print("RMS of the difference: %.3f %% of the mean; noise alone gives %.3f %%" %
          (100 * rms(blur - still) / still.mean(), 100 * noise / still.mean()))
    print("noise at as many samples: blurred %.3f %%, stills %.3f %% of the mean" %
          (100 * of_blur / still.mean(), 100 * of_stills / still.mean()))
    print("worst of %d blocks: %.2f standard errors" % (apart.size, abs(apart).max()))


if __name__ == "__main__":
    main()
