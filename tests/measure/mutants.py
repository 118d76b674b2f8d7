#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Breaks the product in small ways, one at a time, and sees whether the tests notice.

    tests/measure/mutants.py [--count 20] [--seed 1] [--minutes 3]

Draws places over all rooms with a fixed seed: a room by its lines, a line of code in it, one change of that line
(an operator, a condition, a constant, a bound). Each mutant is built in a copy of the checkout (build-mutants/tree),
where the programs of the tests that see the file run in the order of tests/CMakeLists.txt, lowest room first, until
one fails or the minutes for tests are over: of the clock, so keep the machine idle. Time for building does not
count. A mutant that hangs counts as survived. A mutant that does not compile is
drawn anew. Prints a line for each: killed by which test, or survived. Ends with the survivors as differences.
"""
import argparse
import os
import random
import re
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TREE = ROOT / "build-mutants" / "tree"
BUILD = TREE / "build"

# What is changed into what. Templates' brackets, includes and shifts of streams are kept out by the spaces.
CHANGES = [
    (r" < ", " <= "), (r" <= ", " < "), (r" > ", " >= "), (r" >= ", " > "),
    (r" < ", " > "), (r" == ", " != "), (r" != ", " == "),
    (r" && ", " || "), (r" \|\| ", " && "), (r"\bif \((?!const |auto |!|constexpr )", "if (!"), (r"!(?=[a-z_(])", ""),
    (r" \+ ", " - "), (r" - ", " + "), (r" \* ", " / "), (r" / ", " * "), (r" \+= ", " -= "),
    (r"std::min\(", "std::max("), (r"std::max\(", "std::min("),
    (r"\btrue\b", "false"), (r"\bfalse\b", "true"),
    (r"(?<![\w.\"])0\.5f?\b", "0.25f"), (r"(?<![\w.\"])1(?![\w.\"])", "2"), (r"(?<![\w.\"])0(?![\w.\"])", "1"),
    (r"\bcontinue;", ";"),
]


def rooms():
    """Folders that CMakeLists.txt names as rooms."""
    return re.findall(r"^petzval_room\((\S+)", (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE)


def code_lines(path):
    """Numbers of lines that hold code which may be changed: no comments, no declarations of what is included."""
    numbers, in_comment = [], False
    for number, line in enumerate(path.read_text().splitlines()):
        text = line.strip()
        in_comment = in_comment or text.startswith("/*")
        plain = not in_comment and not text.startswith(("//", "#", "static_assert", "using ", "namespace "))
        if "*/" in text:
            in_comment = False
        if plain and text:
            numbers.append(number)
    return numbers


def places():
    """(file, line) of all code, room by room, so that a room is drawn as often as it has lines."""
    return [(path.relative_to(ROOT), number)
            for room in rooms()
            for path in sorted((ROOT / room).glob("*.h")) + sorted((ROOT / room).glob("*.cpp"))
            for number in code_lines(path)]


def mutant(draw, all_places):
    """(file, line, old text, new text), drawn anew until the line has something to change."""
    while True:
        path, number = draw.choice(all_places)
        line = (ROOT / path).read_text().splitlines()[number]
        code = line.split("//")[0]
        options = [(match, new) for old, new in CHANGES for match in re.finditer(old, code)
                   if code[:match.start()].count('"') % 2 == 0]
        if options:
            match, new = draw.choice(options)
            changed = line[:match.start()] + new + line[match.end():]
            # A condition that is negated whole needs its brackets.
            if new == "if (!":
                end = changed.rfind(")")
                if changed.count("(") != changed.count(")") or end < 0 or "{" in changed[match.start():end]:
                    continue
                begin = match.start() + len("if (!")
                depth, close = 1, begin
                while depth:
                    depth += {"(": 1, ")": -1}.get(changed[close], 0)
                    close += 1
                changed = changed[:begin] + "(" + changed[begin:close - 1] + ")" + changed[close - 1:]
            return path, number, line, changed


def test_programs():
    """Names of test programs in the order of tests/CMakeLists.txt: from the lowest room up."""
    text = (ROOT / "tests" / "CMakeLists.txt").read_text()
    return [folder.replace("/", "_") + "_test" for folder in re.findall(r"^petzval_tests\((\S+)", text, re.MULTILINE)]


def ninja(*arguments, **options):
    return subprocess.run(["ninja", "-C", str(BUILD), *arguments], capture_output=True, text=True, **options)


def prepare():
    """A clean copy of what is committed, configured and built: what is broken there is broken nowhere else."""
    if not TREE.exists():
        subprocess.run(["git", "clone", "--quiet", "--no-checkout", str(ROOT), str(TREE)], check=True)
        shared = ROOT.parent / "shared"
        if shared.exists():
            (TREE.parent / "shared").symlink_to(shared)
    head = subprocess.run(["git", "-C", str(ROOT), "rev-parse", "HEAD"], check=True, capture_output=True, text=True)
    subprocess.run(["git", "-C", str(TREE), "fetch", "--quiet"], check=True)
    subprocess.run(["git", "-C", str(TREE), "checkout", "--quiet", "--force", "--detach", head.stdout.strip()],
                   check=True)
    subprocess.run(["cmake", "--preset", "release"], cwd=TREE, check=True, capture_output=True)
    subprocess.run(["ninja", "-C", str(BUILD)], check=True, stdout=subprocess.DEVNULL)


def run(program, seconds):
    """None where the tests pass or the seconds are over; else the name of a test that failed, or 'a crash'."""
    environment = {**os.environ, "OCIO": "", "GTEST_FAIL_FAST": "1", "GTEST_BRIEF": "1"}
    shards = [subprocess.Popen([str(BUILD / "bin" / program)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               text=True, errors="replace", cwd=BUILD,
                               env={**environment, "GTEST_TOTAL_SHARDS": "2", "GTEST_SHARD_INDEX": str(index)})
              for index in (0, 1)]
    deadline = time.monotonic() + seconds
    found = None
    for shard in shards:
        try:
            output, _ = shard.communicate(timeout=max(0.1, deadline - time.monotonic()))
        except subprocess.TimeoutExpired:
            shard.kill()
            output, _ = shard.communicate()
            failed = re.search(r"\[  FAILED  \] (\S+)", output)
            found = found or (failed and failed[1])
            continue
        if shard.returncode != 0 and not found:
            failed = re.search(r"\[  FAILED  \] (\S+)", output)
            found = failed[1] if failed else "a crash"
    return found


def killer_of(minutes):
    """What kills the mutant that lies in the tree: None if nothing, 'does not compile' if it is none."""
    left = minutes * 60
    seen = [program for program in test_programs() if "no work to do" not in ninja("-n", program).stdout]
    for program in seen:
        if ninja("-k", "1", program, "petzval").returncode != 0:
            return "does not compile"
        start = time.monotonic()
        failed = run(program, left)
        left -= time.monotonic() - start
        if failed:
            return f"{program}: {failed}"
        if left <= 0:
            break
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=20, help="mutants that compile")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, default=3, help="for the tests of one mutant")
    parser.add_argument("--show", action="store_true", help="print what would be changed, and end")
    arguments = parser.parse_args()
    draw, all_places = random.Random(arguments.seed), places()
    if not arguments.show:
        prepare()
    survivors, number, unfit = [], 0, 0
    while number < arguments.count:
        path, line, old, new = mutant(draw, all_places)
        label = f"{path}:{line + 1}"
        if arguments.show:
            number += 1
            print(f"{number:3} {label}\n    - {old.strip()}\n    + {new.strip()}")
            continue
        target = TREE / path
        whole = target.read_text()
        lines = whole.splitlines(keepends=True)
        lines[line] = new + "\n"
        target.write_text("".join(lines))
        try:
            killer = killer_of(arguments.minutes)
        finally:
            target.write_text(whole)
        if killer == "does not compile":
            unfit += 1
            continue
        number += 1
        print(f"{number:3} {'killed  ' if killer else 'SURVIVED'} {label}  {killer or ''}", flush=True)
        if not killer:
            survivors.append(f"{label}\n    - {old.strip()}\n    + {new.strip()}")
    if not arguments.show:
        print(f"{number} mutants, {len(survivors)} survived; {unfit} did not compile\n" + "\n".join(survivors))
    return 0


if __name__ == "__main__":
    sys.exit(main())
