# SPDX-License-Identifier: Apache-2.0
"""Animations and morph targets (glTF 2.0, sections 3.11 and 3.7.2.2) for the scenes that move."""
import struct

from first_light_glb import FLOAT, UNSIGNED_SHORT, GlbWriter, turn


class MovingGlb(GlbWriter):
    """A GlbWriter whose nodes, lights and meshes move. Times are in seconds."""

    def __init__(self, generator):
        super().__init__(generator)
        self.animations = self.json["animations"] = []
        self.samples = {}

    def _samples(self, rows, kind):
        """Numbers for an animation, with their bounds if they are times; equal ones are stored once."""
        flat = [c for row in rows for c in row]
        data = struct.pack("<%df" % len(flat), *flat)
        if (data, kind) not in self.samples:
            count = len(flat) if kind == "SCALAR" else len(rows)
            accessor = {"bufferView": self._view(data), "componentType": FLOAT, "count": count, "type": kind}
            if kind == "SCALAR":
                stored = struct.unpack("<%df" % len(flat), data)
                accessor.update(min=[min(stored)], max=[max(stored)])
            self.samples[data, kind] = self._append("accessors", accessor)
        return self.samples[data, kind]

    def animate(self, animation, target, path, times, rows, interpolation="LINEAR"):
        """Adds a channel to the animation of this name. target: a node, or a pointer into the JSON with path
        "pointer". rows: for each time the numbers of the property; of a CUBICSPLINE three rows, the tangent before
        it, the value, and the tangent after it."""
        found = [a for a in self.animations if a["name"] == animation]
        if not found:
            found = [{"name": animation, "channels": [], "samplers": []}]
            self.animations += found
        kind = {"translation": "VEC3", "scale": "VEC3", "rotation": "VEC4"}.get(path, "SCALAR")
        sampler = {"input": self._samples([[t] for t in times], "SCALAR"), "interpolation": interpolation,
                   "output": self._samples(rows, kind)}
        if path == "pointer":
            self.used.add("KHR_animation_pointer")
            where = {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": target}}}
        else:
            where = {"node": target, "path": path}
            first = rows[1 if interpolation == "CUBICSPLINE" else 0]
            self.json["nodes"][target][path] = [round(v, 7) for v in first]  # the pose that the file stores
        found[0]["channels"].append({"sampler": len(found[0]["samplers"]), "target": where})
        found[0]["samplers"].append(sampler)

    def spin(self, animation, node, axis, turns, duration_s, keys_per_turn=4):
        """Turns a node steadily. A pair of keys goes the short way round, so a turn needs at least three."""
        count = abs(turns) * keys_per_turn
        self.animate(animation, node, "rotation", [duration_s * k / count for k in range(count + 1)],
                     [turn(axis, 360 * turns * k / count) for k in range(count + 1)])

    def fly(self, animation, node, path, duration_s, keys):
        """Moves a node along path(u), u from 0 to 1, by a cubic spline of this many pieces."""
        step, h = duration_s / keys, 1e-4
        rows = []
        for k in range(keys + 1):
            u = k / keys
            tangent = [(b - a) / (2 * h * duration_s) for a, b in zip(path(u - h), path(u + h))]
            rows += [tangent, path(u), tangent]
        self.animate(animation, node, "translation", [step * k for k in range(keys + 1)], rows, "CUBICSPLINE")

    def painted(self, name, png, roughness, scale=None, **more):
        """A material whose colours are those of a PNG file."""
        slot = self.slot(self.texture(name, png), scale)
        return self.material(name, "#ffffff", roughness, maps={"baseColorTexture": slot}, **more)

    def light(self, name, kind, **properties):
        """A light of KHR_lights_punctual; gives the extensions of its node."""
        self.used.add("KHR_lights_punctual")
        lights = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append({"name": name, "type": kind, **properties})
        return {"KHR_lights_punctual": {"light": len(lights) - 1}}

    def _sparse(self, rows, bounds=False):
        """Vectors to four decimals; those of zeros are not stored (glTF 2.0, section 3.6.2.3)."""
        rows = [[round(v, 4) + 0.0 for v in row] for row in rows]
        kept = [k for k, row in enumerate(rows) if any(row)]
        accessor = {"componentType": FLOAT, "count": len(rows), "type": "VEC3"}
        data = struct.pack("<%df" % (3 * len(kept)), *(v for k in kept for v in rows[k]))
        if kept:
            places = struct.pack("<%dH" % len(kept), *kept)
            accessor["sparse"] = {"count": len(kept), "values": {"bufferView": self._view(data)},
                                  "indices": {"bufferView": self._view(places), "componentType": UNSIGNED_SHORT}}
        if bounds:
            stored = list(struct.iter_unpack("<3f", data)) + [(0.0, 0.0, 0.0)] * (len(kept) < len(rows))
            accessor.update(min=[min(c) for c in zip(*stored)], max=[max(c) for c in zip(*stored)])
        return self._append("accessors", accessor)

    def morph(self, mesh, names, targets):
        """Gives a mesh morph targets. targets: for each primitive, for each name, a Shape with the same vertices."""
        for primitive, shapes in zip(self.json["meshes"][mesh]["primitives"], targets):
            base, primitive["targets"] = shapes[0], []
            for shape in shapes[1:]:
                moved = [[[b - a for a, b in zip(p, q)] for p, q in zip(before, after)]
                         for before, after in ((base.positions, shape.positions), (base.normals, shape.normals))]
                primitive["targets"].append({"POSITION": self._sparse(moved[0], bounds=True),
                                             "NORMAL": self._sparse(moved[1])})
        self.json["meshes"][mesh].update(weights=[0] * len(names), extras={"targetNames": names})
