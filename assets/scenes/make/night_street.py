#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes night_street.glb: a street at night, whose small lamps become discs or stars by the iris.

    python3 make/night_street.py night_street.glb

The standard library alone. Metres, y up.
"""
import math
import random
import sys

from low_sun import box, dull, write_glb


def ball(middle, radius, steps=8):
    """Triangles of a ball, outside first."""
    def at(i, j):
        up, around = math.pi * i / steps, math.pi * j / steps
        return tuple(m + radius * d for m, d in zip(middle, (math.sin(up) * math.cos(around), math.cos(up),
                                                             -math.sin(up) * math.sin(around))))
    out = []
    for i in range(steps):
        for j in range(2 * steps):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            out += [a, b, c] if i < steps - 1 else []
            out += [a, c, d] if i > 0 else []
    return out


def glow(colour, nits):
    """Material that shines."""
    return {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}, "emissiveFactor": colour,
            "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": nits}}}


def main(path):
    random.seed(5)
    walls, posts, windows, warm, cool = [], [], [], [], []
    for side in (-1, 1):
        z = -3.0
        while z > -70:
            wide, high = random.uniform(6, 11), random.uniform(7, 15)
            near, far = side * 15.0, side * 19.0
            walls += box((min(near, far), 0, z - wide + 0.1), (max(near, far), high, z))
            for floor in range(int(high / 2.8)):
                for k in range(int(wide / 1.7)):
                    if random.random() < 0.35:
                        y, w = 1.2 + 2.8 * floor, z - 0.9 - 1.7 * k
                        x = near - side * 0.01
                        a, b, c, d = (x, y, w), (x, y, w - 0.9), (x, y + 1.3, w - 0.9), (x, y + 1.3, w)
                        windows += [a, b, c, a, c, d] if side > 0 else [a, c, b, a, d, c]
            z -= wide
        for i, z in enumerate((-7, -13, -21, -32, -48)):
            x = side * 3.6
            posts += box((x - 0.05, 0, z - 0.05), (x + 0.05, 3.5, z + 0.05))
            (cool if (i + (side > 0)) % 2 else warm).extend(ball((x, 3.62, z), 0.07))
    signal = [(-2.9, 2.5, -17), (2.9, 2.5, -26)]
    posts += [c for x, y, z in signal for c in box((x - 0.12, 0, z - 0.3), (x + 0.12, 2.3, z - 0.12))]
    ground = [(-30, 0, 4), (30, 0, 4), (30, 0, -90), (-30, 0, 4), (30, 0, -90), (-30, 0, -90)]
    write_glb(path, [("ground", dull((0.07, 0.07, 0.075), 0.35), ground), ("walls", dull((0.3, 0.24, 0.2)), walls),
                     ("posts", dull((0.04, 0.04, 0.045), 0.5), posts), ("windows", glow([1, 0.72, 0.38], 8), windows),
                     ("warm lamps", glow([1, 0.74, 0.42], 150000), warm),
                     ("cool lamps", glow([0.85, 0.93, 1], 150000), cool),
                     ("red", glow([1, 0.04, 0.02], 60000), ball(signal[0], 0.06)),
                     ("green", glow([0.05, 1, 0.35], 60000), ball(signal[1], 0.06))],
              [{"name": "front", "camera": 0, "translation": [0.3, 1.6, 2]}], 0.52, generator="make/night_street.py")


if __name__ == "__main__":
    main(*sys.argv[1:])
