# SPDX-License-Identifier: Apache-2.0
"""Lamps, as Cycles means them: watts and radiance become candela, lux and nits of the same number; 1 is 1 everywhere."""
import math

import bpy

from .glb import extras, unscaled
from .nodes import surface_of

IS_OLD = bpy.app.version < (4, 0)


def add_lamp(glb, one, matrix, lost):
    lamp, cycles = one.data, getattr(one.data, "cycles", None)
    strength = lamp.energy * 2 ** getattr(lamp, "exposure", 0)
    color = list(lamp.color)
    if getattr(lamp, "use_temperature", False):
        color = [a * b for a, b in zip(color, lamp.temperature_color)]
    if lamp.use_nodes and lamp.node_tree:
        shader = surface_of(lamp, "OUTPUT_LIGHT")
        if shader is None:
            return  # it sends nothing
        if shader.type != "EMISSION" or any(socket.is_linked for socket in shader.inputs):
            lost.append(f"nodes of lamp {one.name}")
        else:
            strength *= shader.inputs["Strength"].default_value
            color = [a * b for a, b in zip(color, shader.inputs["Color"].default_value)]
    if getattr(cycles, "is_portal", False) or strength == 0 or max(color) <= 0:
        return
    if strength < 0 or min(color) < 0:
        lost.append(f"lamp {one.name}, which takes light away")
        return
    linking = getattr(one, "light_linking", None)
    scale = [abs(x) for x in matrix.to_scale()]
    # Cycles' lamps light from nearby as a disc that faces what they light, Petzval's as a ball.
    is_soft = IS_OLD or getattr(lamp, "use_soft_falloff", False)
    for is_lost, text in (
            (not getattr(lamp, "normalize", True), "the strength of lamp {}, which is not normalised"),
            (not getattr(cycles, "cast_shadow", lamp.use_shadow), "no shadow: {}"),
            (linking and (linking.receiver_collection or linking.blocker_collection), "light linking of lamp {}"),
            (lamp.type == "AREA" and getattr(lamp, "spread", math.pi) < math.pi - 1e-4, "spread of area lamp {}"),
            (lamp.type == "SPOT" and max(scale) > 1.01 * min(scale), "the scale of spot {}, which makes its cone oval"),
            (lamp.type in ("POINT", "SPOT") and is_soft and lamp.shadow_soft_size > 0.3,
             "the falloff near lamp {}, which is wide: r²/d² brighter at the distance d from its radius r"),
            (lamp.type == "SPOT" and lamp.spot_blend > 0,
             "the smooth rim of spots: up to 11 % of the light on the axis off, as glTF's is another")):
        if is_lost:
            lost.append(text.format(one.name))
    node, own = {"name": one.name}, {"visible": False}
    if lamp.type == "AREA":
        size_y = lamp.size_y if lamp.shape in ("RECTANGLE", "ELLIPSE") else lamp.size
        # Radiance P / (4 A) before Blender 4.0, P / (pi A) since (projects.blender.org/blender/blender/issues/109404).
        extras(node).update(own, area=[max(1e-6, lamp.size * scale[0]), max(1e-6, size_y * scale[1])], color=color,
                            intensity_cd=strength / (4 if IS_OLD else math.pi),
                            **({"shape": "ellipse"} if lamp.shape in ("DISK", "ELLIPSE") else {}))
        glb.place(node, unscaled(matrix))
        return
    light = {"name": one.name, "type": lamp.type.lower(), "intensity": strength / (4 * math.pi)}
    if lamp.type == "SUN":
        half = min(lamp.angle / 2, math.radians(89.5))
        # Before Blender 4.0 its light comes from a flat disc, whose rim lights at a slant.
        light.update(type="directional", intensity=strength * (2 * math.cos(half) / (1 + math.cos(half)) if IS_OLD else 1))
        if half > 0:
            own["angle_deg"] = math.degrees(2 * half)
    elif lamp.shadow_soft_size > 0:
        own["radius_m"] = lamp.shadow_soft_size
    if lamp.type == "SPOT":
        outer = min(lamp.spot_size / 2, math.pi / 2)
        # Cycles' rim is a smooth step in the cosine, glTF's a square: they part least, by 0.11, where the square ends after
        # 0.8 of the step.
        inner = math.acos(min(1, math.cos(outer) + 0.8 * lamp.spot_blend * (1 - math.cos(outer))))
        light["spot"] = {"outerConeAngle": outer, "innerConeAngle": min(inner, outer * 0.999)}
        if IS_OLD:  # they fall off with the cosine too, as a flat lamp does
            size_m = max(1e-4, 2 * lamp.shadow_soft_size)
            extras(node).update(area=[size_m, size_m], shape="ellipse", visible=False)
    if len(own) > 1:
        extras(light).update(own)
    most = max(1, *color)
    light.update(color=[c / most for c in color], intensity=light["intensity"] * most)
    lights = glb.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {}).setdefault("lights", [])
    lights.append(light)
    node["extensions"] = {"KHR_lights_punctual": {"light": len(lights) - 1}}
    glb.place(node, unscaled(matrix))
