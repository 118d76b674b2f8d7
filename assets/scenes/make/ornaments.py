#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the scene of sharp and blurred, ornaments before far lamps: python3 ornaments.py ../ornaments.glb

Metres, y up; the camera "front" stands at the origin and looks along -z; RGB 1 is 1 nit. What is at 1 m is seen on the
left, what is at 2 m on the right, twice as large, so that both look alike; lamps fill the whole 3:2 frame 6 m away.
"""
import math
import random

from first_light_glb import GlbWriter, write_scene
from first_light_shapes import Shape, lathe, rounded_box, sphere, tube
from first_light_textures import GLYPHS, png
from gem import panel

YFOV_DEG, ASPECT = 40, 1.5
NEAR_M, FAR_M = 1.0, 2.0
LAMP_M, LAMP_RADIUS_M, LAMP_COLUMNS, LAMP_ROWS = 6.0, 0.035, 11, 7
LAMP_COLOURS = ("#ffd9a0", "#ffb45c", "#ff5a3c", "#ffffff", "#5fd0ff", "#6a86ff", "#7fe05a", "#ff62b0")
LAMP_NITS = 10
BARS = 9


def bitmap(width, height, colour_at):
    """A PNG whose pixel x, y has the colour code triple colour_at(x, y)."""
    return png([[code for x in range(width) for code in colour_at(x, y)] for y in range(height)])


def chequers(dark, light, cells_x, cells_y, cell=16):
    return bitmap(cells_x * cell, cells_y * cell, lambda x, y: light if (x // cell + y // cell) % 2 else dark)


def figure(glyph, dark, light, dot=16):
    """A figure of 5 x 7 dots in a field of 11, with a border."""
    rows = [int(GLYPHS[glyph][i:i + 2], 16) for i in range(0, 14, 2)]

    def colour_at(x, y):
        i, j = x // dot - 3, y // dot - 2
        inside = 0 <= i < 5 and 0 <= j < 7
        edge = min(x, y, 11 * dot - 1 - x, 11 * dot - 1 - y) < dot * 0.75
        return dark if edge or (inside and rows[j] >> (4 - i) & 1) else light
    return bitmap(11 * dot, 11 * dot, colour_at)


def bars():
    """Black bars on white, BARS of them, upright."""
    cell = 16
    return bitmap((2 * BARS + 1) * cell, 8, lambda x, y: (235,) * 3 if x // cell % 2 == 0 else (12,) * 3)


def hang(glb, name, mesh, thread, at, size):
    """An ornament of this size on a thread that leaves the frame above."""
    glb.node(name, mesh=mesh, at=at, scale=size)
    glb.node(name + " thread", mesh=thread, at=at, scale=-at[2])


def ornaments(glb):
    def painted(name, picture):
        return glb.material(name, "#ffffff", 0.6, maps={"baseColorTexture": glb.slot(glb.texture(name, picture))})
    cube = rounded_box((1, 1, 1), 0.01).map_uv(lambda a, b: (a + 0.5, 0.5 - b))
    ball = sphere(0.5, 20, 40)
    card = panel((0, 0, 0), (0, 0, 1), 1, 1)
    card.uvs = [(x + 0.5, 0.5 - y) for x, y, _ in card.positions]
    thread = glb.mesh("thread", (tube([(0, 0, -0.06), (0, 0.6, -0.06)], [0.0012, 0.0012], 6),
                                 glb.material("thread", "#d8d8d8", 0.7)))
    black, cream = (14, 14, 16), (238, 232, 216)
    striped = glb.mesh("bars", (card, painted("bars", bars())))
    red, blue = (176, 24, 20), (16, 52, 140)
    for name, glyph, side, z, colour in (("near", "1", -1, NEAR_M, red), ("far", "2", 1, FAR_M, blue)):
        figured = glb.mesh(name + " cube", (cube, painted(name + " figure", figure(glyph, colour, cream))))
        chequered = glb.mesh(name + " ball", (ball, painted(name + " chequers", chequers(black, cream, 16, 8))))
        # In units of the distance: the front of the cube, the limb of the ball and the card are there.
        hang(glb, name + " cube", figured, thread, (side * 0.24 * z, 0.03 * z, -z - 0.09 * z), 0.18 * z)
        hang(glb, name + " ball", chequered, thread, (side * 0.085 * z, -0.16 * z, -z), 0.12 * z)
        glb.node(name + " bars", mesh=striped, at=(side * 0.42 * z, -0.17 * z, -z), scale=0.13 * z)


def lamps(glb):
    """Discs that face the camera, strewn evenly to beyond the frame's corners."""
    rng = random.Random(7)
    disc = lathe([[(LAMP_RADIUS_M, 0), (0, 0)]], 20)
    flat = Shape()
    flat.positions = [(x, -z, 0) for x, _, z in disc.positions]
    flat.normals = [(0, 0, 1)] * len(disc.positions)
    flat.uvs = disc.uvs
    for i in range(0, len(disc.indices), 3):
        flat.triangle(*disc.indices[i:i + 3])
    meshes = [glb.mesh("lamp " + c, (flat, glb.material("lamp " + c, "#000000", 1.0, emissive=c, nits=LAMP_NITS)))
              for c in LAMP_COLOURS]
    half_y = LAMP_M * math.tan(math.radians(YFOV_DEG / 2)) * 1.04
    half_x = half_y * ASPECT
    for j in range(LAMP_ROWS):
        for i in range(LAMP_COLUMNS):
            x = ((i + 0.5 + 0.25 * (-1) ** j + rng.uniform(-0.15, 0.15)) / LAMP_COLUMNS * 2 - 1) * half_x
            y = ((j + 0.5 + rng.uniform(-0.18, 0.18)) / LAMP_ROWS * 2 - 1) * half_y
            glb.node("lamp", mesh=rng.choice(meshes), at=(x, y, -LAMP_M - rng.uniform(0, 0.3)))


def build():
    glb = GlbWriter("ornaments.py of Petzval")
    glb.camera("front", YFOV_DEG, (0, 0, 0), (0, 0, 0, 1))
    ornaments(glb)
    lamps(glb)

    def light(name, at, target, size, colour, nits):
        glb.node(name, mesh=glb.mesh(name, (panel(at, target, size, size),
                                            glb.material(name, "#000000", 1.0, emissive=colour, nits=nits))))
    light("key", (-1.5, 1.5, 0.2), (0, 0, -1.5), 1.5, "#fff1dd", 14)
    light("fill", (1.8, 0.2, 0.4), (0, 0, -1.5), 1.2, "#cfe0ff", 7)
    return glb


if __name__ == "__main__":
    write_scene("ornaments.py", build)
