# SPDX-License-Identifier: Apache-2.0
"""The world, which becomes a sky beside the file, and the film."""
import math
import os

import bpy
import numpy as np

from .cameras import frame_words
from .glb import extras
from .nodes import find, nodes_of, surface_of, value_of

VIEWS = {"Standard": "sRGB", "Raw": "raw", "Filmic": "ACES", "Filmic Log": "ACES", "AgX": "ACES"}


def write_sky(path, colors):
    """Writes an EXR of floats; colors: rows from the bottom, columns, R, G, B."""
    height, width = colors.shape[:2]
    with open(path, "wb") as file:  # on a full disk Blender would say nothing
        os.posix_fallocate(file.fileno(), 0, 16 * width * height + 4096)
    image = bpy.data.images.new("petzval sky", width, height, float_buffer=True)
    try:
        image.colorspace_settings.is_data = True
        image.pixels.foreach_set(np.dstack([colors, np.ones((height, width))]).astype(np.float32).ravel())
        image.file_format = "OPEN_EXR"
        image.filepath_raw = path
        image.save()
    finally:
        bpy.data.images.remove(image)


def light_of(image):
    """What a picture holds, linear: rows from the bottom, columns, R, G, B."""
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(image.size[1], image.size[0], -1)
    pixels = np.repeat(pixels[..., :1], 3, axis=2) if pixels.shape[2] < 3 else pixels[..., :3]
    if image.is_float or image.colorspace_settings.is_data or "linear" in image.colorspace_settings.name.lower():
        return pixels
    return np.where(pixels <= 0.04045, pixels / 12.92, ((np.maximum(pixels, 0) + 0.055) / 1.055) ** 2.4)


def add_world(glb, world, path, lost):
    """path: of the .glb."""
    color, strength, image, turn = (0.0, 0.0, 0.0), 1.0, None, 0.0
    if world and not nodes_of(world):
        color = tuple(world.color)
    elif world:
        shader = surface_of(world, "OUTPUT_WORLD")
        if surface_of(world, "OUTPUT_WORLD", "Volume"):
            lost.append("volume of the world")
        if shader and shader.type == "BACKGROUND" and value_of(shader.inputs["Strength"]) is not None:
            strength, color = value_of(shader.inputs["Strength"]), value_of(shader.inputs["Color"])
            source = find(shader.inputs["Color"])
            if color is None:
                color = (0.0, 0.0, 0.0)
                if source.type == "TEX_ENVIRONMENT" and not (source.image and source.image.size[0]):
                    color = (1.0, 0.0, 1.0)
                    lost.append("the world's picture, which is missing")
                elif source.type == "TEX_ENVIRONMENT" and source.projection == "EQUIRECTANGULAR":
                    image, turn = source.image, rotation_of(source, lost)
                else:
                    lost.append(f"the world's {source.bl_label}: bake it to a picture")
        elif shader:
            lost.append(f"the world's {shader.bl_label}")
    if strength < 0 or min(color) < 0:
        lost.append("a world that takes light away")
        strength = 0.0
    if world and not getattr(getattr(world, "cycles_visibility", world), "camera", True):
        lost.append("a world that the camera does not see")
    own, sky = extras(glb.json["scenes"][0]), os.path.splitext(path)[0] + ".sky.exr"
    write_sky(sky, strength * (light_of(image) if image else np.full((2, 4, 3), color[:3])))
    own["sky"] = os.path.basename(sky)
    if turn:
        own["sky_rotation_deg"] = turn


def rotation_of(texture, lost):
    """Degrees, as petzval's sky_rotation_deg, by which a mapping turns a sky about the vertical axis."""
    mapping = find(texture.inputs["Vector"])
    if mapping is None or is_direction(texture):
        return 0.0
    if mapping.type != "MAPPING":
        lost.append(f"the sky's {mapping.bl_label}")
        return 0.0
    place, scale, (x, y, z) = (value_of(mapping.inputs[name]) or (0, 0, 0) for name in ("Location", "Scale", "Rotation"))
    others = (x, y, *place, *(s - 1 for s in scale))
    if mapping.vector_type not in ("POINT", "TEXTURE") or any(abs(s) > 1e-6 for s in others) or not is_direction(mapping):
        lost.append("the sky's mapping, but for a rotation about the vertical axis")
    return math.degrees(z if mapping.vector_type == "TEXTURE" else -z)


def is_direction(node):
    """Whether a node of a world is at the direction of the sky."""
    link = node.inputs["Vector"].links
    return bool(link) and (link[0].from_node.type, link[0].from_socket.name) == ("TEX_COORD", "Generated")


def add_film(glb, scene, framed, lost):
    """framed: the command has frame_words()."""
    own, view, render, cycles = extras(glb.json["scenes"][0]), scene.view_settings, scene.render, getattr(scene, "cycles", None)
    exposure = view.exposure + math.log2(max(1e-9, cycles.film_exposure if cycles else 1))
    if exposure:
        own["exposure_ev"] = exposure
    own["view"] = VIEWS.get(view.view_transform, "sRGB")
    for is_used, text in ((own["view"] == "ACES" or view.view_transform not in VIEWS,
                           f"the view {view.view_transform}: {own['view']} takes its place"),
                          (view.look != "None" or abs(view.gamma - 1) > 1e-6 or view.use_curve_mapping,
                           "look, gamma and curves of colour management"),
                          (render.use_border and not framed, f"the render region: {' '.join(frame_words(scene))}"),
                          (cycles and cycles.film_exposure != 1, "film exposure, in EXR files: PNG and JPEG have it"),
                          (render.use_motion_blur, "motion blur"),
                          (abs(render.pixel_aspect_x - render.pixel_aspect_y) > 1e-6, "pixels that are not square: the picture is as wide as they are shown"),
                          (cycles and cycles.sample_clamp_direct > 0, "clamped direct light"),
                          (cycles and cycles.max_bounces < 4, "few bounces: --method max-depth=N sets them"),
                          (cycles and getattr(cycles, "use_fast_gi", False), "fast global illumination")):
        if is_used:
            lost.append(text)
