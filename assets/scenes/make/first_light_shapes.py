# SPDX-License-Identifier: Apache-2.0
"""Shapes of the built-in scene: closed bodies with outward normals, lengths in metres, y up."""
import math


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def times(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return times(a, 1 / math.sqrt(dot(a, a)))


class Shape:
    """An indexed triangle mesh with normals and texture coordinates."""

    def __init__(self):
        self.positions, self.normals, self.uvs, self.indices = [], [], [], []

    def triangle(self, a, b, c):
        """Wound counter-clockwise around its vertex normals; one without area is left out."""
        p, q, r = (self.positions[i] for i in (a, b, c))
        face = cross(sub(q, p), sub(r, p))
        if dot(face, face) < 1e-24:
            return
        mean = add(self.normals[a], add(self.normals[b], self.normals[c]))
        self.indices += (a, b, c) if dot(face, mean) > 0 else (a, c, b)

    def sheet(self, rows):
        """rows[i][j] = (position, normal, uv): joins neighbours by quads."""
        first, width = len(self.positions), len(rows[0])
        for row in rows:
            for position, normal, uv in row:
                self.positions.append(position)
                self.normals.append(normal)
                self.uvs.append(uv)
        for i in range(len(rows) - 1):
            for j in range(width - 1):
                a = first + i * width + j
                self.triangle(a, a + 1, a + width + 1)
                self.triangle(a, a + width + 1, a + width)
        return self

    def join(self, other, at=(0, 0, 0)):
        first = len(self.positions)
        self.positions += [add(p, at) for p in other.positions]
        self.normals += other.normals
        self.uvs += other.uvs
        self.indices += [first + i for i in other.indices]
        return self

    def map_uv(self, f):
        self.uvs = [f(u, v) for u, v in self.uvs]
        return self


def spline(points, steps=6):
    """Catmull-Rom curve through points of any dimension (Catmull and Rom 1974), `steps` pieces a span."""
    ends = [points[0]] + list(points) + [points[-1]]
    curve = []
    for p0, p1, p2, p3 in zip(ends, ends[1:], ends[2:], ends[3:]):
        for k in range(steps):
            t = k / steps
            curve.append(tuple(
                b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)))
                for a, b, c, d in zip(p0, p1, p2, p3)))
    return curve + [tuple(points[-1])]


def arc(centre, radius, from_deg, to_deg, steps=6):
    """Points (r, y) of a circular arc."""
    angles = [math.radians(from_deg + (to_deg - from_deg) * k / steps) for k in range(steps + 1)]
    return [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles]


def lathe(parts, segments=64):
    """Turns profiles of (r, y) about the y axis. Each part is smooth in itself, with creases between
    parts. A profile that rises has its outside away from the axis. u runs around, v along, both 0-1."""
    shape = Shape()
    spans = [[math.dist(p, q) for p, q in zip(part, part[1:])] for part in parts]
    total, length = sum(map(sum, spans)), 0.0
    for part, span in zip(parts, spans):
        rows = []
        for i, (r, y) in enumerate(part):
            (r0, y0), (r1, y1) = part[max(i - 1, 0)], part[min(i + 1, len(part) - 1)]
            slope = math.hypot(r1 - r0, y1 - y0)
            nr, ny = (y1 - y0) / slope, (r0 - r1) / slope
            if r < 1e-9:
                nr, ny = 0.0, math.copysign(1.0, ny)
            v = (length + sum(span[:i])) / total
            row = []
            for j in range(segments + 1):
                angle = 2 * math.pi * (j % segments) / segments
                c, s = math.cos(angle), math.sin(angle)
                row.append(((r * c, y, -r * s), (nr * c, ny, -nr * s), (j / segments, 1 - v)))
            rows.append(row)
        shape.sheet(rows)
        length += sum(span)
    return shape


def sphere(radius, rings=16, segments=32):
    return lathe([[(max(r, 0.0), y) for r, y in arc((0, 0), radius, -90, 90, rings)]], segments)


def surface(point, nu, nv, uv=lambda s, t: (s, t), flip=False):
    """The sheet point(s, t), s and t in [0, 1]; normals by central differences, along ds x dt unless flipped."""
    h = 1e-4
    rows = []
    for j in range(nv + 1):
        row = []
        for i in range(nu + 1):
            s, t = i / nu, j / nv
            n = unit(cross(sub(point(s + h, t), point(s - h, t)), sub(point(s, t + h), point(s, t - h))))
            row.append((point(s, t), times(n, -1) if flip else n, uv(s, t)))
        rows.append(row)
    return Shape().sheet(rows)


def rounded_box(size, radius, steps=2):
    """A box about the origin with round edges and corners; uv in metres across each face."""
    shape = Shape()
    for axis in range(3):
        a, b = ((1, 2), (0, 2), (0, 1))[axis]
        half = [s / 2 - radius for s in size]
        stops = [(side, math.tan(math.radians(45 * (k / steps - (side < 0)))))
                 for side in (-1, 1) for k in range(steps + 1)]
        for sign in (-1, 1):
            rows = []
            for side_a, ta in stops:
                row = []
                for side_b, tb in stops:
                    n = [0, 0, 0]
                    n[axis], n[a], n[b] = sign, ta, tb
                    n = unit(n)
                    p = [0, 0, 0]
                    p[axis], p[a], p[b] = sign * half[axis], side_a * half[a], side_b * half[b]
                    p = add(p, times(n, radius))
                    row.append((p, n, (p[a], p[b])))
                rows.append(row)
            shape.sheet(rows)
    return shape


def tube(path, radii, segments=10):
    """A tube with round-off ends along points; radii: one for each point."""
    rows = []
    tangents = [unit(sub(path[min(i + 1, len(path) - 1)], path[max(i - 1, 0)])) for i in range(len(path))]
    side = unit(cross(tangents[0], (0.31, 0.17, 0.93)))
    for p, r, t in zip(path, radii, tangents):
        side = unit(sub(side, times(t, dot(side, t))))
        up = cross(t, side)
        row = []
        for j in range(segments + 1):
            angle = 2 * math.pi * (j % segments) / segments
            n = add(times(side, math.cos(angle)), times(up, math.sin(angle)))
            row.append((add(p, times(n, r)), n, (j / segments, 0)))
        rows.append(row)
    for end, t in ((0, times(tangents[0], -1)), (-1, tangents[-1])):
        tip = [(add(path[end], times(t, 0.5 * radii[end])), t, (0, 0))] * (segments + 1)
        rows.insert(0 if end == 0 else len(rows), tip)
    return Shape().sheet(rows)


def polyhedron(planes, reach=10.0):
    """The flat-shaded convex body on the inner side of planes (unit normal, distance from the origin)."""
    shape = Shape()
    for n, d in planes:
        a = unit(cross(n, (0.3, 0.5, 0.8) if abs(n[1]) > 0.9 else (0, 1, 0)))
        b = cross(n, a)
        face = [add(times(n, d), add(times(a, x * reach), times(b, y * reach)))
                for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        for m, e in planes:
            if m != n:
                face = clip(face, m, e)
        first = len(shape.positions)
        shape.positions += face
        shape.normals += [n] * len(face)
        shape.uvs += [(dot(p, a), dot(p, b)) for p in face]
        for i in range(1, len(face) - 1):
            shape.triangle(first, first + i, first + i + 1)
    return shape


def clip(polygon, normal, distance):
    """What of a convex polygon lies on the inner side of a plane (Sutherland and Hodgman 1974)."""
    kept = []
    for p, q in zip(polygon, polygon[1:] + polygon[:1]):
        hp, hq = dot(p, normal) - distance, dot(q, normal) - distance
        if hp <= 0:
            kept.append(p)
        if hp * hq < 0:
            kept.append(add(p, times(sub(q, p), hp / (hp - hq))))
    return kept


def brilliant():
    """A round brilliant of girdle radius 1 about the y axis, table up: the usual angles of crown
    (34.5 degrees) and pavilion (40.75 degrees). Its pavilion mains lie along azimuth 0, 45, ... degrees."""
    def facets(count, offset_deg, slope_deg, up, radius, height):
        """Planes at a slope to the horizontal that pass through (radius, height) at their azimuth."""
        s, c = math.sin(math.radians(slope_deg)), math.cos(math.radians(slope_deg))
        azimuths = [math.radians(offset_deg + 360 * k / count) for k in range(count)]
        return [((s * math.cos(a), up * c, s * math.sin(a)), s * radius + up * c * height) for a in azimuths]
    girdle = 0.02
    return polyhedron(
        [((0, 1, 0), 0.33)] +
        facets(8, 0, 34.5, 1, 1, girdle) + facets(8, 22.5, 20, 1, 0.565, 0.33) +
        facets(16, 11.25, 39, 1, 0.985, girdle) + facets(16, 11.25, 90, 1, 0.97, 0) +
        facets(8, 0, 40.75, -1, 1, -girdle) + facets(16, 11.25, 42, -1, 0.985, -girdle))


def prism(side, length):
    """An equilateral prism lying along x on its base at y = 0."""
    inner = side / (2 * math.sqrt(3))
    s = math.sqrt(3) / 2
    body = polyhedron([((0, -1, 0), inner), ((0, 0.5, s), inner), ((0, 0.5, -s), inner),
                       ((1, 0, 0), length / 2), ((-1, 0, 0), length / 2)])
    return Shape().join(body, at=(0, inner, 0))
