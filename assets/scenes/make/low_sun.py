#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes low_sun.glb: two rows of pillars on a plain, and a low sun that shines into the camera.

    python3 make/low_sun.py low_sun.glb [RIGHT_DEG UP_DEG]     # where the sun stands, from the camera's axis

The standard library alone. Metres, y up.
"""
import json
import math
import struct
import sys

SUN_DEG = (5, 9)  # to the right of the camera's axis, and above it


def box(low, high):
    """Triangles of a box, each of three corners, outside first."""
    x, y, z = zip(low, high)
    faces = [((0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)), ((1, 0, 0), (0, 0, 0), (0, 1, 0), (1, 1, 0)),
             ((0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)), ((1, 0, 1), (1, 0, 0), (1, 1, 0), (1, 1, 1)),
             ((0, 1, 1), (1, 1, 1), (1, 1, 0), (0, 1, 0)), ((0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1))]
    out = []
    for face in faces:
        a, b, c, d = [(x[i], y[j], z[k]) for i, j, k in face]
        out += [a, b, c, a, c, d]
    return out


def meshes():
    """Names, colours and triangles."""
    stone, dark = [], []
    for i in range(6):
        z = -6.0 - 3.2 * i
        for side in (-1, 1):
            x = side * 1.9
            stone += box((x - 0.28, 0, z - 0.28), (x + 0.28, 2.6, z + 0.28))
            stone += box((x - 0.4, 2.6, z - 0.4), (x + 0.4, 2.8, z + 0.4))
            stone += box((x - 0.4, 0, z - 0.4), (x + 0.4, 0.18, z + 0.4))
    dark += box((-3.4, 0, -4.4), (-2.5, 3.6, -4.0))  # a wall in the shade, near the left edge
    dark += box((-0.35, 0, -9.3), (0.35, 0.9, -8.7))
    ground = [(-60, 0, 4), (60, 0, 4), (60, 0, -120), (-60, 0, 4), (60, 0, -120), (-60, 0, -120)]
    return [("ground", (0.22, 0.19, 0.15), ground), ("stone", (0.55, 0.5, 0.43), stone),
            ("dark", (0.05, 0.05, 0.055), dark)]


def toward_sun(right_deg, up_deg):
    """Rotation, x y z w, that turns +z to the sun: a directional light shines along -z."""
    up, right = math.radians(up_deg), math.radians(right_deg)
    x, y, z = math.cos(up) * math.sin(right), math.sin(up), -math.cos(up) * math.cos(right)
    half = math.acos(z) / 2
    across = math.hypot(x, y)
    return [-y / across * math.sin(half), x / across * math.sin(half), 0, math.cos(half)]


def write_glb(path, parts_of_scene, more_nodes, yfov, lights=None, generator="make/low_sun.py"):
    """Writes a file of parts (name, material, triangles) and further nodes; its camera is number 0."""
    data = b""
    views, accessors, materials, parts, nodes = [], [], [], [], []
    for name, material, triangles in parts_of_scene:
        chunk = b"".join(struct.pack("<3f", *corner) for corner in triangles)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(chunk)})
        data += chunk
        accessors.append({"bufferView": len(views) - 1, "componentType": 5126, "count": len(triangles), "type": "VEC3",
                          "min": [min(c[k] for c in triangles) for k in range(3)],
                          "max": [max(c[k] for c in triangles) for k in range(3)]})
        materials.append({"name": name, **material})
        parts.append({"name": name, "primitives": [{"attributes": {"POSITION": len(accessors) - 1},
                                                    "material": len(materials) - 1}]})
        nodes.append({"name": name, "mesh": len(parts) - 1})
    nodes += more_nodes
    gltf = {"asset": {"version": "2.0", "generator": generator}, "scene": 0,
            "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes, "meshes": parts, "materials": materials,
            "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(data)}],
            "cameras": [{"name": "front", "type": "perspective", "perspective": {"yfov": yfov, "znear": 0.1}}]}
    used = sorted({name for m in materials for name in m.get("extensions", {})}) + (["KHR_lights_punctual"] if lights else [])
    if used:
        gltf["extensionsUsed"] = used
    if lights:
        gltf["extensions"] = {"KHR_lights_punctual": {"lights": lights}}
    text = json.dumps(gltf, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    with open(path, "wb") as out:
        out.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)))
        out.write(struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data)


def dull(colour, roughness=0.9):
    """Material that reflects a colour."""
    return {"pbrMetallicRoughness": {"baseColorFactor": [*colour, 1], "metallicFactor": 0, "roughnessFactor": roughness}}


def main(path, right_deg=SUN_DEG[0], up_deg=SUN_DEG[1]):
    sun = {"name": "sun", "type": "directional", "color": [1, 0.82, 0.6], "intensity": 60000,
           "extras": {"petzval": {"angle_deg": 0.53}}}
    write_glb(path, [(name, dull(colour), triangles) for name, colour, triangles in meshes()],
              [{"name": "front", "camera": 0, "translation": [0, 1.5, 0]},
               {"name": "sun", "rotation": toward_sun(float(right_deg), float(up_deg)),
                "extensions": {"KHR_lights_punctual": {"light": 0}}}], 0.47, [sun])


if __name__ == "__main__":
    main(*sys.argv[1:])
