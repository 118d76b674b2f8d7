#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes a room of glass: a window at noon, ice in whisky in a tumbler, frosted panes: python3 glass.py ../glass.glb

Metres, y up, the floor at y = 0; RGB 1 is 1 nit. The window and the frosted panes are thin: light goes straight on
through the one, and the others blur it. The tumbler, what is in it and the ice are closed volumes that overlap.
"""
from first_light_glb import GlbWriter, then, turn, write_scene
from first_light_shapes import Shape, add, arc, lathe, rounded_box, sphere, unit
from gem import look

X, Y = (1, 0, 0), (0, 1, 0)
WALL_M, HEIGHT_M = 0.15, 2.6
LEFT, RIGHT, FAR, NEAR = -2.0, 2.0, -3.0, 2.0
WINDOW = ((0.55, -1.6), (2.2, 0.4))  # (y, z) of its corners in the left wall
SUN = unit((0.75, -0.85, -0.12))  # the way it shines, at noon
TABLE_AT, TABLE_TOP = (1.15, -0.35), 0.74
CLEAR_M = 0.0002  # between glass and what it stands on
PANES_Z, PANE_M = -2.1, (0.62, 1.9)
# The tumbler: radii inside, its floor and its rim.
INNER_LOW, INNER_HIGH, FLOOR_M, RIM_M, SIDE_M = 0.0335, 0.0385, 0.012, 0.088, 0.0035


def block(low, high):
    """A closed box with sharp edges; uv is not used."""
    shape = Shape()
    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        for sign, level in ((-1, low[axis]), (1, high[axis])):
            normal = [0, 0, 0]
            normal[axis] = sign
            first = len(shape.positions)
            for s, t in ((0, 0), (1, 0), (1, 1), (0, 1)):
                p = [0, 0, 0]
                p[axis], p[a], p[b] = level, (low, high)[s][a], (low, high)[t][b]
                shape.positions.append(tuple(p))
                shape.normals.append(tuple(normal))
                shape.uvs.append((s, t))
            shape.triangle(first, first + 1, first + 2)
            shape.triangle(first, first + 2, first + 3)
    return shape


def sheet(corner, a, b, normal):
    """A parallelogram that shows the side of its normal."""
    shape = Shape()
    shape.positions = [corner, add(corner, a), add(add(corner, a), b), add(corner, b)]
    shape.normals, shape.uvs = [normal] * 4, [(0, 0), (1, 0), (1, 1), (0, 1)]
    shape.triangle(0, 1, 2)
    shape.triangle(0, 2, 3)
    return shape


def inner_radius(y):
    """Of the tumbler at a height over its foot."""
    return INNER_LOW + (INNER_HIGH - INNER_LOW) * (y - FLOOR_M) / (RIM_M - FLOOR_M)


def tumbler():
    foot, rim = INNER_LOW + SIDE_M - 0.003, INNER_HIGH + SIDE_M / 2
    return lathe([[(0, 0), (foot, 0)] + arc((foot, 0.003), 0.003, -90, 0)[1:] + [(INNER_HIGH + SIDE_M, RIM_M)],
                  arc((rim, RIM_M), SIDE_M / 2, 0, 180, 8),
                  [(INNER_HIGH, RIM_M), (inner_radius(FLOOR_M), FLOOR_M)],
                  [(inner_radius(FLOOR_M), FLOOR_M), (0, FLOOR_M)]], 96)


def whisky(level):
    """It reaches half a millimetre into the glass: where both are, the smaller volume is."""
    into = 0.0005
    low = FLOOR_M - into
    return lathe([[(0, low), (inner_radius(low) + into, low)],
                  [(inner_radius(low) + into, low), (inner_radius(level) + into, level)],
                  [(inner_radius(level) + into, level), (0, level)]], 96)


def walls():
    """The room, its window left open."""
    w = WALL_M
    (low, back), (high, front) = WINDOW
    shape = Shape()
    for a, b in (((LEFT - w, 0, FAR - w), (LEFT, HEIGHT_M, back)), ((LEFT - w, 0, front), (LEFT, HEIGHT_M, NEAR + w)),
                 ((LEFT - w, 0, back), (LEFT, low, front)), ((LEFT - w, high, back), (LEFT, HEIGHT_M, front)),
                 ((RIGHT, 0, FAR - w), (RIGHT + w, HEIGHT_M, NEAR + w)),
                 ((LEFT, 0, FAR - w), (RIGHT, HEIGHT_M, FAR)), ((LEFT, 0, NEAR), (RIGHT, HEIGHT_M, NEAR + w)),
                 ((LEFT - w, HEIGHT_M, FAR - w), (RIGHT + w, HEIGHT_M + w, NEAR + w))):
        shape.join(block(a, b))
    return shape


def bars():
    """The window's frame: an upright and a cross bar, and a border. Each is a millimetre thicker than the one before,
    as faces in one plane flicker."""
    (low, back), (high, front) = WINDOW
    shape, t = Shape(), 0.025
    middle, across = (back + front) / 2, low + 0.62 * (high - low)
    for i, (a, b) in enumerate((((low, middle - t), (high, middle + t)), ((across - t, back), (across + t, front)),
                                ((low, back), (high, back + 2 * t)), ((low, front - 2 * t), (high, front)),
                                ((low, back), (low + 2 * t, front)), ((high - 2 * t, back), (high, front)))):
        shape.join(block((LEFT - 0.1 - 0.001 * i, a[0], a[1]), (LEFT - 0.05 + 0.001 * i, b[0], b[1])))
    return shape


def table():
    x, z = TABLE_AT
    shape = block((x - 0.45, TABLE_TOP - 0.03, z - 0.3), (x + 0.45, TABLE_TOP, z + 0.3))
    for dx in (-0.41, 0.37):
        for dz in (-0.26, 0.22):
            shape.join(block((x + dx, 0, z + dz), (x + dx + 0.04, TABLE_TOP - 0.03, z + dz + 0.04)))
    return shape


def drink(glb):
    """The tumbler on the table, whisky in it, and two cubes of ice: one floats, one lies on the floor."""
    glass = dict(roughness=0.0, transmission=1)
    solid = glb.material("glass", ior=1.52, volume={"thicknessFactor": SIDE_M}, **glass)
    amber = glb.material("whisky", ior=1.36, volume={
        "thicknessFactor": 0.07, "attenuationColor": [0.9, 0.42, 0.06], "attenuationDistance": 0.03}, **glass)
    frozen = glb.material("ice", ior=1.31, volume={"thicknessFactor": 0.028}, **glass)
    at = (TABLE_AT[0], TABLE_TOP + CLEAR_M, TABLE_AT[1])
    level = 0.047
    glb.node("tumbler", mesh=glb.mesh("tumbler", (tumbler(), solid)), at=at)
    glb.node("whisky", mesh=glb.mesh("whisky", (whisky(level), amber)), at=at)
    cube = glb.mesh("ice", (rounded_box((0.028, 0.028, 0.028), 0.003, 3), frozen))
    glb.node("ice", mesh=cube, at=add(at, (0.012, level - 0.006, -0.004)), rotation=then(turn(X, 24), turn(Y, 31)))
    glb.node("ice", mesh=cube, at=add(at, (-0.013, 0.0275, 0.008)), rotation=turn(Y, -18))


def frosted(glb):
    """Three thin panes side by side, ever rougher, and what stands behind them."""
    wide, high = PANE_M
    slat = glb.mesh("slat", (block((-0.018, 0, -0.01), (0.018, 1.8, 0.01)), glb.material("slat", "#24443a", 0.8)))
    for i, roughness in enumerate((0.12, 0.27, 0.5)):
        pane = glb.material("pane %d" % i, "#f4faf7", roughness, double_sided=True, transmission=1)
        low_x = -0.95 + i * (wide + 0.01)
        glb.node("pane", mesh=glb.mesh("pane", (sheet((low_x, 0.03, PANES_Z), (wide, 0, 0), (0, high, 0), (0, 0, 1)),
                                                pane)))
        x = low_x + wide / 2
        for colour, dx, y, r in (("#c9332b", -0.14, 0.85, 0.11), ("#2f62b5", 0.16, 0.72, 0.11), ("#e3b32d", 0, 1.45, 0.09)):
            paint = glb.material("ball " + colour, colour, 0.6)
            glb.node("ball", mesh=glb.mesh("ball", (sphere(r), paint)), at=(x + dx, y, PANES_Z - 0.28))
        for k in range(7):
            glb.node("slat", mesh=slat, at=(x + 0.09 * (k - 3), 0, PANES_Z - 0.6))
        lamp = glb.material("bulb", "#000000", 1.0, emissive="#ffd9a0", nits=22)
        glb.node("bulb", mesh=glb.mesh("bulb", (sphere(0.03), lamp)), at=(x + 0.12, 1.2, PANES_Z - 0.25))


def sun_and_sky(glb):
    glb.used.add("KHR_lights_punctual")
    glb.json["extensions"] = {"KHR_lights_punctual": {"lights": [
        {"name": "sun", "type": "directional", "intensity": 22, "color": [1.0, 0.93, 0.82]}]}}
    # A light shines along -z of its node.
    glb.node("sun", rotation=look((0, 0, 0), SUN), extensions={"KHR_lights_punctual": {"light": 0}})
    sky = glb.material("sky", "#000000", 1.0, emissive="#b9d4ff", nits=12)
    glb.node("sky", mesh=glb.mesh("sky", (sheet((-4, -0.5, 3), (0, 0, -7.2), (0, 3.25, 0), X), sky)))


def build():
    glb = GlbWriter("glass.py of Petzval")

    def put(name, shape, material):
        glb.node(name, mesh=glb.mesh(name, (shape, material)))
    put("walls", walls(), glb.material("plaster", "#e6e1d8", 0.95))
    put("floor", block((LEFT - WALL_M, -WALL_M, FAR - WALL_M), (RIGHT + WALL_M, 0, NEAR + WALL_M)),
        glb.material("floor", "#b4936f", 0.5))
    put("frame", bars(), glb.material("frame", "#f2f2f0", 0.6))
    put("table", table(), glb.material("table", "#5c4433", 0.35))
    (low, back), (high, front) = WINDOW
    put("window", sheet((LEFT - 0.075, low, back), (0, high - low, 0), (0, 0, front - back), X),
        glb.material("window", "#f6faf8", 0.0, double_sided=True, transmission=1))
    drink(glb)
    frosted(glb)
    sun_and_sky(glb)
    for name, fov, eye, target in (
            ("room", 52, (1.75, 1.5, 1.8), (-0.75, 0.95, -1.2)),
            ("ice", 15, (TABLE_AT[0] + 0.42, TABLE_TOP + 0.075, TABLE_AT[1] + 0.12),
             (TABLE_AT[0], TABLE_TOP + 0.043, TABLE_AT[1])),
            ("frosted", 42, (-0.02, 1.25, 0.6), (-0.02, 1.05, PANES_Z))):
        glb.camera(name, fov, eye, look(eye, target))
    return glb


if __name__ == "__main__":
    write_scene("glass.py", build)
