# SPDX-License-Identifier: Apache-2.0
"""Plain copies of what renders show of a scene, for Blender's own exporter to write."""
import contextlib

import bpy
import numpy as np
from mathutils import Matrix

from .materials import Materials
from .nodes import nodes_of

FLAGS = {"is_holdout": "holdout", "is_shadow_catcher": "shadow catcher", "visible_camera": "invisible to the camera",
         "visible_shadow": "no shadow", "visible_diffuse": "no diffuse rays", "visible_glossy": "no glossy rays",
         "visible_transmission": "no rays through glass"}
SETTINGS = {"export_format": "GLB", "use_active_scene": True, "export_animations": False, "export_vertex_color": "ACTIVE",
            "export_all_vertex_colors": False}


@contextlib.contextmanager
def as_in_renders(view_layer, lost):
    """Gives what is seen in the window the settings of renders."""
    wishes = [(one, "hide_viewport", one.hide_render) for one in (*bpy.data.collections, *bpy.data.objects)]
    wishes += [(layer, "hide_viewport", False) for layer in layers_in(view_layer.layer_collection)]
    render = view_layer.id_data.render
    wishes += [(render, "simplify_subdivision", render.simplify_subdivision_render)]
    for one in bpy.data.objects:
        wishes += [(one, "show_instancer_for_viewport", one.show_instancer_for_render)]
        for modifier in one.modifiers:
            wishes += [(modifier, "show_viewport", modifier.show_render)]
            if hasattr(modifier, "render_levels"):
                wishes += [(modifier, "levels", modifier.render_levels)]
        for name in ("resolution", "resolution_u", "resolution_v"):  # 0: that of the window
            wishes += [(one.data, name, getattr(one.data, "render_" + name))] if getattr(one.data, "render_" + name, 0) else []
    undo = []
    for owner, name, value in wishes:
        before = getattr(owner, name)
        if before != value:
            try:
                setattr(owner, name, value)
                undo.append((owner, name, before))
            except AttributeError:  # of a library
                lost.append(f"{name} of renders of {owner.name}, which is linked")
    hidden = [one for one in view_layer.objects if one.hide_get()]
    for one in hidden:
        one.hide_set(False)
    try:
        yield
    finally:
        for owner, name, before in reversed(undo):
            setattr(owner, name, before)
        for one in hidden:
            one.hide_set(True)


def layers_in(layer):
    yield layer
    for child in layer.children:
        yield from layers_in(child)


def list_flags(one, layer, lost):
    lost += [f"{text}: {one.name}" for flag, text in FLAGS.items() if getattr(one, flag, True) == flag.startswith("is_")]
    if one.holdout_get(view_layer=layer) or one.indirect_only_get(view_layer=layer):
        lost.append(f"holdout or indirect only: {one.name}")
    if any(system.settings.type == "HAIR" and system.settings.render_type == "PATH" for system in one.particle_systems):
        lost.append(f"hair of {one.name}")


def is_closed(mesh):
    """Whether each edge that has faces has two."""
    edges = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("edge_index", edges)
    return set(np.bincount(edges)) <= {0, 2}


def is_pattern(one):
    """Whether an instance is what its parent places on vertices or faces, which renders show there alone."""
    parent = one.object.parent
    return bool(parent) and parent.instance_type in ("VERTS", "FACES") and not (one.is_instance and one.parent == parent)


class Meshes:
    """A scene of plain copies of all meshes, which is exported and then removed."""

    def __init__(self, lost):
        self.scene = bpy.data.scenes.new("Petzval")
        self.materials = Materials(lost)
        self.others = []  # lamps and cameras, with their places
        self._meshes, self._made, self._lost = {}, [], lost

    def add_all(self, depsgraph):
        self._override = depsgraph.view_layer.material_override
        for one in depsgraph.object_instances:
            if (one.is_instance or one.show_self) and not is_pattern(one):
                self._add(one.object, one.matrix_world.copy(), depsgraph.view_layer_eval)

    def export(self, path):
        """Writes it."""
        window, known = bpy.context.window, bpy.ops.export_scene.gltf.get_rna_type().properties.keys()
        before, window.scene = window.scene, self.scene
        try:
            with bpy.context.temp_override(window=window, area=None, region=None):  # an area of properties has a scene of its own
                bpy.ops.export_scene.gltf(filepath=path, **{key: value for key, value in SETTINGS.items() if key in known})
        finally:
            window.scene = before

    def _add(self, one, matrix, layer):
        if one.type in ("LIGHT", "CAMERA"):
            self.others.append((one.original, matrix))
        elif one.type in ("MESH", "CURVE", "SURFACE", "FONT", "META"):
            list_flags(one, layer, self._lost)
            looks = tuple(slot.material and slot.material.original for slot in one.material_slots)
            sheared = max(abs(a - b) for row, other in zip(matrix, Matrix.LocRotScale(*matrix.decompose()))
                          for a, b in zip(row, other)) > 1e-5 * max(1, matrix.median_scale)
            shape = one.data if one.type == "MESH" else one.original
            key = (shape.as_pointer(), looks, tuple(map(tuple, matrix)) if sheared else None)
            if key not in self._meshes:
                self._meshes[key] = self._plain(one, looks, matrix if sheared else None)
            if self._meshes[key]:
                copy = bpy.data.objects.new(one.name, self._meshes[key])
                copy.matrix_world = Matrix.Identity(4) if sheared else matrix
                self.scene.collection.objects.link(copy)
        elif one.type not in ("EMPTY", "ARMATURE", "LATTICE", "SPEAKER", "LIGHT_PROBE"):
            self._lost.append(f"{one.type.lower()} {one.name}")

    def _plain(self, one, looks, matrix):
        """Mesh of an object after its modifiers; None where it has no faces. matrix: that its points take."""
        mesh = bpy.data.meshes.new_from_object(one)  # as it is evaluated: that of an instance, where it is one
        if mesh is None:
            return None
        self._made.append(mesh)
        if not mesh.polygons:
            return None
        mesh.name = one.name
        if matrix:
            mesh.transform(matrix)
            if matrix.determinant() < 0:
                mesh.flip_normals()
        closed, shown = is_closed(mesh), set()
        if not mesh.materials:
            mesh.materials.append(None)
        for i, own in enumerate(mesh.materials):
            look = self._override or (looks[i] if i < len(looks) else own)
            mesh.materials[i] = self.materials.copy_of(look, closed)
            for node in nodes_of(look) if look else ():
                if node.type in ("VERTEX_COLOR", "ATTRIBUTE"):
                    name = getattr(node, "layer_name", None) or getattr(node, "attribute_name", None)
                    shown.add(name or mesh.color_attributes.default_color_name)
        for name in [one.name for one in mesh.color_attributes if one.name not in shown]:  # glTF multiplies by them
            mesh.color_attributes.remove(mesh.color_attributes[name])
        if mesh.color_attributes:
            mesh.color_attributes.render_color_index = 0
        return mesh

    def remove(self):
        for one in list(self.scene.collection.objects):
            bpy.data.objects.remove(one)
        bpy.data.scenes.remove(self.scene)
        for mesh in self._made:
            bpy.data.meshes.remove(mesh)
        self.materials.remove()
