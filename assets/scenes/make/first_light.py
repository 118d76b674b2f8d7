#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the built-in scene, a tabletop at dusk: python3 first_light.py ../first_light.glb

Metres, y up. The camera "table" stands over the origin and looks along -z; RGB 1 is 1 nit. Everything is
procedural and from fixed seeds, so that equal versions of Python and zlib give equal files.
"""
import math
import random

import first_light_objects as objects
import first_light_textures as textures
from first_light_glb import GlbWriter, then, turn, write_scene
from first_light_shapes import (Shape, add, arc, brilliant, cross, lathe, prism, rounded_box, spline,
                                sub, surface, tube, unit)

X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
TABLE_M = 0.74
EYE = (0.0, 1.02, 0.0)
PITCH_DEG = -6.5
FOCUS_M = 1.0


class Materials:
    """Every material of the scene by name."""

    def __init__(self, glb):
        def texture(name, png):
            return glb.slot(glb.texture(name, png))
        colour, shine, grain = (texture("wood " + n, p) for n, p in
                                zip(("colour", "roughness", "normal"), textures.wood()))
        wood = {"baseColorTexture": colour, "metallicRoughnessTexture": shine, "normalTexture": {**grain, "scale": 0.7}}
        self.planks = [glb.material("oak %d" % i, tint, 0.75, maps=wood)
                       for i, tint in enumerate(("#ffffff", "#ead9c8", "#f6ecd8"))]
        self.dark_wood = glb.material("dark oak", "#7a5a48", 0.9, maps=wood)
        weave = glb.texture("weave", textures.weave())
        self.linen = glb.material("linen", "#ffffff", 0.9, double_sided=True, specular={"specularFactor": 0.4}, maps={
            "baseColorTexture": texture("linen", textures.linen()),
            "normalTexture": glb.slot(weave, scale=(15, 36))})
        self.chart = glb.material("chart", "#f4f4f4", 0.6, maps={
            "baseColorTexture": texture("chart", textures.focus_chart())})
        self.rule = glb.material("rule", "#ffffff", 0.45, maps={
            "baseColorTexture": texture("rule", textures.folding_rule(RULE_PIECES))})
        rings = {"metallicRoughnessTexture": texture("turned metal", textures.brushed())}
        self.brass = glb.material("brass", "#f0c46c", 0.48, 1.0, maps=rings)
        self.copper = glb.material("copper", "#f2a183", 0.42, 1.0, maps=rings)
        self.black = glb.material("black lacquer", "#0c0b0b", 0.35)
        self.card = glb.material("cardboard", "#b9a88a", 0.85)
        self.glass = glb.material("crown glass", "#ffffff", 0.0, ior=1.517, transmission=1,
                                  volume={"thicknessFactor": 0.002})
        self.flint = glb.material("flint glass", "#ffffff", 0.0, ior=1.728, transmission=1,
                                  volume={"thicknessFactor": 0.03, "attenuationColor": [0.93, 0.97, 1.0],
                                          "attenuationDistance": 0.1})
        glaze = [(0, "#d9cfb8"), (0.14, "#cdbf9f"), (0.24, "#2f8f8c"), (0.6, "#135a6b"), (1, "#0c2c40")]
        self.glaze = glb.material("glaze", "#ffffff", 0.12, maps={
            "baseColorTexture": texture("glaze", textures.speckle(384, glaze, 37, 9))})
        skin = [(0, "#b9a534"), (0.12, "#e8c02c"), (0.5, "#f4cc30"), (0.9, "#e9bb26"), (1, "#a8a032")]
        self.lemon = glb.material("lemon", "#ffffff", 0.38, maps={
            "baseColorTexture": texture("lemon", textures.speckle(256, skin, 41, 7)),
            "normalTexture": glb.slot(glb.texture("peel", textures.dimples()), scale=(2, 1.4))})
        self.cherry = glb.material("cherry", "#6d0712", 0.12)
        self.stem = glb.material("stem", "#5d5a2a", 0.6)
        self.twig = glb.material("twig", "#3a2a20", 0.8)
        self.berry = glb.material("berry", "#b8261a", 0.3)
        self.boxwood = glb.material("boxwood", "#d8b070", 0.35)
        self.ebony = glb.material("ebony", "#1d1512", 0.28)
        self.cover = [glb.material("book cover " + c, c, 0.8, maps={"normalTexture": glb.slot(weave, scale=(12, 12))})
                      for c in ("#6e1f22", "#1f3a4c")]
        self.pages = glb.material("pages", "#d8c9a6", 0.9)
        self.paper_lantern = glb.material("paper lantern", "#d8c8a8", 0.9, emissive="#ffffff", nits=3.2, maps={
            "emissiveTexture": texture("paper glow", textures.paper_glow())})
        self.stone = glb.material("terrace", "#3a3f48", 0.22)
        self.trees = glb.material("trees", "#141b20", 0.95, emissive="#1c2542", nits=0.5)
        self.dusk = glb.material("dusk", "#000000", 1.0, emissive="#ffffff", nits=0.42, maps={
            "emissiveTexture": texture("dusk", textures.dusk())})
        self.key = glb.material("pendant light", "#000000", 1.0, emissive="#ffd3a0", nits=15)
        self.fill = glb.material("blue light", "#000000", 1.0, emissive="#8fb4ff", nits=1.3)
        self.enamel = glb.material("enamel", "#20332f", 0.3)
        self.lamps = [glb.material("lamp " + c, "#000000", 1.0, emissive=c, nits=n) for c, n in LAMP_COLOURS]


RULE_PIECES = 9
# Colour and nits; warm ones first, accents last.
LAMP_COLOURS = (("#ffb45c", 4), ("#ff9038", 4), ("#ffd089", 3.5), ("#ff5f30", 3.5), ("#ff4f86", 3), ("#2fd0c4", 2.5),
                ("#5f8dff", 3.5), ("#7fe05a", 2.5))


def table(glb, m):
    """Seven planks with gaps, an apron and four legs; turned so that the planks lead to the right."""
    rng = random.Random(3)
    group = glb.node("table", at=(-0.08, TABLE_M, -0.30), rotation=turn(Y, -8))
    width, length, thick = 0.15, 2.9, 0.036
    for i in range(7):
        u0, v0 = rng.random(), rng.random()
        plank = rounded_box((width - 0.003, thick, length), 0.0035)
        plank.map_uv(lambda a, b, u0=u0, v0=v0: (b / 1.4 + u0, a / 0.28 + v0))
        glb.node("plank %d" % i, group, at=((i - 3) * width, -thick / 2, -length / 2),
                 mesh=glb.mesh("plank %d" % i, (plank, m.planks[i * 2 % 3])))
    def metres(shape):
        return shape.map_uv(lambda a, b: (a / 1.4, b / 0.28))
    rail = glb.mesh("rail", (metres(rounded_box((0.03, 0.09, 2.5), 0.003)), m.dark_wood))
    leg = glb.mesh("leg", (metres(rounded_box((0.07, TABLE_M - thick, 0.07), 0.006)), m.dark_wood))
    for side in (-0.44, 0.44):
        glb.node("rail", group, at=(side, -thick - 0.0451, -length / 2), mesh=rail)
        for end in (-0.15, -2.75):
            glb.node("leg", group, at=(side, -(TABLE_M + thick) / 2, end), mesh=leg)


def runner(glb, m):
    """A linen runner across the table, with folds that die away where things stand on it."""
    def drape(s, t):
        x, z = (t - 0.5) * 1.5, (s - 0.5) * 0.46
        calm = min(1.0, max(0.0, (abs(x + 0.02) - 0.33) / 0.16))
        fold = 0.5 + 0.5 * math.sin(21 * x + 5 * math.sin(6 * z + 1.0))
        hem = 0.0022 + 0.0012 * max(0.0, 1 - min(s, 1 - s) / 0.03)
        y = hem + 0.015 * calm * calm * fold * (0.7 + 0.3 * math.sin(11 * z + 2))
        over = max(0.0, abs(x) - 0.532)
        drop = over * over / (over + 0.02)
        return (x - math.copysign(over - 0.25 * over, x) if over else x, y - drop, z)
    cloth = surface(drape, 40, 130, uv=lambda s, t: (s, t))
    glb.node("runner", at=(0.012, TABLE_M, -1.02), rotation=turn(Y, -8), mesh=glb.mesh("runner", (cloth, m.linen)))


ON_CLOTH_M = TABLE_M + 0.0024


def chart(glb, m):
    """A card that stands square to the optical axis of "table", its face at FOCUS_M; a brass foot holds it."""
    lean = turn(X, PITCH_DEG)
    w, h, foot_y, front = 0.12, 0.16, 0.006, 0.00165
    face = surface(lambda s, t: ((s - 0.5) * w, (t - 0.5) * h, front), 1, 1, uv=lambda s, t: (s, 1 - t))
    mesh = glb.mesh("chart", (face, m.chart), (rounded_box((w, h, 0.003), 0.0012), m.card))
    bottom = ON_CLOTH_M + foot_y
    sine, cosine = math.sin(math.radians(-PITCH_DEG)), math.cos(math.radians(PITCH_DEG))
    rise = bottom + h / 2 * cosine
    z = -(FOCUS_M + front - (EYE[1] - rise) * sine) / cosine
    x = -0.075
    glb.node("chart", at=(x, rise, z), rotation=lean, mesh=mesh)
    bar = rounded_box((0.09, 0.012, 0.016), 0.002)
    foot_z = z + sine / cosine * h / 2 - 0.0105
    stay = rounded_box((0.012, 0.05, 0.003), 0.001)
    brass = glb.mesh("chart foot", (bar, m.brass))
    glb.node("chart foot", at=(x, ON_CLOTH_M + 0.0062, foot_z), mesh=brass)
    glb.node("chart stay", at=(x, ON_CLOTH_M + 0.034, foot_z - 0.0005), rotation=lean,
             mesh=glb.mesh("chart stay", (stay, m.brass)))


def rule(glb, m):
    """A folding rule laid out along the table from 0.5 m on: a scale for the depth of field."""
    group = glb.node("folding rule", at=(0.125, ON_CLOTH_M, -0.53), rotation=turn(Y, 95))
    head = spline([(0.0045, 0.0003), (0.003, 0.0008), (0, 0.001)], 3)
    rivet = glb.mesh("rivet", (lathe([[(0.0045, -0.003), (0.0045, 0.0003)], head], 20), m.brass))
    for i in range(RULE_PIECES):
        piece = rounded_box((0.2 + 0.016, 0.003, 0.016), 0.0007)
        def atlas(a, b, i=i):
            u = min(1, max(0, (a + 0.1) / 0.2))
            v = min(0.98, max(0.02, b / 0.016 + 0.5))
            return (0.001 + 0.998 * u, (i + v) / RULE_PIECES)
        up = 0.0016 if i % 2 == 0 else 0.0047
        glb.node("rule %d" % i, group, at=(0.1 + 0.2 * i, up, 0),
                 mesh=glb.mesh("rule %d" % i, (piece.map_uv(atlas), m.rule)))
        if i:
            glb.node("rivet", group, at=(0.2 * i, 0.0062, 0), mesh=rivet)


def key_and_fill(glb, m):
    """A wide pendant lamp above the table, out of the picture, and a patch of blue sky on the right."""
    r = 0.36
    disc = lathe([[(r * k / 3, 0.012) for k in range(4)]], 32)
    shade = lathe([[(r, 0.012), (r + 0.004, 0.0), (r + 0.008, 0.002)],
                   spline([(r + 0.008, 0.002), (0.27, 0.09), (0.09, 0.15), (0.03, 0.19), (0, 0.20)], 8)], 48)
    cord = tube([(0, 0.195, 0), (0, 1.6, 0)], [0.004, 0.004])
    glb.node("pendant", at=(-0.42, TABLE_M + 0.80, -0.95), rotation=then(turn(Z, 14), turn(X, 10)), mesh=glb.mesh(
        "pendant", (disc, m.key), (shade, m.enamel), (cord, m.black)))
    panel = surface(lambda s, t: ((s - 0.5) * 1.3, (t - 0.5) * 1.1, 0), 2, 2)
    glb.node("blue light", at=(1.55, 1.55, 0.15), rotation=then(turn(X, 18), turn(Y, -122)),
             mesh=glb.mesh("blue light", (panel, m.fill)))


def backdrop(glb, m):
    """Dark wet stone, a line of trees and the band of sky above them."""
    ground = surface(lambda s, t: ((s - 0.5) * 36, 0, 6 - 26 * t), 12, 12)
    glb.node("terrace", mesh=glb.mesh("terrace", (ground, m.stone)))
    def round_wall(radius, low, high):
        def point(s, t):
            a = math.radians(-27.5 + 55 * s)
            return (radius * math.sin(a), low(s) + (high(s) - low(s)) * t, -radius * math.cos(a))
        return point
    sky = surface(round_wall(17, lambda s: 1.15, lambda s: 4.0), 20, 10, uv=lambda s, t: (s, 1 - t))
    glb.node("dusk sky", mesh=glb.mesh("dusk sky", (sky, m.dusk)))
    def crowns(s):
        hills = 0.25 * math.sin(9 * s + 1) + 0.12 * math.sin(31 * s)
        return 1.45 + hills + 0.10 * abs(math.sin(70 * s + 2 * math.sin(13 * s))) + 0.05 * abs(math.sin(211 * s))
    trees = surface(round_wall(16.5, lambda s: -0.1, crowns), 260, 2)
    glb.node("trees", mesh=glb.mesh("trees", (trees, m.trees)))


class Lamps:
    """Small round lamps: a bright cap that faces the camera in a dark housing."""

    def __init__(self, glb, m):
        self.glb = glb
        cap = lathe([[(max(r, 0), y) for r, y in arc((0, -0.02), 0.0583, 19, 90, 3)]], 20)
        housing = lathe([spline([(0, -0.06), (0.035, -0.05), (0.055, -0.015), (0.0555, 0.0)], 3)], 20)
        self.meshes = [glb.mesh("lamp %d" % i, (cap, material), (housing, m.black))
                       for i, material in enumerate(m.lamps)]

    def put(self, x, y, z, colour, diameter_m):
        """Turned toward the camera, its cap's axis along the line of sight."""
        away = unit(sub(EYE, (x, y, z)))
        spin = unit(cross(Y, away))
        angle = math.degrees(math.acos(max(-1.0, min(1.0, away[1]))))
        self.glb.node("lamp", at=(x, y, z), rotation=turn(spin, angle), scale=diameter_m / 0.11,
                      mesh=self.meshes[colour])


def festoons(glb, m, lamps):
    """Strings of lamps between posts, and garden lamps on stakes beyond them."""
    rng = random.Random(59)
    post = glb.mesh("post", (tube([(0, 0, 0), (0, 3.2, 0)], [0.04, 0.035], 12), m.twig))
    wires = Shape()
    strings = (((-2.9, 2.35, -5.2), (-0.9, 2.55, -9.5), 0.42, 9), ((-0.9, 2.55, -9.5), (3.9, 2.75, -11.5), 0.55, 12),
               ((3.4, 2.05, -6.2), (3.9, 2.75, -11.5), 0.30, 7), ((-5.6, 2.5, -12.5), (-0.9, 2.55, -9.5), 0.5, 9))
    for a, b, sag, count in strings:
        def hang(t, a=a, b=b, sag=sag):
            x, y, z = (p + (q - p) * t for p, q in zip(a, b))
            return (x, y - 4 * sag * t * (1 - t), z)
        wires.join(tube([hang(i / 24) for i in range(25)], [0.006] * 25, 6))
        for k in range(count):
            x, y, z = hang((k + 0.5) / count)
            colour = rng.choice((0, 0, 0, 1, 1, 2, 2, 3, 5)) if k % 4 != 2 else rng.choice((3, 4, 5, 6, 7))
            lamps.put(x, y - 0.09, z, colour, rng.uniform(0.09, 0.12))
    for x, z in {(p[0], p[2]): None for string in strings for p in string[:2]}:
        glb.node("post", at=(x, 0, z), mesh=post)
    for k in range(34):
        x = -7.2 + 14.4 * (k + rng.uniform(0.1, 0.9)) / 34
        z = -rng.uniform(12.6, 14.6)
        colour = rng.choice((0, 0, 1, 1, 2, 2, 3, 4, 5, 5, 6))
        y = rng.uniform(0.3, 1.25)
        lamps.put(x, y, z, colour, rng.uniform(0.10, 0.15))
        wires.join(tube([(x, 0, z - 0.05), (x, y, z - 0.05)], [0.012, 0.012], 6))
    glb.node("wires", mesh=glb.mesh("wires and stakes", (wires, m.twig)))


def still_life(glb, m):
    def put(name, shape, material, x, z, y=ON_CLOTH_M, **more):
        glb.node(name, at=(x, y, z), mesh=glb.mesh(name, (shape, material)), **more)
    chart(glb, m)
    objects.petzval_lens(glb, m, (0.165, ON_CLOTH_M, -1.03), 24)
    put("wine glass", objects.wine_glass(), m.glass, -0.215, -1.10)
    gem, size = brilliant(), 0.030
    main_deg = 40.75
    deep = (math.sin(math.radians(main_deg)) + 0.02 * math.cos(math.radians(main_deg))) * size
    put("brilliant", gem, m.flint, -0.115, -0.845, ON_CLOTH_M + deep + 0.0002, scale=size,
        rotation=then(turn(Z, -main_deg), turn(Y, -40)))
    put("prism", prism(0.036, 0.075), m.glass, 0.040, -0.885, ON_CLOTH_M + 0.0377,
        rotation=then(turn(Z, 90), turn(Y, 20)))
    peel = glb.mesh("lemon", (objects.lemon(), m.lemon))
    for x, z, y, pose in ((0.275, -0.86, ON_CLOTH_M, then(turn(Z, 84), turn(Y, 25))),
                          (0.335, -1.32, TABLE_M, then(turn(Z, 96), turn(Y, -50)))):
        glb.node("lemon", at=(x, y + 0.0274, z), rotation=pose, mesh=peel)
    objects.cherries(glb, m, (0.165, ON_CLOTH_M, -0.815), -35)
    put("mug", objects.mug(), m.copper, 0.435, -1.42, TABLE_M)
    put("vase", objects.vase(), m.glaze, -0.395, -1.46, TABLE_M)
    objects.twigs(glb, m, (-0.395, TABLE_M, -1.46))
    top = objects.books(glb, m, (-0.235, TABLE_M, -1.75), 14)
    small, tall = objects.pawn(), objects.bishop()
    pawns = [glb.mesh("pawn", (small, m.boxwood)), glb.mesh("dark pawn", (small, m.ebony))]
    bishops = [glb.mesh("bishop", (tall, m.boxwood)), glb.mesh("dark bishop", (tall, m.ebony))]
    for i, (x, z) in enumerate(((0.155, -1.36), (0.165, -1.62), (0.175, -1.92), (0.185, -2.27), (0.20, -2.7))):
        glb.node("pawn", at=(x, TABLE_M, z), scale=1.25, mesh=pawns[i % 2])
    glb.node("bishop", at=add(top, (0.03, 0, 0.0)), scale=1.2, mesh=bishops[0])
    glb.node("bishop", at=add(top, (-0.035, 0, 0.01)), scale=1.2, mesh=bishops[1])
    rule(glb, m)
    objects.paper_lanterns(glb, m, ((0.56, TABLE_M, -2.15, 1.0), (0.02, TABLE_M, -2.75, 1.15)))


def build():
    glb = GlbWriter("first_light.py of Petzval")
    m = Materials(glb)
    glb.camera("table", 28, EYE, turn(X, PITCH_DEG))
    glb.camera("close", 22, (-0.095, 0.86, -0.50), turn(X, -11))
    table(glb, m)
    runner(glb, m)
    still_life(glb, m)
    key_and_fill(glb, m)
    backdrop(glb, m)
    festoons(glb, m, Lamps(glb, m))
    return glb


if __name__ == "__main__":
    write_scene("first_light.py", build)
