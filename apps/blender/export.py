# SPDX-License-Identifier: Apache-2.0
"""Writes the scene of a Blender file as a .glb that Petzval renders as Cycles does.

    blender -b FILE.blend -P apps/blender/export.py -- OUT.glb

Blender's own exporter writes meshes and materials. What it loses is put into the file here: sizes and strengths of lamps,
the world, depth of field, solid glass, exposure. What Petzval does not render is listed. For Blender 3.4 and newer.
"""
import json
import math
import os
import struct
import sys

import bpy
from mathutils import Matrix

if __package__:
    from . import meshes
else:  # as a script
    sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
    import meshes

# Blender's z is up, glTF's y.
TO_GLTF = Matrix(((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1)))
VIEWS = {"Standard": "sRGB", "Raw": "raw", "Filmic": "ACES", "Filmic Log": "ACES", "AgX": "ACES"}


class Lost(list):
    """What Petzval does not render, in words, each once."""

    def add(self, text):
        if text not in self:
            self.append(text)


class Glb:
    """A .glb whose JSON is changed."""

    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        length = struct.unpack_from("<I", data, 12)[0]
        self.json = json.loads(data[20:20 + length])
        self.rest = data[20 + length:]

    def save(self, path):
        text = json.dumps(self.json, ensure_ascii=False).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sIII4s", b"glTF", 2, 20 + len(text) + len(self.rest), len(text), b"JSON"))
            file.write(text + self.rest)

    def add(self, kind, value):
        self.json.setdefault(kind, []).append(value)
        return len(self.json[kind]) - 1

    def use(self, extension):
        used = self.json.setdefault("extensionsUsed", [])
        if extension not in used:
            used.append(extension)

    def place(self, node, matrix):
        """Adds a node to the scene; matrix: Blender's, to the world."""
        node["matrix"] = [x for column in (TO_GLTF @ matrix).transposed() for x in column]
        self.json["scenes"][0].setdefault("nodes", []).append(self.add("nodes", node))


def extras(owner):
    return owner.setdefault("extras", {}).setdefault("petzval", {})


def unscaled(matrix):
    """Place and turn of a matrix, without scale and mirror: it looks along -z."""
    z, x = matrix.col[2].xyz.normalized(), matrix.col[0].xyz.normalized()
    y = z.cross(x).normalized()
    out = Matrix.Identity(4)
    for i, axis in enumerate((y.cross(z), y, z, matrix.translation)):
        out.col[i].xyz = axis
    return out


def write_meshes(scene, path, lost):
    """Writes the meshes alone. Returns lamps and cameras with their places, and the materials' copies by name."""
    layers = list(meshes.layers_in(bpy.context.view_layer.layer_collection))
    rendered = {one for layer in layers for one in layer.collection.objects if not one.hide_render}
    back = meshes.as_in_renders(scene, rendered, layers, lost)
    try:
        plain = meshes.Meshes(bpy.context.evaluated_depsgraph_get(), rendered, lost)
    finally:
        back()
    window = bpy.context.window
    known = bpy.ops.export_scene.gltf.get_rna_type().properties.keys()
    wishes = {"export_format": "GLB", "use_active_scene": True, "export_cameras": False, "export_lights": False,
              "export_animations": False, "export_apply": False, "export_extras": False, "export_skins": False,
              "export_morph": False, "export_tangents": False, "export_yup": True}
    try:
        if window:
            window.scene = plain.scene
        bpy.ops.export_scene.gltf(filepath=path, **{key: value for key, value in wishes.items() if key in known})
        return plain.others, dict(plain.materials.facts)
    finally:
        if window:
            window.scene = scene
        plain.remove()


# Lamps: Cycles' watts and radiance become candela, lux and nits of the same number, so that 1 is 1 everywhere. ------


def add_lamp(glb, one, matrix, lost):
    lamp = one.data
    strength = lamp.energy * 2 ** getattr(lamp, "exposure", 0)
    color = list(lamp.color)
    if getattr(lamp, "use_temperature", False):
        color = [a * b for a, b in zip(color, lamp.temperature_color)]
    if not getattr(lamp, "normalize", True):
        lost.add(f"the strength of lamp {one.name}, which is not normalised")
    if lamp.use_nodes and lamp.node_tree:
        shader = meshes.surface_of(lamp, "OUTPUT_LIGHT")
        if shader is None:
            return  # it sends nothing
        if shader.type != "EMISSION" or any(socket.is_linked for socket in shader.inputs):
            lost.add(f"nodes of lamp {one.name}")
        else:
            strength *= shader.inputs["Strength"].default_value
            color = [a * b for a, b in zip(color, shader.inputs["Color"].default_value)]
    if getattr(getattr(lamp, "cycles", None), "is_portal", False) or strength == 0 or max(color) <= 0:
        return
    if strength < 0 or min(color) < 0:
        lost.add(f"lamp {one.name}, which takes light away")
        return
    if not getattr(getattr(lamp, "cycles", None), "cast_shadow", lamp.use_shadow):
        lost.add(f"no shadow: {one.name}")
    light = {"name": one.name, "color": color}
    node = {"name": one.name}
    own = {"visible": False}
    turn = unscaled(matrix)
    if lamp.type == "SUN":
        light.update(type="directional", intensity=strength)
        if lamp.angle > 0:
            own["angle_deg"] = min(179.0, math.degrees(lamp.angle))
        if lamp.angle > math.radians(35):
            lost.add(f"the exact strength of sun {one.name}, whose disc is wide")
    elif lamp.type in ("POINT", "SPOT"):
        light.update(type=lamp.type.lower(), intensity=strength / (4 * math.pi))
        if lamp.shadow_soft_size > 0:
            own["radius_m"] = lamp.shadow_soft_size
            if lamp.type == "SPOT" and lamp.shadow_soft_size > 0.3:
                lost.add(f"the exact cone of spot {one.name}, which is wide")
        if lamp.type == "SPOT" and bpy.app.version < (4, 0):
            # Those of older versions fall off with the cosine too, as a flat lamp does.
            size_m = max(1e-4, 2 * lamp.shadow_soft_size)
            extras(node).update(area=[size_m, size_m], shape="ellipse", visible=False)
        if lamp.type == "SPOT":
            outer = lamp.spot_size / 2
            # Where the smooth rim begins: Cycles blends over this part of the cone.
            light["spot"] = {"outerConeAngle": min(outer, math.pi / 2), "innerConeAngle": inner_angle(outer, lamp.spot_blend)}
            if lamp.spot_blend > 0:
                lost.add("the smooth rim of spots: up to 11 % of the light on the axis off, as glTF's is another")
    else:
        scale = matrix.to_scale()
        size_x = lamp.size * abs(scale.x)
        size_y = (lamp.size_y if lamp.shape in ("RECTANGLE", "ELLIPSE") else lamp.size) * abs(scale.y)
        area = extras(node)
        area["area"] = [max(1e-6, size_x), max(1e-6, size_y)]
        round_ = lamp.shape in ("DISK", "ELLIPSE")
        if round_:
            area["shape"] = "ellipse"
        # Radiance P / (4 A) before Blender 4.0, P / (pi A) since (projects.blender.org/blender/blender/issues/109404).
        area.update(intensity_cd=strength / (4 if bpy.app.version < (4, 0) else math.pi), color=color, visible=False)
        if getattr(lamp, "spread", math.pi) < math.pi - 1e-4:
            lost.add(f"spread of area lamp {one.name}")
        glb.place(node, turn)
        return
    if "radius_m" in own or "angle_deg" in own:
        extras(light).update(own)
    most = max(color)
    if most > 1:
        light["color"] = [c / most for c in color]
        light["intensity"] *= most
    glb.use("KHR_lights_punctual")
    lights = glb.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {}).setdefault("lights", [])
    lights.append(light)
    node["extensions"] = {"KHR_lights_punctual": {"light": len(lights) - 1}}
    glb.place(node, turn)


def inner_angle(outer, blend):
    """Half angle of the full cone of a spot as glTF has it. Cycles' rim is a smooth step in the cosine, glTF's a square:
    they part least, by 0.11, where the square ends after 0.8 of the step."""
    cosine = math.cos(outer)
    return min(math.acos(min(1.0, cosine + 0.8 * blend * (1 - cosine))), outer * 0.999)


# Cameras -----------------------------------------------------------------------------------------------------------


def is_wide(camera, width, height):
    """Whether the sensor fits the picture's width."""
    return camera.sensor_fit == "HORIZONTAL" or (camera.sensor_fit == "AUTO" and width >= height)


def half_height(camera, width, height):
    """Tangent of half the vertical angle of view."""
    side = camera.sensor_height if camera.sensor_fit == "VERTICAL" else camera.sensor_width
    return side / (2 * camera.lens) * (height / width if is_wide(camera, width, height) else 1)


def frame_words(scene, width, height):
    """Words of the command line for a picture of this size: with lens shift, a part of a larger frame about the axis."""
    camera = scene.camera and scene.camera.data
    if not camera or camera.type != "PERSP" or not (camera.shift_x or camera.shift_y):
        return ["--size", f"{width}x{height}"]
    side = width if is_wide(camera, width, height) else height
    right, up = round(2 * camera.shift_x * side), round(2 * camera.shift_y * side)  # in halves of a pixel
    full = width + abs(right), height + abs(up)
    upright = half_height(camera, width, height) * full[1] / height
    words = ["--size", f"{full[0]}x{full[1]}", "--crop", f"{(abs(right) + right) // 2},{(abs(up) - up) // 2},{width},{height}",
             "--fov", f"{math.degrees(2 * math.atan(upright)):.7g}"]
    if camera.dof.use_dof:
        tall = 2 * camera.lens * upright
        words += ["--sensor", f"{tall * full[0] / full[1]:.7g}x{tall:.7g}"]
    return words


def add_camera(glb, scene, one, matrix, framed, lost):
    camera = one.data
    render = scene.render
    width = render.resolution_x * render.pixel_aspect_x
    height = render.resolution_y * render.pixel_aspect_y
    out = {"name": one.name}
    wide = is_wide(camera, width, height)
    if camera.type == "PERSP":
        upright = half_height(camera, width, height)
        out["type"] = "perspective"
        out["perspective"] = {"yfov": 2 * math.atan(upright), "aspectRatio": width / height,
                              "znear": max(camera.clip_start, 1e-4)}
        if camera.dof.use_dof and camera.dof.aperture_fstop > 0:
            focus = camera.dof.focus_distance
            if camera.dof.focus_object:
                place = camera.dof.focus_object.matrix_world.translation
                focus = -(matrix.inverted() @ place).z
            own = {"fstop": camera.dof.aperture_fstop}
            if focus > 0:
                own["focus_m"] = focus
            else:
                lost.add(f"the focus of camera {one.name}, which lies behind it")
            own["sensor_mm"] = [2 * camera.lens * upright * width / height, 2 * camera.lens * upright]
            extras(out).update(own)
            if camera.dof.aperture_blades >= 3:
                turn = math.degrees(camera.dof.aperture_rotation)
                own["aperture"] = f"polygon:{camera.dof.aperture_blades},{turn:g}"
                extras(out).update(own)
            if abs(camera.dof.aperture_ratio - 1) > 1e-3:
                lost.add(f"aperture ratio of camera {one.name}")
    elif camera.type == "ORTHO":
        half = camera.ortho_scale / 2  # along the side that fits
        if camera.dof.use_dof:
            lost.add(f"depth of field of orthographic camera {one.name}")
        out["type"] = "orthographic"
        out["orthographic"] = {"xmag": half if wide else half * width / height,
                               "ymag": half * height / width if wide else half, "znear": 1e-3, "zfar": 1e4}
    else:
        lost.add(f"panoramic camera {one.name}")
        return
    if (camera.shift_x or camera.shift_y) and not (framed and camera.type == "PERSP"):
        words = "" if camera.type == "ORTHO" else f": render with {' '.join(frame_words(scene, int(width), int(height)))}"
        lost.add(f"lens shift of camera {one.name} is not in the file{words}")
    if matrix.determinant() < 0:
        lost.add(f"the mirror of camera {one.name}")
    glb.place({"name": one.name, "camera": glb.add("cameras", out)}, unscaled(matrix))


# Materials ---------------------------------------------------------------------------------------------------------


def mend_material(glb, json_material, facts, lost):
    name, shader, closed = facts
    json_material["name"] = name
    json_material["doubleSided"] = True
    metal = json_material.setdefault("pbrMetallicRoughness", {})
    extensions = json_material.setdefault("extensions", {})
    if shader == "BSDF_DIFFUSE":
        metal.update(metallicFactor=0, roughnessFactor=1)
        extensions["KHR_materials_specular"] = {"specularFactor": 0}
    elif shader == "BSDF_GLOSSY":
        metal["metallicFactor"] = 1
    elif shader == "BSDF_GLASS":
        metal["metallicFactor"] = 0
        extensions["KHR_materials_transmission"] = {"transmissionFactor": 1}
    elif shader == "BSDF_TRANSPARENT":
        metal["baseColorFactor"] = [1, 1, 1, 0]
        json_material["alphaMode"] = "BLEND"
    elif shader == "NONE" or (shader == "EMISSION" and "emissiveFactor" not in json_material):
        metal["baseColorFactor"] = [0, 0, 0, 1]
        extensions["KHR_materials_specular"] = {"specularFactor": 0}
    if extensions.get("KHR_materials_transmission", {}).get("transmissionFactor", 0) > 0:
        extras(json_material)["solid"] = closed
        if not closed:
            lost.add(f"refraction of material {name}: a mesh that has it is open, and counts as a thin pane")
    for extension in extensions:
        glb.use(extension)
    if not extensions:
        del json_material["extensions"]


def add_default_material(glb):
    """What Cycles gives to faces without a material: a diffuse surface of 0.8, where glTF's is white."""
    bare = [one for mesh in glb.json.get("meshes", []) for one in mesh["primitives"] if "material" not in one]
    if not bare:
        return
    index = glb.add("materials", {
        "name": "none", "doubleSided": True, "extensions": {"KHR_materials_specular": {"specularFactor": 0}},
        "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.8, 0.8, 1], "metallicFactor": 0}})
    glb.use("KHR_materials_specular")
    for one in bare:
        one["material"] = index


# World and film ----------------------------------------------------------------------------------------------------


def write_sky(path, colors, width, height):
    """Writes an EXR of floats, R, G, B for each pixel, the bottom row first."""
    image = bpy.data.images.new("petzval sky", width, height, float_buffer=True)
    try:
        image.colorspace_settings.is_data = True
        image.pixels = [x for color in colors for x in (*color, 1.0)]
        image.file_format = "OPEN_EXR"
        image.filepath_raw = path
        image.save()
    finally:
        bpy.data.images.remove(image)


def add_world(glb, scene, path, lost):
    world = scene.world
    sky = os.path.splitext(path)[0] + ".sky.exr"
    color, strength, image, turn = (0.0, 0.0, 0.0), 1.0, None, 0.0
    if world and not world.use_nodes:
        color = tuple(world.color)
    elif world and world.node_tree:
        output = next((node for node in world.node_tree.nodes
                       if node.type == "OUTPUT_WORLD" and node.is_active_output), None)
        links = output.inputs["Surface"].links if output else ()
        shader = links[0].from_node if links else None
        if output and output.inputs["Volume"].is_linked:
            lost.add("volume of the world")
        if shader and shader.type == "BACKGROUND" and not shader.inputs["Strength"].is_linked:
            strength = shader.inputs["Strength"].default_value
            source = shader.inputs["Color"].links[0].from_node if shader.inputs["Color"].is_linked else None
            if source is None:
                color = tuple(shader.inputs["Color"].default_value[:3])
            elif source.type == "TEX_ENVIRONMENT" and not (source.image and source.image.size[0]):
                color = (1.0, 0.0, 1.0)
                lost.add("the world's picture, which is missing")
            elif source.type == "TEX_ENVIRONMENT" and source.projection == "EQUIRECTANGULAR":
                image, turn = source.image, rotation_of(source, lost)
            else:
                lost.add(f"the world's {source.bl_label}: bake it to a picture")
        elif shader:
            lost.add(f"the world's {shader.bl_label}")
    if strength < 0 or min(color) < 0:
        lost.add("a world that takes light away")
        strength = 0.0
    if world and not getattr(getattr(world, "cycles_visibility", world), "camera", True):
        lost.add("a world that the camera does not see")
    own = extras(glb.json["scenes"][0])
    if image:
        width, height = image.size
        pixels = list(image.pixels)
        step = len(pixels) // (width * height)
        linear = image.is_float or image.colorspace_settings.is_data
        decode = (lambda x: x) if linear else (lambda x: x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4)
        colors = [tuple(strength * decode(pixels[i * step + c]) for c in range(3)) for i in range(width * height)]
        write_sky(sky, colors, width, height)
        own["sky_rotation_deg"] = turn
    else:
        write_sky(sky, [tuple(strength * c for c in color)] * 8, 4, 2)
    own["sky"] = os.path.basename(sky)


def rotation_of(texture, lost):
    """Degrees, as petzval's sky_rotation_deg, by which a mapping turns a sky about the vertical axis."""
    vector = texture.inputs["Vector"]
    mapping = vector.links[0].from_node if vector.is_linked else None
    if mapping is None:
        return 0.0
    if mapping.type != "MAPPING":
        lost.add(f"the sky's {mapping.bl_label}")
        return 0.0
    x, y, z = mapping.inputs["Rotation"].default_value
    plain = mapping.vector_type == "POINT" and all(abs(s - 1) < 1e-6 for s in mapping.inputs["Scale"].default_value)
    if abs(x) > 1e-6 or abs(y) > 1e-6 or not plain or any(abs(s) > 1e-6 for s in mapping.inputs["Location"].default_value):
        lost.add("the sky's mapping, but for a rotation about the vertical axis")
    return -math.degrees(z)


def add_film(glb, scene, lost):
    own = extras(glb.json["scenes"][0])
    view = scene.view_settings
    exposure = view.exposure + math.log2(max(1e-9, scene.cycles.film_exposure if hasattr(scene, "cycles") else 1))
    if exposure:
        own["exposure_ev"] = exposure
    own["view"] = VIEWS.get(view.view_transform, "sRGB")
    if own["view"] != "sRGB" and view.view_transform != "Raw":
        lost.add(f"the view {view.view_transform}: {own['view']} takes its place")
    if view.look != "None" or abs(view.gamma - 1) > 1e-6 or view.use_curve_mapping:
        lost.add("look, gamma and curves of colour management")
    render, cycles = scene.render, getattr(scene, "cycles", None)
    for is_used, text in ((render.use_motion_blur, "motion blur"), (render.use_border, "the render region"),
                          (abs(render.pixel_aspect_x - render.pixel_aspect_y) > 1e-6, "pixels that are not square"),
                          (cycles and cycles.sample_clamp_direct > 0, "clamped direct light"),
                          (cycles and cycles.max_bounces < 4, "few bounces: --method max-depth=N sets them"),
                          (cycles and getattr(cycles, "use_fast_gi", False), "fast global illumination")):
        if is_used:
            lost.add(text)


def export(path, scene=None, framed=False):
    """Writes the scene at its frame. framed: the command has frame_words(). Returns what Petzval does not render, a line
    each."""
    scene = scene or bpy.context.scene
    lost = Lost()
    others, materials = write_meshes(scene, path, lost)
    glb = Glb(path)
    glb.json.setdefault("scenes", [{}])
    for json_material in glb.json.get("materials", []):
        if json_material.get("name") in materials:
            mend_material(glb, json_material, materials[json_material["name"]], lost)
    add_default_material(glb)
    # Cycles takes the scene's camera wherever it is, shown or not.
    cameras = [(one, matrix) for one, matrix in others if one.type == "CAMERA" and one != scene.camera]
    if scene.camera:
        evaluated = scene.camera.evaluated_get(bpy.context.evaluated_depsgraph_get())
        cameras.insert(0, (evaluated, evaluated.matrix_world.copy()))
    else:
        lost.add("a camera: the scene has none that is active, and Petzval takes the first, or frames it")
    for one, matrix in cameras:
        add_camera(glb, scene, one, matrix, framed and one.name == scene.camera.name, lost)
    for one, matrix in others:
        if one.type == "LIGHT":
            add_lamp(glb, one, matrix, lost)
    add_world(glb, scene, path, lost)
    add_film(glb, scene, lost)
    glb.save(path)
    return lost


def main():
    words = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    if len(words) != 1:
        sys.exit("blender -b FILE.blend -P export.py -- OUT.glb")
    for line in export(os.path.abspath(words[0])):
        print(f"petzval: not rendered: {line}")


if __name__ == "__main__":
    main()
