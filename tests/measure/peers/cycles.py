# SPDX-License-Identifier: Apache-2.0
"""Renders a glTF file with Blender's Cycles to a linear EXR: its own settings, less what biases it.

    blender -b --factory-startup -noaudio -P cycles.py -- '{"scene": "a.glb", "output": "a.exr", ...}'

Run by programs.py, which says what the JSON holds. For Blender 3.4 and 5.2, whose names for the
same things differ. Prints "CYCLES done" at its end, as Blender's exit status tells nothing of scripts.
"""
import json
import math
import os
import sys

import bpy
import numpy
from mathutils import Matrix, Vector

wanted = json.loads(sys.argv[sys.argv.index("--") + 1])
# Sobol points scrambled after Owen in both; in 5.2 from tables, the better of its two patterns for
# the error of a pixel (against_cycles.md has the numbers).
PATTERNS = ("SOBOL", "TABULATED_SOBOL")
# glTF has y up, Blender z: (x, y, z) -> (x, -z, y).
TURN = Matrix(((1, 0, 0, 0), (0, 0, -1, 0), (0, 1, 0, 0), (0, 0, 0, 1)))


def set_first(thing, name, values):
    """Sets the property to the first of the values that this Blender knows."""
    for value in values:
        try:
            setattr(thing, name, value)
            return
        except TypeError:
            pass
    raise SystemExit("this Blender knows none of %s for %s" % (values, name))


def load(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    # Debian 12's numpy has dropped names that its importer of glTF still uses.
    for name, kind in (("bool", bool), ("int", int), ("float", float), ("object", object)):
        if not hasattr(numpy, name):
            setattr(numpy, name, kind)
    import addon_utils
    addon_utils.enable("cycles")
    addon_utils.enable("io_scene_gltf2")
    options = bpy.ops.import_scene.gltf.get_rna_type().properties.keys()
    units = next(name for name in options if name.endswith("convert_lighting_mode"))
    bpy.ops.import_scene.gltf(filepath=os.path.abspath(path), **{units: "COMPAT"})


def mend_volume(tree, node):
    """Gives the volume the absorption of KHR_materials_volume, -ln(colour) / distance; the importer's
    is (1 - colour) / distance. One that absorbs nothing is taken out: Cycles would march through it."""
    colour, density = node.inputs["Color"], node.inputs["Density"]
    sigma = [-math.log(max(c, 1e-6)) * density.default_value for c in colour.default_value[:3]]
    most = max(sigma)
    if most > 0:
        density.default_value = most
        colour.default_value = [1 - s / most for s in sigma] + [1]
    else:
        tree.nodes.remove(node)


def mend_materials():
    """The importer of 3.4 links the hidden output of its colour mixers, which Cycles then drops,
    texture and all, and leaves out alpha cutoffs."""
    for material in bpy.data.materials:
        if not material.use_nodes:
            continue
        tree = material.node_tree
        for link in list(tree.links):
            node = link.from_node
            if node.bl_idname == "ShaderNodeMix" and node.data_type == "RGBA" and not link.from_socket.enabled:
                tree.links.new(node.outputs[2], link.to_socket)
        for node in [n for n in tree.nodes if n.bl_idname == "ShaderNodeVolumeAbsorption"]:
            mend_volume(tree, node)
        if bpy.app.version >= (4, 2) or material.blend_method != "CLIP":
            continue
        for node in [n for n in tree.nodes if n.bl_idname == "ShaderNodeBsdfPrincipled"]:
            alpha = node.inputs["Alpha"]
            if alpha.is_linked:
                source = alpha.links[0].from_socket
                step = tree.nodes.new("ShaderNodeMath")
                step.operation = "GREATER_THAN"
                step.inputs[1].default_value = material.alpha_threshold
                tree.links.new(source, step.inputs[0])
                tree.links.new(step.outputs[0], alpha)


def set_camera(scene):
    eye, target = Vector(wanted["look_at"][:3]), Vector(wanted["look_at"][3:])
    back = (eye - target).normalized()
    right = Vector((0, 1, 0)).cross(back).normalized()
    up = back.cross(right)
    pose = Matrix([[right[i], up[i], back[i], eye[i]] for i in range(3)] + [[0, 0, 0, 1]])
    data = bpy.data.cameras.new("peer")
    camera = bpy.data.objects.new("peer", data)
    scene.collection.objects.link(camera)
    camera.matrix_world = TURN @ pose
    data.sensor_fit, data.sensor_height = "VERTICAL", 24
    data.angle_y = math.radians(wanted["fov_deg"])
    data.clip_start, data.clip_end = 1e-4 * (eye - target).length, 1e12
    if wanted["lens_radius_m"] > 0:
        data.dof.use_dof = True
        data.dof.aperture_fstop = data.lens * 1e-3 / (2 * wanted["lens_radius_m"])
        data.dof.focus_distance = wanted["focus_m"]
    scene.camera = camera


def set_lights(scene):
    for thing in scene.collection.all_objects:
        if thing.type == "LIGHT":  # glTF's lights are points
            thing.data.shadow_soft_size = 0
            if thing.data.type == "SUN":
                thing.data.angle = 0
            thing.data.cycles.max_bounces = 1024
    world = scene.world = bpy.data.worlds.new("peer")
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    nodes.clear()
    background, out = nodes.new("ShaderNodeBackground"), nodes.new("ShaderNodeOutputWorld")
    links.new(background.outputs[0], out.inputs["Surface"])
    background.inputs["Color"].default_value = (0, 0, 0, 1)
    # A picture of the sky keeps Cycles' own importance map ("AUTOMATIC", 4096 x 2048).
    world.cycles.max_bounces = 1024
    if wanted["environment"]:
        image = nodes.new("ShaderNodeTexEnvironment")
        image.image = bpy.data.images.load(os.path.abspath(wanted["environment"]))
        set_first(image.image.colorspace_settings, "name", ("Linear", "Linear Rec.709"))
        links.new(image.outputs[0], background.inputs["Color"])
    else:
        world.cycles.sampling_method = "NONE"


def set_render(scene):
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y = wanted["width"], wanted["height"]
    render.resolution_percentage = 100
    render.threads_mode, render.threads = "FIXED", wanted["threads"]
    render.dither_intensity = 0
    render.use_compositing = render.use_sequencer = False
    scene.view_settings.view_transform = "Raw"
    settings = render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGB", "32"
    cycles.device = "CPU"
    set_first(cycles, "sampling_pattern", [wanted["pattern"]] if wanted["pattern"] else PATTERNS)
    cycles.samples, cycles.seed = wanted["samples"], wanted["seed"]
    cycles.use_adaptive_sampling = bool(wanted["noise_threshold"])
    if wanted["noise_threshold"]:
        cycles.adaptive_threshold, cycles.adaptive_min_samples = wanted["noise_threshold"], 0  # 0: its own choice
    cycles.use_denoising = cycles.use_fast_gi = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = cycles.blur_glossy = 0
    cycles.min_light_bounces = cycles.min_transparent_bounces = 0
    for kind in ("max", "diffuse", "glossy", "transmission", "volume"):
        setattr(cycles, kind + "_bounces", wanted["bounces"])
    cycles.transparent_max_bounces = 64
    cycles.pixel_filter_type = "BOX"
    cycles.use_auto_tile = False
    for thing in scene.collection.all_objects:
        if thing.type == "MESH":
            owner = thing if hasattr(thing, "shadow_terminator_geometry_offset") else thing.cycles
            owner.shadow_terminator_geometry_offset = 0


load(wanted["scene"])
mend_materials()
scene = bpy.context.scene
set_camera(scene)
set_lights(scene)
set_render(scene)
scene.render.filepath = os.path.abspath(wanted["output"])
bpy.ops.render.render(write_still=True)
print("CYCLES done")
