#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the scenes by which rays to targets are measured, as NAME.gltf, and the sky of glints and dew, sun.hdr.

    scenes.py FOLDER [NAME ...]

Prints for each the arguments of render that it is meant for. Metres, Y up; the camera looks along -Z.
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

    def use(self, **extensions):
        """The extensions of a material, which become known as used by the file."""
        used = self.json.setdefault("extensionsUsed", [])
        used += [name for name in extensions if name not in used]
        return {"extensions": extensions}

    def add_shining(self, colour, nits):
        return self.add_material((0, 0, 0), 0, 1, emissiveFactor=list(colour), **self.use(
            KHR_materials_emissive_strength={"emissiveStrength": nits}))

    def add_glass(self, colour, index, thickness):
        return self.add_material(colour, 0, 0, **self.use(
            KHR_materials_transmission={"transmissionFactor": 1}, KHR_materials_ior={"ior": index},
            KHR_materials_volume={"thicknessFactor": thickness}))

    def add_node(self, **node):
        self.json["nodes"].append(node)

    def add_floor(self, material, y, aside, near, far):
        self.add_node(mesh=self.add_mesh(material, *quad(
            (-aside, y, near), (aside, y, near), (aside, y, far), (-aside, y, far))))

    def add_wall(self, material, left, right, low, high, z):
        self.add_node(mesh=self.add_mesh(material, *upright(left, right, low, high, z)))

    def add_softbox(self, nits):
        """A square metre behind the camera: it shows what would be black, and is not seen."""
        self.add_node(mesh=self.add_mesh(self.add_shining((1, .95, .9), nits), *quad(
            (-.5, 1, 2), (-.5, 2, 2), (.5, 2, 2), (.5, 1, 2))))

    def add_chequered_ball(self, radius, *centre):
        """What is in focus."""
        self.json["images"] = [{"mimeType": "image/png", "bufferView": self.add_view(png(
            64, 32, lambda x, y: (220, 200, 160) if (x // 2 + y // 2) % 2 else (60, 20, 30)))}]
        self.json["textures"] = [{"source": 0}]
        chequered = self.add_material((1, 1, 1), 0, .6)
        self.json["materials"][chequered]["pbrMetallicRoughness"]["baseColorTexture"] = {"index": 0}
        self.add_node(mesh=self.add_mesh(chequered, *ball(radius, 5)), translation=centre)

    def write(self, path):
        self.json["scenes"] = [{"nodes": list(range(len(self.json["nodes"])))}]
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        self.json["buffers"] = [{"byteLength": len(self.data), "uri": uri}]
        with open(path, "w") as file:
            json.dump(self.json, file)


def quad(a, b, c, d):
    return [a, b, c, d], [(0, 1, 2), (0, 2, 3)]


def upright(left, right, low, high, z):
    """A quad that faces +Z."""
    return quad((left, low, z), (right, low, z), (right, high, z), (left, high, z))


def turned(profile, sides=64):
    """What a line of (radius, y) sweeps about Y, smooth around and sharp at the line's corners; its outside is on the right."""
    corners, faces, normals = [], [], []
    for (r0, y0), (r1, y1) in zip(profile, profile[1:]):
        first, length = len(corners), math.hypot(r1 - r0, y1 - y0)
        for i in range(sides):
            s, c = math.sin(2 * math.pi * i / sides), math.cos(2 * math.pi * i / sides)
            corners += [(r0 * s, y0, r0 * c), (r1 * s, y1, r1 * c)]
            normals += [((y1 - y0) / length * s, (r0 - r1) / length, (y1 - y0) / length * c)] * 2
            a, b = first + 2 * i, first + 2 * ((i + 1) % sides)
            faces += [(a, b, b + 1)] * (r0 > 0) + [(a, b + 1, a + 1)] * (r1 > 0)
    return corners, faces, normals


COLOURS = (1, .8, .5), (1, .4, .2), (.5, .7, 1), (.4, 1, .5), (1, 1, 1)


def write_night(path):
    """A matt floor and wall, 60 lamps of 5 mm at 3 to 10 m, a chequered ball at 1 m."""
    draw, file = random.Random(1), Gltf()
    matt = file.add_material((.5, .45, .4), 0, 1)
    file.add_floor(matt, -.6, 12, 1, -12)
    file.add_wall(matt, -12, 12, -.6, 8, -12)
    file.add_chequered_ball(.1, .05, -.05, -1.1)
    lamps = [file.add_mesh(file.add_shining(colour, 2e5), *ball(.0025, 3)) for colour in COLOURS]
    for i in range(60):
        away = draw.uniform(3, 10)
        file.add_node(mesh=lamps[i % 5], translation=[
            draw.uniform(-.33, .33) * away, draw.uniform(max(-.2 * away, -.55), .2 * away), -away])
    file.write(path)


def write_glints(path):
    """40 metal balls of 20 mm at 0.6 to 2 m on a matt table, every other one rough by 0.1, in the sun."""
    draw, file = random.Random(2), Gltf()
    matt = file.add_material((.3, .25, .2), 0, 1)
    file.add_floor(matt, -.15, 3, 1, -4)
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


def write_city(path):
    """539 lit windows in seven towers at 150 to 250 m, a figure at 1.5 m between two street lamps."""
    draw, file = random.Random(3), Gltf()
    dark = file.add_material((.04, .04, .05), 0, .9)
    file.add_floor(dark, 0, 200, 20, -300)
    windows = [[file.add_mesh(material, *upright(-w, w, -h, h, 0)) for w, h in ((.4, .6), (.45, .55), (.35, .65))]
               for material in (file.add_shining(c, 300) for c in ((1, .75, .45), (1, .85, .65), (.75, .9, 1), (.6, .8, 1)))]
    for tower in range(7):
        away = draw.uniform(150, 250)
        columns, floors = int(.042 * away), draw.randrange(16, int(.11 * away))
        left = (-.32 + .092 * tower) * away
        file.add_wall(dark, left, left + 2 * columns, 0, 3 * floors + 1, -away)
        for place in draw.sample(range(columns * floors), 77):
            file.add_node(mesh=draw.choice(draw.choice(windows)), translation=[
                left + 1 + 2 * (place % columns), 2 + 3 * (place // columns), .05 - away])
    lamp = file.add_mesh(file.add_shining((1, .7, .35), 5000), *ball(.15, 4))
    for x, z in ((-2.9, -14), (2.5, 1)):
        file.add_node(mesh=lamp, translation=[x, 5, z])
        file.add_wall(dark, x - .05, x + .05, 0, 4.85, z)
    skin, coat = (file.add_material(colour, 0, .8) for colour in ((.6, .4, .3), (.15, .1, .3)))
    file.add_node(mesh=file.add_mesh(skin, *ball(.11, 5)), translation=[.25, 1.65, -1.6])
    file.add_node(mesh=file.add_mesh(coat, *ball(.2, 5)), scale=[1, 3.6, .7], translation=[.25, .8, -1.6])
    file.write(path)


def write_fairy(path, garlands=8):
    """25 fairy lights of 3 mm in each garland at 1.5 to 6 m, a matt wall behind, a chequered ball at 1 m."""
    draw, file = random.Random(4), Gltf()
    matt = file.add_material((.45, .42, .4), 0, 1)
    file.add_floor(matt, -1.6, 5, 3, -6.5)
    file.add_wall(matt, -5, 5, -1.6, 3, -6.5)
    file.add_softbox(300)
    file.add_chequered_ball(.08, .1, -.1, -1.08)
    lights = [file.add_mesh(file.add_shining(colour, 2e5), *ball(.0015, 2)) for colour in COLOURS]
    for garland in range(garlands):
        down = .4 / garlands * garland
        ends = [(draw.uniform(1.6, 5.9), side * .34, draw.uniform(.24 - down, .27 - down)) for side in (-1, 1)]
        sag = draw.uniform(.05, .13)
        for i in range(25):
            t = (i + draw.uniform(.3, .7)) / 25
            away, across, up = (a + (b - a) * t for a, b in zip(*ends))
            file.add_node(mesh=lights[i % 5 if garland % 2 else 0], translation=[
                across * away, (up - sag * 4 * t * (1 - t)) * away, -away])
    file.write(path)


def write_dew(path):
    """400 drops of water of 2 to 4 mm on matt green at 0.4 to 1.2 m, against the sun."""
    draw, file = random.Random(5), Gltf()
    leaf = file.add_material((.015, .05, .01), 0, 1, **file.use(KHR_materials_specular={"specularFactor": 0}))
    file.add_floor(leaf, -.12, 4, 2, -6)
    radii = (.001, .0014, .0017, .002)
    drops = [file.add_mesh(file.add_glass((1, 1, 1), 1.33, 2 * r), *ball(r, 4)) for r in radii]
    for _ in range(400):
        away, size = draw.uniform(.4, 1.2), draw.randrange(4)
        file.add_node(mesh=drops[size], translation=[draw.uniform(-.36, .36) * away, radii[size] - .1199, -away])
    file.write(path)


def write_asphalt(path):
    """24 street lamps 0.2 m wide, 5 m high, at 10 to 40 m, mirrored in wet asphalt, smoother on the left; a ball at 2 m."""
    file = Gltf()
    for left, roughness in ((-9, .05), (0, .15)):
        wet = file.add_material((.03, .03, .035), 0, roughness)
        file.add_node(mesh=file.add_mesh(wet, *quad((left, 0, 5), (left + 9, 0, 5), (left + 9, 0, -80), (left, 0, -80))))
    file.add_softbox(300)
    file.add_chequered_ball(.12, .05, .12, -2.1)
    lamps = [file.add_mesh(file.add_shining(colour, 4e4), *turned([(0, 0), (.1, 0)])) for colour in ((1, .6, .25), (1, .9, .8))]
    for i in range(12):
        for side, lamp in zip((-1, 1), lamps):
            file.add_node(mesh=lamp, translation=[side * 4.5, 5, -10 - 30 * i / 11],
                          rotation=[-math.sin(math.pi / 8), 0, 0, math.cos(math.pi / 8)])
    file.write(path)


def write_tree(path):
    """A dark cone of 1.5 m at 3.5 m with 40 balls of metal and glass and 60 lights of 4 mm; a ball at 1.5 m."""
    draw, file = random.Random(6), Gltf()
    matt = file.add_material((.3, .25, .22), 0, 1)
    file.add_floor(matt, -.85, 4, 3, -5)
    file.add_wall(matt, -4, 4, -.85, 3, -5)
    file.add_softbox(3000)
    file.add_chequered_ball(.1, .3, -.2, -1.6)
    file.add_node(mesh=file.add_mesh(file.add_material((.01, .04, .015), 0, .9), *turned([(0, 0), (.55, 0), (0, 1.5)])),
                  translation=[0, -.75, -3.5])
    balls = [file.add_material(colour, 1, roughness) for colour, roughness in (
        ((.8, .05, .05), 0), ((.9, .7, .3), 0), ((.1, .2, .8), 0), ((.9, .9, .9), .1))]
    balls.append(file.add_glass((.9, 1, .95), 1.5, .09))
    balls = [(file.add_mesh(material, *ball(.045, 5)), .045) for material in balls]
    lights = [(file.add_mesh(file.add_shining(colour, 2e5), *ball(.002, 2)), .004) for colour in COLOURS]

    def hang(meshes, count):
        """Spread evenly over the half of the cone that is seen, and off it by a radius."""
        for i in range(count):
            up = 1 - math.sqrt(1 - (i + .5) / count * .97)
            around, off = math.radians(200) * ((i * .618 + draw.uniform(0, .1)) % 1 - .5), meshes[i % 5][1]
            r = .55 * (1 - up) + 1.1 * off
            file.add_node(mesh=meshes[i % 5][0], translation=[
                r * math.sin(around), 1.5 * up - .75, r * math.cos(around) - 3.5])

    hang(balls, 40)
    hang(lights, 60)
    file.write(path)


def write_workshop(path):
    """40 polished metal balls and cylinders on a dark bench at 0.8 to 2.5 m, two lamps of 2 cm; a ball at 0.6 m."""
    draw, file = random.Random(7), Gltf()
    file.add_floor(file.add_material((.025, .02, .015), 0, 1), -.18, 2, 1, -4)
    file.add_softbox(20)
    file.add_chequered_ball(.03, .03, -.15, -.62)
    lamp = file.add_mesh(file.add_shining((1, .9, .75), 1e6), *turned([(0, 0), (.01, 0)]))
    for x, z in ((-.4, -.8), (.5, -1.8)):
        file.add_node(mesh=lamp, translation=[x, .5, z])
    metals = [file.add_material(colour, 1, 0) for colour in ((.9, .9, .9), (.95, .75, .4), (.9, .6, .5))]
    for row in range(5):
        radius = .02 + .006 * row
        shapes = [[file.add_mesh(metal, *shape) for metal in metals] for shape in (
            ball(radius, 5), turned([(0, -radius), (.7 * radius, -radius), (.7 * radius, radius), (0, radius)]))]
        for column in range(8):
            away = .8 * (2.5 / .8) ** ((row + draw.uniform(-.15, .15) + .15) / 4.3)
            kind, turn = (row + column) % 2, draw.uniform(0, math.pi)
            a, b = math.sqrt(.5) * math.sin(turn), math.sqrt(.5) * math.cos(turn)
            file.add_node(mesh=draw.choice(shapes[kind]), rotation=[a, a, b, b], translation=[
                (-.3 + .6 * (column + draw.uniform(.2, .8)) / 8) * away, radius * (.7 if kind else 1) - .1799, -away])
    file.write(path)


def write_crowd(path):
    """2,000 fairy lights in 80 garlands."""
    write_fairy(path, 80)


def write_block(path):
    """20 lamps of 6 mm at 3 to 7 m on a matt floor, most of them behind a block of clear glass 0.3 m thick."""
    draw, file = random.Random(9), Gltf()
    matt = file.add_material((.4, .4, .4), 0, 1)
    file.add_floor(matt, -.6, 6, 1, -8)
    file.add_wall(matt, -6, 6, -.6, 4, -8)
    corners = [(x, y, z) for x in (-.6, .6) for y in (-.5, .5) for z in (-1.9, -1.6)]
    faces = []
    for a, b, c, d in ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)):
        faces += [(a, b, c), (a, c, d)]
    file.add_node(mesh=file.add_mesh(file.add_glass((1, 1, 1), 1.5, .3), corners, faces))
    lamps = [file.add_mesh(file.add_shining(colour, 2e5), *ball(.003, 3)) for colour in COLOURS]
    for i in range(20):
        away = draw.uniform(3, 7)
        file.add_node(mesh=lamps[i % 5], translation=[
            draw.uniform(-.25, .25) * away, draw.uniform(-.08, .2) * away, -away])
    file.add_softbox(300)
    file.write(path)


AHEAD = "--look-at 0,0,0,0,0,-1"
SCENES = {
    "night": (write_night, AHEAD + " --focus 1m"),
    "glints": (write_glints, AHEAD + " --focus 0.4m --env sun.hdr"),
    "city": (write_city, "--look-at 0,1.6,0,0,1.72,-1 --focus 1.5m"),
    "fairy": (write_fairy, AHEAD + " --focus 1m"),
    "crowd": (write_crowd, AHEAD + " --focus 0.5m"),
    "block": (write_block, AHEAD + " --focus 1m"),
    "dew": (write_dew, "--look-at 0,0,0,0,-0.2,-1 --focus 0.5m --fstop 2.8 --env sun.hdr --env-rotate 110"),
    "asphalt": (write_asphalt, "--look-at 0,0.4,0,0,0.4,-1 --focus 2m"),
    "tree": (write_tree, AHEAD + " --focus 1.5m"),
    "workshop": (write_workshop, "--look-at 0,0,0,0,-0.12,-1 --focus 0.6m"),
}


def main(folder, names):
    for name in names or SCENES:
        write, arguments = SCENES[name]
        write(os.path.join(folder, name + ".gltf"))
        print(name + ".gltf", arguments, "--lens takumar-50mm-f1.2 --size 480x320 --spp 128")
    write_sky(os.path.join(folder, "sun.hdr"))


if __name__ == "__main__":
    if len(sys.argv) < 2 or not os.path.isdir(sys.argv[1]) or not set(sys.argv[2:]) <= set(SCENES):
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2:])
