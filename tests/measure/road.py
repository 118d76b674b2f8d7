#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Counts the road of a sample: the files of the product that one must read to follow it.

    tests/measure/road.py build/bin/petzval            # both roads, file by file
    tests/measure/road.py --check build/bin/petzval    # fails where a road is longer than LONGEST

A file is on the road if callgrind counts an instruction of one of its lines while SampleBatch::render()
runs, that is from the film point to the film: not while a scene is loaded, nor in prepasses, nor in the
loop over tiles. It counts with all its lines. Code that was inlined counts for the file in which it is
written. The picture is the built-in scene, 64x36 pixels, 16 samples a pixel, one thread,
without rays to targets. Rooms core,
camera and integrator are compiled with line numbers for this (CMakeLists.txt).

Exit status 77: there is no valgrind, or it does not know this processor.
"""
import argparse
import collections
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
ROADS = {
    "thin lens": ["--fstop", "2", "--focus", "1.5m"],
    "Takumar": ["--lens", "takumar-50mm-f1.2", "--focus", "1m"],
}
LONGEST = {"thin lens": (50, 5526), "Takumar": (71, 8657)}  # files, lines
PRODUCT = re.compile(r"(?:.*/)?((?:core|camera|integrator|io|apps)/\S+)$")
SAMPLING = "petzval::integrator::SampleBatch<petzval::integrator::PathTracer<petzval::Bvh, petzval::integrator::Unwatched> >::render()"


def skip(reason):
    print(f"{reason}: the road of a sample is not counted")
    sys.exit(77)


def profile(program, options, out):
    command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", "--dump-line=yes",
               "--compress-strings=no", "--compress-pos=no", f"--toggle-collect={SAMPLING}",
               program, "render", str(ROOT / "assets/scenes/first_light.glb"), "--size", "64x36", "--method", "targets=off", "--spp", "16",
               "--threads", "1", *options, "--quiet", "-o", str(out) + ".exr"]
    done = subprocess.run(command, capture_output=True, text=True)
    if "Unrecognised instruction" in done.stderr:
        skip("valgrind does not know an instruction of this processor")
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stderr}")


def costs(out):
    """Counts of instructions by file of the product and by line, of those that ran."""
    lines = collections.defaultdict(collections.Counter)
    name, skip = "", False
    for row in open(out):
        if row.startswith(("fl=", "fi=", "fe=")):
            found = PRODUCT.match(row[3:].strip())
            name = found.group(1) if found else ""
            if name and not (ROOT / name).is_file():
                sys.exit(f"{name} is not there any more: build the program again")
        elif row.startswith("calls="):
            skip = True  # the next row has what the called function took
        elif row[0].isdigit():
            if name and not skip:
                line, cost = row.split()
                lines[name][int(line)] += int(cost)
            skip = False
    return lines


def total(out):
    return int(re.search(r"^(?:summary|totals): (\d+)", pathlib.Path(out).read_text(), re.M).group(1))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--check", action="store_true", help="print sums only, and fail where a road is too long")
    parser.add_argument("--instructions", action="store_true", help="print how many instructions a sample takes")
    asked = parser.parse_args()
    if not shutil.which("valgrind"):
        skip("there is no valgrind")
    too_long = False
    with tempfile.TemporaryDirectory() as folder:
        for road, options in ROADS.items():
            out = pathlib.Path(folder) / "callgrind.out"
            profile(asked.program.resolve(), options, out)
            lines = costs(out)
            length = {name: (ROOT / name).read_text().count("\n") for name in lines}
            if not asked.check:
                for name in sorted(lines):
                    print(f"{length[name]:6} {len(lines[name]):5} {sum(lines[name].values()):12}  {name}")
            files, all_lines = len(length), sum(length.values())
            run = sum(len(of) for of in lines.values())
            print(f"{road}: {files} files, {all_lines} lines, of which {run} ran")
            if asked.instructions:
                print(f"{road}: {total(out) / (64 * 36 * 16):.1f} instructions a sample")
            most_files, most_lines = LONGEST[road]
            if files < 20:
                sys.exit("so few files cannot be: was the program built without line numbers?")
            if asked.check and (files > most_files or all_lines > most_lines):
                print(f"{road}: more than {most_files} files, {most_lines} lines. Move what a plain sample does not "
                      "run to files of its own, or raise LONGEST and say why.")
                too_long = True
    sys.exit(too_long)


if __name__ == "__main__":
    main()
