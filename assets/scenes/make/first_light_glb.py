# SPDX-License-Identifier: Apache-2.0
"""Writes binary glTF 2.0 (Khronos, glTF 2.0 specification, section 4.4) with nothing but the standard library."""
import json
import math
import struct
import sys

ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
UNSIGNED_SHORT, UNSIGNED_INT, FLOAT = 5123, 5125, 5126


def linear(srgb_hex):
    """'#rrggbb' as three linear sRGB values in [0, 1] (IEC 61966-2-1)."""
    codes = [int(srgb_hex[i:i + 2], 16) / 255 for i in (1, 3, 5)]
    return [round(c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4, 5) for c in codes]


def turn(axis, angle_deg):
    """Quaternion (x, y, z, w) of a rotation about a unit axis, counter-clockwise seen from its tip."""
    half = math.radians(angle_deg) / 2
    return tuple(a * math.sin(half) for a in axis) + (math.cos(half),)


def then(first, second):
    """The rotation `first` followed by `second`."""
    (bx, by, bz, bw), (ax, ay, az, aw) = first, second
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


class GlbWriter:
    """Collects meshes, materials, textures and nodes; `bytes()` gives the file."""

    def __init__(self, generator):
        self.binary = bytearray()
        self.used = set()
        self.primitives = {}
        self.json = {"asset": {"version": "2.0", "generator": generator}, "scene": 0,
                     "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [], "cameras": [],
                     "textures": [], "images": [], "samplers": [{"magFilter": 9729, "minFilter": 9729}],
                     "accessors": [], "bufferViews": []}

    def _append(self, name, item):
        self.json[name].append(item)
        return len(self.json[name]) - 1

    def _view(self, data, target=None):
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)}
        if target:
            view["target"] = target
        self.binary += data + bytes(-len(data) % 4)
        return self._append("bufferViews", view)

    def _floats(self, rows, kind, bounds=False):
        flat = [c for row in rows for c in row]
        data = struct.pack("<%df" % len(flat), *flat)
        accessor = {"bufferView": self._view(data, ARRAY_BUFFER), "componentType": FLOAT,
                    "count": len(rows), "type": kind}
        if bounds:
            stored = list(zip(*struct.iter_unpack("<3f", data)))
            accessor.update(min=[min(c) for c in stored], max=[max(c) for c in stored])
        return self._append("accessors", accessor)

    def _indices(self, indices, vertices):
        small = vertices < 65536
        data = struct.pack("<%d%s" % (len(indices), "H" if small else "I"), *indices)
        return self._append("accessors", {
            "bufferView": self._view(data, ELEMENT_ARRAY_BUFFER), "count": len(indices), "type": "SCALAR",
            "componentType": UNSIGNED_SHORT if small else UNSIGNED_INT})

    def texture(self, name, png):
        """A PNG file's bytes as a repeating, bilinear texture; gives its index."""
        image = self._append("images", {"name": name, "mimeType": "image/png", "bufferView": self._view(png)})
        return self._append("textures", {"sampler": 0, "source": image})

    def slot(self, texture, scale=None, **more):
        """A texture slot; scale repeats the texture by KHR_texture_transform."""
        slot = {"index": texture, **more}
        if scale:
            self.used.add("KHR_texture_transform")
            slot["extensions"] = {"KHR_texture_transform": {"scale": list(scale)}}
        return slot

    def material(self, name, colour="#ffffff", roughness=0.5, metallic=0.0, emissive=None, nits=None,
                 maps=None, double_sided=False, extras=None, **extensions):
        """colour and emissive are '#rrggbb'; nits scales emissive; maps are slots by their glTF names;
        extensions such as ior=1.5 or volume={...} go out as KHR_materials_*; extras as they are."""
        pbr = {"baseColorFactor": linear(colour) + [1], "metallicFactor": metallic, "roughnessFactor": roughness}
        material = {"name": name, "pbrMetallicRoughness": pbr}
        for slot, value in (maps or {}).items():
            inner = slot in ("baseColorTexture", "metallicRoughnessTexture")
            (pbr if inner else material)[slot] = value
        if emissive:
            material["emissiveFactor"] = linear(emissive)
            extensions["emissive_strength"] = {"emissiveStrength": nits}
        if double_sided:
            material["doubleSided"] = True
        if extras:
            material["extras"] = extras
        if extensions:
            simple = {"ior": "ior", "dispersion": "dispersion", "transmission": "transmissionFactor"}
            full = {"KHR_materials_" + k: ({simple[k]: v} if k in simple else v) for k, v in extensions.items()}
            self.used.update(full)
            material["extensions"] = full
        return self._append("materials", material)

    def mesh(self, name, *parts):
        """parts: (shape, material) pairs. A shape used twice is stored once."""
        primitives = []
        for shape, material in parts:
            if id(shape) not in self.primitives:
                attributes = {"POSITION": self._floats(shape.positions, "VEC3", bounds=True),
                              "NORMAL": self._floats(shape.normals, "VEC3"),
                              "TEXCOORD_0": self._floats(shape.uvs, "VEC2")}
                # The shape is kept too: its id stays taken while it lives.
                self.primitives[id(shape)] = (attributes, self._indices(shape.indices, len(shape.positions)), shape)
            attributes, indices, _ = self.primitives[id(shape)]
            primitives.append({"attributes": attributes, "indices": indices, "material": material})
        return self._append("meshes", {"name": name, "primitives": primitives})

    def node(self, name, parent=None, at=None, rotation=None, scale=None, **content):
        """content: mesh=, camera=; at in metres."""
        node = {"name": name, **content}
        for key, value in (("translation", at), ("rotation", rotation), ("scale", scale and [scale] * 3)):
            if value:
                node[key] = [round(v, 7) for v in value]
        index = self._append("nodes", node)
        if parent is None:
            self.json["scenes"][0]["nodes"].append(index)
        else:
            self.json["nodes"][parent].setdefault("children", []).append(index)
        return index

    def camera(self, name, yfov_deg, at, rotation):
        camera = {"type": "perspective", "name": name, "perspective": {
            "yfov": round(math.radians(yfov_deg), 6), "aspectRatio": round(16 / 9, 6), "znear": 0.01}}
        return self.node(name, at=at, rotation=rotation, camera=self._append("cameras", camera))

    def triangles(self):
        """Triangles as placed, instances counted each time."""
        per_mesh = [sum(self.json["accessors"][p["indices"]]["count"] // 3 for p in m["primitives"])
                    for m in self.json["meshes"]]
        return sum(per_mesh[n["mesh"]] for n in self.json["nodes"] if "mesh" in n)

    def bytes(self):
        self.json["extensionsUsed"] = sorted(self.used)
        self.json["buffers"] = [{"byteLength": len(self.binary)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        chunks += struct.pack("<I4s", len(self.binary), b"BIN\0") + self.binary
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def write_scene(script, build):
    """The main program of a script: writes the scene that build() makes to the file it is given."""
    if len(sys.argv) != 2:
        sys.exit("usage: %s OUT.glb" % script)
    glb = build()
    data = glb.bytes()
    with open(sys.argv[1], "wb") as file:
        file.write(data)
    print("%s: %d bytes, %d triangles" % (sys.argv[1], len(data), glb.triangles()))
