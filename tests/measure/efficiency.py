#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares two Petzval programs: CPU time, error and efficiency of NEW over OLD, as a table.

    efficiency.py OLD NEW SCENE_FOLDER... [--spp N] [--size WxH] [--seeds N] [--crop x,y,w,h]

Each folder holds a scene and its view.json; peers/rooms.py writes some. The programs take turns, seed by seed. CPU
time is that of rendering alone. The error is the squared one against a picture that OLD makes with another seed and
many more samples, relative as in peers/noise.py: its mean, its mean without the worst 0.1 % of the pixels
("trimmed"), and its median ("typical"). Efficiency is 1 / (error x CPU time). Intervals are 95 %, by the jackknife
over the seeds. CPU time and error are better below 1, efficiency above.
"""
import argparse
import dataclasses
import hashlib
import json
import os
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "peers"))
import bench  # noqa: E402
import noise  # noqa: E402
import scenes  # noqa: E402
import table  # noqa: E402
from programs import Petzval  # noqa: E402

COLUMNS = ("CPU time", *(what + " " + measure for measure in noise.MEASURES for what in ("error", "efficiency")))


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("old", metavar="OLD", type=Petzval)
    parser.add_argument("new", metavar="NEW", type=Petzval)
    parser.add_argument("folders", metavar="SCENE_FOLDER", nargs="+")
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--reference-spp", type=int, help="samples of the reference (default: 128 times --spp)")
    parser.add_argument("--size", default="240x135")
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--other-seeds", action="store_true",
                        help="NEW takes seeds of its own: OLD against OLD then shows what chance alone does")
    parser.add_argument("--crop", metavar="x,y,w,h")
    parser.add_argument("--bounces", type=int, default=12)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--cache", metavar="FOLDER", default=os.path.join(tempfile.gettempdir(), "petzval-references"),
                        help="where references are kept (default: %(default)s)")
    a = parser.parse_args()
    a.reference_spp = a.reference_spp or 128 * a.spp
    return a


def render(a, program, row, spp, seed, output):
    """Renders to the file; returns the CPU time of rendering, s."""
    with tempfile.TemporaryDirectory() as folder:
        stats = os.path.join(folder, "stats.json")
        options = ("--stats", stats, *(("--crop", a.crop) if a.crop else ()))
        program.render(a, dataclasses.replace(row, petzval=options), row.scene, spp, seed, output)
        with open(stats) as file:
            return json.load(file)["render_cpu_s"]


def reference(a, row):
    """The pixels of the reference; kept under a name that tells OLD, scene and settings."""
    key = hashlib.sha256(repr((a.old.version, a.size, a.crop, a.bounces, dataclasses.astuple(row))).encode())
    folder = os.path.dirname(row.scene)
    files = [os.path.join(at, name) for at, _, names in os.walk(folder) for name in names]
    for path in [*sorted(files), *([row.sky] if row.sky else [])]:
        with open(path, "rb") as file:
            key.update(hashlib.sha256(file.read()).digest())
    os.makedirs(a.cache, exist_ok=True)
    path = os.path.join(a.cache, "%s-%d-%s.exr" % (row.name, a.reference_spp, key.hexdigest()[:16]))
    if not os.path.exists(path):
        part = path[:-4] + ".part.exr"  # a render that was stopped leaves nothing that looks whole
        render(a, a.old, row, a.reference_spp, bench.REFERENCE_SEED, part)
        os.rename(part, path)
    return bench.pixels(path).astype(float)


def measure(a, row):
    """The ratios of one scene."""
    truth, programs = reference(a, row), (a.old, a.new)
    pictures, found = ([], []), ({"cpu_s": []}, {"cpu_s": []})
    with tempfile.TemporaryDirectory() as folder:
        output = os.path.join(folder, "picture.exr")
        for seed in range(1, a.seeds + 1):
            for which in ((0, 1), (1, 0))[seed % 2]:
                shift = a.seeds if which and a.other_seeds else 0
                found[which]["cpu_s"].append(render(a, programs[which], row, a.spp, seed + shift, output))
                pictures[which].append(bench.pixels(output))
    for which in (0, 1):
        found[which].update(noise.with_each_left_out(lambda some: noise.error_against(some, truth), pictures[which]))
        found[which]["mean"] = sum(p.mean(dtype=float) for p in pictures[which])
    return table.new_over_old(*found)


def main():
    a = arguments()
    rows = {folder: scenes.of_view(os.path.basename(os.path.abspath(folder)), folder) for folder in a.folders}
    for folder, row in rows.items():
        if not row:
            sys.exit("%s has no view.json: give the folder of one scene, as peers/rooms.py writes it" % folder)
    print("| scene | %s | brightness |\n|%s" % (" | ".join(COLUMNS), "---|" * (len(COLUMNS) + 2)), flush=True)
    for row in rows.values():
        r = measure(a, row)
        print("| %s | %s | %.4f |" % (row.name, " | ".join(table.shown(r[c]) for c in COLUMNS), r["brightness"]),
              flush=True)


if __name__ == "__main__":
    main()
