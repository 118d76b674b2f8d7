# SPDX-License-Identifier: Apache-2.0
"""Materials: copies for Blender's own exporter, which knows the Principled BSDF alone, and what it writes wrongly."""
import math

import bpy

from .glb import extras
from .nodes import find, nodes_of, surface_of, value_of

IS_OLD = bpy.app.version < (4, 0)
SPECULAR, TRANSMISSION = ("Specular", "Transmission") if IS_OLD else ("Specular IOR Level", "Transmission Weight")
# Shaders, and what a Principled BSDF has that takes their place.
AS_PRINCIPLED = {"BSDF_DIFFUSE": {SPECULAR: 0, "Roughness": 1}, "BSDF_GLOSSY": {"Metallic": 1}, "BSDF_GLASS": {TRANSMISSION: 1}}
SHADERS = {*AS_PRINCIPLED, "BSDF_PRINCIPLED", "EMISSION", "BSDF_TRANSPARENT"}
# Inputs of the Principled BSDF that glTF, Petzval or the exporter does not have.
NOT_RENDERED = {"Subsurface": "subsurface scattering", "Subsurface Weight": "subsurface scattering", "Sheen": "sheen",
                "Sheen Weight": "the exact sheen", "Anisotropic": "anisotropy", "Diffuse Roughness": "roughness",
                "Transmission Roughness": "roughness of the transmission", "Thin Film Thickness": "thin film",
                "Thin Wall": "thin wall", "Coat Weight": "the exact coat"}


class Materials:
    """Copies of materials, each once: other shaders become a Principled BSDF with the same links."""

    def __init__(self, lost):
        self.originals = {}  # by the copy's name: the material, or None, and whether all its meshes are closed
        self._copies, self._lost = {}, lost

    def copy_of(self, look, closed):
        """look: None for what has none."""
        if look not in self._copies:
            copy = self._copies[look] = look.copy() if look else bpy.data.materials.new("none")
            copy.name = f"petzval {len(self._copies)}"
            copy.use_backface_culling = False  # which Cycles does not have
            self.originals[copy.name] = [look, True]
            if look and nodes_of(copy):
                self._mend(copy, look.name)
        self.originals[self._copies[look].name][1] &= closed
        return self._copies[look]

    def remove(self):
        for copy in self._copies.values():
            bpy.data.materials.remove(copy)

    def _mend(self, copy, name):
        surface = surface_of(copy)
        if surface is None or surface.type not in SHADERS:
            return
        for socket in surface.inputs:
            self._simplify(copy, socket, name)
        if surface.type in AS_PRINCIPLED:
            links, own = copy.node_tree.links, copy.node_tree.nodes.new("ShaderNodeBsdfPrincipled")
            for old, new in (("Color", "Base Color"), ("Roughness", "Roughness"), ("Normal", "Normal"), ("IOR", "IOR")):
                if old in surface.inputs and new not in AS_PRINCIPLED[surface.type]:
                    if surface.inputs[old].is_linked:
                        links.new(surface.inputs[old].links[0].from_socket, own.inputs[new])
                    elif old != "Normal":
                        own.inputs[new].default_value = surface.inputs[old].default_value
            for key, value in AS_PRINCIPLED[surface.type].items():
                own.inputs[key].default_value = value
            links.new(own.outputs[0], surface.outputs[0].links[0].to_socket)
        if surface.type == "BSDF_PRINCIPLED":
            alpha = surface.inputs["Alpha"]
            copy.blend_method = "BLEND" if alpha.is_linked or alpha.default_value < 1 else "OPAQUE"

    def _simplify(self, copy, socket, name):
        """Takes numbers for nodes of numbers, and names what the exporter passes over."""
        source = find(socket)
        if source is None:
            return
        value = value_of(socket)
        if value is not None:
            copy.node_tree.links.remove(socket.links[0])
            socket.default_value = value
            return
        picture = source
        if source.type == "NORMAL_MAP" and find(source.inputs["Color"]):
            picture = find(source.inputs["Color"])
        elif source.type in ("SEPRGB", "SEPARATE_COLOR") and find(source.inputs[0]):
            picture = find(source.inputs[0])
        elif source.type == "TEX_IMAGE" and socket.name in ("Roughness", "Metallic"):
            self._lost.append(f"the picture at {socket.name} of material {name}: put Separate Color before it")
        if picture.type in ("VERTEX_COLOR", "ATTRIBUTE") and socket.name in ("Color", "Base Color"):
            socket.default_value = (1, 1, 1, 1)
        elif picture.type != "TEX_IMAGE":
            self._lost.append(f"{picture.bl_label} at {socket.name} of material {name}: bake it")
        elif picture.image is None or not picture.image.has_data and not picture.image.size[0]:
            self._lost.append(f"the missing picture at {socket.name} of material {name}")
        elif picture.image.is_float:
            self._lost.append(f"the exact colours of the picture of floats {picture.image.name}: make it one of 8 bits")
        elif socket.links[0].from_socket.name != "Alpha" and not (
                picture.image.colorspace_settings.name == "sRGB" if socket.type == "RGBA" else picture.image.colorspace_settings.is_data):
            self._lost.append(f"the colour space of picture {picture.image.name} at {socket.name}")
        elif picture.image.source not in ("FILE", "GENERATED"):
            self._lost.append(f"all but one picture of {picture.image.name}, of the kind {picture.image.source.lower()}")
        elif picture.projection != "FLAT":
            self._lost.append(f"the projection {picture.projection.lower()} of material {name}")
        else:
            place = find(picture.inputs["Vector"])
            place = find(place.inputs["Vector"]) if place and place.type == "MAPPING" else place
            if place and place.type not in ("UVMAP", "TEX_COORD"):
                self._lost.append(f"{place.bl_label} coordinates of material {name}")


def mend_material(out, look, closed, lost):
    """Puts right glTF's material of a Blender material."""
    name = out["name"] = look.name if look else "none"
    metal = out.setdefault("pbrMetallicRoughness", {})
    extensions = out.setdefault("extensions", {})
    surface = look and surface_of(look)
    kind = surface.type if surface else "NONE" if look and nodes_of(look) else "MATT"
    values = {socket.name: value_of(socket) for socket in surface.inputs} if surface else {}
    if kind in ("MATT", "NONE") or kind == "EMISSION" and "emissiveFactor" not in out:
        # Cycles gives faces without a material a diffuse surface of 0.8.
        color = look.diffuse_color if look else (0.8, 0.8, 0.8)
        metal.update(baseColorFactor=[*color[:3], 1] if kind == "MATT" else [0, 0, 0, 1], metallicFactor=0)
    if kind in ("MATT", "NONE", "EMISSION", "BSDF_DIFFUSE"):
        extensions["KHR_materials_specular"] = {"specularFactor": 0}
    if kind == "BSDF_TRANSPARENT":
        metal["baseColorFactor"] = [1, 1, 1, 0]
        out["alphaMode"] = "BLEND"
    elif kind == "BSDF_PRINCIPLED":
        mend_principled(extensions, metal, values)
    clear = extensions.get("KHR_materials_transmission", {}).get("transmissionFactor", 0)
    if clear > 0:
        extras(out)["solid"] = closed
    list_losses(look, surface, values, clear, closed, name, lost)
    if not extensions:
        del out["extensions"]


def mend_principled(extensions, metal, values):
    """Index and gloss, which the exporter leaves out or exaggerates; the coat; the colour of glass."""
    ior, level, clear = values["IOR"], values[SPECULAR], values[TRANSMISSION]
    if ior is not None and level is not None:
        own = extensions.setdefault("KHR_materials_specular", {})
        own.pop("specularFactor", None)
        own["specularColorFactor"] = list(values["Specular Tint"][:3]) if not IS_OLD and values["Specular Tint"] else [1, 1, 1]
        # Blender has a level that multiplies what is reflected straight on; before 4.0 the index is of the glass alone.
        straight = 0.08 * level if IS_OLD else ((ior - 1) / (ior + 1)) ** 2 * 2 * level
        if clear == 0:
            ior = (1 + math.sqrt(straight)) / max(1e-3, 1 - math.sqrt(straight))
        elif not IS_OLD:
            own["specularFactor"] = min(1, 2 * level)
        if ior == 1:
            own["specularFactor"] = 0
        extensions["KHR_materials_ior"] = {"ior": max(1, ior)}
    coat = extensions.get("KHR_materials_clearcoat", {})
    if IS_OLD and "clearcoatFactor" in coat:  # where 1 is a quarter of a coat
        coat["clearcoatFactor"] /= 4
    if not IS_OLD and clear == 1 and "baseColorTexture" not in metal:
        # Since 4.0 light is coloured once on its way through a body, in glTF at both sides.
        metal["baseColorFactor"] = [*(math.sqrt(x) for x in metal.get("baseColorFactor", [1] * 4)[:3]), 1]


def list_losses(look, surface, values, clear, closed, name, lost):
    """What the material's nodes have that Petzval does not render, or renders otherwise."""
    def has(key):
        return key in values and values[key] != 0

    kind, glossy = surface and surface.type, surface and (surface.type == "BSDF_GLOSSY" or has("Metallic"))
    rough = values.get("Roughness") if values.get("Roughness") is not None else 1
    is_body = has(SPECULAR) and values[TRANSMISSION] != 1 and values["Metallic"] != 1
    color = values.get("Color") or values.get("Base Color") or ()
    if look:
        lost += [f"{word.lower()} of material {name}" for word in ("Volume", "Displacement") if surface_of(look, socket=word)]
    lost += [f"{text} of material {name}" for key, text in NOT_RENDERED.items() if has(key)]
    for is_lost, text in (
            (surface and kind not in SHADERS, f"{surface and surface.bl_label} of material {name}"),
            (clear > 0 and not closed, f"refraction of material {name}: a mesh that has it is open, and counts as a thin pane"),
            (kind == "BSDF_DIFFUSE" and has("Roughness"), f"roughness of diffuse material {name}"),
            (kind == "BSDF_GLOSSY" and has("Anisotropy"), f"anisotropy of material {name}"),
            (kind == "BSDF_TRANSPARENT" and color != (1, 1, 1, 1), f"colour of transparent material {name}"),
            (kind == "BSDF_GLASS" and color != (1, 1, 1, 1), f"the colour of what glass {name} reflects"),
            ((values.get("IOR") or 1) < 1, f"the index below 1 of material {name}"),
            (kind != "EMISSION" and any(not 0 <= x <= 1 for x in color), f"colours beyond 0 and 1 of material {name}"),
            ((values.get("Strength") or 0) < 0, f"emission of material {name}, which takes light away"),
            (IS_OLD and has("Specular Tint"), f"specular tint of material {name}"),
            (kind == "BSDF_PRINCIPLED" and not IS_OLD and clear > 0 and (clear < 1 or values["Base Color"] is None),
             f"the exact colour of glass {name}: twice as deep where transmission is below 1 or a picture gives the colour"),
            (is_body, "gloss of Principled bodies, up to 17 % of it at 45°: Schlick's formula takes the place of Fresnel's"),
            (is_body and IS_OLD,
             "light of Principled bodies, up to 25 % from the side: before Blender 4.0 their gloss takes nothing from it"),
            ((glossy or clear > 0) and rough > 0.2 and surface.distribution != "MULTI_GGX",
             "the light that rough metal and glass lose in Cycles, unless they have Multiscatter GGX"),
            ((glossy or clear > 0) and rough > 0.6,
             "how dark very rough metal and glass of a colour are in Cycles: up to 30 % of what is dark")):
        if is_lost:
            lost.append(text)
