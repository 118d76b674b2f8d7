#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the scene of a face that talks, smiles and blinks: python3 face.py ../face.glb

The head is one body of three morph targets, positions and normals. Within this script a head is 2 units high about the
origin and looks along +z; in the scene a unit is HEAD_M metres. Angles are azimuth a from the front, positive towards
+x, and elevation e. RGB 1 is 1 nit.
"""
import math

from first_light_glb import then, turn, write_scene
from first_light_shapes import Shape, add, arc, cross, dot, lathe, sphere, sub, times, unit
from first_light_textures import png
from gem import look, panel
from motion import MovingGlb
from wheels import codes, picture

X, Y = (1, 0, 0), (0, 1, 0)
HEAD_M, TALK_S = 0.11, 2.0
COLUMNS = 40
MOUTH_E, MOUTH_A = -29, 21
CHIN_ROWS = (-90, -78, -67, -58, -51, -45, -40, -36.5, -33.5, -31)
FACE_ROWS = (-27, -24.5, -21.5, -17.5, -13, -8, -3, 2, 7, 12, 17, 21, 24.5, 28, 32, 38, 46, 57, 72, 90)
POCKET = ((0.07, -0.03), (0.4, -0.07), (0.4, 0.05), (0.07, 0.03))  # depth and height of the inside of the mouth
EYE_A, EYE_E, EYE_R, BROW_E = 22, 9, 0.20, 30
FACES = ("smile", "jaw open", "brows up")


def smoothstep(low, high, x):
    t = min(1.0, max(0.0, (x - low) / (high - low)))
    return t * t * (3 - 2 * t)


def hill(a, e, at_a, at_e, wide, high):
    """A smooth hill on both sides of the face."""
    return sum(math.exp(-((a - s * at_a) / wide) ** 2 - ((e - at_e) / high) ** 2) for s in ((1, -1) if at_a else (1,)))


def opening(a):
    """1 in the middle of the mouth, 0 at its corners and beyond."""
    return max(0.0, 1 - (a / MOUTH_A) ** 2)


def skin(a, e):
    """A point of the head at rest."""
    ca, sa, ce, se = (f(math.radians(v)) for v in (a, e) for f in (math.cos, math.sin))
    n = (ce * sa, se, ce * ca)
    lips = math.exp(-(a / (MOUTH_A * 0.95)) ** 4)
    out = (0.23 * hill(a, e, 0, -9, 7.5, 7) + 0.10 * hill(a, e, 0, 2, 6, 11) - 0.10 * hill(a, e, EYE_A, EYE_E, 12, 10) +
           0.06 * hill(a, e, 36, -13, 16, 13) + 0.05 * hill(a, e, EYE_A, BROW_E - 2, 15, 6) +
           0.07 * hill(a, e, 0, -54, 16, 11) +
           0.055 * lips * (math.exp(-((e - MOUTH_E - 3.2) / 2.8) ** 2) + math.exp(-((e - MOUTH_E + 3.6) / 3.2) ** 2)))
    jaw = 1 - 0.2 * smoothstep(0, -75, e)
    return add((0.82 * jaw * n[0], n[1], 0.9 * n[2]), times(n, out))


def moved(face, p, a, e, upper):
    """Where a point of the head goes in a face. upper: it is above the mouth."""
    if face == "smile":
        corner = [hill(a - s * MOUTH_A, e, 0, MOUTH_E, 12, 12) for s in (1, -1)]
        g, middle = sum(corner), hill(a, e, 0, MOUTH_E, 11, 9)
        p = add(p, ((corner[0] - corner[1]) * 0.10, 0.15 * g - 0.05 * middle, -0.06 * g))
        return add(p, times(unit(p), 0.07 * hill(a, e, 36, -14, 15, 11)))
    if face == "jaw open":
        mask, w = smoothstep(-10, -47, e), opening(a)
        mask = mask * (1 - w) if upper else mask + (1 - mask) * w
        mask *= (1 - smoothstep(40, 105, abs(a))) * smoothstep(-95, -62, e)
        angle = math.radians(19 * mask)
        y, z = p[1] + 0.12, p[2] + 0.1
        c, s = math.cos(angle), math.sin(angle)
        return (p[0] * (1 - 0.08 * mask), c * y - s * z - 0.12, s * y + c * z - 0.1)
    if face == "brows up":
        return add(p, (0, 0.13 * hill(a, e, EYE_A - 4, BROW_E, 20, 9), 0))
    return p


def column(s):
    """Azimuth of a place from -1 to 1 around the head: most of them are in the face."""
    return 180 * (0.55 * s + 0.45 * s ** 3)


def head(face):
    """The skin and the inside of the mouth in a face: Shapes with the same vertices for each."""
    rows = [(e, False, None) for e in CHIN_ROWS] + [(MOUTH_E, False, None)]
    rows += [(MOUTH_E, k > 1, pocket) for k, pocket in enumerate(POCKET)]
    rows += [(MOUTH_E, True, None)] + [(e, True, None) for e in FACE_ROWS]
    low, high = len(CHIN_ROWS), len(CHIN_ROWS) + len(POCKET) + 1
    points, rest, uvs, same = [], [], [], []
    for i, (e, upper, pocket) in enumerate(rows):
        for j in range(COLUMNS + 1):
            s = 2 * j / COLUMNS - 1
            a = column(s)
            p = skin(a, e)
            if pocket:
                w = math.sqrt(opening(a))
                p = add(p, (-0.3 * p[0] * w * pocket[0], pocket[1] * w, -pocket[0] * w))
            rest.append(p)
            points.append(moved(face, p, a, e, upper))
            uvs.append(((s + 1) / 2, (90 - e) / 180))
            # Vertices that share a normal: at the poles, at the seam, and where the mouth has ended.
            pole = i in (0, len(rows) - 1)
            same.append((low if low < i <= high and not opening(a) else i, 0 if pole else j % COLUMNS))
    parts = {True: [], False: []}
    sums = {key: (0, 0, 0) for key in same}
    for i in range(len(rows) - 1):
        for j in range(COLUMNS):
            q = i * (COLUMNS + 1) + j
            for t in ((q, q + 1, q + COLUMNS + 2), (q, q + COLUMNS + 2, q + COLUMNS + 1)):
                def area(at):
                    return cross(sub(at[t[1]], at[t[0]]), sub(at[t[2]], at[t[0]]))
                if dot(area(rest), area(rest)) > 1e-16:
                    parts[low <= i < high].append(t)
                    for k in t:
                        sums[same[k]] = add(sums[same[k]], area(points))
    shapes = []
    for inside in (False, True):
        used = sorted({k for t in parts[inside] for k in t})
        number = {k: n for n, k in enumerate(used)}
        shape = Shape()
        shape.positions, shape.uvs = [points[k] for k in used], [uvs[k] for k in used]
        shape.normals = [unit(sums[same[k]]) for k in used]
        shape.indices = [number[k] for t in parts[inside] for k in t]
        shapes.append(shape)
    return shapes


def complexion(size=256):
    """The skin's colours: blush, lips, brows, freckles."""
    colours = [codes(c) for c in ("#e9b793", "#e07f68", "#b5403c", "#4b1713", "#4a2b1a")]
    freckles = [(a, e) for a, e in ((27, -6), (31, -9), (35, -5), (24, -11), (39, -10), (33, -13), (29, -2.5))]
    rows = []
    for y in range(size):
        row = []
        for x in range(size):
            a, e = column(2 * (x + 0.5) / size - 1), 90 - 180 * (y + 0.5) / size
            b, w = abs(a), max(0.0, 1 - (abs(a) / (MOUTH_A + 3)) ** 2)
            arch = BROW_E - 4 + 5 * (1 - ((b - 24) / 14) ** 2)
            brow = smoothstep(0.8, -0.8, abs(e - arch) - 2.9 + 0.06 * abs(b - 18)) * smoothstep(15.5, 13.5, abs(b - 23))
            spots = sum(math.exp(-((b - p) ** 2 + (e - q) ** 2) / 0.6) for p, q in freckles)
            layers = (0.55 * hill(a, e, 36, -13, 15, 10) + 0.5 * hill(a, e, 0, -9, 7, 6),
                      smoothstep(1.2, -0.6, abs(e - MOUTH_E + 0.4) - 6.2 * w ** 0.7) if w else 0.0,
                      smoothstep(1.3, 0.3, abs(e - MOUTH_E)) * smoothstep(0, 0.15, w),
                      max(brow, 0.45 * min(1, spots)))
            value = colours[0]
            for colour, weight in zip(colours[1:], layers):
                value = [v + (c - v) * weight for v, c in zip(value, colour)]
            row += [2 * min(127, round(v / 2)) for v in value]
        rows.append(row)
    return png(rows)


def facing(shape):
    """A body of revolution about y, turned to z."""
    shape.positions = [(x, -z, y) for x, y, z in shape.positions]
    shape.normals = [(x, -z, y) for x, y, z in shape.normals]
    return shape


def portrait(glb):
    skin_paint = glb.painted("skin", complexion(), 0.5)
    shapes = [head(face) for face in ("rest", *FACES)]
    mesh = glb.mesh("head", *zip(shapes[0], (skin_paint, glb.material("mouth", "#5a1014", 0.4))))
    glb.morph(mesh, list(FACES), [list(primitive) for primitive in zip(*shapes)])
    root = glb.node("figure", scale=HEAD_M)
    node = glb.node("head", parent=root, mesh=mesh)

    def put(name, shape, material, parent=node, **more):
        return glb.node(name, parent=parent, mesh=glb.mesh(name, (shape, material)), **more)
    rings = ["#0a0a0c"] * 6 + ["#2f6d8c"] * 7 + ["#173848"] + ["#f6f3ee"] * 50
    iris = picture(4, 64, lambda x, y: rings[y])
    ball = facing(lathe([[(max(r, 0.0), y) for r, y in arc((0, 0), EYE_R, -90, 90, 12)]], 20))
    lid = lathe([[(max(r, 0.0), y) for r, y in arc((0, 0), EYE_R * 1.07, 8, 90, 6)]], 20)
    white, flesh = glb.painted("eye", iris, 0.05), glb.material("lid", "#dba27f", 0.5)
    eye, lid, ear = (glb.mesh(*named) for named in (("eye", (ball, white)), ("lid", (lid, flesh)),
                                                    ("ear", (sphere(0.19, 8, 16), flesh))))
    lids = []
    for side in (1, -1):
        at = times(skin(side * EYE_A, EYE_E), 0.87)
        glb.node("eye", parent=node, mesh=eye, at=at, rotation=turn(Y, 5 * side))
        lids.append(glb.node("lid", parent=node, mesh=lid, at=at))
        glb.node("ear", parent=node, mesh=ear, at=(side * 0.82, -0.02, -0.02))
    teeth = lathe([[(0.30, -0.075), (0.31, 0), (0.30, 0.1)]], 24)
    put("teeth", teeth, glb.material("teeth", "#f3efe4", 0.15), at=add(skin(0, MOUTH_E), (0, 0.005, -0.42)))
    rib = picture(8, 4, lambda x, y: "#8f1f24" if x < 2 else "#c23037")
    knit = glb.node("knit", parent=node, at=(0, 0.30, -0.12), rotation=turn(X, -27))
    cap, band = lathe([arc((0, 0), 1, 0, 90, 10)], 32), lathe([arc((0.9, 0), 0.12, -90, 270, 10)], 32)
    for shape in (cap, band):
        shape.positions = [(0.88 * x, 0.95 * y, 0.98 * z) for x, y, z in shape.positions]
    cuff = picture(8, 4, lambda x, y: "#c9b78f" if x < 2 else "#f1e4c4")
    put("cap", cap, glb.painted("wool", rib, 0.95, (30, 1)), knit)
    put("band", band, glb.painted("cuff", cuff, 0.95, (36, 1)), knit)
    put("bobble", sphere(0.2, 8, 16), glb.material("bobble", "#f4ead0", 1.0), knit, at=(0, 1.08, 0))
    put("neck", lathe([[(0.36, -1.5), (0.34, -0.6)]], 24), glb.material("neck", "#d99f7c", 0.5), root)
    stripes = picture(4, 64, lambda x, y: "#e9dfc8" if y // 8 % 2 else "#23506e")
    put("jumper", lathe([[(1.45, -2.6), (1.4, -1.95), (1.2, -1.6), (0.75, -1.38), (0.5, -1.28), (0.48, -1.1)]], 40),
        glb.painted("jumper", stripes, 0.9), root)
    return node, lids


def talk(glb, node, lids):
    """A sentence, a gasp and a smile within 48 frames of 1/24 s; a nod besides."""
    frames = {0: (0.2, 0, 0), 3: (0.2, 0.55, 0.2), 6: (0.2, 0.1, 0.3), 9: (0.1, 0.7, 0), 12: (0.3, 0.15, 0),
              15: (0.1, 0.5, 0.2), 19: (0, 0, 0), 23: (0, 0, -0.2), 24: (0, 1, 1), 29: (0.1, 0.9, 1), 32: (1, 0.3, 0.3),
              40: (1, 0.2, 0.1), 48: (0.2, 0, 0)}
    glb.animate("talk", node, "weights", [f / 24 for f in frames], list(frames.values()))
    wide, shut = -24, 42
    blink = {0: wide, 16: wide, 18: shut, 20: wide, 24: wide - 14, 30: wide - 10, 34: wide + 10, 44: wide + 6, 48: wide}
    for lid in lids:
        glb.animate("talk", lid, "rotation", [f / 24 for f in blink], [turn(X, v) for v in blink.values()])
    pose = {0: (0, 0), 8: (3, 20), 16: (6, 14), 22: (6, -16), 25: (-7, -10), 32: (-3, 4), 40: (3, 6), 48: (0, 0)}
    glb.animate("nod", node, "rotation", [f / 24 for f in pose],
                [then(turn(X, pitch), turn(Y, yaw)) for pitch, yaw in pose.values()])


def build():
    glb = MovingGlb("face.py of Petzval")
    for name, fov, eye in (("front", 20, (0.03, 0.01, 0.95)), ("side", 22, (0.62, 0.06, 0.72))):
        glb.camera(name, fov, eye, look(eye, (0, 0.005, 0)))
    talk(glb, *portrait(glb))

    def light(name, at, size, colour, nits):
        glb.node(name, mesh=glb.mesh(name, (panel(at, (0, 0, 0), size, size),
                                            glb.material(name, "#000000", 1.0, emissive=colour, nits=nits))))
    light("key", (-0.75, 0.65, 0.85), 0.5, "#fff0dc", 24)
    light("fill", (1.0, 0.1, 0.8), 0.6, "#cfe0ff", 4)
    light("rim", (0.7, 0.6, -0.6), 0.4, "#ffd2a0", 16)
    wall = panel((0, 0, -0.9), (0, 0, 0), 6, 4)
    glb.node("wall", mesh=glb.mesh("wall", (wall, glb.material("wall", "#58a09c", 0.95))))
    return glb


if __name__ == "__main__":
    write_scene("face.py", build)
