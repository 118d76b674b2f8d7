#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the rooms of the code from the lines petzval_room of CMakeLists.txt (needs graphviz):

    tests/make/rooms.py | tred | dot -Tsvg > docs/pictures/rooms.svg
    tests/make/rooms.py --check docs/pictures/rooms.svg

An arrow leads from a room to one that it knows. tred takes out those that follow from others.
--check fails where the picture has other rooms than the build.
"""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FLOORS = {"apps": "#f3e3d3", "io": "#dfe9f3", "integrator": "#e3f0df", "camera": "#f3eecb", "core": "#ebe3f0"}


def rooms():
    """Dict of each room's list of rooms and libraries that it knows."""
    text = re.sub(r"#.*", "", (ROOT / "CMakeLists.txt").read_text())
    found = {}
    for call in re.findall(r"\n *petzval_room\(([^)]*)\)", text):
        name, *rest = call.split()
        found[name] = [word for word in rest if word not in ("MODULE", "SHOWS", "USES")]
    return found


def dot(known):
    """Text of the graph, for tred and dot."""
    lines = ["digraph rooms {", '  rankdir=TB; nodesep=0.12; ranksep=0.45; fontname="DejaVu Sans"',
             '  node [shape=box, style="filled,rounded", fontname="DejaVu Sans", fontsize=11, height=0.3]',
             '  edge [color="#7a7a7a", arrowsize=0.5]']
    for floor, colour in FLOORS.items():
        lines.append(f'  subgraph "cluster_{floor}" {{ label="{floor}"; labeljust=l; color="#bbbbbb"')
        for room, knows in known.items():
            if room.split("/")[0] == floor:
                libraries = [re.sub(r".*::|\$\{CMAKE_DL_LIBS\}", "", name) for name in knows if name not in known]
                label = (room.removeprefix(floor + "/") + "".join(rf"\n{name}" for name in libraries if name))
                lines.append(f'    "{room}" [label="{label}", fillcolor="{colour}"]')
        lines.append("  }")
    for room, knows in known.items():
        lines += [f'  "{room}" -> "{other}"' for other in knows if other in known]
    return "\n".join(lines + ["}"])


def main():
    known = rooms()
    if sys.argv[1:2] != ["--check"]:
        print(dot(known))
        return
    drawn = set(re.findall(r'class="node">\s*<title>([^<]+)</title>', Path(sys.argv[2]).read_text()))
    if drawn != set(known):
        sys.exit(f"{sys.argv[2]} has other rooms than CMakeLists.txt: {sorted(drawn ^ set(known))}; draw it anew: "
                 "tests/make/rooms.py | tred | dot -Tsvg")


if __name__ == "__main__":
    main()
