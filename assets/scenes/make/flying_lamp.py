#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the scene of a flying lamp behind paper boats: python3 flying_lamp.py ../flying_lamp.glb

Metres, y up, the water at y = 0; RGB 1 is 1 nit. Both cameras have a lens and are sharp 1 m away, where two of the
boats float; the lamp flies a figure of eight behind them. A point light wanders above, and one of the cameras moves.
"""
import math
import random

from first_light_glb import turn, write_scene
from first_light_shapes import Shape, cross, sphere, sub, times, unit
from first_light_textures import normals, png
from gem import look, panel
from motion import MovingGlb
from wheels import codes, picture

X, Y = (1, 0, 0), (0, 1, 0)
LENS = {"lens": "takumar-50mm-f1.2", "fstop": 1.2, "focus_m": 1.0}
EYE, TARGET = (0.0, 0.15, 0.0), (0.0, 0.085, -1.0)
FLY_S, WANDER_S, PULSE_S, SWAY_S = 1.5, 3.0, 6.0, 3.0
SWAY_DEG = 17
LAMPS = ("#ffb45c", "#ff5a3c", "#5fd0ff", "#6a86ff", "#7fe05a", "#ff62b0", "#ffd9a0")


def wave(u, turns=1, phase_deg=0):
    return math.sin(2 * math.pi * (turns * u + phase_deg / 360))


def flight(u):
    """The lamp's way: a figure of eight seen from above, behind the boats."""
    return (0.64 * wave(u, 1, 40), 0.15 + 0.075 * wave(u, 2, 150), -2.25 + 0.55 * wave(u, 2, 80))


def wandering(u):
    """The way of the point light, above the boats."""
    return (0.42 * wave(u), 0.42 + 0.06 * wave(u, 2), -0.92 + 0.2 * wave(u, 1, 90))


def sway(u):
    """The way of the camera "moving", about the boats."""
    a = math.radians(SWAY_DEG * wave(u))
    return (TARGET[0] + math.sin(a), EYE[1] + 0.05 * wave(u, 2), TARGET[2] + math.cos(a))


def boat():
    """A boat folded of paper, half its length 1, afloat at y = 0: four sides of the hull and the peak between them.
    The sheets have no thickness. uv is that of the paper, seen from the side."""
    shape = Shape()

    def face(*corners):
        normal = unit(cross(sub(corners[1], corners[0]), sub(corners[2], corners[0])))
        outward = times(normal, 1 if normal[2] * corners[0][2] + normal[2] * corners[-1][2] >= 0 else -1)
        first = len(shape.positions)
        shape.positions += corners
        shape.normals += [outward] * len(corners)
        shape.uvs += [((x + 1) / 2, 1 - y) for x, y, _ in corners]
        for i in range(1, len(corners) - 1):
            shape.triangle(first, first + i, first + i + 1)
    for s in (1, -1):
        low, rim = 0.07 * s, 0.23 * s
        face((-0.5, -0.06, low), (0.5, -0.06, low), (0, 0.34, rim))
        face((-0.5, -0.06, low), (0, 0.34, rim), (-1, 0.5, 0.012 * s))
        face((0.5, -0.06, low), (1, 0.5, 0.012 * s), (0, 0.34, rim))
        face((-0.42, 0.1, 0.08 * s), (0.42, 0.1, 0.08 * s), (0, 0.84, 0.006 * s))
    return shape


def ruled(paper, rule, margin):
    """A page of an exercise book."""
    return picture(128, 128, lambda x, y: margin if x in (40, 41) else rule if y % 8 == 0 else paper)


def boats(glb):
    folded = boat()
    for name, size, at, yaw, colours in (
            ("boat", 0.115, (-0.07, 0, -1.0), 14, ("#f6efdf", "#5b86c4", "#d8453a")),
            ("small boat", 0.07, (0.17, 0, -0.98), -32, ("#e4553f", "#f3c9a8", "#f6efdf")),
            ("near boat", 0.08, (-0.205, 0, -0.76), -28, ("#2f7f86", "#cfe6df", "#f6efdf")),
            ("far boat", 0.10, (0.38, 0, -1.75), 8, ("#f0c65a", "#c07a2a", "#c07a2a"))):
        paper = glb.painted(name, ruled(*colours), 0.8, double_sided=True)
        glb.node(name, mesh=glb.mesh(name, (folded, paper)), at=at, scale=size, rotation=turn(Y, yaw))


def water(glb):
    """A dark surface with low waves, and the dusk behind it."""
    size, rng = 128, random.Random(11)
    waves = [(rng.randint(-4, 4), rng.randint(2, 9), rng.random()) for _ in range(9)]
    height = [[sum(math.sin(2 * math.pi * ((i * x + j * y) / size + p)) / math.hypot(i, j) for i, j, p in waves)
               for x in range(size)] for y in range(size)]
    ripples = glb.slot(glb.texture("ripples", png(normals(height, 0.35, 2))), (32, 16))
    surface = Shape()
    surface.positions = [(-16, 0, 4), (16, 0, 4), (16, 0, -12), (-16, 0, -12)]
    surface.normals, surface.uvs = [Y] * 4, [(0, 0), (1, 0), (1, 1), (0, 1)]
    surface.triangle(0, 1, 2)
    surface.triangle(0, 2, 3)
    glb.node("water", mesh=glb.mesh("water", (surface, glb.material(
        "water", "#061018", 0.04, maps={"normalTexture": ripples}, ior=1.33))))
    stops = (codes("#0c1533"), codes("#27325f"), codes("#7a5a7a"), codes("#e0905a"))

    def colour_at(y):
        t = 3 * (y / 63) ** 1.6
        k = min(2, int(t))
        return [round(a + (b - a) * (t - k)) for a, b in zip(stops[k], stops[k + 1])]
    sky = panel((0, 1.9, -11.9), (0, 1.9, 0), 32, 4)
    sky.uvs = [(0, 1), (1, 1), (1, 0), (0, 0)]
    gradient = glb.texture("dusk", png([colour_at(y) * 4 for y in range(64)]))
    glb.node("dusk", mesh=glb.mesh("dusk", (sky, glb.material(
        "dusk", "#000000", 1.0, emissive="#ffffff", nits=0.45, maps={"emissiveTexture": glb.slot(gradient)}))))


def lamps(glb):
    """The flying lamp, still ones for comparison, and the point light."""
    def glowing(name, colour, nits):
        return glb.material(name, "#000000", 1.0, emissive=colour, nits=nits)
    bead = sphere(0.008, 8, 16)
    lamp = glb.node("flying lamp", mesh=glb.mesh("flying lamp", (bead, glowing("flying lamp", "#ffb648", 70))))
    glb.fly("fly", lamp, flight, FLY_S, 16)
    ball, rng = sphere(0.025, 6, 12), random.Random(5)
    meshes = [glb.mesh("lamp " + c, (ball, glowing("lamp " + c, c, 12))) for c in LAMPS]
    for k in range(26):
        far = rng.uniform(4.5, 9)
        across = ((k + rng.uniform(0.2, 0.8)) / 26 * 2 - 1) * 0.46
        glb.node("lamp", mesh=meshes[k * 3 % len(meshes)], at=(across * far, rng.uniform(0.11, 0.16) * far, -far))
    wisp = glb.node("wisp", extensions=glb.light("wisp", "point", intensity=1.0, color=[0.72, 0.86, 1.0]))
    glb.fly("wander", wisp, wandering, WANDER_S, 12)
    glb.animate("pulse", "/extensions/KHR_lights_punctual/lights/0/intensity", "pointer",
                [0, PULSE_S / 2, PULSE_S], [[v] for key in (1.0, 0.25, 1.0) for v in (0, key, 0)], "CUBICSPLINE")
    glow = panel((-0.6, 0.35, 0.4), TARGET, 0.6, 0.6)
    glb.node("glow", mesh=glb.mesh("glow", (glow, glowing("glow", "#ffdcb8", 16))))


def cameras(glb):
    for name in ("still", "moving"):
        node = glb.camera(name, 27, EYE, look(EYE, TARGET))
        glb.json["cameras"][-1]["extras"] = {"petzval": LENS}
    keys = 24
    glb.fly("sway", node, sway, SWAY_S, 12)
    glb.animate("sway", node, "rotation", [SWAY_S * k / keys for k in range(keys + 1)],
                [look(sway(k / keys), TARGET) for k in range(keys + 1)])


def build():
    glb = MovingGlb("flying_lamp.py of Petzval")
    cameras(glb)
    boats(glb)
    water(glb)
    lamps(glb)
    return glb


if __name__ == "__main__":
    write_scene("flying_lamp.py", build)
