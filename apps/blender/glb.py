# SPDX-License-Identifier: Apache-2.0
"""A .glb whose JSON is changed."""
import json
import struct

from mathutils import Matrix

# Blender's z is up, glTF's y.
TO_GLTF = Matrix(((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1)))


class Glb:
    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        length = struct.unpack_from("<I", data, 12)[0]
        self.json = json.loads(data[20:20 + length])
        self._rest = data[20 + length:]
        self.json.setdefault("scenes", [{}])
        self.json["asset"]["generator"] = "Petzval's add-on"  # so that nobody guesses what another exporter lost

    def save(self, path):
        kinds = [self.json, *self.json.get("materials", []), *self.json.get("nodes", [])]
        used = {*self.json.get("extensionsUsed", []), *(key for one in kinds for key in one.get("extensions", {}))}
        if used:
            self.json["extensionsUsed"] = sorted(used)
        text = json.dumps(self.json, ensure_ascii=False).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sIII4s", b"glTF", 2, 20 + len(text) + len(self._rest), len(text), b"JSON"))
            file.write(text + self._rest)

    def add(self, kind, value):
        """Index of the value, which is added to those of its kind."""
        self.json.setdefault(kind, []).append(value)
        return len(self.json[kind]) - 1

    def place(self, node, matrix):
        """Adds a node to the scene; matrix: to Blender's world."""
        node["matrix"] = [x for column in (TO_GLTF @ matrix).transposed() for x in column]
        self.json["scenes"][0].setdefault("nodes", []).append(self.add("nodes", node))


def extras(owner):
    """What Petzval is told of a glTF object, in its extras."""
    return owner.setdefault("extras", {}).setdefault("petzval", {})


def unscaled(matrix):
    """Place and turn of a matrix, without scale and mirror: it looks along -z."""
    z, x = matrix.col[2].xyz.normalized(), matrix.col[0].xyz.normalized()
    y = z.cross(x).normalized()
    out = Matrix.Identity(4)
    for i, axis in enumerate((y.cross(z), y, z, matrix.translation)):
        out.col[i].xyz = axis
    return out
