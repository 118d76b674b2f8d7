#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the scene of things that turn, wheels on a stand and a cart around it: python3 wheels.py ../wheels.glb

Metres, y up, the floor at y = 0; RGB 1 is 1 nit. At 24 frames in a second and a shutter of 180 degrees the wheels turn
20, 90 and 200 degrees while it is open. Every wheel is an instance of one mesh.
"""
import math

from first_light_glb import then, turn, write_scene
from first_light_shapes import Shape, arc, lathe, rounded_box, sphere, tube
from first_light_textures import GLYPHS, png
from gem import look, panel
from motion import MovingGlb

X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
SPIN_S, TURNS = 0.75, (2, 9, 20)  # 20, 90 and 200 degrees in 1/48 s
RADIUS, SPOKES = 0.155, 8
SPACING, AXLE_Y = 0.345, 0.285
SPOKE_COLOURS = ("#e4572e", "#f3a712", "#f2e05a", "#7cb518", "#2a9d8f", "#2f6fbf", "#7a4fbf", "#d6498c")
# The cart rolls on two circles, which are whole numbers of its wheels' radii: so all come back at once.
DRIVE_S, CART_WHEEL, TRACKS = 2.25, 0.04, (14, 16)
LANE = CART_WHEEL * sum(TRACKS) / 2
AXLES_DEG = (-5.2, 5.2)  # of the cart, about the middle of its circle
ROOM, WALL_HIGH, BULBS = 2.4, 1.5, 40


def codes(srgb_hex):
    return tuple(int(srgb_hex[i:i + 2], 16) for i in (1, 3, 5))


def picture(width, height, colour_at):
    return png([[c for x in range(width) for c in codes(colour_at(x, y))] for y in range(height)])


def wheel():
    """A wheel about the z axis. Its picture is of columns: the spokes' colours, then the tyre's two and brass."""
    def column(k):
        return lambda u, v: ((k + 0.5) / (SPOKES + 3), 0.5)
    shape = Shape()
    for k in range(SPOKES):
        angle = 2 * math.pi * k / SPOKES
        along = [(r * math.cos(angle), r * math.sin(angle), 0) for r in (0.02, 0.08, RADIUS - 0.016)]
        shape.join(tube(along, (0.013, 0.011, 0.008), 7).map_uv(column(k)))
    pieces, around = 48, 8
    for k in range(pieces):
        rows = []
        for i in range(k, k + 2):
            a = 2 * math.pi * i / pieces
            rows.append([])
            for j in range(around + 1):
                b = 2 * math.pi * j / around
                n = (math.cos(b) * math.cos(a), math.cos(b) * math.sin(a), math.sin(b))
                r = RADIUS - 0.012 + 0.012 * math.cos(b)
                rows[-1].append(((r * math.cos(a), r * math.sin(a), 0.014 * math.sin(b)), n, (0, 0)))
        shape.join(Shape().sheet(rows).map_uv(column(SPOKES + k // 2 % 2)))
    hub = lathe([[(0, -0.024), (0.03, -0.024)], [(0.03, -0.024), (0.03, 0.024)],
                 arc((0, -0.006), 0.0424, 45, 90, 5)], 24)
    hub.positions = [(x, -z, y) for x, y, z in hub.positions]
    hub.normals = [(x, -z, y) for x, y, z in hub.normals]
    return shape.join(hub.map_uv(column(SPOKES + 2)))


def plate(text):
    """A picture of these figures in dark dots on cream."""
    dot = 4

    def colour_at(x, y):
        i, j = divmod(x // dot - 2, 6)
        row = y // dot - 2
        if 0 <= i < len(text) and j < 5 and 0 <= row < 7:
            if int(GLYPHS[text[i]][2 * row:2 * row + 2], 16) >> (4 - j) & 1:
                return "#1c2430"
        return "#efe6d2"
    return picture((6 * len(text) + 3) * dot, 11 * dot, colour_at), (6 * len(text) + 3) / 11


def stand(glb, mesh):
    """Three wheels on posts, and one that lies before them and never moves."""
    wood, brass = glb.material("walnut", "#4a2c1a", 0.4), glb.material("brass", "#c9a04e", 0.25, metallic=1.0)

    def put(name, shape, material, at):
        glb.node(name, mesh=glb.mesh(name, (shape, material)), at=at)
    put("foot", rounded_box((1.06, 0.03, 0.12), 0.006), wood, (0, 0.015, -0.05))
    post, axle = rounded_box((0.034, AXLE_Y, 0.034), 0.005, 1), tube([(0, 0, -0.075), (0, 0, 0.034)], (0.008,) * 2, 16)
    for turns, x in zip(TURNS, (-SPACING, 0, SPACING)):
        put("post", post, wood, (x, 0.03 + AXLE_Y / 2, -0.075))
        put("axle", axle, brass, (x, AXLE_Y, 0))
        degrees = round(turns * 360 / SPIN_S / 48)
        node = glb.node("wheel %d" % degrees, mesh=mesh, at=(x, AXLE_Y, 0))
        glb.spin("spin", node, Z, -turns, SPIN_S)
        figures, aspect = plate(str(degrees))
        paper = glb.painted("plate %d" % degrees, figures, 0.6)
        card = panel((0, 0, 0), (0, 0.35, 1), 0.055 * aspect, 0.055)
        card.uvs = [(0, 1), (1, 1), (1, 0), (0, 0)]
        put("plate", card, paper, (x, 0.058, 0.0))
    glb.node("wheel at rest", mesh=mesh, at=(0.16, 0.025, 0.30), rotation=then(turn(X, -86.3), turn(Y, 30)))


def cart(glb, mesh):
    """A cart that drives around the stand and carries the camera "follow" beside it."""
    pivot = glb.node("drive")
    glb.spin("drive", pivot, Y, 1, DRIVE_S, 8)
    for azimuth in AXLES_DEG:
        for radii in TRACKS:
            a, r = math.radians(azimuth), radii * CART_WHEEL
            hub = glb.node("axle", parent=pivot, at=(r * math.sin(a), CART_WHEEL, r * math.cos(a)),
                           rotation=turn(Y, azimuth))
            node = glb.node("cart wheel", parent=hub, mesh=mesh, scale=CART_WHEEL / RADIUS)
            glb.spin("drive", node, Z, -radii, DRIVE_S)
    painted = glb.material("cart", "#b3261e", 0.3)
    body = rounded_box((0.2, 0.022, 0.052), 0.006, 1)
    for at, size in (((0, 0.03, 0.029), (0.2, 0.05, 0.006)), ((0, 0.03, -0.029), (0.2, 0.05, 0.006)),
                     ((0.097, 0.03, 0), (0.006, 0.05, 0.056)), ((-0.097, 0.03, 0), (0.006, 0.05, 0.056))):
        body.join(rounded_box(size, 0.0025, 1), at)
    glb.node("cart", parent=pivot, mesh=glb.mesh("cart", (body, painted)), at=(0, 0.045, LANE))
    ball = sphere(0.026, 8, 16)
    for x, y, z, colour in ((-0.062, 0.082, 0.002, "#f2c14e"), (-0.006, 0.083, -0.003, "#3a86c8"),
                            (0.054, 0.082, 0.003, "#f4f1e6"), (-0.033, 0.126, 0, "#58a55c"),
                            (0.026, 0.125, 0, "#e8743b")):
        paint = glb.material("ball " + colour, colour, 0.15)
        glb.node("ball", parent=pivot, mesh=glb.mesh("ball", (ball, paint)), at=(x, y, LANE + z))
    eye = (0.16, 0.20, LANE + 0.62)
    node = glb.camera("follow", 30, eye, look(eye, (0.02, 0.10, LANE)))
    glb.json["scenes"][0]["nodes"].remove(node)
    glb.json["nodes"][pivot]["children"].append(node)


def tent(glb):
    """A round room: tiles, a striped wall, a string of bulbs along it, and the lamp above."""
    tiles = picture(64, 64, lambda x, y: ("#d9ccb4", "#7d8f8a")[(x // 32 + y // 32) % 2])
    floor = Shape()
    floor.positions = [(-ROOM, 0, ROOM), (ROOM, 0, ROOM), (ROOM, 0, -ROOM), (-ROOM, 0, -ROOM)]
    floor.normals, floor.uvs = [Y] * 4, [(0, 0), (1, 0), (1, 1), (0, 1)]
    floor.triangle(0, 1, 2)
    floor.triangle(0, 2, 3)
    glb.node("floor", mesh=glb.mesh("floor", (floor, glb.painted("tiles", tiles, 0.22, (2 * ROOM / 0.24,) * 2))))
    stripes = picture(64, 4, lambda x, y: "#22405f" if x < 32 else "#b9825a")
    wall = lathe([[(ROOM, WALL_HIGH), (ROOM, 0)]], 96)
    glb.node("wall", mesh=glb.mesh("wall", (wall, glb.painted("canvas", stripes, 0.9, (36, 1)))))
    bulb = glb.mesh("bulb", (sphere(0.022, 8, 12), glb.material("bulb", "#000000", 1.0, emissive="#ffcf8a", nits=9)))
    for k in range(BULBS):
        a = 2 * math.pi * (k + 0.5) / BULBS
        sag = 0.05 * math.cos(4 * a)
        glb.node("bulb", mesh=bulb, at=((ROOM - 0.06) * math.sin(a), 0.62 + sag, (ROOM - 0.06) * math.cos(a)))

    def lamp(name, at, target, size, colour, nits):
        glb.node(name, mesh=glb.mesh(name, (panel(at, target, size, size),
                                            glb.material(name, "#000000", 1.0, emissive=colour, nits=nits))))
    lamp("key", (-1.1, 2.3, 1.3), (0, 0.2, 0), 0.9, "#fff0d8", 36)
    lamp("fill", (1.9, 2.0, -0.2), (0, 0.2, 0), 0.8, "#cfe2ff", 16)


def build():
    glb = MovingGlb("wheels.py of Petzval")
    eye = (0.14, 0.64, 2.0)
    glb.camera("front", 26.5, eye, look(eye, (0.01, 0.20, 0.05)))
    paint = [*SPOKE_COLOURS, "#f1ead9", "#b3261e", "#c9a04e"]
    painted = glb.painted("wheel", picture(len(paint) * 4, 4, lambda x, y: paint[x // 4]), 0.35)
    mesh = glb.mesh("wheel", (wheel(), painted))
    stand(glb, mesh)
    cart(glb, mesh)
    tent(glb)
    return glb


if __name__ == "__main__":
    write_scene("wheels.py", build)
