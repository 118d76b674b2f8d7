#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Denoised pictures against pictures that are not: error, FLIP and CPU time of views by name, as a table.

    denoised.py [--petzval PATH] [--scenes DIR] [--rows a,b] [--budget 60s] [--samples 64] [-o FOLDER]

Each view is one `petzval chart --axis noise`. The line of a view is at --samples, or at as many as its budget allowed.
The worst view comes first. docs/design/denoise.md explains the table.
"""
import argparse
import csv
import math
import os
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "peers"))
import rooms  # noqa: E402
import scenes  # noqa: E402

OPEN = ("cornell-box", "hotel-room", "many-lights", "lowpoly-village", "house-foliage", "damaged-helmet",
        "flight-helmet", "dispersion-test", "grass-field", "two-cylinder-engine")
ROOMS = tuple(rooms.SCENES)[:6]
FIRST_LIGHT, ORNAMENTS = (os.path.join(scenes.ASSETS, name) for name in ("first_light.glb", "ornaments.glb"))
LENSES = {
    "bokeh of small lamps": (ORNAMENTS, "--lens", "takumar-50mm-f1.2", "--focus", "0.6m",
                             "--look-at=0,0,-0.4,0,0,-1"),
    "coloured fringes": (ORNAMENTS, "--lens", "singlet:schott:N-SF11,0.7", "--fov", "16",
                         "--look-at=0,-0.1,0,0,-0.1,-1", "--focal-length", "200", "--fstop", "4", "--focus", "2m"),
    "blurred foreground": (FIRST_LIGHT, "--lens", "kodak-petzval-100mm-f2", "--look-at=0,1.303,2.484,0,1.09,0",
                           "--focus", "3.5m"),
    "fine textures": (FIRST_LIGHT, "--lens", "takumar-50mm-f1.2", "--fstop", "4", "--focus", "1m"),
    "motion blur": (os.path.join(scenes.ASSETS, "wheels.glb"), "--lens", "double-gauss-100mm-f2", "--at", "0.1s",
                    "--shutter", "180deg"),
    "glass": (os.path.join(scenes.ASSETS, "glass.glb"), "--camera", "ice", "--lens", "double-gauss-100mm-f2"),
    "caustic": (os.path.join(scenes.ASSETS, "gem.glb"), "--lens", "double-gauss-100mm-f2"),
}
FOLIAGE = ("--lens", "takumar-50mm-f1.2", "--focus", "1.2m", "--method", "fit=fov")


def view_of(row):
    return (row.scene, "--fov", str(row.vfov_deg), "--look-at=" + ",".join(map(str, [*row.eye, *row.target])),
            *(("--env", row.sky) if row.sky else ()))


def views(open_scenes, folder):
    """Name and words of all views that are there; writes the rooms into the folder."""
    rows = scenes.all_rows(open_scenes and os.path.abspath(open_scenes), folder)
    found = {name: rows[name] and view_of(rows[name]) for name in (*OPEN, *ROOMS)}
    found.update(LENSES)
    foliage = rows["house-foliage"]
    found["foliage"] = foliage and (*view_of(foliage), *FOLIAGE)
    return found


def wanted(rows, open_scenes, folder):
    """Name and words of the views that --rows names, or of all; says which are skipped."""
    found = views(open_scenes, os.path.join(folder, "rooms"))
    for name in rows.split(",") if rows else found:
        if name not in found:
            sys.exit("--rows: no view %s; there are %s" % (name, ", ".join(found)))
        if found[name]:
            yield name, found[name]
        else:
            print("skipped: %s, not in the folder of --scenes" % name)


def say_mean(lines, of):
    if lines:
        print("\ngeometric mean of the %s: %.3g" % (of, math.exp(sum(math.log(r) for r, _ in lines) / len(lines))))


def means(path):
    """Means over the seeds of the points of a report: {method: {samples: {column: mean}}}."""
    found = {}
    with open(path) as file:
        for line in csv.DictReader(file):
            point = found.setdefault(line["method"], {}).setdefault(int(line["samples"]), {})
            for column in ("cpu_s", "symmetric_mse", "flip", "believed"):
                point.setdefault(column, []).append(float(line[column]))
    return {method: {samples: {column: sum(v) / len(v) for column, v in point.items()}
                     for samples, point in points.items()} for method, points in found.items()}


def measure(a, words, report):
    command = [a.petzval, "chart", *words, "--axis", "noise", "--size", a.size, "--budget", a.budget, "--quiet",
               "-o", report]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                          text=True)
    if done.returncode == 2 and "--budget" in done.stderr:
        return {}
    if done.returncode:
        sys.exit("exit status %d of %s:\n%s" % (done.returncode, " ".join(command), done.stderr))
    return means(os.path.join(report, "points.csv"))


def line(name, points, most):
    """Ratio of the squared errors, and the line of a view; at the most samples too."""
    plain, denoised = points["samples"], points["denoised"]
    both = sorted(set(plain) & set(denoised))
    at = max((n for n in both if n <= most and plain[n]["believed"]), default=both[0])
    last = max(n for n in both if plain[n]["believed"] or n == at)

    def ratio(n, *columns):
        return math.prod(denoised[n][c] / plain[n][c] for c in columns)
    def errors(n):  # near the reference's own error, which both hold, the ratio is too large
        return "%s%.2g" % ("" if denoised[n]["believed"] else "at most ", ratio(n, "symmetric_mse"))
    return ratio(at, "symmetric_mse"), "| %s | %d | %s | %.3g, %.3g | %.2f | %.2g | %d: %s |" % (
        name, at, errors(at), plain[at]["flip"], denoised[at]["flip"], ratio(at, "cpu_s"),
        ratio(at, "cpu_s", "symmetric_mse"), last, errors(last))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--petzval", default=os.path.join(HERE, "..", "..", "build", "bin", "petzval"))
    parser.add_argument("--scenes", metavar="DIR", help="folder of scenes that are not part of the project")
    parser.add_argument("--rows", help="names of views, with commas (default: all)")
    parser.add_argument("--size", default="192x108")
    parser.add_argument("--budget", default="60s", help="of each view")
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("-o", "--output", metavar="FOLDER", help="where the reports are kept")
    a = parser.parse_args()
    lines = []
    with tempfile.TemporaryDirectory() as folder:
        for name, words in wanted(a.rows, a.scenes, folder):
            points = measure(a, words, os.path.join(a.output or folder, name.replace(" ", "_")))
            if not points:
                print("skipped: %s, as --budget is too small for it" % name)
                continue
            lines.append(line(name, points, a.samples))
            print(lines[-1][1], flush=True)
    print("\n| view | samples | symmetric MSE, over that without | FLIP without, with | CPU time | error x CPU time | "
          "at the most samples |\n|%s" % ("---|" * 7))
    print("\n".join(text for _, text in sorted(lines, reverse=True)))
    say_mean(lines, "symmetric MSE, bounds as they are")


if __name__ == "__main__":
    main()
