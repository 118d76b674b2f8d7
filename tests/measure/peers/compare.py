#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Petzval against Blender Cycles on one machine in one run, as a chart of cost against error.

    compare.py SCENE --look-at=ex,ey,ez,tx,ty,tz --fov DEG [--env HDR]
               [--lens-radius M --focus M] [--size 320x240] -o REPORT

Same camera, light, bounces and box filter; the programs take turns. The cost of a render is its
samples times the CPU time of a sample, from a long less a short render of the same seed: loading,
building and start-up cancel. Each program is held against its own converged picture, as the two do
not share a surface model: the error is noise, which is what sampling is for. Skips, saying so,
where Blender is not installed.
"""
import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
BIN = os.path.join(HERE, "..", "..", "..", "build", "bin")
PARTS, FIRST_REFERENCE_SEED = 4, 1000000


def petzval(a, samples, seed, output):
    command = [os.path.join(BIN, "petzval"), "render", a.scene, "--size", a.size, "--spp", str(samples),
               "--filter", "box", "--look-at=" + a.look_at, "--fov", str(a.fov), "--threads", str(a.threads),
               "--max-depth", str(a.bounces + 1), "--seed", str(seed), "--quiet",
               "--stats", output + ".json", "-o", output]
    if a.env:
        command += ["--env", a.env]
    if a.lens_radius > 0:
        command += ["--lens", "thin", "--lens-radius", str(a.lens_radius), "--focus", "%gm" % a.focus]
    else:
        command += ["--lens", "pinhole"]
    subprocess.run(command, check=True)
    with open(output + ".json") as file:
        return json.load(file)["render_cpu_s"]


def cycles(a, samples, seed, output):
    width, height = map(int, a.size.split("x"))
    wanted = {"scene": a.scene, "output": output, "width": width, "height": height, "samples": samples,
              "seed": seed % 2**31, "threads": a.threads, "bounces": a.bounces, "fov_deg": a.fov,
              "look_at": [float(x) for x in a.look_at.split(",")], "environment": a.env,
              "lens_radius_m": a.lens_radius, "focus_m": a.focus, "pattern": a.pattern}
    # Blender takes Python's modules from beside the first python3 in the path.
    text = subprocess.run(["blender", "-b", "--factory-startup", "-noaudio", "-P", os.path.join(HERE, "cycles.py"),
                           "--", json.dumps(wanted)], env=dict(os.environ, PATH="/usr/bin:/bin"), text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT).stdout
    for line in text.splitlines():
        if line.startswith("CYCLES render_cpu_s="):
            return float(line.split("=")[1])
    sys.exit("no render_cpu_s from Blender:\n" + text[-2000:])


def measure(a, folder):
    programs = {"petzval": petzval, "cycles": cycles}
    levels = [a.least << i for i in range(0, 32, a.step) if a.least << i <= a.most]
    file = lambda *words: os.path.join(folder, "-".join(map(str, words)) + ".exr")
    reference = {name: [] for name in programs}
    for part in range(PARTS):
        for name, render in programs.items():
            render(a, a.reference_samples // PARTS, FIRST_REFERENCE_SEED + part, file(name, "reference", part))
            reference[name].append(file(name, "reference", part))
    spent = {}
    for seed in range(a.seeds):
        for samples in levels:
            for name, render in programs.items():
                spent[name, samples, seed] = render(a, samples, seed, file(name, samples, seed))
    methods = []
    for name in programs:
        per_sample = [(spent[name, levels[-1], seed] - spent[name, levels[0], seed]) / (levels[-1] - levels[0])
                      for seed in range(a.seeds)]
        points = [{"samples": samples,
                   "seeds": [{"seed": seed, "cpu_s": per_sample[seed] * samples, "file": file(name, samples, seed)}
                             for seed in range(a.seeds)]} for samples in levels]
        methods.append({"name": name, "reference": reference[name], "points": points})
    return methods


def summary(points):
    """One line: speed, error and efficiency of Petzval over those of Cycles at the most samples."""
    case = points["cases"][0]
    ours, theirs = ({key: method["points"][-1][key]["mean"] for key in ("cpu_s", "relative_mse", "efficiency_per_s")}
                    for method in case["methods"])
    return "%s: speed %.2f, error of Cycles over ours %.2f, efficiency %.2f" % (
        case["name"], theirs["cpu_s"] / ours["cpu_s"], theirs["relative_mse"] / ours["relative_mse"],
        ours["efficiency_per_s"] / theirs["efficiency_per_s"])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("--look-at", required=True)
    parser.add_argument("--fov", type=float, required=True, help="vertical, degrees")
    parser.add_argument("--env")
    parser.add_argument("--lens-radius", type=float, default=0, help="m; 0 is a pinhole")
    parser.add_argument("--focus", type=float, default=1, help="m")
    parser.add_argument("--size", default="320x240")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--bounces", type=int, default=12)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--least", type=int, default=4, help="samples of each pixel")
    parser.add_argument("--most", type=int, default=64)
    parser.add_argument("--step", type=int, default=2, help="levels are 2^step apart")
    parser.add_argument("--reference-samples", type=int, default=2048)
    parser.add_argument("--pattern", choices=("SOBOL", "PROGRESSIVE_MULTI_JITTER"), default="SOBOL",
                        help="Cycles' points: Sobol scrambled after Owen (Burley 2020), or its default")
    parser.add_argument("-o", "--output", required=True)
    a = parser.parse_args()
    if not shutil.which("blender"):
        print("skipped: no blender here (apt-get install blender python3-numpy)")
        return
    width, height = map(int, a.size.split("x"))
    with tempfile.TemporaryDirectory() as folder:
        name = os.path.basename(os.path.dirname(os.path.abspath(a.scene)))
        camera = "thin lens of %g m radius" % a.lens_radius if a.lens_radius > 0 else "pinhole"
        manifest = {"scene": a.scene, "name": name + ("-thin" if a.lens_radius > 0 else ""),
                    "title": "Petzval and Blender Cycles: %s, %s" % (name, camera),
                    "width": width, "height": height, "threads": a.threads, "seeds": a.seeds,
                    "remarks": ["Each program is held against its own converged picture: their surface models differ",
                                "CPU time of the samples only, from a long less a short render",
                                "%d bounces, box filter; Petzval: Sobol points scrambled after Owen; Cycles: %s" %
                                (a.bounces, a.pattern)],
                    "methods": measure(a, folder)}
        path = os.path.join(folder, "manifest.json")
        with open(path, "w") as file:
            json.dump(manifest, file)
        subprocess.run([os.path.join(BIN, "peers_chart"), path, a.output], check=True)
    with open(os.path.join(a.output, "points.json")) as file:
        print(summary(json.load(file)))


if __name__ == "__main__":
    main()
