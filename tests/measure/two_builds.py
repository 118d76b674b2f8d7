#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares pictures of two builds of the program, as those of two Debian releases:

    two_builds.py render PROGRAM FOLDER      once with each build, in its own system
    two_builds.py compare FOLDER FOLDER      with python3-openimageio and python3-numpy

With the same seed at most one pixel in 1,000 may be off by more than 1 %. With other seeds the means of
16x16 blocks must agree: Student's t by four pictures of each build, corrected for all blocks (Sidak 1967).
Ends with 1 where that is not so.
"""
import pathlib
import subprocess
import sys

SCENES = {
    "pinhole": "first_light --lens pinhole",
    "double-gauss": "first_light --lens double-gauss-100mm-f2 --fstop 2 --focus 1m",
    "sky": "first_light --lens pinhole --env studio",
    "gem": "gem",
    "glass": "glass",
    "takumar": "ornaments --lens takumar-50mm-f1.2 --focus 1m",
    "thin": "ornaments --lens thin --fstop 1.4 --focus 1m",
    "wheels": "wheels --at 0.1 --shutter 180deg",
    "face": "face --at 0.98 --shutter 180deg",
    "flying-lamp": "flying_lamp --at 0.5 --shutter 180deg",
}
SEEDS = 4
BLOCK_PX = 16
ALPHA = 0.01


def render(program, folder):
    assets = pathlib.Path(__file__).resolve().parents[2] / "assets" / "scenes"
    folder.mkdir(parents=True, exist_ok=True)
    for name, words in SCENES.items():
        scene, *options = words.split()
        for seed in range(2 * SEEDS + 1):
            subprocess.run([program, "render", assets / f"{scene}.glb", *options, "--size", "96x64", "--spp", "32",
                            "--seed", str(seed), "--quiet", "-o", folder / f"{name}-{seed}.exr"], check=True)


def pixels(path):
    import OpenImageIO as oiio
    picture = oiio.ImageBuf(str(path))
    return picture.get_pixels(oiio.FLOAT)[:, :, :3].astype("f8")


def two_sided_p(t, degrees):
    """Chance of Student's t with an even number of degrees: Abramowitz and Stegun 1964, 26.7.4."""
    import numpy as np
    angle = np.arctan(np.abs(t) / np.sqrt(degrees))
    term = total = np.ones_like(angle)
    for k in range(1, degrees // 2):
        term = term * (2 * k - 1) / (2 * k) * np.cos(angle) ** 2
        total = total + term
    return 1 - np.sin(angle) * total


def block_means(picture):
    height, width, _ = picture.shape
    return picture.reshape(height // BLOCK_PX, BLOCK_PX, width // BLOCK_PX, BLOCK_PX, 3).mean(axis=(1, 3))


def compare(first, second):
    import numpy as np
    tests = len(SCENES) * (96 // BLOCK_PX) * (64 // BLOCK_PX) * 3
    least_p = -np.expm1(np.log1p(-ALPHA) / tests)
    failed = False
    for name in SCENES:
        a, b = (pixels(folder / f"{name}-0.exr") for folder in (first, second))
        off = np.abs(a - b).max(axis=2) > 0.01 * np.maximum(a, b).max(axis=2)
        sets = [np.array([block_means(pixels(folder / f"{name}-{seed}.exr")) for seed in seeds])
                for folder, seeds in ((first, range(1, SEEDS + 1)), (second, range(SEEDS + 1, 2 * SEEDS + 1)))]
        deviation = np.sqrt(sum(s.var(axis=0, ddof=1) / SEEDS for s in sets))
        apart = sets[0].mean(axis=0) - sets[1].mean(axis=0)
        t = np.divide(apart, deviation, out=np.where(apart == 0, 0., np.inf), where=deviation > 0)
        p = two_sided_p(t, 2 * (SEEDS - 1)).min()
        finite = all(np.isfinite(x).all() for x in (a, b, *sets))
        bad = not (finite and off.mean() <= 1e-3 and p >= least_p)
        failed |= bad
        print(f"{name:14}{off.mean():9.5f} of the pixels off by more than 1 %, {(a != b).any(axis=2).mean():.3f} "
              f"not equal; least p of a block {p:.2g} (at least {least_p:.2g}){'  FAILED' if bad else ''}")
    return 1 if failed else 0


if __name__ == "__main__":
    if len(sys.argv) != 4 or sys.argv[1] not in ("render", "compare"):
        sys.exit(__doc__)
    if sys.argv[1] == "render":
        render(sys.argv[2], pathlib.Path(sys.argv[3]))
    else:
        sys.exit(compare(*map(pathlib.Path, sys.argv[2:])))
