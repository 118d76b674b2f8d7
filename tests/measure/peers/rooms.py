#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes nine small scenes for bench.py, each with a view.json: rooms.py FOLDER

Metres, y up; equal bytes from equal versions of Python and numpy. All surfaces are two-sided, as
Cycles knows no others.
"""
import json
import math
import os
import random
import struct
import sys
import zlib

import numpy

SKY, EVEN_SKY, GENTLE_SKY = "sky.hdr", "even.hdr", "gentle.hdr"
WHITE, GREY, RED, GREEN, BLUE = (.8, .8, .8), (.45, .45, .45), (.7, .2, .15), (.25, .55, .25), (.2, .3, .65)
MATERIALS = {  # base colour (alphaMode BLEND if it has an alpha), metallic, roughness, emission
    "wall": (WHITE, 0, 1, None), "floor": ((.5, .35, .22), 0, .35, None), "grey": (GREY, 0, .9, None),
    "red": (RED, 0, .8, None), "green": (GREEN, 0, .8, None), "blue": (BLUE, 0, .15, None),
    "gold": ((1, .77, .34), 1, .25, None), "steel": ((.6, .6, .62), 1, .4, None),
    "window": ((0, 0, 0), 0, 1, (12, 13, 15)), "lamp": ((0, 0, 0), 0, 1, (60, 42, 20)),
    "blue lamp": ((0, 0, 0), 0, 1, (15, 25, 60)), "leaf": ((1, 1, 1), 0, .8, None),
    "slate": ((.08, .08, .09), 0, .9, None),
    "black glass": ((.02, .02, .02, .25), 0, .02, None), "shaft": ((1, 1, 1, .03), 0, 1, None),
}


class Model:
    """Triangles by material, and at most one sun."""

    def __init__(self):
        self.parts, self.sun = {}, None

    def add(self, material, positions, normals, triangles, uv=None):
        part = self.parts.setdefault(material, ([], [], [], []))
        part[2].append(numpy.asarray(triangles) + sum(map(len, part[0])))
        part[0].append(numpy.asarray(positions, float))
        part[1].append(numpy.asarray(normals, float))
        if uv is not None:
            part[3].append(numpy.asarray(uv, float))

    def box(self, material, low, high, turn_deg=0):
        """Adds a box, turned about the vertical axis through its middle."""
        low, high = numpy.array(low, float), numpy.array(high, float)
        angle = math.radians(turn_deg)
        turn = numpy.array(((math.cos(angle), 0, math.sin(angle)), (0, 1, 0), (-math.sin(angle), 0, math.cos(angle))))
        middle, half = (low + high) / 2, (high - low) / 2
        for axis in range(3):
            for sign in (-1, 1):
                normal, u, v = numpy.zeros((3, 3))
                normal[axis], u[(axis + 1) % 3], v[(axis + 2) % 3] = sign, sign, 1
                corners = [normal * half + (a * u + b * v) * half for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
                self.add(material, numpy.array(corners) @ turn.T + middle, [turn @ normal] * 4, ((0, 1, 2), (0, 2, 3)))

    def sphere(self, material, centre, radius, steps=24):
        """Adds a smooth sphere."""
        theta, phi = numpy.meshgrid(numpy.linspace(0, math.pi, steps + 1),
                                    numpy.linspace(0, 2 * math.pi, 2 * steps + 1), indexing="ij")
        normals = numpy.stack((numpy.sin(theta) * numpy.sin(phi), numpy.cos(theta),
                               numpy.sin(theta) * numpy.cos(phi)), -1).reshape(-1, 3)
        row = 2 * steps + 1
        faces = []
        for i in range(steps):
            for j in range(2 * steps):
                a, b = i * row + j, (i + 1) * row + j
                faces += [(a, b, b + 1)] if i < steps - 1 else []
                faces += [(a, b + 1, a + 1)] if i else []
        self.add(material, numpy.array(centre) + radius * normals, normals, faces)

    def turned(self, material, foot, profile, lean=(0, 0, 0), steps=32):
        """Adds what (radius, height) points make, turned about a vertical axis; height moves it by `lean` too."""
        angle = numpy.linspace(0, 2 * math.pi, steps + 1)
        out, around = (numpy.stack((s, 0 * s, c), -1) for s, c in (
            (numpy.sin(angle), numpy.cos(angle)), (numpy.cos(angle), -numpy.sin(angle))))
        rise = numpy.array((0, 1, 0)) + lean
        for (r0, y0), (r1, y1) in zip(profile, profile[1:]):
            normals = numpy.cross(around, (r1 - r0) * out + (y1 - y0) * rise)
            normals /= numpy.linalg.norm(normals, axis=1, keepdims=True)
            faces = []
            for i in range(steps):
                faces += [(i, i + 1, steps + 2 + i)] if r0 else []
                faces += [(i, steps + 2 + i, steps + 1 + i)] if r1 else []
            self.add(material, (*(foot + r0 * out + y0 * rise), *(foot + r1 * out + y1 * rise)),
                     (*normals, *normals), faces)

    def crossed_cards(self, material, centre, half, dice):
        """Adds two textured squares that cross, turned at random."""
        turn, _ = numpy.linalg.qr([[dice.gauss(0, 1) for _ in range(3)] for _ in range(3)])
        for side, normal in ((0, 2), (2, 0)):
            across, up = half * turn[side], half * turn[1]
            corners = [centre + a * across + b * up for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            self.add(material, corners, [numpy.cross(across, up) / half ** 2] * 4, ((0, 1, 2), (0, 2, 3)),
                     ((0, 1), (1, 1), (1, 0), (0, 0)))

    def wall_with_window(self, material, low, high, window):
        """Adds a wall that is thin along x, with a hole of (y0, z0, y1, z1) and a cross of glazing bars."""
        (x0, y0, z0), (x1, y1, z1), (a0, b0, a1, b1) = low, high, window
        self.box(material, (x0, y0, z0), (x1, a0, z1))
        self.box(material, (x0, a1, z0), (x1, y1, z1))
        self.box(material, (x0, a0, z0), (x1, a1, b0))
        self.box(material, (x0, a0, b1), (x1, a1, z1))
        x, y, z, bar = (x0 + x1) / 2, (a0 + a1) / 2, (b0 + b1) / 2, .03
        self.box(material, (x - bar, y - bar, b0), (x + bar, y + bar, b1))
        self.box(material, (x - bar, a0, z - bar), (x + bar, a1, z + bar))

    def write(self, path):
        data, accessors, views, primitives = b"", [], [], []

        def view(content, **target):
            nonlocal data
            views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(content), **target})
            data += content + b"\0" * (-len(content) % 4)
            return len(views) - 1

        def put(array, kind, component, target):
            view(array.tobytes(), target=target)
            accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": len(array),
                              "type": kind})
            return len(accessors) - 1

        names = sorted(self.parts)
        for i, name in enumerate(names):
            positions, normals, triangles, *uv = (numpy.concatenate(p) for p in self.parts[name] if p)
            positions = positions.astype("<f4")
            position = put(positions, "VEC3", 5126, 34962)
            accessors[-1].update(min=positions.min(0).tolist(), max=positions.max(0).tolist())
            primitives.append({"material": i, "attributes": {
                "POSITION": position, "NORMAL": put(normals.astype("<f4"), "VEC3", 5126, 34962)},
                "indices": put(triangles.astype("<u4").ravel(), "SCALAR", 5125, 34963)})
            if uv:
                primitives[-1]["attributes"]["TEXCOORD_0"] = put(uv[0].astype("<f4"), "VEC2", 5126, 34962)
        gltf = {"asset": {"version": "2.0", "generator": "rooms.py of Petzval"}, "scene": 0,
                "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{**p, "mode": 4} for p in primitives]}],
                "materials": [material(name) for name in names], "extensionsUsed": ["KHR_materials_emissive_strength"],
                "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(data)}]}
        if "leaf" in names:
            gltf["images"] = [{"bufferView": view(png(leaf_picture())), "mimeType": "image/png"}]
            gltf["textures"], gltf["buffers"][0]["byteLength"] = [{"source": 0}], len(data)
        if self.sun:
            gltf["extensionsUsed"].append("KHR_lights_punctual")
            gltf["extensions"] = {"KHR_lights_punctual": {"lights": [
                {"type": "directional", "intensity": self.sun[1], "color": [1, .95, .85]}]}}
            gltf["scenes"][0]["nodes"].append(1)
            gltf["nodes"].append({"rotation": turn_from_minus_z(self.sun[0]),
                                  "extensions": {"KHR_lights_punctual": {"light": 0}}})
        text = json.dumps(gltf).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(data), len(text), 0x4E4F534A) + text +
                       struct.pack("<II", len(data), 0x004E4942) + data)


def material(name):
    colour, metallic, roughness, emission = MATERIALS[name]
    out = {"name": name, "doubleSided": True, "pbrMetallicRoughness": {
        "baseColorFactor": [*colour, 1][:4], "metallicFactor": metallic, "roughnessFactor": roughness}}
    if len(colour) > 3:
        out["alphaMode"] = "BLEND"
    if name == "leaf":
        out.update(alphaMode="MASK", alphaCutoff=.5)
        out["pbrMetallicRoughness"]["baseColorTexture"] = {"index": 0}
    if emission:
        out["emissiveFactor"] = [e / max(emission) for e in emission]
        out["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": max(emission)}}
    return out


def png(rgba):
    """The bytes of a PNG file of 8-bit rgba, (rows, columns, 4)."""
    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))
    height, width = rgba.shape[:2]
    rows = numpy.concatenate((numpy.zeros((height, 1), numpy.uint8), rgba.reshape(height, -1)), 1)  # no filter
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows.tobytes(), 9)) + chunk(b"IEND", b""))


def leaf_picture(size=512):
    """A twig with pointed leaves on a transparent ground, their edges 8 pixels soft."""
    x, y = numpy.meshgrid(*[(numpy.arange(size) + .5) / size] * 2)
    alpha, shade = 8 / size - abs(x - .5) - (y < .1), numpy.full_like(x, .5)
    for i in range(9):
        side = (-1) ** i * (i < 8)
        along, left, low = math.radians(90 - 55 * side), x - .5, y - .96 + .075 * i
        u = (left * math.cos(along) - low * math.sin(along)) / .34
        v = (left * math.sin(along) + low * math.cos(along)) / .34
        inside = numpy.where((u > 0) & (u < 1), .25 * numpy.sin(math.pi * u.clip(0, 1) ** .8) - abs(v), -1)
        shade = numpy.where(inside > -.05, 1 - .2 * side + .25 * (abs(v) < .015), shade)
        alpha = numpy.maximum(alpha, .34 * inside)
    rgba = numpy.stack((.35 * shade, .55 * shade, .18 * shade, .5 + alpha * size / 8), -1)
    return (255 * rgba.clip(0, 1)).round().astype(numpy.uint8)


def turn_from_minus_z(direction):
    """The unit quaternion (x, y, z, w) that turns -z into the direction: the half-way construction."""
    d = numpy.array(direction, float) / numpy.linalg.norm(direction)
    q = numpy.array((*numpy.cross((0, 0, -1), d), 1 - d[2]))
    return (q / numpy.linalg.norm(q)).tolist()


def room(m, wide=5., high=2.8, deep=7.):
    """Adds a room without its wall at x = -wide/2, with furniture."""
    x, z, t = wide / 2, deep / 2, .2
    m.box("floor", (-x - t, -t, -z - t), (x + t, 0, z + t))
    m.box("wall", (-x - t, high, -z - t), (x + t, high + t, z + t))
    m.box("green", (x, 0, -z), (x + t, high, z))
    m.box("wall", (-x - t, 0, -z - t), (x + t, high, -z))
    m.box("wall", (-x - t, 0, z), (x + t, high, z + t))
    m.box("grey", (-.7, .7, -2.1), (1.1, .76, -1.1), 12)
    for dx, dz in ((-.6, -2.), (1., -2.), (-.6, -1.2), (1., -1.2)):
        m.box("steel", (dx - .03, 0, dz - .03), (dx + .03, .7, dz + .03))
    m.box("red", (1.3, 0, -3.3), (2.3, 1.9, -2.8))
    m.box("blue", (-2.1, 0, -3.1), (-1.4, .9, -2.4), 30)
    m.sphere("gold", (.3, .96, -1.6), .2)
    m.sphere("blue", (-.3, .88, -1.5), .12)
    m.sphere("wall", (.8, .86, -1.7), .1)
    m.box("wall", (-1.6, .02, -.6), (-.9, .45, .1), -20)


def closed_room(m):
    room(m)
    m.box("wall", (-2.7, 0, -3.5), (-2.5, 2.8, 3.5))
    m.box("window", (-2.5, .9, -2.4), (-2.48, 2.2, -.8))


def half_open_room(m):
    room(m)
    m.wall_with_window("wall", (-2.7, 0, -3.5), (-2.5, 2.8, 3.5), (.8, -2.8, 2.4, -.2))


def sun_room(m):
    half_open_room(m)
    m.sun = ((1, -.75, -.25), 40.)


def street(m):
    dice = random.Random(1)
    m.box("grey", (-40, -.2, -60), (40, 0, 10))
    for side in (-1, 1):
        z = 4.
        while z > -50:
            deep, high = dice.uniform(4, 8), dice.uniform(7, 14)
            near, far = side * 5, side * 13
            m.box(dice.choice(("wall", "red", "grey", "green")),
                  (min(near, far), 0, z - deep), (max(near, far), high, z))
            for floor in range(int(high / 3)):
                for at in numpy.arange(z - deep + 1, z - 1, 1.8):
                    x = side * 4.98
                    m.box("blue", (x - .04, 3 * floor + 1, at), (x + .04, 3 * floor + 2.3, at + 1))
            z -= deep
    for i in range(10):
        x, z = (-1) ** i * 3.6, 1.5 - 4.5 * i
        m.box("steel", (x - .05, 0, z - .05), (x + .05, 4, z + .05))
        m.sphere("lamp", (x, 4.15, z), .18, 8)
    for i in range(6):
        x, z = (-1) ** i * 2.2, -6 * i
        m.box(("red", "blue", "steel")[i % 3], (x - .8, .2, z - 7.4), (x + .8, 1.4, z - 4))


def hall(m):
    dice = random.Random(2)
    m.box("floor", (-10, -.2, -24), (10, 0, 6))
    m.box("wall", (-10, 6, -24), (10, 6.2, 6))
    for x in (-10.2, 10):
        m.box("wall", (x, 0, -24), (x + .2, 6, 6))
    for z in (-24.2, 6):
        m.box("green", (-10, 0, z), (10, 6, z + .2))
    for i in range(4):
        for x in (-5, 5):
            m.box("grey", (x - .35, 0, -4.35 - 5 * i), (x + .35, 6, -3.65 - 5 * i))
    for i in range(120):
        x, y, z, half = dice.uniform(-9.5, 9.5), dice.uniform(3, 5.6), dice.uniform(-23, 4), dice.uniform(.02, .06)
        m.box(dice.choice(("lamp", "lamp", "blue lamp")), (x - half, y - half, z - half),
              (x + half, y + half, z + half))
    for i in range(24):
        x, z, r = dice.uniform(-8, 8), dice.uniform(-20, -2), dice.uniform(.2, .7)
        m.sphere(dice.choice(("gold", "wall", "red", "blue")), (x, r, z), r, 16)


def spheres(m):
    m.box("wall", (-30, -.2, -30), (30, 0, 30))
    for i in range(7):
        m.sphere("wall", (-3.3 + 1.1 * i, .5, 0), .5)
        m.sphere("wall", (-3.3 + 1.1 * i, .3, 1.2), .3)


def glass_table(m):
    m.sun = ((-.6, -1, -.45), 30.)
    for i in range(-8, 9):
        for j in range(-8, 7):
            m.box(("grey", "wall")[(i + j) % 2], (.6 * i, -.1, .6 * j), (.6 * i + .59, 0, .6 * j + .59))
    m.box("wall", (-5, 0, -3.2), (5, .9, -3))
    m.box("floor", (-1, .7, -.6), (1, .74, .6))
    for x, z in ((-.9, -.5), (.9, -.5), (-.9, .5), (.9, .5)):
        m.box("floor", (x - .04, 0, z - .04), (x + .04, .7, z + .04))
    m.box("black glass", (-.9, .745, -.52), (.9, .751, .52))
    for x, z, colour in ((-.5, -.1, "wall"), (.1, .3, "green"), (.45, -.25, "red")):
        m.turned(colour, (x, .751, z), ((0, 0), (.035, 0), (.045, .1), (.041, .1), (.032, .005), (0, .005)))
    m.sphere("wall", (-.15, .831, -.2), .08)
    m.sphere("red", (-.3, .791, .2), .04)
    m.sphere("green", (.62, .801, .1), .05)
    m.box("green", (-.75, .751, .1), (-.5, .79, .3), 20)
    m.box("red", (.15, .751, -.42), (.3, .9, -.3), -15)
    for x in (-2.2, 2.3):
        m.box("red", (x - .25, 0, -2.8), (x + .25, .45, -2.3))
        m.sphere("green", (x, .75, -2.55), .4)


def light_cone(m):
    m.sun = ((-.6, -1, -.1), 40.)
    m.box("green", (-200, -.3, -400), (200, -.2, 100))
    m.box("slate", (-3, -.2, -5), (3, 0, 4))
    for x in (-3, 3):
        m.box("wall", (x - .1, 0, -5), (x + .1, .7, 4))
        m.box("wall", (x - .06, 2.6, -5), (x + .06, 2.7, 4))
        m.box("floor", (x - .55 * x / 3 - .45, .55, -4.8), (x - .55 * x / 3 + .45, .6, 3))
    m.box("slate", (-3.1, 0, -5.1), (3.1, 2.7, -4.9))
    for z in range(-5, 5):
        for x in (-3, 3):
            m.box("wall", (x - .05, .7, z - .05), (x + .05, 2.6, z + .05))
        m.box("wall", (-3, 2.6, z - .05), (3, 2.7, z + .05))
    for x in (-2, -1, 0, 1, 2):
        m.box("wall", (x - .04, 2.6, -5), (x + .04, 2.68, 4))
    dice = random.Random(3)
    for x in (-2.45, 2.45):
        for i in range(8):
            z, r = 2.4 - i, dice.uniform(.16, .26)
            m.box("red", (x - .13, .6, z - .13), (x + .13, .84, z + .13))
            m.sphere("green", (x, .8 + r, z), r, 12)
    m.box("steel", (-.8, 0, -3.4), (.5, .5, -2.7), 15)
    m.sphere("wall", (-.1, .8, -3), .3)
    m.sphere("wall", (.9, .3, -1.2), .3)
    m.turned("shaft", (-.3, .01, -1.3), ((1.7, 0), (0, 2.6)), (.5, 0, .1))


def leaves(m):
    dice = random.Random(4)
    m.sun = ((-.5, -1, -.6), 30.)
    m.box("grey", (-200, -.2, -400), (200, 0, 10))
    for x, z, high, crown in ((-1.7, -1, 2.1, 1.2), (1.3, -1.4, 2.4, 1.4), (0, -4, 2.8, 1.9), (-4, -5, 2.6, 1.9),
                              (4.2, -5, 2.8, 1.9), (-.4, .2, .5, .6), (1.8, 0, .6, .7), (-2.3, .2, .4, .6)):
        m.box("floor", (x - .05 * crown, 0, z - .05 * crown), (x + .05 * crown, high, z + .05 * crown))
        for _ in range(int(260 * crown)):
            d = numpy.array([dice.gauss(0, 1) for _ in range(3)])
            d *= crown * dice.uniform(.3, 1) / numpy.linalg.norm(d)
            m.crossed_cards("leaf", (x, high, z) + d * (1, .8, 1), .1 + .1 * crown, dice)


# Name: what fills it, eye, target, vertical angle of view in degrees, its sky.
SCENES = {
    "closed-room": (closed_room, (1.6, 1.5, 3.1), (-.3, 1., -1.6), 55, SKY),
    "half-open-room": (half_open_room, (1.6, 1.5, 3.1), (-.3, 1., -1.6), 55, SKY),
    "sun-room": (sun_room, (1.6, 1.5, 3.1), (-.3, 1., -1.6), 55, None),
    "street": (street, (.6, 1.7, 6), (0, 2.6, -10), 50, SKY),
    "hall": (hall, (1, 2.2, 5.5), (0, 1.5, -8), 55, None),
    "spheres": (spheres, (0, 2, 6), (0, .4, 0), 40, EVEN_SKY),
    "glass-table": (glass_table, (.1, 1.65, 1.35), (0, .74, .02), 40, GENTLE_SKY),
    "light-cone": (light_cone, (.5, 1.6, 2.1), (-.1, 1.25, -1.2), 55, GENTLE_SKY),
    "leaves": (leaves, (0, 1.5, 3.4), (0, 1.75, -1), 46, GENTLE_SKY),
}


def write_sky(path, rgb):
    """Writes the picture as Radiance RGBE, not compressed (Ward 1991, Real Pixels)."""
    mantissa, exponent = numpy.frexp(rgb.max(-1))
    scale = mantissa * 256 / rgb.max(-1)
    rgbe = numpy.concatenate((rgb * scale[..., None], (exponent + 128)[..., None]), -1).astype(numpy.uint8)
    with open(path, "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % rgb.shape[:2] + rgbe.tobytes())


def write_skies(folder):
    height, width = 256, 512
    elevation, azimuth = numpy.meshgrid(math.pi * (.5 - (numpy.arange(height) + .5) / height),
                                        2 * math.pi * (numpy.arange(width) + .5) / width, indexing="ij")
    up = numpy.sin(elevation)
    # A sun of 3 degrees at 35 degrees above the horizon, with a haze around it.
    sun = up * math.sin(math.radians(35)) + numpy.cos(elevation) * math.cos(math.radians(35)) * numpy.cos(azimuth - .3)
    up = up[..., None]
    sky = numpy.where(up > 0, numpy.array((1., 1.6, 3.)) + (1 - up) ** 4 * numpy.array((3., 2.6, 2.)),
                      numpy.array((.5, .45, .4)))
    write_sky(os.path.join(folder, GENTLE_SKY), sky)
    sky = sky + (8 * numpy.exp(12 * (sun - 1)))[..., None]
    sky = sky + (sun > math.cos(math.radians(1.5)))[..., None] * numpy.array((3000., 2700., 2200.))
    write_sky(os.path.join(folder, SKY), sky)
    write_sky(os.path.join(folder, EVEN_SKY), numpy.ones((height, width, 3)))


def write_rooms(folder):
    """Writes all scenes, each in a folder of its name, and their skies."""
    os.makedirs(folder, exist_ok=True)
    write_skies(folder)
    for name, (fill, eye, target, vfov_deg, sky) in SCENES.items():
        os.makedirs(os.path.join(folder, name), exist_ok=True)
        m = Model()
        fill(m)
        m.write(os.path.join(folder, name, name + ".glb"))
        with open(os.path.join(folder, name, "view.json"), "w") as file:
            json.dump({"file": name + ".glb", "eye": eye, "target": target, "vfov_deg": vfov_deg,
                       "env": sky and "../" + sky}, file, indent=1)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    write_rooms(sys.argv[1])
