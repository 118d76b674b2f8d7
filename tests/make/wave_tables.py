#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the table of docs/measured/waves.md: wavefronts on the axis, line d, distant object, the film at the least
spot of F, d and C of that stop; and from which f-number Airy's disc is wider than a pixel.

    tests/make/wave_tables.py build/bin/petzval
"""
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

ASSETS = pathlib.Path(__file__).resolve().parents[2] / "assets/lenses"
WIDTHS_PX = [1920, 3840, 6000]
program = sys.argv[1]


def figures(name, *words):
    """RMS in waves, Strehl ratio and f-number."""
    with tempfile.TemporaryDirectory() as folder:
        text = subprocess.run([program, "lens", "wavefront", name, "--field", "0", "--film-shift", "best", "-o",
                               f"{folder}/a.svg", *words], check=True, capture_output=True, text=True).stdout
    row = re.search(r"^ +0 +d +(.*)$", text, re.MULTILINE).group(1).split()
    return float(row[2]), float(row[4]), float(row[5])


def width_mm(name):
    """Of the largest 3:2 picture in the image circle, 36 mm at most."""
    return min(36, 3 * json.loads((ASSETS / f"{name}.json").read_text())["image_circle"] / math.sqrt(13))


names = [row.split()[0] for row in subprocess.run([program, "lens", "list"], check=True, capture_output=True,
                                                  text=True).stdout.splitlines()[2:]]
print("| lens | wide open | RMS (λ) | Strehl | RMS at f/8 (λ) | Strehl at f/8 | film (mm) | "
      + " | ".join(f"{px} px" for px in WIDTHS_PX) + " |\n" + "|---" * (7 + len(WIDTHS_PX)) + "|")
for name in names:
    rms, strehl, fnumber = figures(name)
    rms_8, strehl_8, _ = figures(name, "--fstop", "8")
    pixels = [1000 * width_mm(name) / px / (2 * 1.21967 * 0.5875618) for px in WIDTHS_PX]
    print(f"| `{name}` | f/{fnumber:.2f} | {rms:.3f} | {strehl:.3f} | {rms_8:.4f} | {strehl_8:.3f} | "
          f"{width_mm(name):.1f} | " + " | ".join(f"f/{n:.1f}" for n in pixels) + " |")
