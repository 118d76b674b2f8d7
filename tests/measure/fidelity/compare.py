#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Renders a list of models and puts our pictures beside those of other renderers.

    compare.py LIST.json PICTURES -o OUT [--petzval build/bin/petzval] [--spp 256] [--only NAME]...

LIST.json is a list of scenes, or an object with one under "scenarios", as pages that compare glTF renderers keep it:

    {"name": "Chair", "model": "Chair.glb", "lighting": "room.hdr", "dimensions": {"width": 768, "height": 768},
     "target": {"x": 0, "y": 0.3, "z": 0}, "orbit": {"theta": 0, "phi": 90, "radius": 1}, "verticalFoV": 45,
     "renderSkybox": false, "exclude": ["RENDERER"], "exposure": 0, "variant": "red"}

All but "name" and "model" may be left out; these are the defaults, but for the last three, and without "lighting" the
studio light is taken. theta and phi are in degrees, theta about the y axis from +z, phi from +y; radius and target in
metres; "exposure" in EV. Names of files are relative to LIST.json.

The pictures of others are PICTURES/RENDERER/NAME.png, or PICTURES/NAME/RENDERER-golden.png; all of a scene have one
size, ours is rendered in it. Without any of them the scene has the size of the list.

OUT gets NAME.png (ours), NAME-beside.png (ours, the median of the others, the others by name), table.md and
table.json. A distance is to the median of the other renderers at each pixel and channel. It is the root mean square of
the squared YIQ difference of Kotsarenko and Ramos 2010 ("Measuring perceived color difference using YIQ NTSC
transmission color space in mobile applications"), over its largest value, in decibels; over pixels that one of the two
covers; pictures stand on white. So do the fidelity tests of <model-viewer> measure it. 0 dB is the largest difference.
"""
import argparse
import glob
import json
import math
import os
import shlex
import subprocess
import sys
import tempfile

import numpy

OURS = "petzval"
GOLDEN = "-golden.png"
YIQ = numpy.array([[.29889531, .58662247, .11448223], [.59597799, -.27417610, -.32180189],
                   [.21147017, -.52261711, .31114694]])
YIQ_WEIGHTS = numpy.array([.5053, .299, .1957])
LARGEST = 35215.  # of the weighted sum of squares, between colours of 0 to 255


def read_list(path):
    with open(path, encoding="utf-8") as file:
        scenes = json.load(file)
    return scenes["scenarios"] if isinstance(scenes, dict) else scenes


def look_at(scene):
    """The numbers of --look-at: the eye on a sphere about the target."""
    target = [float(scene.get("target", {}).get(axis, 0)) for axis in "xyz"]
    orbit = {"theta": 0, "phi": 90, "radius": 1, **scene.get("orbit", {})}
    theta, phi = math.radians(orbit["theta"]), math.radians(orbit["phi"])
    way = (math.sin(phi) * math.sin(theta), math.cos(phi), math.sin(phi) * math.cos(theta))
    return [t + orbit["radius"] * w for t, w in zip(target, way)] + target


def command(scene, folder, size, output, petzval="petzval", spp=256):
    """The one command that renders a scene of the list."""
    lighting = scene.get("lighting", "studio")
    words = [petzval, "render", os.path.join(folder, scene["model"]),
             "--look-at", ",".join("%.9g" % (round(number, 12) + 0.) for number in look_at(scene)),
             "--fov", "%.9g" % scene.get("verticalFoV", 45), "--size", "%dx%d" % size,
             "--env", lighting if lighting == "studio" else os.path.join(folder, lighting),
             "--exposure", "%.9g" % scene.get("exposure", 0), "--view", "sRGB", "--spp", str(spp)]
    if not scene.get("renderSkybox", False):
        words.append("--transparent")
    if "variant" in scene:
        words += ["--variant", scene["variant"]]
    return words + ["-o", output]


def run(words):
    return subprocess.run(words, check=True, stdout=subprocess.PIPE).stdout.decode()


def read_png(path):
    """RGBA of a picture as codes from 0 to 255, alpha from 0 to 1; not premultiplied."""
    read = ["oiiotool", "--iconfig", "oiio:UnassociatedAlpha", "1", path]
    width, height, channels = map(int, run(read + ["--echo", "{TOP.width} {TOP.height} {TOP.nchannels}"]).split())
    if channels not in (3, 4):
        sys.exit("%s: has %d channels instead of RGB or RGBA" % (path, channels))
    with tempfile.TemporaryDirectory() as folder:
        def plane(what, planes):
            raw = os.path.join(folder, "picture.pnm")
            # OpenImageIO 2.5 writes PNM upside down where it is not told otherwise, and reads it so.
            run(read + ["--ch", what, "-d", "uint8", "--attrib:type=int", "pnm:pfmflip", "0", "-o", raw])
            size = width * height * planes
            with open(raw, "rb") as file:
                return numpy.frombuffer(file.read()[-size:], numpy.uint8).reshape(height, width, planes).astype(float)
        rgb = plane("0,1,2", 3)
        alpha = plane("3", 1) / 255 if channels == 4 else numpy.ones((height, width, 1))
    return numpy.concatenate([rgb, alpha], 2)


def write_png(path, rgb):
    with tempfile.TemporaryDirectory() as folder:
        raw = os.path.join(folder, "picture.ppm")
        with open(raw, "wb") as file:
            file.write(b"P6 %d %d 255\n" % (rgb.shape[1], rgb.shape[0]))
            file.write(rgb.round().clip(0, 255).astype(numpy.uint8).tobytes())
        run(["oiiotool", "--iconfig", "pnm:pfmflip", "0", raw, "-o", path])


def on_white(rgba):
    alpha = rgba[..., 3:]
    return rgba[..., :3] * alpha + 255 * (1 - alpha)


def distance_db(a, b):
    """Distance of two RGBA pictures in dB; -inf where they are the same, None where both are empty."""
    covered = (a[..., 3] > 0) | (b[..., 3] > 0)
    if not covered.any():
        return None
    yiq = (on_white(a) - on_white(b))[covered] @ YIQ.T
    squares = yiq ** 2 @ YIQ_WEIGHTS
    ratio = math.sqrt(numpy.mean(squares ** 2)) / LARGEST
    return 10 * math.log10(ratio) if ratio > 0 else -math.inf


def others_of(pictures, scene):
    """Names of the pictures of a scene, by renderer."""
    name = scene["name"]
    found = {os.path.basename(os.path.dirname(path)): path
             for path in glob.glob(os.path.join(glob.escape(pictures), "*", glob.escape(name) + ".png"))}
    for path in glob.glob(os.path.join(glob.escape(pictures), glob.escape(name), "*" + GOLDEN)):
        found[os.path.basename(path)[:-len(GOLDEN)]] = path
    for left_out in scene.get("exclude", []) + [OURS]:
        found.pop(left_out, None)
    return dict(sorted(found.items()))


def distances(ours, others):
    """Distance of each renderer to the median of the other ones, in dB. Ours is none of those of the others."""
    def to_median(picture, rest):
        return distance_db(picture, numpy.median(list(rest.values()), 0)) if rest else None
    found = {OURS: to_median(ours, others)}
    for name in others:
        found[name] = to_median(others[name], {n: p for n, p in others.items() if n != name})
    return found


def compare(scene, a):
    """Renders a scene and compares it; returns its row."""
    others = {name: read_png(path) for name, path in others_of(a.pictures, scene).items()}
    sizes = {picture.shape[1::-1] for picture in others.values()}
    if len(sizes) > 1:
        sys.exit("%s: the pictures of others have different sizes: %s" % (scene["name"], sorted(sizes)))
    dimensions = {"width": 768, "height": 768, **scene.get("dimensions", {})}
    size = sizes.pop() if sizes else (dimensions["width"], dimensions["height"])
    output = os.path.join(a.output, scene["name"] + ".png")
    words = command(scene, os.path.dirname(os.path.abspath(a.list)), size, output, a.petzval, a.spp)
    print(shlex.join(words), flush=True)
    run(words + ["--progress", "none"])
    ours = read_png(output)
    beside = [ours] + ([numpy.median(list(others.values()), 0)] if others else []) + list(others.values())
    write_png(os.path.join(a.output, scene["name"] + "-beside.png"),
              numpy.concatenate([on_white(picture) for picture in beside], 1))
    return {"name": scene["name"], "command": words, "distance_db": distances(ours, others)}


def table(rows):
    """Markdown: a row for each scene, a column for each renderer."""
    names = [OURS] + sorted({name for row in rows for name in row["distance_db"]} - {OURS})

    def cell(row, name):
        value = row["distance_db"].get(name)
        return "" if value is None else "same" if value == -math.inf else "%.2f" % value
    lines = [["scene"] + names, ["---"] * (len(names) + 1)]
    lines += [[row["name"]] + [cell(row, name) for name in names] for row in rows]
    return "".join("| %s |\n" % " | ".join(line) for line in lines)


def main(words):
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("list", help="JSON list of scenes")
    parser.add_argument("pictures", help="folder of the other renderers' pictures")
    parser.add_argument("-o", "--output", required=True, help="folder of what is written; made if need be")
    parser.add_argument("--petzval", default="build/bin/petzval")
    parser.add_argument("--spp", type=int, default=256)
    parser.add_argument("--only", action="append", help="a scene by name; may be repeated")
    a = parser.parse_args(words)
    os.makedirs(a.output, exist_ok=True)
    scenes = [scene for scene in read_list(a.list) if not a.only or scene["name"] in a.only]
    if not scenes:
        sys.exit("%s: no such scene" % a.list)
    rows = [compare(scene, a) for scene in scenes]
    with open(os.path.join(a.output, "table.md"), "w", encoding="utf-8") as file:
        file.write(table(rows))
    with open(os.path.join(a.output, "table.json"), "w", encoding="utf-8") as file:
        # JSON has no infinity: null is "the same", an absent renderer had no picture.
        json.dump([{**row, "distance_db": {n: None if d == -math.inf else d
                                           for n, d in row["distance_db"].items() if d is not None}}
                   for row in rows], file, indent=1)
    print(table(rows), end="")


if __name__ == "__main__":
    main(sys.argv[1:])
