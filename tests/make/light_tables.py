#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the tables of docs/measured/light.md, and fails where a budget does not add up to 1 within 0.1 %.

    tests/make/light_tables.py build/bin/petzval
"""
import csv
import re
import subprocess
import sys
import tempfile

COATINGS = ["uncoated", "mgf2", "v-coat", "broadband"]
PARTS = ["in order", "2 reflections", "more", "stopped", "absorbed", "returned"]
program = sys.argv[1]


def lens(*words):
    return subprocess.run([program, "lens", *words], check=True, capture_output=True, text=True).stdout


names = [row.split()[0] for row in lens("list").splitlines()[2:]]
budgets, glares, checked = {}, {}, 0
with tempfile.TemporaryDirectory() as folder:
    for name in names:
        for coating in ["ideal", *COATINGS]:
            lens("budget", name, "--coating", coating, "--csv", f"{folder}/a.csv")
            for row in csv.DictReader(open(f"{folder}/a.csv")):
                shares = {part: float(row[part]) for part in PARTS}
                checked += 1
                if abs(sum(shares.values()) - 1) > 1e-3:
                    sys.exit(f"{name}, {coating}: {row} adds up to {sum(shares.values())}")
                if float(row["field_deg"]) == 0:
                    sums = budgets.setdefault((name, coating), dict.fromkeys(PARTS, 0))
                    for part in PARTS:
                        sums[part] += shares[part] / 3
            if coating == "ideal":
                continue
            text = lens("ghosts", name, "--coating", coating)
            glare = re.search(r"white field: (\S+) %", text).group(1)
            best = re.search(r"coating of surface (\d+)", text).group(1)
            glares[name, coating] = float(glare), best
print(f"{checked} budgets add up to 1.\n")
print("| lens | " + " | ".join(PARTS) + " |\n" + "|---" * (len(PARTS) + 1) + "|")
for name in names:
    cells = [" / ".join(f"{100 * budgets[name, c][part]:.2f}" for c in ("uncoated", "broadband")) for part in PARTS]
    print(f"| `{name}` | " + " | ".join(cells) + " |")
print("\n| lens | " + " | ".join(COATINGS) + " | surface |\n" + "|---" * (len(COATINGS) + 2) + "|")
for name in names:
    cells = [f"{glares[name, c][0]:.2f}" for c in COATINGS]
    print(f"| `{name}` | " + " | ".join(cells) + f" | {glares[name, 'mgf2'][1]} |")
