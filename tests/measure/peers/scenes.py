# SPDX-License-Identifier: Apache-2.0
"""The rows of bench.py: where their scenes lie, and what is changed in them for all programs alike."""
import dataclasses
import json
import math
import os
import struct

import rooms

HERE = os.path.dirname(os.path.abspath(__file__))
ASSETS = os.path.join(HERE, "..", "..", "..", "assets", "scenes")
FOREIGN = ("house-foliage", "two-cylinder-engine", "flight-helmet", "damaged-helmet", "lowpoly-village", "hotel-room",
           "many-lights", "anatomy-bones", "grass-field", "dispersion-test", "cornell-box")
THIN = {  # radius of the lens and distance of focus, in the scene's units
    "house-foliage": (.02, 1.2), "two-cylinder-engine": (20, 1300), "flight-helmet": (.02, .9),
    "first-light": (.0125, 1.0)}


@dataclasses.dataclass
class Row:
    """A scene as one camera sees it."""
    name: str
    scene: str
    eye: list
    target: list
    vfov_deg: float
    sky: str = None
    lens_radius: float = 0
    focus: float = 1
    petzval: tuple = ()  # options of Petzval alone


def of_view(name, folder):
    """The row that FOLDER/view.json describes, or nothing where that file is not there."""
    path = os.path.join(folder, "view.json")
    if not os.path.exists(path):
        return None
    with open(path) as file:
        view = json.load(file)
    sky = view.get("env") and os.path.normpath(os.path.join(folder, view["env"]))
    return Row(name, os.path.join(folder, view["file"]), view["eye"], view["target"], view["vfov_deg"], sky)


def all_rows(scenes, folder):
    """All rows, as (name, Row or None); writes the rooms into the folder."""
    rooms.write_rooms(folder)
    rows = {name: of_view(name, os.path.join(scenes, name)) if scenes else None for name in FOREIGN}
    down = math.radians(6.5)  # its camera "table"
    rows["first-light"] = Row("first-light", os.path.join(ASSETS, "first_light.glb"), [0, 1.02, 0],
                              [0, 1.02 - math.sin(down), -math.cos(down)], 28)
    for name in rooms.SCENES:
        rows[name] = of_view(name, os.path.join(folder, name))
    for name, (radius, focus) in THIN.items():
        rows[name + "-thin"] = rows[name] and dataclasses.replace(
            rows[name], name=name + "-thin", lens_radius=radius, focus=focus)
    prisms = rows["dispersion-test"]
    rows["dispersion-test-rgb"] = prisms and dataclasses.replace(
        prisms, name="dispersion-test-rgb", petzval=("--spectral", "rgb"))
    return rows


def two_sided(gltf):
    """The text of a glTF file, all its materials two-sided."""
    parsed = json.loads(gltf.decode("utf-8-sig"))
    for material in parsed.get("materials", []):
        material["doubleSided"] = True
    return json.dumps(parsed).encode()


def prepare(row, folder):
    """Writes the scene with two-sided materials into the folder, as Cycles knows no others, and returns its path.

    The files that the scene names by relative paths are linked beside it."""
    source = os.path.dirname(os.path.abspath(row.scene))
    folder = os.path.join(folder, "scene-" + row.name)
    os.makedirs(folder)
    for name in os.listdir(source):
        if name != os.path.basename(row.scene):
            os.symlink(os.path.join(source, name), os.path.join(folder, name))
    with open(row.scene, "rb") as file:
        data = file.read()
    if data[:4] == b"glTF":
        length, = struct.unpack_from("<I", data, 12)
        text = two_sided(data[20:20 + length])
        text += b" " * (-len(text) % 4)
        data = struct.pack("<4sIIII", b"glTF", 2, len(data) - length + len(text), len(text),
                           0x4E4F534A) + text + data[20 + length:]
    else:
        data = two_sided(data)
    path = os.path.join(folder, os.path.basename(row.scene))
    with open(path, "wb") as file:
        file.write(data)
    return path
