# SPDX-License-Identifier: Apache-2.0
"""Writes a scene as a .glb that Petzval renders as Cycles does.

Blender's own exporter writes meshes and materials. What it loses is put into the file here: sizes and strengths of lamps,
the world, depth of field, solid glass, exposure. What Petzval does not render is listed. For Blender 3.4 and newer.
"""
import bpy

from .cameras import add_camera, frame_words  # noqa: F401
from .glb import Glb
from .lamps import add_lamp
from .materials import mend_material
from .meshes import Meshes, as_in_renders
from .world import add_film, add_world


def export(path, scene=None, framed=False):
    """Writes the scene at its frame. framed: the command has frame_words(). Returns what Petzval does not render, a line
    each."""
    scene, layer, lost = scene or bpy.context.scene, bpy.context.view_layer, []
    plain = Meshes(lost)
    try:
        with as_in_renders(layer, lost):
            plain.add_all(bpy.context.evaluated_depsgraph_get())
        plain.export(path)
        glb = Glb(path)
        for out in glb.json.get("materials", []):
            mend_material(out, *plain.materials.originals[out["name"]], lost)
    finally:
        plain.remove()
    # Cycles takes the scene's camera wherever it is, shown or not.
    views = [(one, matrix) for one, matrix in plain.others if one.type == "CAMERA" and one != scene.camera]
    if scene.camera:
        evaluated = scene.camera.evaluated_get(bpy.context.evaluated_depsgraph_get())
        views.insert(0, (evaluated, evaluated.matrix_world.copy()))
    else:
        lost.append("a camera: the scene has none that is active, and Petzval takes the first, or frames it")
    for one, matrix in views:
        add_camera(glb, scene, one, matrix, framed and one.name == scene.camera.name, lost)
    lamps = [(one, matrix) for one, matrix in plain.others if one.type == "LIGHT"]
    for one, matrix in lamps:
        add_lamp(glb, one, matrix, lost)
    if len(lamps) > 1 and any(one.data.type == "AREA" for one, _ in lamps):
        lost.append("light of lamps through other lamps: here those with a size block it")
    add_world(glb, scene.world, path, lost)
    add_film(glb, scene, framed, lost)
    glb.save(path)
    return list(dict.fromkeys(lost))
