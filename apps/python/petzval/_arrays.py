# SPDX-License-Identifier: Apache-2.0
"""Scenes from arrays, by way of glTF 2.0 in its binary form (Khronos Group 2021)."""
from __future__ import annotations

import json
import struct
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import FieldError
from ._keywords import Spectrum, matrix, numbers

_FLOAT, _UINT32 = 5126, 5125


@dataclass
class Material:
    """glTF's metallic-roughness material.

    base_color: R, G, B or R, G, B, A from 0 to 1, linear, or a texture: (height, width, 3 or 4), of uint8 as an sRGB
    display shows it, or of floats, linear. emission_nits: R, G, B. reflectance: a Spectrum, or a name of Petzval's, in
    place of base_color. gltf: more of glTF's material, as {"extensions": {"KHR_materials_ior": {"ior": 1.5}}}.
    """

    base_color: Any = (0.8, 0.8, 0.8)
    metallic: float = 0.0
    roughness: float = 1.0
    emission_nits: Sequence[float] = (0, 0, 0)
    reflectance: Spectrum | str | None = None
    double_sided: bool = True
    gltf: dict[str, Any] = field(default_factory=dict)


@dataclass
class Mesh:
    """Triangles in metres. positions: (N, 3). triangles: (M, 3) indices, counter-clockwise from outside; None: three
    positions each. normals: (N, 3). uvs: (N, 2), v = 0 in a texture's top row. pose: (4, 4) to the world."""

    positions: ArrayLike
    triangles: ArrayLike | None = None
    normals: ArrayLike | None = None
    uvs: ArrayLike | None = None
    material: Material = field(default_factory=Material)
    pose: ArrayLike | None = None
    name: str = ""


@dataclass
class Light:
    """Lamp without a surface. kind: "point" or "spot", intensity in candela, or "directional", in lux. It shines along
    -z of its pose. gltf: more of KHR_lights_punctual, as {"spot": {"outerConeAngle": 0.5}}."""

    kind: str = "point"
    intensity: float = 1.0
    color: Sequence[float] = (1, 1, 1)
    pose: ArrayLike | None = None
    gltf: dict[str, Any] = field(default_factory=dict)


def _rows(name: str, values: Any, columns: int, rows: int | None = None) -> NDArray[np.float32]:
    """Numbers (N, columns), of floats as glTF has them."""
    array = numbers(name, values, (rows, columns)).astype(np.float32)
    if not len(array):
        raise FieldError(f"{name}: holds nothing", name)
    return array


def _factor(name: str, value: Any) -> float:
    return float(numbers(name, value, ()))


def _png(name: str, pixels: NDArray[Any]) -> bytes:
    """Bytes of a PNG (W3C 2003) of 8 or 16 bits."""
    if pixels.ndim != 3 or pixels.shape[2] not in (3, 4) or 0 in pixels.shape:
        raise FieldError(f"{name}: has the shape {pixels.shape}, not (height, width, 3 or 4)", name)
    if pixels.dtype.kind == "f":
        if not ((pixels >= 0) & (pixels <= 1)).all():
            raise FieldError(f"{name}: holds a value that is not from 0 to 1", name)
        shown = pixels.astype(float)
        low = shown[..., :3]  # IEC 61966-2-1:1999
        shown[..., :3] = np.where(low <= 0.0031308, 12.92 * low, 1.055 * low ** (1 / 2.4) - 0.055)
        stored = np.rint(shown * 65535).astype(">u2")
    elif pixels.dtype == np.uint8:
        stored = pixels
    else:
        raise FieldError(f"{name}: is of {pixels.dtype}, not of uint8 or floats", name)
    height, width, channels = pixels.shape
    rows = np.ascontiguousarray(stored).view(np.uint8).reshape(height, -1)
    data = np.hstack([np.zeros((height, 1), np.uint8), rows]).tobytes()
    header = struct.pack(">IIBBBBB", width, height, 8 * stored.dtype.itemsize, 2 if channels == 3 else 6, 0, 0, 0)
    chunks = [(b"IHDR", header), (b"IDAT", zlib.compress(data)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body)) for kind, body in chunks)


class _Glb:
    """A file under construction."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.bytes = folder, bytearray()
        self.json: dict[str, Any] = {"asset": {"version": "2.0", "generator": "petzval"}, "scene": 0, "scenes": [{}]}
        self._materials: dict[int, int] = {}

    def add(self, kind: str, value: Any) -> int:
        self.json.setdefault(kind, []).append(value)
        return len(self.json[kind]) - 1

    def view(self, data: bytes) -> int:
        self.bytes += b"\0" * (-len(self.bytes) % 4)
        at = len(self.bytes)
        self.bytes += data
        return self.add("bufferViews", {"buffer": 0, "byteOffset": at, "byteLength": len(data)})

    def accessor(self, array: NDArray[Any], component: int, kind: str) -> int:
        out = {"bufferView": self.view(array.tobytes()), "componentType": component, "count": len(array), "type": kind}
        if kind == "VEC3":
            out.update(min=array.min(axis=0).tolist(), max=array.max(axis=0).tolist())
        return self.add("accessors", out)

    def material(self, material: Material) -> int:
        if id(material) not in self._materials:
            self._materials[id(material)] = self.add("materials", self._described(material))
        return self._materials[id(material)]

    def _described(self, of: Material) -> dict[str, Any]:
        surface: dict[str, Any] = {"metallicFactor": _factor("metallic", of.metallic),
                                   "roughnessFactor": _factor("roughness", of.roughness)}
        out: dict[str, Any] = {"pbrMetallicRoughness": surface, "doubleSided": bool(of.double_sided)}
        color = np.asarray(of.base_color)
        if color.ndim == 3:
            image = self.add("images", {"bufferView": self.view(_png("base_color", color)), "mimeType": "image/png"})
            surface["baseColorTexture"] = {"index": self.add("textures", {"source": image})}
            whole = 255 if color.dtype == np.uint8 else 1
        elif color.shape in ((3,), (4,)):
            surface["baseColorFactor"] = [*numbers("base_color", of.base_color, color.shape).tolist(), 1.0][:4]
            whole = 1
        else:
            raise FieldError(f"base_color: has the shape {color.shape}, not (3,), (4,) or (height, width, 3 or 4)",
                             "base_color")
        if color.shape[-1] == 4 and color[..., 3].min() < whole:
            out["alphaMode"] = "BLEND"
        if of.reflectance is not None:
            name = of.reflectance
            if isinstance(name, Spectrum):
                name = f"reflectance-{len(self._materials)}.csv"
                of.reflectance.save(self.folder / name)  # type: ignore[union-attr]
            out["extras"] = {"petzval": {"reflectance": name}}
        emission = numbers("emission_nits", of.emission_nits, (3,))
        strength = float(emission.max())
        if strength > 0:
            out["emissiveFactor"] = (emission / strength).tolist()
            out["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}
        return _merged(out, of.gltf)

    def node(self, values: dict[str, Any], pose: ArrayLike | None) -> None:
        if pose is not None:
            values["matrix"] = matrix("pose", pose).T.ravel().tolist()
        self.json["scenes"][0].setdefault("nodes", []).append(self.add("nodes", values))

    def used_extensions(self) -> list[str]:
        found: set[str] = set()

        def look(value: Any) -> None:
            for key, inner in value.items() if isinstance(value, dict) else enumerate(value):
                if key == "extensions":
                    found.update(inner)
                if isinstance(inner, (dict, list)):
                    look(inner)

        look(self.json)
        return sorted(found)

    def save(self, path: Path) -> None:
        if used := self.used_extensions():
            self.json["extensionsUsed"] = used
        if self.bytes:
            self.json["buffers"] = [{"byteLength": len(self.bytes)}]
        try:
            text = json.dumps(self.json, allow_nan=False, default=_plain).encode()
        except (TypeError, ValueError) as error:
            raise FieldError(f"gltf: holds what JSON does not: {error}", "gltf") from None
        chunks = [(b"JSON", text + b" " * (-len(text) % 4))]
        if self.bytes:
            chunks.append((b"BIN\0", bytes(self.bytes) + b"\0" * (-len(self.bytes) % 4)))
        body = b"".join(struct.pack("<I", len(data)) + kind + data for kind, data in chunks)
        path.write_bytes(b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body)


def _plain(value: Any) -> Any:
    """Numbers, arrays and paths, as JSON has them."""
    return value.tolist() if isinstance(value, (np.generic, np.ndarray)) else str(value)


def _merged(a: dict[str, Any], b: dict[str, Any]) -> dict[str, Any]:
    out = dict(a)
    for key, value in b.items():
        old = out.get(key)
        out[key] = _merged(old, value) if isinstance(old, dict) and isinstance(value, dict) else value
    return out


def write_glb(path: Path, meshes: Sequence[Mesh], lights: Sequence[Light] = ()) -> None:
    """Writes a .glb; reflectances lie beside it. Raises FieldError, which names what is not as it must be."""
    glb = _Glb(path.parent)
    for mesh in meshes:
        if not isinstance(mesh, Mesh) or not isinstance(mesh.material, Material):
            raise FieldError(f"meshes: take Mesh with a Material, not {mesh!r}", "meshes")
        positions = _rows("positions", mesh.positions, 3)
        attributes = {"POSITION": glb.accessor(positions, _FLOAT, "VEC3")}
        if mesh.normals is not None:
            normals = _rows("normals", mesh.normals, 3, len(positions))
            attributes["NORMAL"] = glb.accessor(normals, _FLOAT, "VEC3")
        if mesh.uvs is not None:
            attributes["TEXCOORD_0"] = glb.accessor(_rows("uvs", mesh.uvs, 2, len(positions)), _FLOAT, "VEC2")
        primitive: dict[str, Any] = {"attributes": attributes, "material": glb.material(mesh.material)}
        if mesh.triangles is not None:
            triangles = np.asarray(mesh.triangles)
            if triangles.ndim != 2 or triangles.shape[1] != 3 or triangles.dtype.kind not in "iu" or not len(triangles):
                raise FieldError(f"triangles: have the shape {triangles.shape} and type {triangles.dtype}, not whole "
                                 "numbers of the shape (M, 3)", "triangles")
            if triangles.min() < 0 or triangles.max() >= len(positions):
                raise FieldError(f"triangles: name a position that is not among the {len(positions)}", "triangles")
            primitive["indices"] = glb.accessor(triangles.astype(np.uint32).ravel(), _UINT32, "SCALAR")
        elif len(positions) % 3:
            raise FieldError(f"positions: {len(positions)} of them are no triangles of three each", "positions")
        glb.node({"mesh": glb.add("meshes", {"primitives": [primitive]}), **({"name": mesh.name} if mesh.name else {})},
                 mesh.pose)
    if lights:
        lamps = [_merged({"type": lamp.kind, "intensity": _factor("intensity", lamp.intensity),
                          "color": numbers("color", lamp.color, (3,)).tolist()},
                         {**({"spot": {}} if lamp.kind == "spot" else {}), **lamp.gltf}) for lamp in lights]
        glb.json["extensions"] = {"KHR_lights_punctual": {"lights": lamps}}
        for i, lamp in enumerate(lights):
            glb.node({"extensions": {"KHR_lights_punctual": {"light": i}}}, lamp.pose)
    glb.save(path)
