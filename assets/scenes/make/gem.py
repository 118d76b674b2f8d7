#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the scene of dispersion, cut stones and a prism: python3 gem.py ../gem.glb

Metres, y up, the plinth's top at y = 0; RGB 1 is 1 nit. All light comes from meshes: a path finds them through glass,
as it cannot find a point.
"""
import math

from first_light_glb import GlbWriter, then, turn, write_scene
from first_light_shapes import Shape, add, arc, cross, dot, lathe, sub, times, unit

X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
EYE, TARGET, FOV_DEG = (0.0, 0.088, 0.40), (-0.001, 0.0205, 0.0), 10.6
TABLE, CROWN_DEG, PAVILION_DEG = 0.53, 34.5, 40.75
GIRDLE = 0.028  # half of its thickness where the mains touch it, in radii of the stone
CLEAR_M = 0.0002  # between glass and what it stands on
STONE_AT = (0.022, 0.0, -0.002)
PRISM_AT, PRISM_EDGE_DEG = (-0.042, CLEAR_M, -0.018), 9
SF11_ND = 1.78472  # Schott's data sheet of N-SF11
GOLDEN_ANGLE_DEG = 137.50776


def around(angle_deg, radius, y):
    """A point about the y axis, azimuth from +z toward +x."""
    a = math.radians(angle_deg % 360)
    return (radius * math.sin(a), y, radius * math.cos(a))


def flat_body(faces, centre=(0, 0, 0)):
    """The flat-shaded convex body of these polygons; any point within is its centre. It is closed where faces share
    equal corners."""
    shape = Shape()
    for face in faces:
        normal = unit(cross(sub(face[1], face[0]), sub(face[2], face[1])))
        if dot(normal, sub(face[0], centre)) < 0:
            normal = times(normal, -1)
        first = len(shape.positions)
        shape.positions += face
        shape.normals += [normal] * len(face)
        shape.uvs += [(0, 0)] * len(face)
        for i in range(1, len(face) - 1):
            shape.triangle(first, first + i, first + i + 1)
    return shape


def round_brilliant():
    """A round brilliant of girdle radius 1, table up, with the proportions of Tolkowsky (Diamond Design, 1919): table
    53 % of the diameter, crown 34.5 and pavilion 40.75 degrees. He left open how far the stars and the lower girdle
    facets reach: here half of the crown's width, and 0.78 of the pavilion's radius."""
    pieces = 4
    between = math.cos(math.radians(22.5))
    slopes = {1: math.tan(math.radians(CROWN_DEG)), -1: math.tan(math.radians(PAVILION_DEG))}
    reach = {1: (1 + TABLE * between) / 2, -1: 1 - 0.78}

    def tip(angle_deg, side):
        """Where two mains and two girdle facets meet."""
        return around(angle_deg, reach[side], side * (GIRDLE + (1 - reach[side] * between) * slopes[side]))

    def rim(angle_deg, side):
        """Where a girdle facet meets the round girdle; every facet touches it at multiples of 22.5 degrees."""
        p, a = tip(22.5, side), around(0, 1, side * GIRDLE)
        n = cross(sub(a, p), sub(around(22.5, 1, side * GIRDLE), p))
        x, _, z = around(abs((angle_deg + 22.5) % 45 - 22.5), 1, 0)
        return around(angle_deg, 1, p[1] - (n[0] * (x - p[0]) + n[2] * (z - p[2])) / n[1])

    corners = [around(45 * k, TABLE, GIRDLE + (1 - TABLE) * slopes[1]) for k in range(8)]
    culet = (0, -GIRDLE - slopes[-1], 0)
    faces = [corners]
    for k in range(8):
        main = 45 * k
        faces.append([corners[k], tip(main + 22.5, 1), corners[(k + 1) % 8]])
        for side in (1, -1):
            faces.append([corners[k] if side > 0 else culet, tip(main - 22.5, side), rim(main, side),
                          tip(main + 22.5, side)])
            for end in (main - 22.5, main + 22.5):
                faces.append([tip(end, side)] + [rim(main + (end - main) * i / pieces, side)
                                                 for i in range(pieces + 1)])
    step = 22.5 / pieces
    for i in range(16 * pieces):
        faces.append([rim(step * i, 1), rim(step * (i + 1), 1), rim(step * (i + 1), -1), rim(step * i, -1)])
    return flat_body(faces)


def prism(side, height):
    """A 60 degree prism that stands on y = 0; an edge at azimuth 0."""
    foot, head = ([around(120 * k, side / math.sqrt(3), y) for k in range(3)] for y in (0, height))
    return flat_body([foot, head] + [[foot[k], foot[k - 1], head[k - 1], head[k]] for k in range(3)],
                     (0, height / 2, 0))


def panel(centre, target, width, height):
    """A rectangle that faces its target."""
    n = unit(sub(target, centre))
    a = unit(cross(Y, n)) if abs(n[1]) < 0.999 else X
    b = cross(n, a)
    corners = [add(centre, add(times(a, x * width / 2), times(b, y * height / 2)))
               for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return flat_body([corners], sub(centre, n))


def look(eye, target):
    """The rotation of a camera at eye that looks at target, upright."""
    d = unit(sub(target, eye))
    yaw = math.degrees(math.atan2(-d[0], -d[2]))
    return then(turn(X, math.degrees(math.asin(d[1]))), turn(Y, yaw))


def through_prism(heading_deg, edge_deg, n):
    """Heading, an azimuth, of a level ray that entered the face right of a standing prism's near edge (as seen from
    outside, edge at azimuth edge_deg) and left by the far face: Snell's law twice."""
    def refract(heading, normal, eta):
        """normal: azimuth of the face's normal on the side that the ray goes to."""
        sine = math.sin(math.radians(heading - normal)) * eta
        return normal + math.degrees(math.asin(sine))
    inside = refract(heading_deg, edge_deg + 60 + 180, 1 / n)
    return refract(inside, edge_deg + 180, n)


class Materials:
    """Every material of the scene by name."""

    def __init__(self, glb):
        self.plinth = glb.material("polished stone", "#101114", 0.06)
        self.wall = glb.material("wall", "#3a3c42", 0.95)
        glass = dict(roughness=0.0, transmission=1, volume={"thicknessFactor": 0.01})
        # About strontium titanate, which disperses four times as much as diamond (nd 2.417, Abbe number 55).
        self.brilliant = glb.material("brilliant", ior=2.41, dispersion=round(20 / 13, 5), **glass)
        self.prism = glb.material("prism", ior=SF11_ND, extras={"petzval": {"glass": "schott:N-SF11"}}, **glass)

        def light(name, colour, nits):
            return glb.material(name, "#000000", 1.0, emissive=colour, nits=nits)
        self.slit = light("slit", "#ffffff", 4.5)
        self.panels = light("panels", "#ffffff", 5.5)
        self.glow = light("glow", "#dfe8ff", 18)


def stones(glb, m):
    """Brilliants that lie on a pavilion main and turn their tables to the camera."""
    mesh = glb.mesh("brilliant", (round_brilliant(), m.brilliant))
    lean = math.radians(PAVILION_DEG)
    for (x, _, z), radius, yaw_deg in ((STONE_AT, 0.0185, -6), ((0.056, 0, 0.016), 0.006, -12),
                                       ((-0.013, 0, 0.020), 0.0045, 20)):
        y = radius * (math.sin(lean) + GIRDLE * math.cos(lean)) + CLEAR_M
        glb.node("stone", mesh=mesh, at=(x, y, z), scale=radius,
                 rotation=then(turn(X, PAVILION_DEG), turn(Y, yaw_deg)))


def slit(m):
    """A lamp left of the picture, where the ray from the camera through the prism arrives."""
    seen = sub(PRISM_AT, EYE)
    heading = through_prism(math.degrees(math.atan2(seen[0], seen[2])), PRISM_EDGE_DEG, SF11_ND)
    x, _, z = add(PRISM_AT, around(heading, 0.16, 0))
    return panel((x, 0, z), (PRISM_AT[0], 0, PRISM_AT[2]), 0.0032, 0.3), m.slit


def panels(m):
    """Small panels all about the axis of the stone: what its facets flash with. None stands where the prism mirrors
    it, low, nor where the stone's table does, right above."""
    shape, at = Shape(), add(STONE_AT, (0, 0.011, 0))
    lean = math.radians(PAVILION_DEG)
    for i in range(32):
        away = math.radians(12 + 2 * i)
        x, y, z = around(GOLDEN_ANGLE_DEG * i, math.sin(away), math.cos(away))
        y, z = y * math.cos(lean) - z * math.sin(lean), y * math.sin(lean) + z * math.cos(lean)
        if 0.1 < y < 0.97:
            shape.join(panel(add(at, times((x, y, z), 0.65)), at, 0.07, 0.07))
    return shape, m.panels


def build():
    glb = GlbWriter("gem.py of Petzval")
    m = Materials(glb)
    glb.camera("table", FOV_DEG, EYE, look(EYE, TARGET))

    def put(name, shape, material, **more):
        glb.node(name, mesh=glb.mesh(name, (shape, material)), **more)
    r, edge = 0.14, 0.003
    put("plinth", lathe([[(0, -0.2), (r, -0.2)], [(r, -0.2), (r, -edge)], arc((r - edge, -edge), edge, 0, 90, 6),
                         [(r - edge, 0), (0, 0)]], 160), m.plinth)
    put("wall", panel((0, 0.2, -0.7), (0, 0.2, 0), 2.4, 1.6), m.wall)
    stones(glb, m)
    put("prism", prism(0.038, 0.052), m.prism, at=PRISM_AT, rotation=turn(Y, PRISM_EDGE_DEG))
    put("slit", *slit(m))
    put("panels", *panels(m))
    put("glow", panel((0.05, -0.32, -0.6), (0.05, -0.12, -0.7), 0.35, 0.06), m.glow)
    return glb


if __name__ == "__main__":
    write_scene("gem.py", build)
