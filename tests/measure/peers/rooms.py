#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes six small scenes for bench.py, each with a view.json: rooms.py FOLDER

Metres, y up; equal bytes from equal versions of Python and numpy. All surfaces are two-sided, as
Cycles knows no others.
"""
import json
import math
import os
import random
import struct
import sys

import numpy

SKY, EVEN_SKY = "sky.hdr", "even.hdr"
WHITE, GREY, RED, GREEN, BLUE = (.8, .8, .8), (.45, .45, .45), (.7, .2, .15), (.25, .55, .25), (.2, .3, .65)
MATERIALS = {  # base colour, metallic, roughness, emission
    "wall": (WHITE, 0, 1, None), "floor": ((.5, .35, .22), 0, .35, None), "grey": (GREY, 0, .9, None),
    "red": (RED, 0, .8, None), "green": (GREEN, 0, .8, None), "blue": (BLUE, 0, .15, None),
    "gold": ((1, .77, .34), 1, .25, None), "steel": ((.6, .6, .62), 1, .4, None),
    "window": ((0, 0, 0), 0, 1, (12, 13, 15)), "lamp": ((0, 0, 0), 0, 1, (60, 42, 20)),
    "blue lamp": ((0, 0, 0), 0, 1, (15, 25, 60)),
}


class Model:
    """Triangles by material, and at most one sun."""

    def __init__(self):
        self.parts, self.sun = {}, None

    def add(self, material, positions, normals, triangles):
        part = self.parts.setdefault(material, ([], [], []))
        part[2].append(numpy.asarray(triangles) + sum(map(len, part[0])))
        part[0].append(numpy.asarray(positions, float))
        part[1].append(numpy.asarray(normals, float))

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

        def put(array, kind, component, target):
            nonlocal data
            views.append({"buffer": 0, "byteOffset": len(data), "byteLength": array.nbytes, "target": target})
            data += array.tobytes()
            accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": len(array),
                              "type": kind})
            return len(accessors) - 1

        names = sorted(self.parts)
        for i, name in enumerate(names):
            positions, normals, triangles = (numpy.concatenate(p) for p in self.parts[name])
            positions = positions.astype("<f4")
            position = put(positions, "VEC3", 5126, 34962)
            accessors[-1].update(min=positions.min(0).tolist(), max=positions.max(0).tolist())
            primitives.append({"material": i, "attributes": {
                "POSITION": position, "NORMAL": put(normals.astype("<f4"), "VEC3", 5126, 34962)},
                "indices": put(triangles.astype("<u4").ravel(), "SCALAR", 5125, 34963)})
        gltf = {"asset": {"version": "2.0", "generator": "rooms.py of Petzval"}, "scene": 0,
                "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{**p, "mode": 4} for p in primitives]}],
                "materials": [material(name) for name in names], "extensionsUsed": ["KHR_materials_emissive_strength"],
                "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(data)}]}
        if self.sun:
            gltf["extensionsUsed"].append("KHR_lights_punctual")
            gltf["extensions"] = {"KHR_lights_punctual": {"lights": [
                {"type": "directional", "intensity": self.sun[1], "color": [1, .95, .85]}]}}
            gltf["scenes"][0]["nodes"].append(1)
            gltf["nodes"].append({"rotation": turn_from_minus_z(self.sun[0]),
                                  "extensions": {"KHR_lights_punctual": {"light": 0}}})
        text = json.dumps(gltf).encode()
        text += b" " * (-len(text) % 4)
        data += b"\0" * (-len(data) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(data), len(text), 0x4E4F534A) + text +
                       struct.pack("<II", len(data), 0x004E4942) + data)


def material(name):
    colour, metallic, roughness, emission = MATERIALS[name]
    out = {"name": name, "doubleSided": True, "pbrMetallicRoughness": {
        "baseColorFactor": [*colour, 1], "metallicFactor": metallic, "roughnessFactor": roughness}}
    if emission:
        out["emissiveFactor"] = [e / max(emission) for e in emission]
        out["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": max(emission)}}
    return out


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


# Name: what fills it, eye, target, vertical angle of view in degrees, its sky.
SCENES = {
    "closed-room": (closed_room, (1.6, 1.5, 3.1), (-.3, 1., -1.6), 55, SKY),
    "half-open-room": (half_open_room, (1.6, 1.5, 3.1), (-.3, 1., -1.6), 55, SKY),
    "sun-room": (sun_room, (1.6, 1.5, 3.1), (-.3, 1., -1.6), 55, None),
    "street": (street, (.6, 1.7, 6), (0, 2.6, -10), 50, SKY),
    "hall": (hall, (1, 2.2, 5.5), (0, 1.5, -8), 55, None),
    "spheres": (spheres, (0, 2, 6), (0, .4, 0), 40, EVEN_SKY),
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
