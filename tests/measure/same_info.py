#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares what two builds make of glTF files, and of one file with each value changed in turn.

  same_info.py BEFORE/bin/petzval AFTER/bin/petzval RENDERED FOLDER...

Every .gltf and .glb below the folders is given to `petzval info`: output and exit code must be the
same. Then each value of a file that has every material, camera and light is replaced by values of
other types and ranges, and taken away: what `info` says, and the pixels of a small render, must be
the same. Of so many files RENDERED is the number of which one is rendered. Prints what differs; the exit code is 1 where something does.
"""
import base64, concurrent.futures, copy, difflib, json, pathlib, struct, subprocess, sys, tempfile, zlib

VALUES = [-3, -1, -0.001, 0, 0.25, 1, 1.001, 2, 7.5, 1e39, True, None, "x", "mask", [], {}, [1],
          [0.5, 0.5], [2, -1, 0.3], [0.1, 0.2, 0.3, 0.4], [1, 1, 1, 1, 1], ["x", 0, 0]]


def png():
    rows = b"".join(b"\0" + bytes([200, 90 + 30 * y, 255, 250] * 2) for y in range(2))
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 2, 8, 6, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def data_uri(kind, data):
    return f"data:{kind};base64," + base64.b64encode(data).decode()


def slot(**more):
    return {"index": 0, **more}


def moved_slot():
    return {"index": 0, "texCoord": 1,
            "extensions": {"KHR_texture_transform": {"offset": [0.1, 0.2], "scale": [2, 3],
                                                     "rotation": 0.4, "texCoord": 0}}}


def extended(name, **properties):
    return {"extensions": {"KHR_materials_" + name: properties}}


def materials():
    t = slot()
    core = {"name": "core", "emissiveFactor": [0.1, 0.2, 0.3], "alphaMode": "MASK",
            "alphaCutoff": 0.4, "doubleSided": True, "emissiveTexture": moved_slot(),
            "normalTexture": slot(scale=0.7), "occlusionTexture": slot(strength=0.6),
            "extras": {"petzval": {"illuminant": "a"}},
            "pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.8, 0.7, 0.6], "metallicFactor": 0.3,
                                     "roughnessFactor": 0.4, "baseColorTexture": t,
                                     "metallicRoughnessTexture": t}}
    glass = extended("transmission", transmissionFactor=0.8, transmissionTexture=moved_slot())
    glass["pbrMetallicRoughness"] = {"metallicFactor": 0, "roughnessFactor": 0}
    glass["extensions"].update(extended("ior", ior=1.4)["extensions"])
    glass["extensions"].update(extended("dispersion", dispersion=0.5)["extensions"])
    glass["extensions"].update(extended("volume", thicknessFactor=0.1, attenuationDistance=0.5,
                                        attenuationColor=[0.9, 0.5, 0.8])["extensions"])
    bright = extended("emissive_strength", emissiveStrength=3)
    bright["emissiveFactor"] = [0.5, 1, 0.25]
    return [core, glass, bright, {"pbrMetallicRoughness": {}},
            {**extended("unlit"), "emissiveFactor": [1, 1, 1]},
            extended("specular", specularFactor=0.5, specularTexture=t, specularColorTexture=t,
                     specularColorFactor=[0.5, 0.6, 1.7]),
            extended("pbrSpecularGlossiness", diffuseFactor=[0.5, 0.6, 0.7, 0.8],
                     specularFactor=[0.2, 0.3, 0.4], glossinessFactor=0.7, diffuseTexture=t,
                     specularGlossinessTexture=t),
            extended("clearcoat", clearcoatFactor=0.5, clearcoatRoughnessFactor=0.2,
                     clearcoatTexture=t, clearcoatRoughnessTexture=t,
                     clearcoatNormalTexture=slot(scale=0.4)),
            extended("sheen", sheenRoughnessFactor=0.3, sheenColorFactor=[0.2, 0.3, 0.4],
                     sheenColorTexture=t, sheenRoughnessTexture=t),
            extended("anisotropy", anisotropyStrength=0.5, anisotropyRotation=0.7,
                     anisotropyTexture=t),
            extended("iridescence", iridescenceFactor=0.8, iridescenceIor=1.5,
                     iridescenceThicknessMinimum=150, iridescenceThicknessMaximum=350,
                     iridescenceTexture=t, iridescenceThicknessTexture=t),
            extended("diffuse_transmission", diffuseTransmissionFactor=0.5,
                     diffuseTransmissionColorFactor=[0.4, 0.5, 0.6], diffuseTransmissionTexture=t,
                     diffuseTransmissionColorTexture=t)]


def rich_file():
    made = materials()
    corners = struct.pack("<12f", 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0)
    uv = struct.pack("<8f", 0, 0, 1, 0, 0, 1, 1, 1)
    indices = struct.pack("<6H", 0, 1, 2, 2, 1, 3)
    times, values = struct.pack("<2f", 0, 1), struct.pack("<2f", 0.2, 0.9)
    buffer = corners + uv + indices + times + values
    views, at = [], 0
    for part in (corners, uv, indices, times, values):
        views.append({"buffer": 0, "byteOffset": at, "byteLength": len(part)})
        at += len(part)
    nodes = [{"mesh": m, "translation": [m % 4 - 2, m // 4 - 1.5, 0], "rotation": [0, 0, 0, 1],
              "scale": [0.9, 0.9, 0.9]} for m in range(len(made))]
    for light in range(3):
        nodes.append({"translation": [0, 0, 3],
                      "extensions": {"KHR_lights_punctual": {"light": light}}})
    nodes += [{"camera": 0, "translation": [0, 0, 4]}, {"camera": 1, "translation": [0, 0, 4]},
              {"mesh": 0, "translation": [9, 9, 0],
               "extensions": {"KHR_node_visibility": {"visible": False}}}]
    return {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}],
        "extensionsUsed": ["KHR_lights_punctual"], "nodes": nodes, "materials": made,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2,
                                    "material": m}]} for m in range(len(made))],
        "buffers": [{"byteLength": len(buffer),
                     "uri": data_uri("application/octet-stream", buffer)}],
        "bufferViews": views,
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                       "min": [0, 0, 0], "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
                      {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"},
                      {"bufferView": 3, "componentType": 5126, "count": 2, "type": "SCALAR",
                       "min": [0], "max": [1]},
                      {"bufferView": 4, "componentType": 5126, "count": 2, "type": "SCALAR"}],
        "images": [{"uri": data_uri("image/png", png())}],
        "samplers": [{"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 33071}],
        "textures": [{"source": 0, "sampler": 0}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1, "zfar": 100,
                                                            "aspectRatio": 1.5}},
                    {"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 2, "znear": 0.1,
                                                              "zfar": 100}}],
        "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "point", "color": [1, 0.9, 0.8], "intensity": 20, "range": 30,
             "extras": {"petzval": {"radius_m": 0.1}}},
            {"type": "spot", "color": [1, 0.9, 0.8], "intensity": 20,
             "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.5}},
            {"type": "directional", "intensity": 2}]}},
    }


def places(value, path=()):
    """Paths of all values below one, but not of arrays' elements that are numbers."""
    for key, child in value.items() if isinstance(value, dict) else enumerate(value):
        if path + (key,) in [("buffers",), ("images",), ("bufferViews",), ("meshes",), ("asset",)]:
            continue
        if path == ("nodes",) and 0 < key < 12:  # as the first
            continue
        if isinstance(value, dict) or isinstance(child, dict):
            yield path + (key,)
        if isinstance(child, (dict, list)):
            yield from places(child, path + (key,))


def changed(document, path, change):
    document = copy.deepcopy(document)
    owner = document
    for key in path[:-1]:
        owner = owner[key]
    change(owner, path[-1])
    return document


def variants(document):
    yield "as it is", document
    for path in places(document):
        if path[0] not in ("materials", "cameras", "extensions", "nodes", "samplers", "textures"):
            continue
        name = "/".join(map(str, path))
        yield name + " absent", changed(document, path, lambda owner, key: owner.pop(key))
        for value in VALUES:
            yield (f"{name} = {json.dumps(value)}",
                   changed(document, path, lambda owner, key: owner.__setitem__(key, value)))
    # Animated values.
    for path in places(document):
        if path[0] not in ("materials", "cameras", "extensions", "nodes"):
            continue
        moving = copy.deepcopy(document)
        moving["animations"] = [{"samplers": [{"input": 3, "output": 4}], "channels": [
            {"sampler": 0, "target": {"path": "pointer", "extensions": {
                "KHR_animation_pointer": {"pointer": "/" + "/".join(map(str, path))}}}}]}]
        yield "moving " + "/".join(map(str, path)), moving


def outcome(program, *words):
    done = subprocess.run([program, *words], capture_output=True, timeout=120)
    # The BVH's memory hangs on how threads meet.
    told = b"\n".join(l for l in done.stdout.split(b"\n") if not l.startswith(b"  memory:"))
    return done.returncode, told, done.stderr


def texels(path):
    """The compressed pixels of a PNG, without its metadata, which name the build."""
    if not path.exists():
        return b""
    data, at, out = path.read_bytes(), 8, b""
    while at < len(data):
        size = int.from_bytes(data[at:at + 4], "big")
        if data[at + 4:at + 8] == b"IDAT":
            out += data[at + 8:at + 8 + size]
        at += 12 + size
    return out


def compare_file(programs, path):
    return [outcome(program, "info", str(path)) for program in programs]


def compare_variant(programs, every, folder, number, document):
    path = pathlib.Path(folder) / f"{number}.gltf"
    path.write_text(json.dumps(document))
    told = [outcome(program, "info", str(path)) for program in programs]
    if told[0] == told[1] and told[0][0] == 0 and number % every == 0:
        moment = ["--at", "0.5s"] if "animations" in document else []
        for i, program in enumerate(programs):
            picture = path.with_suffix(f".{i}.png")
            told[i] += outcome(program, "render", str(path), "-o", str(picture), "--size", "24x16",
                               "--spp", "1", "--exposure", "0", "--quiet", *moment)[:1]
            told[i] += (texels(picture),)
            picture.unlink(missing_ok=True)
    path.unlink()
    return told


def main():
    programs, every, folders = sys.argv[1:3], int(sys.argv[3]), sys.argv[4:]
    files = sorted(p for f in folders for p in pathlib.Path(f).rglob("*")
                   if p.suffix in (".gltf", ".glb"))
    count = differing = rendered = 0
    def tell(name, told):
        nonlocal count, differing, rendered
        count += 1
        rendered += len(told[0]) > 3
        if told[0] != told[1]:
            differing += 1
            print(f"{name}:", flush=True)
            before, after = ([f"exit {t[0]}"] + (t[1] + t[2]).decode(errors="replace").split("\n") +
                             [f"render: {t[3]} {zlib.crc32(t[4])}" for _ in t[3:4]] for t in told)
            for line in difflib.unified_diff(before, after, n=0, lineterm=""):
                if not line.startswith(("---", "+++", "@@")):
                    print("   ", line[:300], flush=True)
    with concurrent.futures.ThreadPoolExecutor(2) as pool, tempfile.TemporaryDirectory() as folder:
        for path, told in zip(files, pool.map(lambda p: compare_file(programs, p), files)):
            tell(path, told)
        print(f"{count} files: {differing} differ", flush=True)
        for (name, told) in pool.map(
                lambda v: (v[1][0], compare_variant(programs, every, folder, v[0], v[1][1])),
                enumerate(variants(rich_file()))):
            tell(name, told)
    print(f"{count} in all, {rendered} rendered: {differing} differ")
    return differing > 0


if __name__ == "__main__":
    sys.exit(main())
