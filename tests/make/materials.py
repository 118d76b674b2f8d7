#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Renders the pictures of docs/guide/materials.md: a row of spheres and swatches for each property of a material.

    tests/make/materials.py [--petzval FILE] [--spp N] [--out FOLDER] [NAME...]

Each row's scene goes to FOLDER/NAME.gltf, each picture to FOLDER/NAME.jpg (docs/pictures/materials unless --out says
otherwise). A property rises from left to right by equal steps.
"""
import argparse
import math
import os
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "measure", "targets"))
from scenes import Gltf, quad  # noqa: E402

COUNT = 7
RADIUS_M = .44


def globe(radius, columns=72, rows=36):
    """Corners, triangles, normals and texture coordinates of a sphere with its poles above and below."""
    corners, faces, normals, uv = [], [], [], []
    for j in range(rows + 1):
        for i in range(columns + 1):
            across, down = 2 * math.pi * i / columns, math.pi * j / rows
            n = (math.sin(down) * math.cos(across), math.cos(down), -math.sin(down) * math.sin(across))
            normals.append(n)
            corners.append(tuple(radius * x for x in n))
            uv.append((i / columns, j / rows))
    for j in range(rows):
        for i in range(columns):
            a, b = j * (columns + 1) + i, (j + 1) * (columns + 1) + i
            faces += [(a, b, b + 1), (a, b + 1, a + 1)]
    return corners, faces, normals, uv


class Row:
    """One property: what a material is at each step, from 0 to 1, and what the picture needs beside it."""

    def __init__(self, material, arguments=(), lamp=False):
        self.material, self.arguments, self.lamp = material, list(arguments), lamp


def surface(colour, metallic, roughness, **extensions):
    return {"colour": colour, "metallic": metallic, "roughness": roughness,
            "extensions": {"KHR_materials_" + name: value for name, value in extensions.items()}}


PAINT, CLOTH, LEAF = (.5, .015, .02), (.02, .03, .12), (.25, .4, .08)
STEEL, IRON, BLACK = (.9, .9, .9), (.56, .57, .58), (.01, .01, .01)


def film(colour, metallic, **factors):
    return lambda s: surface(colour, metallic, .08, iridescence={
        "iridescenceFactor": 1, **{name: low + (high - low) * s for name, (low, high) in factors.items()}})


THICKER = {"iridescenceIor": (1.9, 1.9), "iridescenceThicknessMaximum": (100, 1000)}
DENSER = {"iridescenceIor": (1, 2.5), "iridescenceThicknessMaximum": (400, 400)}

ROWS = {
    "clearcoat": Row(lambda s: surface(PAINT, 0, .6, clearcoat={"clearcoatFactor": s})),
    "clearcoat_roughness": Row(lambda s: surface(PAINT, .6, .5, clearcoat={
        "clearcoatFactor": 1, "clearcoatRoughnessFactor": s})),
    "sheen": Row(lambda s: surface(CLOTH, 0, .9, sheen={
        "sheenColorFactor": [.9 * s, .8 * s, .6 * s], "sheenRoughnessFactor": .4})),
    "sheen_roughness": Row(lambda s: surface(CLOTH, 0, .9, sheen={
        "sheenColorFactor": [.9, .8, .6], "sheenRoughnessFactor": s})),
    "anisotropy": Row(lambda s: surface(STEEL, 1, .25, anisotropy={"anisotropyStrength": s})),
    "anisotropy_rotation": Row(lambda s: surface(STEEL, 1, .25, anisotropy={
        "anisotropyStrength": .8, "anisotropyRotation": s * math.pi})),
    "diffuse_transmission": Row(lambda s: surface(LEAF, 0, .6, diffuse_transmission={
        "diffuseTransmissionFactor": s, "diffuseTransmissionColorFactor": [.6, .8, .1]}), lamp=True),
}
for name, colour, metallic, factors in (("film_thickness", BLACK, 0, THICKER), ("film_on_metal", IRON, 1, THICKER),
                                        ("film_ior", BLACK, 0, DENSER)):
    for mode in ("rgb", "wavelengths"):
        ROWS["%s_%s" % (name, mode)] = Row(film(colour, metallic, **factors), ["--spectral", mode])


def write_scene(path, row):
    file = Gltf()
    used = set()
    for i in range(COUNT):
        look = row.material(i / (COUNT - 1))
        used |= set(look["extensions"])
        material = file.add_material(look["colour"], look["metallic"], look["roughness"],
                                     extensions=look["extensions"], doubleSided=True)
        file.add_node(mesh=file.add_mesh(material, *globe(RADIUS_M)), translation=[i, 0, 0])
        corners, faces = quad((-.4, -.16, 0), (.4, -.16, 0), (.4, .16, -.12), (-.4, .16, -.12))
        file.add_node(mesh=file.add_mesh(material, corners, faces, uv=[(0, 1), (1, 1), (1, 0), (0, 0)]),
                      translation=[i, -.72, 0])
    if row.lamp:
        used.add("KHR_materials_emissive_strength")
        shining = file.add_material((0, 0, 0), 0, 1, emissiveFactor=[1, 1, 1], extensions={
            "KHR_materials_emissive_strength": {"emissiveStrength": 6}})
        file.add_node(mesh=file.add_mesh(shining, *quad((-2, -1, -3), (COUNT + 1, -1, -3), (COUNT + 1, 1, -3),
                                                        (-2, 1, -3))), translation=[0, 2.2, 0])
    file.json["extensionsUsed"] = sorted(used)
    file.write(path)


def main():
    root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--petzval", default=os.path.join(root, "build/bin/petzval"))
    parser.add_argument("--spp", type=int, default=256)
    parser.add_argument("--out", default=os.path.join(root, "docs/pictures/materials"))
    parser.add_argument("names", nargs="*", help="; ".join(ROWS))
    args = parser.parse_args()
    os.makedirs(args.out, exist_ok=True)
    scenes = args.out if args.out != parser.get_default("out") else os.path.join(root, "out")
    os.makedirs(scenes, exist_ok=True)
    middle = (COUNT - 1) / 2
    for name in args.names or ROWS:
        if name not in ROWS:
            parser.error("there is no row %s; there are %s" % (name, ", ".join(ROWS)))
        scene = os.path.join(scenes, name + ".gltf")
        write_scene(scene, ROWS[name])
        picture = os.path.join(args.out, name + ".jpg")
        subprocess.run([args.petzval, "render", scene, "--env", "studio", "--background", "0.18,0.18,0.18", "--exposure", "-0.7",
                        "--look-at", "%g,-0.2,14,%g,-0.2,0" % (middle, middle), "--fov", "6.1", "--size", "910x190",
                        "--spp", str(args.spp), "--quiet", *ROWS[name].arguments, "-o", picture], check=True)
        print(picture)


if __name__ == "__main__":
    main()
