#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the scenes by which rays to targets are measured: night.gltf, glints.gltf and its sky, sun.hdr.

    scenes.py FOLDER

night: a matt floor and wall, 60 lamps of 5 mm at 3 to 10 m, a chequered ball at 1 m.
glints: 40 metal balls of 20 mm at 0.6 to 2 m on a matt table, every other one rough by 0.1; the sun is 0.53 degrees wide.
"""
import base64
import json
import math
import os
import random
import struct
import sys
import zlib


def ball(radius, halvings):
    """Corners, triangles and texture coordinates of a sphere that is an octahedron, halved so often."""
    corners = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    for _ in range(halvings):
        middles, finer = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                p = [(x + y) / 2 for x, y in zip(corners[a], corners[b])]
                length = math.hypot(*p)
                middles[key] = len(corners)
                corners.append(tuple(x / length for x in p))
            return middles[key]

        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        faces = finer
    uv = [(.5 + math.atan2(x, z) / (2 * math.pi), .5 + math.asin(y) / math.pi) for x, y, z in corners]
    return [tuple(radius * x for x in p) for p in corners], faces, corners, uv


def png(width, height, pixel):
    """An 8-bit RGB picture; pixel(x, y) gives three bytes."""
    rows = b"".join(b"\0" + bytes(v for x in range(width) for v in pixel(x, y)) for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


class Gltf:
    """A glTF file with all its data inside."""

    def __init__(self):
        self.data = b""
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "nodes": [], "meshes": [], "materials": [],
                     "accessors": [], "bufferViews": []}

    def add_view(self, data):
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)})
        self.data += data + b"\0" * (-len(data) % 4)
        return len(self.json["bufferViews"]) - 1

    def add_values(self, values, kind, count):
        rows = [v if isinstance(v, tuple) else (v,) for v in values]
        code = "I" if kind == 5125 else "f"
        view = self.add_view(b"".join(struct.pack("<%d%s" % (count, code), *row) for row in rows))
        self.json["accessors"].append({
            "bufferView": view, "componentType": kind, "count": len(rows), "type": {1: "SCALAR", 2: "VEC2", 3: "VEC3"}[count],
            "min": [min(r[i] for r in rows) for i in range(count)], "max": [max(r[i] for r in rows) for i in range(count)]})
        return len(self.json["accessors"]) - 1

    def add_mesh(self, material, positions, faces, normals=None, uv=None):
        attributes = {"POSITION": self.add_values(positions, 5126, 3)}
        if normals:
            attributes["NORMAL"] = self.add_values(normals, 5126, 3)
        if uv:
            attributes["TEXCOORD_0"] = self.add_values(uv, 5126, 2)
        indices = self.add_values([i for face in faces for i in face], 5125, 1)
        self.json["meshes"].append({"primitives": [{"attributes": attributes, "indices": indices, "material": material}]})
        return len(self.json["meshes"]) - 1

    def add_material(self, colour, metallic, roughness, **more):
        self.json["materials"].append({"pbrMetallicRoughness": {
            "baseColorFactor": [*colour, 1], "metallicFactor": metallic, "roughnessFactor": roughness}, **more})
        return len(self.json["materials"]) - 1

    def add_node(self, **node):
        self.json["nodes"].append(node)

    def write(self, path):
        self.json["scenes"] = [{"nodes": list(range(len(self.json["nodes"])))}]
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        self.json["buffers"] = [{"byteLength": len(self.data), "uri": uri}]
        with open(path, "w") as file:
            json.dump(self.json, file)


def quad(a, b, c, d):
    return [a, b, c, d], [(0, 1, 2), (0, 2, 3)]


def write_night(path):
    draw, file = random.Random(1), Gltf()
    matt = file.add_material((.5, .45, .4), 0, 1)
    file.add_node(mesh=file.add_mesh(matt, *quad((-12, -.6, 1), (12, -.6, 1), (12, -.6, -12), (-12, -.6, -12))))
    file.add_node(mesh=file.add_mesh(matt, *quad((-12, -.6, -12), (12, -.6, -12), (12, 8, -12), (-12, 8, -12))))
    file.json["images"] = [{"mimeType": "image/png", "bufferView": file.add_view(png(
        64, 32, lambda x, y: (220, 200, 160) if (x // 2 + y // 2) % 2 else (60, 20, 30)))}]
    file.json["textures"] = [{"source": 0}]
    chequered = file.add_material((1, 1, 1), 0, .6)
    file.json["materials"][chequered]["pbrMetallicRoughness"]["baseColorTexture"] = {"index": 0}
    file.add_node(mesh=file.add_mesh(chequered, *ball(.1, 5)), translation=[.05, -.05, -1.1])
    lamps = []
    for colour in ((1, .8, .5), (1, .4, .2), (.5, .7, 1), (.4, 1, .5), (1, 1, 1)):
        shining = file.add_material((0, 0, 0), 0, 1, emissiveFactor=list(colour), extensions={
            "KHR_materials_emissive_strength": {"emissiveStrength": 2e5}})
        lamps.append(file.add_mesh(shining, *ball(.0025, 3)))
    file.json["extensionsUsed"] = ["KHR_materials_emissive_strength"]
    for i in range(60):
        away = draw.uniform(3, 10)
        file.add_node(mesh=lamps[i % 5], translation=[
            draw.uniform(-.33, .33) * away, draw.uniform(max(-.2 * away, -.55), .2 * away), -away])
    file.write(path)


def write_glints(path):
    draw, file = random.Random(2), Gltf()
    matt = file.add_material((.3, .25, .2), 0, 1)
    file.add_node(mesh=file.add_mesh(matt, *quad((-3, -.15, 1), (3, -.15, 1), (3, -.15, -4), (-3, -.15, -4))))
    balls = [file.add_mesh(file.add_material((.9, .85, .8), 1, roughness), *ball(.01, 5)) for roughness in (0, .1)]
    for i in range(40):
        away = draw.uniform(.6, 2)
        file.add_node(mesh=balls[i % 2], translation=[
            draw.uniform(-.33, .33) * away, max(-.14, draw.uniform(-.22, .15) * away), -away])
    file.write(path)


def write_sky(path, width=4096):
    """A Radiance picture: 5,000 nits of blue sky, and a sun of 1.6e9 nits and 0.53 degrees."""
    def rgbe(colour):
        exponent = math.frexp(max(colour))[1]
        return bytes([int(v * 256 / 2 ** exponent) for v in colour] + [exponent + 128])

    height, sun_deg = width // 2, .53
    azimuth, up = math.radians(200), math.radians(40)
    sun = (math.cos(up) * math.cos(azimuth), math.sin(up), math.cos(up) * math.sin(azimuth))
    blue, white = rgbe((3500, 5000, 9000)), rgbe((1.6e9, 1.6e9, 1.5e9))
    rows = []
    for y in range(height):
        theta = math.pi * (y + .5) / height
        row = bytearray(blue * width)
        if abs(math.pi / 2 - theta - up) < math.radians(sun_deg):
            for x in range(width):
                phi = 2 * math.pi * (x + .5) / width
                along = (math.sin(theta) * math.cos(phi), math.cos(theta), math.sin(theta) * math.sin(phi))
                if sum(a * b for a, b in zip(along, sun)) > math.cos(math.radians(sun_deg / 2)):
                    row[4 * x:4 * x + 4] = white
        rows.append(bytes(row))
    with open(path, "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width) + b"".join(rows))


if __name__ == "__main__":
    if len(sys.argv) != 2 or not os.path.isdir(sys.argv[1]):
        sys.exit(__doc__)
    write_night(os.path.join(sys.argv[1], "night.gltf"))
    write_glints(os.path.join(sys.argv[1], "glints.gltf"))
    write_sky(os.path.join(sys.argv[1], "sun.hdr"))
