# SPDX-License-Identifier: Apache-2.0
"""Plain copies of what renders show of a scene, for Blender's own exporter to write: meshes and materials."""
import bpy
from mathutils import Matrix

SHADERS = {"BSDF_PRINCIPLED", "BSDF_DIFFUSE", "BSDF_GLOSSY", "BSDF_GLASS", "EMISSION", "BSDF_TRANSPARENT"}

# Objects -----------------------------------------------------------------------------------------------------------


def layers_in(layer):
    """A layer collection and those in it that renders have."""
    if layer.exclude or layer.collection.hide_render:
        return
    yield layer
    for child in layer.children:
        yield from layers_in(child)


def as_in_renders(scene, objects, layers, lost):
    """Gives what is seen in the window the settings of renders. Returns what takes them back."""
    wishes = [(layer, "hide_viewport", False) for layer in layers]
    wishes += [(layer.collection, "hide_viewport", False) for layer in layers]
    if scene.render.use_simplify:
        wishes += [(scene.render, "simplify_subdivision", scene.render.simplify_subdivision_render)]
    for one in objects:
        wishes += [(one, "hide_viewport", False),
                   (one, "show_instancer_for_viewport", one.show_instancer_for_render)]
        for modifier in one.modifiers:
            wishes += [(modifier, "show_viewport", modifier.show_render)]
            if hasattr(modifier, "render_levels"):
                wishes += [(modifier, "levels", modifier.render_levels)]
        if one.type in ("CURVE", "SURFACE", "FONT") and one.data.render_resolution_u:
            wishes += [(one.data, "resolution_u", one.data.render_resolution_u)]
        if one.type == "META":
            wishes += [(one.data, "resolution", one.data.render_resolution)]
    undo = []
    for owner, name, value in wishes:
        before = getattr(owner, name)
        if before != value:
            try:
                setattr(owner, name, value)
                undo.append((owner, name, before))
            except AttributeError:  # of a library
                lost.add(f"{name} of renders of {owner.name}, which is linked")
    hidden = [one for one in objects if one.hide_get()]
    for one in hidden:
        one.hide_set(False)

    def back():
        for one in hidden:
            one.hide_set(True)
        for owner, name, before in reversed(undo):
            setattr(owner, name, before)

    return back


def list_flags(one, lost):
    for flag, wanted, text in (("is_holdout", False, "holdout"), ("is_shadow_catcher", False, "shadow catcher"),
                               ("visible_camera", True, "invisible to the camera"), ("visible_shadow", True, "no shadow"),
                               ("visible_diffuse", True, "no diffuse rays"), ("visible_glossy", True, "no glossy rays"),
                               ("visible_transmission", True, "no rays through glass")):
        if getattr(one, flag, wanted) != wanted:
            lost.add(f"{text}: {one.name}")
    if any(system.settings.type == "HAIR" for system in one.particle_systems):
        lost.add(f"hair of {one.name}")


class Meshes:
    """A scene of plain copies of all meshes, which is exported and then removed."""

    def __init__(self, depsgraph, rendered, lost):
        self.scene = bpy.data.scenes.new("Petzval")
        self.materials = Materials(lost)
        self.others = []  # lamps and cameras, with their places
        self._meshes, self._made, self._override = {}, [], bpy.context.view_layer.material_override
        try:
            self._add_all(depsgraph, rendered, lost)
        except Exception:
            self.remove()  # nothing of it stays in the file
            raise

    def _add_all(self, depsgraph, rendered, lost):
        for one in depsgraph.object_instances:
            real = one.object.original
            holder = one.parent.original if one.is_instance and one.parent else real
            if holder not in rendered or real.hide_render or not (one.is_instance or one.show_self):
                continue
            self._add(one.object, one.matrix_world.copy(), lost)

    def _add(self, one, matrix, lost):
        if one.type in ("LIGHT", "CAMERA"):
            self.others.append((one.original, matrix))
        elif one.type in ("MESH", "CURVE", "SURFACE", "FONT", "META"):
            list_flags(one, lost)
            looks = tuple(slot.material.original if slot.material else None for slot in one.material_slots)
            sheared = max(abs(a - b) for row, other in zip(matrix, Matrix.LocRotScale(*matrix.decompose()))
                          for a, b in zip(row, other)) > 1e-5 * max(1, matrix.median_scale)
            key = (one.data.as_pointer() if one.data else one.name, looks, tuple(map(tuple, matrix)) if sheared else None)
            if key not in self._meshes:
                self._meshes[key] = self._plain(one, looks, matrix if sheared else None)
            if self._meshes[key]:
                copy = bpy.data.objects.new(one.name, self._meshes[key])
                copy.matrix_world = Matrix.Identity(4) if sheared else matrix
                self.scene.collection.objects.link(copy)
        elif one.type not in ("EMPTY", "ARMATURE", "LATTICE", "SPEAKER", "LIGHT_PROBE"):
            lost.add(f"{one.type.lower()} {one.name}")

    def _plain(self, one, looks, matrix):
        """Mesh of an object after its modifiers; None where it has no faces."""
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
        for i in range(len(mesh.materials)):
            look = looks[i] if i < len(looks) else mesh.materials[i]
            mesh.materials[i] = self._override or look
        if self._override and not mesh.materials:
            mesh.materials.append(self._override)
        closed, colored = is_closed(mesh), False
        for i, look in enumerate(mesh.materials):
            if look:
                mesh.materials[i] = self.materials.copy_of(look, closed)
                colored = colored or any(node.type in ("VERTEX_COLOR", "ATTRIBUTE") for node in nodes_of(look))
        if not colored:  # glTF multiplies by them
            for attribute in list(mesh.color_attributes):
                mesh.color_attributes.remove(attribute)
        return mesh

    def remove(self):
        for one in list(self.scene.collection.objects):
            bpy.data.objects.remove(one)
        bpy.data.scenes.remove(self.scene)
        for mesh in self._made:
            bpy.data.meshes.remove(mesh)
        self.materials.remove()


def is_closed(mesh):
    """Whether each edge has two faces."""
    count = [0] * len(mesh.edges)
    for polygon in mesh.polygons:
        for index in polygon.loop_indices:
            count[mesh.loops[index].edge_index] += 1
    return bool(count) and all(n == 2 for n in count)


# Materials ---------------------------------------------------------------------------------------------------------

def nodes_of(owner):
    return owner.node_tree.nodes if owner.use_nodes and owner.node_tree else ()


def surface_of(owner, output="OUTPUT_MATERIAL"):
    """Node that a material's surface, or a lamp, is made by; None where it has none."""
    found = next((node for node in nodes_of(owner) if node.type == output and node.is_active_output), None)
    link = found and found.inputs["Surface"].links
    return link[0].from_node if link else None


class Materials:
    """Copies that Blender's exporter understands: other shaders become a Principled BSDF with the same links."""

    def __init__(self, lost):
        self.facts = {}  # by the copy's name: name, shader, and whether all its meshes are closed
        self._copies, self._lost = {}, lost

    def copy_of(self, material, closed):
        if material not in self._copies:
            copy = self._copies[material] = material.copy()
            copy.name = f"petzval {len(self._copies)}"
            copy.use_backface_culling = False  # which Cycles does not have
            self.facts[copy.name] = [material.name, self._mend(copy, material.name), True]
        self.facts[self._copies[material].name][2] &= closed
        return self._copies[material]

    def remove(self):
        for copy in self._copies.values():
            bpy.data.materials.remove(copy)

    def _mend(self, copy, name):
        """Makes the copy's surface a Principled BSDF. Returns what it was."""
        if not nodes_of(copy):
            copy.use_nodes = True
            copy.node_tree.nodes.clear()
            self._principled(copy).inputs["Base Color"].default_value = copy.diffuse_color
            return "BSDF_DIFFUSE"
        if any(node.type == "OUTPUT_MATERIAL" and node.inputs["Volume"].is_linked for node in nodes_of(copy)):
            self._lost.add(f"volume of material {name}")
        if any(node.type == "OUTPUT_MATERIAL" and node.inputs["Displacement"].is_linked for node in nodes_of(copy)):
            self._lost.add(f"displacement of material {name}")
        surface = surface_of(copy)
        if surface is None:
            return "NONE"
        if surface.type not in SHADERS:
            self._lost.add(f"{surface.bl_label} of material {name}")
            return surface.type
        for socket in surface.inputs:
            self._simplify(copy, socket, name)
        if surface.type in ("BSDF_DIFFUSE", "BSDF_GLOSSY", "BSDF_GLASS"):
            own = self._principled(copy)
            for old, new in (("Color", "Base Color"), ("Roughness", "Roughness"), ("Normal", "Normal"), ("IOR", "IOR")):
                if old in surface.inputs and not (old == "Roughness" and surface.type == "BSDF_DIFFUSE"):
                    if surface.inputs[old].is_linked:
                        copy.node_tree.links.new(surface.inputs[old].links[0].from_socket, own.inputs[new])
                    elif old != "Normal":
                        own.inputs[new].default_value = surface.inputs[old].default_value
            if surface.type == "BSDF_DIFFUSE" and surface.inputs["Roughness"].default_value > 0:
                self._lost.add(f"roughness of diffuse material {name}")
        if surface.type == "BSDF_PRINCIPLED":
            subsurface = surface.inputs.get("Subsurface") or surface.inputs.get("Subsurface Weight")
            if subsurface and (subsurface.is_linked or subsurface.default_value > 0):
                self._lost.add(f"subsurface scattering of material {name}")
            alpha = surface.inputs["Alpha"]
            copy.blend_method = "BLEND" if alpha.is_linked or alpha.default_value < 1 else "OPAQUE"
        return surface.type

    def _principled(self, copy):
        nodes, links = copy.node_tree.nodes, copy.node_tree.links
        output = next((node for node in nodes if node.type == "OUTPUT_MATERIAL" and node.is_active_output), None)
        own = nodes.new("ShaderNodeBsdfPrincipled")
        links.new(own.outputs[0], (output or nodes.new("ShaderNodeOutputMaterial")).inputs["Surface"])
        return own

    def _simplify(self, copy, socket, name):
        """Takes numbers for nodes of numbers, and names what the exporter passes over."""
        if not socket.is_linked:
            return
        source = socket.links[0].from_node
        if source.type in ("RGB", "VALUE"):
            value = source.outputs[0].default_value
            copy.node_tree.links.remove(socket.links[0])
            socket.default_value = value
            return
        picture = source
        if source.type == "NORMAL_MAP" and source.inputs["Color"].is_linked:
            picture = source.inputs["Color"].links[0].from_node
        elif source.type in ("SEPRGB", "SEPARATE_COLOR") and source.inputs[0].is_linked:
            picture = source.inputs[0].links[0].from_node
        elif source.type == "TEX_IMAGE" and socket.name in ("Roughness", "Metallic"):
            self._lost.add(f"the picture at {socket.name} of material {name}: put Separate Color before it")
        if picture.type in ("VERTEX_COLOR", "ATTRIBUTE") and socket.name in ("Color", "Base Color"):
            socket.default_value = (1, 1, 1, 1)
        elif picture.type != "TEX_IMAGE":
            self._lost.add(f"{picture.bl_label} at {socket.name} of material {name}: bake it")
        elif picture.image is None or not picture.image.has_data and not picture.image.size[0]:
            self._lost.add(f"the missing picture at {socket.name} of material {name}")
        elif picture.image.is_float:
            self._lost.add(f"the exact colours of the picture of floats {picture.image.name}: make it one of 8 bits")
        elif picture.inputs["Vector"].is_linked:
            place = picture.inputs["Vector"].links[0]
            if place.from_node.type not in ("UVMAP", "MAPPING") and place.from_socket.name != "UV":
                self._lost.add(f"{place.from_node.bl_label} coordinates of material {name}")
