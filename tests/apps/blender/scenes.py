# SPDX-License-Identifier: Apache-2.0
"""Scenes that Blender's Cycles and Petzval must render alike.

    blender -b --factory-startup -noaudio --python-exit-code 1 -P tests/apps/blender/scenes.py -- PETZVAL [NAME...]

Each scene is made here, rendered by Cycles, exported by apps/blender/export.py and rendered by Petzval. The means over
the picture and over its middle must agree within 2 %, outlines within half a pixel.
"""
import math
import os
import subprocess
import sys
import tempfile

import bpy
import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "../../../apps/blender"))
from export import scene as petzval  # noqa: E402

SIZE, SAMPLES, MOST = (96, 64), 96, 0.02


def material(name, kind="ShaderNodeBsdfDiffuse", color=(0.5, 0.5, 0.5, 1), **values):
    out = bpy.data.materials.new(name)
    out.use_nodes = True
    nodes = out.node_tree.nodes
    nodes.clear()
    surface = nodes.new(kind)
    (surface.inputs.get("Color") or surface.inputs["Base Color"]).default_value = color
    for key, value in values.items():
        surface.inputs[key if key in surface.inputs else "Specular IOR Level"].default_value = value
    out.node_tree.links.new(surface.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return out


def add_object(name, data, location=(0, 0, 0), rotation_deg=(0, 0, 0)):
    one = bpy.data.objects.new(name, data)
    one.location = location
    one.rotation_euler = [math.radians(x) for x in rotation_deg]
    bpy.context.scene.collection.objects.link(one)
    return one


def add_mesh(add, look, **values):
    add(**values)
    one = bpy.context.object
    one.data.materials.append(look)
    return one


def plane(look, **values):
    return add_mesh(bpy.ops.mesh.primitive_plane_add, look, **values)


def cube(look, **values):
    return add_mesh(bpy.ops.mesh.primitive_cube_add, look, **values)


def add_lamp(kind, rotation_deg=(0, 0, 0), location=(0, 0, 2), **values):
    lamp = bpy.data.lights.new("lamp", kind)
    for key, value in values.items():
        setattr(lamp, key, value)
    return add_object("lamp", lamp, location, rotation_deg)


def background():
    return bpy.context.scene.world.node_tree.nodes["Background"]


def even_world(color=(0.5, 0.5, 0.5), strength=1):
    background().inputs["Color"].default_value = (*color, 1)
    background().inputs["Strength"].default_value = strength


def begin():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = SAMPLES, False, False
    cycles.sample_clamp_indirect = cycles.blur_glossy = cycles.light_sampling_threshold = 0
    cycles.pixel_filter_type, cycles.filter_width = "GAUSSIAN", 1.5
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.view_settings.view_transform = "Standard"
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    even_world((0, 0, 0))
    camera = bpy.data.cameras.new("camera")
    camera.lens = 50
    scene.camera = add_object("camera", camera, (0, -4, 4), (45, 0, 0))
    plane(material("card"), size=3)


def point():
    add_lamp("POINT", energy=100, shadow_soft_size=0)


def ball():
    add_lamp("POINT", energy=100, shadow_soft_size=0.1, color=(1, 0.6, 0.2))


def spot():
    """In its full cone: the rim falls off otherwise."""
    add_lamp("SPOT", energy=100, shadow_soft_size=0, spot_size=math.radians(120), spot_blend=0)


def rim():
    """Its light is nowhere further off than 0.12 of that on the axis."""
    add_lamp("SPOT", energy=100, shadow_soft_size=0, spot_size=math.radians(70), spot_blend=0.6)


def sun():
    add_lamp("SUN", rotation_deg=(30, 20, 0), energy=3, angle=math.radians(5))
    cube(material("box"), size=0.5, location=(0, 0, 0.5))


def wide_sun():
    add_lamp("SUN", rotation_deg=(30, 20, 0), energy=3, angle=math.radians(80))
    cube(material("box"), size=0.5, location=(0, 0, 0.5))


def area():
    lamp = add_lamp("AREA", rotation_deg=(20, 0, 30), energy=50, shape="RECTANGLE", size=1, size_y=0.5)
    lamp.scale = (0.5, 2, 1)


def disk():
    add_lamp("AREA", energy=50, shape="DISK", size=1, color=(1, 0.5, 0.2))


def emission():
    plane(material("lamp", "ShaderNodeEmission", (1, 0.8, 0.6, 1), Strength=7), size=0.6, location=(0, 0, 1.5))


def sky():
    """A picture with a rotation, on a box that throws a shadow."""
    image = bpy.data.images.new("sky", 64, 32, float_buffer=True)
    pixels = np.zeros((32, 64, 4), np.float32)
    pixels[..., 3] = 1
    pixels[16:, :, :3] = 0.3
    pixels[24:28, 10:16, :3] = (20, 10, 5)
    image.pixels = pixels.ravel().tolist()
    tree = bpy.context.scene.world.node_tree
    texture, mapping, place = (tree.nodes.new("ShaderNode" + kind) for kind in ("TexEnvironment", "Mapping", "TexCoord"))
    texture.image = image
    mapping.inputs["Rotation"].default_value = (0, 0, math.radians(40))
    tree.links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
    tree.links.new(texture.outputs[0], background().inputs["Color"])
    background().inputs["Strength"].default_value = 2
    cube(material("box"), size=0.5, location=(0, 0, 0.5))


def glass():
    """Refracts, as its mesh is closed."""
    even_world()
    add_mesh(bpy.ops.mesh.primitive_uv_sphere_add, material("glass", "ShaderNodeBsdfGlass", (1, 1, 1, 1), IOR=1.5, Roughness=0),
             radius=0.6, location=(0, 0, 0.7), segments=64, ring_count=32)
    bpy.ops.object.shade_smooth()
    cube(material("red", color=(0.8, 0.1, 0.1, 1)), size=0.3, location=(0.9, 0.5, 0.15))


def placed():
    """Collections, instances of geometry nodes, modifiers, hidden and animated things."""
    even_world()
    scene = bpy.context.scene
    blue, hidden = material("blue", color=(0.1, 0.2, 0.8, 1)), material("hidden", color=(1, 0, 0, 1))
    cube(hidden, size=2, location=(0, 0, 0)).hide_render = True
    cube(blue, size=0.3, location=(-1, 0.8, 0.15)).hide_viewport = True  # from view alone
    shared = bpy.data.collections.new("shared")
    one = cube(blue, size=0.3, location=(0, 0, 0.15))
    scene.collection.objects.unlink(one)
    shared.objects.link(one)
    holder = add_object("holder", None, (1, -0.5, 0), (0, 0, 45))
    holder.instance_type, holder.instance_collection = "COLLECTION", shared
    grid = plane(material("grid", color=(0.1, 0.6, 0.1, 1)), size=0.6, location=(-0.8, -0.7, 0.2))
    group = bpy.data.node_groups.new("dots", "GeometryNodeTree")
    if hasattr(group, "interface"):
        group.interface.new_socket("in", in_out="INPUT", socket_type="NodeSocketGeometry")
        group.interface.new_socket("out", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    else:
        group.inputs.new("NodeSocketGeometry", "in")
        group.outputs.new("NodeSocketGeometry", "out")
    first, last = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    dots, ball_ = group.nodes.new("GeometryNodeInstanceOnPoints"), group.nodes.new("GeometryNodeMeshUVSphere")
    ball_.inputs["Radius"].default_value = 0.12
    group.links.new(first.outputs[0], dots.inputs["Points"])
    group.links.new(ball_.outputs[0], dots.inputs["Instance"])
    group.links.new(dots.outputs[0], last.inputs[0])
    grid.modifiers.new("dots", "NODES").node_group = group
    moving = cube(blue, size=0.3, location=(0.5, 1, 0.15))
    moving.modifiers.new("bevel", "BEVEL").width = 0.1
    moving.keyframe_insert("location", frame=1)
    moving.location.x = -0.5
    moving.keyframe_insert("location", frame=11)
    lens = scene.camera.data
    lens.keyframe_insert("lens", frame=1)
    lens.lens = 40
    lens.keyframe_insert("lens", frame=11)
    scene.frame_set(11)


def instances():
    """Collections with lamps in instances under a mirror that moves; patterns on vertices and faces; several materials."""
    even_world((0.1, 0.1, 0.1))
    shared = bpy.data.collections.new("shared")
    one = cube(material("red", color=(0.8, 0.1, 0.1, 1)), size=0.4, location=(0, 0, 0.2))
    one.data.materials.append(material("blue", color=(0.1, 0.1, 0.9, 1)))
    for i, polygon in enumerate(one.data.polygons):
        polygon.material_index = i % 2
    round_ = one.modifiers.new("round", "SUBSURF")
    round_.levels, round_.render_levels = 0, 3
    one.modifiers.new("thick", "SOLIDIFY").material_offset = 1
    for thing in (one, add_lamp("POINT", energy=20, location=(0.3, 0, 1), shadow_soft_size=0.05)):
        bpy.context.scene.collection.objects.unlink(thing)
        shared.objects.link(thing)
    parent = add_object("parent", None)
    parent.scale.x = -1
    parent.keyframe_insert("location", frame=1)
    parent.location.x = 0.8
    parent.keyframe_insert("location", frame=21)
    for x in (-0.8, 0.3):
        holder = add_object("holder", None, (x, 0.2, 0), (0, 0, 30))
        holder.instance_type, holder.instance_collection, holder.parent = "COLLECTION", shared, parent
    for kind, x in (("VERTS", -0.9), ("FACES", 0.9)):
        pattern = cube(material(kind, color=(0.9, 0.9, 0, 1)), size=0.3)
        pattern.parent = plane(material("holder"), size=1.2, location=(x, -0.5, 0.3))
        pattern.parent.instance_type = kind
        pattern.parent.show_instancer_for_render = kind == "FACES"
    bpy.context.scene.frame_set(11)


def linked():
    """A collection of another file, whose material has the name of one here."""
    even_world()
    path = os.path.join(bpy.app.tempdir, "library.blend")
    shared = bpy.data.collections.new("shared")
    one = cube(material("red", color=(0.8, 0.1, 0.1, 1)), size=0.5, location=(0, 0, 0.25))
    one.modifiers.new("round", "SUBSURF").render_levels = 2
    one.modifiers["round"].levels = 2
    bpy.context.scene.collection.objects.unlink(one)
    shared.objects.link(one)
    bpy.data.libraries.write(path, {shared})
    for kind, owner in ((bpy.data.collections, shared), (bpy.data.objects, one)):
        kind.remove(owner)
    bpy.data.materials.remove(bpy.data.materials["red"])
    cube(material("red", color=(0.1, 0.2, 0.8, 1)), size=0.4, location=(1, -0.6, 0.2))
    with bpy.data.libraries.load(path, link=True) as (_, wanted):
        wanted.collections = ["shared"]
    for place in ((-0.7, 0, 0), (0.3, 0.5, 0)):
        holder = add_object("holder", None, place, (0, 0, 30))
        holder.instance_type, holder.instance_collection = "COLLECTION", bpy.data.collections["shared"]


def blur():
    """Depth of field: a lamp out of focus."""
    plane(material("lamp", "ShaderNodeEmission", (1, 1, 1, 1), Strength=20), size=0.1, location=(0, 0, 1.5))
    even_world((0.1, 0.1, 0.1))
    dof = bpy.context.scene.camera.data.dof
    dof.use_dof, dof.aperture_fstop, dof.focus_object = True, 0.4, bpy.data.objects["Plane"]


def shift():
    """Lens shift with depth of field."""
    blur()
    camera = bpy.context.scene.camera.data
    camera.shift_x, camera.shift_y = 0.21, -0.13
    camera.dof.aperture_fstop = 0.2
    cube(material("box", color=(0.7, 0.3, 0.1, 1)), size=0.6, location=(0.7, 0.5, 0.8))


def region():
    """A part of a frame with lens shift, a sensor that fits the height, a percentage of the size."""
    even_world()
    camera, render = bpy.context.scene.camera.data, bpy.context.scene.render
    camera.shift_x, camera.shift_y, camera.sensor_fit, camera.sensor_height = -0.125, 0.0625, "VERTICAL", 26
    render.resolution_x, render.resolution_y, render.resolution_percentage = 2 * SIZE[0] + 1, 2 * SIZE[1] + 1, 50
    render.use_border = render.use_crop_to_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.1, 0.9, 0.05, 0.8
    cube(material("box", color=(0.2, 0.7, 0.3, 1)), size=0.5, location=(0.5, 0, 0.25))


def ortho():
    even_world()
    camera = bpy.context.scene.camera.data
    camera.type, camera.ortho_scale, camera.shift_x, camera.shift_y = "ORTHO", 4, 0.2, -0.15
    cube(material("box", color=(0.2, 0.7, 0.3, 1)), size=0.5, location=(0.5, 0, 0.25))


def settings():
    """Modifiers, curves and instancers as renders have them; objects that only some views show."""
    even_world()
    ball_ = cube(material("ball", color=(0.1, 0.2, 0.8, 1)), size=1, location=(-0.8, 0, 0.5))
    ball_.modifiers.new("round", "SUBSURF").levels = 0
    ball_.modifiers["round"].render_levels = 3
    row = cube(material("row", color=(0.8, 0.2, 0.1, 1)), size=0.3, location=(0.2, -0.8, 0.15))
    row.modifiers.new("row", "ARRAY").count = 3
    row.modifiers["row"].show_viewport = False
    bpy.ops.curve.primitive_bezier_circle_add(radius=0.4, location=(0.9, 0.6, 0.2))
    ring = bpy.context.object.data
    ring.bevel_depth, ring.resolution_u, ring.render_resolution_u = 0.15, 1, 24
    ring.materials.append(material("ring", color=(0.1, 0.7, 0.1, 1)))
    outside = bpy.data.collections.new("outside")
    bpy.context.scene.collection.children.link(outside)
    outside.hide_render = True
    hidden = cube(material("hidden"), size=2)
    bpy.context.scene.collection.objects.unlink(hidden)
    outside.objects.link(hidden)
    bpy.context.scene.camera.hide_render = True  # Cycles takes it all the same
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("second", bpy.data.cameras.new("second")))


def mirrored():
    """Scales that are negative, uneven, or shear."""
    lamp = add_lamp("AREA", energy=80, shape="ELLIPSE", size=1, size_y=0.4, location=(0.5, 0, 2.5))
    lamp.scale = (-1, 1, 1)
    add_lamp("AREA", energy=500, size=1, location=(0, 0, 3)).scale = (1, 1, -1)  # shines upwards
    parent = add_object("parent", None, (-0.5, 0.3, 0.4))
    parent.scale = (2.5, 1, 1)
    child = cube(material("child", color=(0.7, 0.5, 0.1, 1)), size=0.4)
    child.rotation_euler = (0, 0, math.radians(40))
    child.parent = parent
    cube(material("other", color=(0.1, 0.6, 0.6, 1)), size=0.4, location=(0.9, -0.6, 0.3)).scale = (1, -2, 1)


def looks():
    """Materials that glTF says otherwise: textures on other shaders, colours that are not used, alpha, black."""
    even_world()
    # Large fields: between texels Cycles mixes what a display shows, and Petzval light.
    image = bpy.data.images.new("fields", 32, 32)
    image.pixels = [x for i in range(1024) for x in ((0.9, 0.1, 0.1, 1) if (i // 16 + i // 512) % 2 else (0.1, 0.1, 0.9, 1))]
    image.pack()
    for i, kind in enumerate(("ShaderNodeBsdfDiffuse", "ShaderNodeBsdfGlossy")):
        look = material("textured", kind)
        texture = look.node_tree.nodes.new("ShaderNodeTexImage")
        texture.image = image
        surface = next(node for node in look.node_tree.nodes if node.type.startswith("BSDF"))
        look.node_tree.links.new(texture.outputs[0], surface.inputs["Color"])
        plane(look, size=0.7, location=(-1, 0.9 - 0.8 * i, 0.05))
    painted = plane(material("painted", "ShaderNodeBsdfPrincipled", Roughness=1, Specular=0), size=0.7, location=(0, 0.9, 0.05))
    colors = painted.data.color_attributes.new("unused", "FLOAT_COLOR", "POINT")
    for one in colors.data:
        one.color = (0.1, 0.1, 0.1, 1)
    clear = material("clear", "ShaderNodeBsdfPrincipled", (0, 0, 0, 1), Alpha=0.4, Roughness=1, Specular=0)
    plane(clear, size=0.7, location=(0, 0.1, 0.05))
    plane(material("off", "ShaderNodeEmission", Strength=0), size=0.7, location=(0, -0.7, 0.05))
    plane(material("window", "ShaderNodeBsdfTransparent", (1, 1, 1, 1)), size=0.7, location=(1, 0.9, 0.05))
    number = material("number")
    tree = number.node_tree
    rgb = tree.nodes.new("ShaderNodeRGB")
    rgb.outputs[0].default_value = (0.1, 0.8, 0.2, 1)
    tree.links.new(rgb.outputs[0], tree.nodes["Diffuse BSDF"].inputs["Color"])
    first = plane(number, size=0.7, location=(1, 0.1, 0.05))
    second = add_object("second", first.data, (1, -0.7, 0.05))  # the same mesh, another material
    second.material_slots[0].link, second.material_slots[0].material = "OBJECT", material("own", color=(0.8, 0.8, 0.1, 1))
    first.data.materials[0].use_backface_culling = True
    first.rotation_euler = (math.pi, 0, 0)


def gloss():
    """The gloss of black dielectrics alone, as bodies differ before Blender 4; glass of a colour."""
    even_world()
    level, ior = (1, 1.45) if bpy.app.version < (4, 0) else (0.5, 1.8)  # 8 % are reflected straight on
    black = material("black", "ShaderNodeBsdfPrincipled", (0, 0, 0, 1), Specular=level, Roughness=0.2, IOR=ior)
    plane(black, size=2.8, location=(0, 0, 0.05))
    clear = material("clear", "ShaderNodeBsdfPrincipled", (0.8, 0.5, 0.2, 1), Roughness=0, IOR=1.5)
    principled = clear.node_tree.nodes["Principled BSDF"]
    (principled.inputs.get("Transmission") or principled.inputs["Transmission Weight"]).default_value = 1
    add_mesh(bpy.ops.mesh.primitive_uv_sphere_add, clear, radius=0.6, location=(0.5, 0, 0.7), segments=64, ring_count=32)
    bpy.ops.object.shade_smooth()


def maps():
    """Pictures that are turned, scaled and moved, or lie on a second map; colours of vertices, of several."""
    even_world()
    image = bpy.data.images.new("quarters", 64, 64)
    pixels = np.ones((64, 64, 4), np.float32)
    pixels[:32, :32], pixels[32:, :32], pixels[:32, 32:] = (0.9, 0.1, 0.1, 1), (0.1, 0.9, 0.1, 1), (0.1, 0.1, 0.9, 1)
    image.pixels = pixels.ravel().tolist()
    image.pack()
    for kind, x in (("Mapping", -0.8), ("UVMap", 0.8)):
        look = material(kind)
        tree = look.node_tree
        texture, place, bend = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNode" + kind), tree.nodes.new("NodeReroute")
        texture.image = image
        for a, b in ((place.outputs[0], texture.inputs[0]), (texture.outputs[0], bend.inputs[0]),
                     (bend.outputs[0], tree.nodes["Diffuse BSDF"].inputs[0])):
            tree.links.new(a, b)
        card = plane(look, size=1.2, location=(x, 0.6, 0.05))
        if kind == "UVMap":
            place.uv_map = card.data.uv_layers.new(name="second").name
            for one in card.data.uv_layers["second"].data:
                one.uv = (0.5 * one.uv[0] + 0.1, 2 * one.uv[1])
        else:
            tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["UV"], place.inputs[0])
            place.inputs["Rotation"].default_value = (0, 0, 0.5)
            place.inputs["Scale"].default_value, place.inputs["Location"].default_value = (1.7, 0.8, 1), (0.3, 0.2, 0)
    look = material("painted")
    node = look.node_tree.nodes.new("ShaderNodeVertexColor")
    node.layer_name = "second"
    look.node_tree.links.new(node.outputs[0], look.node_tree.nodes["Diffuse BSDF"].inputs[0])
    card = plane(look, size=0.9, location=(0, -0.8, 0.05))
    for name, color in (("first", (0.9, 0.1, 0.1, 1)), ("second", (0.1, 0.8, 0.3, 1))):
        for one in card.data.color_attributes.new(name, "FLOAT_COLOR", "POINT").data:
            one.color = color


SCENES = {one.__name__: one for one in (point, ball, spot, rim, sun, wide_sun, area, disk, emission, sky, glass, placed, instances, linked,
                                          blur, shift, region, ortho, settings, mirrored, looks, gloss, maps)}


def pixels_of(path):
    image = bpy.data.images.load(path)
    image.colorspace_settings.is_data = True
    pixels = np.array(image.pixels, np.float32).reshape(image.size[1], image.size[0], -1)[::-1, :, :3]
    bpy.data.images.remove(image)
    return pixels


def compare(name, program, folder):
    """Complaints about a scene."""
    begin()
    SCENES[name]()
    bpy.context.view_layer.update()
    there = os.path.join(folder, name)
    before = {kind: len(getattr(bpy.data, kind)) for kind in ("objects", "meshes", "scenes", "images")}
    lost = petzval.export(there + ".glb")
    complaints = [f"export left {kind} behind" for kind, count in before.items() if len(getattr(bpy.data, kind)) != count]
    subprocess.run([program, "render", there + ".glb", *petzval.frame_words(bpy.context.scene), "--spp", str(SAMPLES), "--method",
                    "filter=gauss", "--spectral", "rgb", "--quiet", "-o", there + ".petzval.exr"], check=True)
    bpy.context.scene.render.filepath = there + ".cycles.exr"
    bpy.ops.render.render(write_still=True)
    cycles, own = pixels_of(there + ".cycles.exr"), pixels_of(there + ".petzval.exr")
    rows, columns = slice(SIZE[1] // 4, -SIZE[1] // 4), slice(SIZE[0] // 4, -SIZE[0] // 4)
    for what, a, b in (("picture", cycles, own), ("middle", cycles[rows, columns], own[rows, columns])):
        ratio = b.mean(axis=(0, 1)) / np.maximum(a.mean(axis=(0, 1)), 1e-9)
        print(f"{name}: {what}: Petzval over Cycles {np.round(ratio, 4)}")
        if name == "rim":
            off = np.abs(b - a).max() / a.max()
            print(f"rim: at most {off:.3f} off")
            if off > 0.12:
                complaints.append(f"{off} of the light on the axis is off")
        # glTF's gloss is Schlick's, Cycles' Fresnel's: at 45° 0.89 of it.
        elif np.abs(ratio - 1).max() > (0.1 if name == "gloss" else MOST):
            complaints.append(f"the {what} is {ratio} times as bright")
    # Outlines: the shift between the pictures, from their gradients (Lucas and Kanade 1981).
    a, b = np.log1p(cycles.mean(axis=2)), np.log1p(own.mean(axis=2))
    gradient = np.stack([g.ravel() for g in np.gradient((a + b) / 2)], axis=1)
    shift = np.linalg.lstsq(gradient, (a - b).ravel(), rcond=None)[0]
    print(f"{name}: shift {np.round(shift, 3)} px; lost: {'; '.join(lost) or 'nothing'}")
    if np.abs(shift).max() > 0.5:
        complaints.append(f"is shifted by {shift} pixels")
    return [f"{name}: {text}" for text in complaints]


def check_losses(folder):
    """Complaints about what is lost in silence."""
    begin()
    scene = bpy.context.scene
    is_old = bpy.app.version < (4, 0)
    looks = [material("noise"), material("mixed", "ShaderNodeBsdfToon"), material("tinted", "ShaderNodeBsdfGlass", (0.8, 0.5, 0.2, 1)),
             material("dark", "ShaderNodeBsdfGlossy", Roughness=1), material("plastic", "ShaderNodeBsdfPrincipled"),
             material("bright", color=(2, 0.5, 0.5, 1)), material("stretched", "ShaderNodeBsdfPrincipled", Anisotropic=0.5)]
    tree = looks[0].node_tree
    tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs[0], tree.nodes["Diffuse BSDF"].inputs[0])
    image = bpy.data.images.new("numbers", 4, 4)
    image.colorspace_settings.name = "Non-Color"
    looks.append(material("numbers"))
    tree = looks[-1].node_tree
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    tree.links.new(texture.outputs[0], tree.nodes["Diffuse BSDF"].inputs[0])
    for look in looks:
        plane(look)
    bpy.context.object.is_holdout = True
    add_lamp("POINT", energy=1, shadow_soft_size=0.6)
    add_lamp("AREA", energy=1, spread=1)
    parent = add_object("parent", None)
    parent.scale, scene.camera.parent = (1, 1, 3), parent
    mixed = scene.world.node_tree.nodes.new("ShaderNodeTexSky")
    scene.world.node_tree.links.new(mixed.outputs[0], background().inputs["Color"])
    scene.cycles.film_exposure, scene.render.use_motion_blur, scene.render.pixel_aspect_x = 2, True, 2
    bpy.context.view_layer.update()
    lost = "\n".join(petzval.export(os.path.join(folder, "losses.glb")))
    wanted = ["Noise Texture at Color of material noise", "Toon BSDF of material mixed", "what glass tinted reflects", "open",
              "how dark very rough metal", "colours beyond 0 and 1 of material bright", "anisotropy of material stretched",
              "colour space of picture numbers", "holdout", "falloff near lamp", "spread of area lamp", "through other lamps",
              "shear of camera", "the world's Sky Texture", "film exposure", "motion blur", "not square"]
    wanted += ["gloss of Principled bodies"]
    wanted += ["light of Principled bodies", "unless they have Multiscatter GGX"] if is_old else []
    return [f"{text}: is lost in silence" for text in wanted if text not in lost]


def main():
    program, *names = sys.argv[sys.argv.index("--") + 1:]
    with tempfile.TemporaryDirectory() as folder:
        folder = os.environ.get("KEEP", folder)
        complaints = [text for name in names or SCENES for text in compare(name, program, folder)] + check_losses(folder)
    for text in complaints:
        print(text)
    print(f"{len(names or SCENES)} scenes, {len(complaints)} complaints")
    if complaints:
        raise SystemExit(1)


main()
