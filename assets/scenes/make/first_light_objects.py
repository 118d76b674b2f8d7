# SPDX-License-Identifier: Apache-2.0
"""The things on the table of the built-in scene. Shapes stand on y = 0; functions of (glb, m, ...) place nodes."""
import math
import random

from first_light_glb import then, turn
from first_light_shapes import Shape, add, arc, lathe, rounded_box, sphere, spline, tube

X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)


def petzval_lens(glb, m, at, yaw_deg):
    """A brass portrait lens on its side: it rests on the rims of flange and hood, both of one radius.
    at: the point on the table below its flange; yaw 0 looks along +z."""
    r = 0.046
    body = lathe([
        [(0.030, 0.0), (0.040, 0.0)], arc((0.040, 0.002), 0.002, -90, 0, 3), [(0.042, 0.002), (0.042, 0.012)],
        [(0.042, 0.012), (r - 0.0015, 0.012)], arc((r - 0.0015, 0.0135), 0.0015, -90, 90, 6),
        [(r - 0.0015, 0.015), (0.036, 0.015)], spline([(0.036, 0.015), (0.0335, 0.020), (0.0335, 0.060)], 4),
        [(0.0335, 0.060), (0.0365, 0.060)], arc((0.0365, 0.061), 0.001, -90, 90, 4),
        [(0.0365, 0.062), (0.0345, 0.062)], [(0.0345, 0.062), (0.0345, 0.098)],
        spline([(0.0345, 0.098), (0.0365, 0.104), (0.042, 0.110), (r - 0.001, 0.120)], 6),
        [(r - 0.001, 0.120), (r - 0.001, 0.148)], arc((r - 0.0015, 0.149), 0.0015, -40, 180, 6)], 72)
    bore = lathe([[(r - 0.003, 0.149), (0.041, 0.121), (0.0335, 0.108)], [(0.0335, 0.108), (0.0320, 0.096)],
                  [(0.0320, 0.096), (0.030, 0.0)]], 72)
    front = lathe([lens_cap(0.0395, 0.1195, -0.004),
                   [(0.0395, 0.1195), (0.0395, 0.1215)], lens_cap(0.0395, 0.1215, 0.009)[::-1]], 64)
    knob = lathe([[(0, 0), (0.004, 0)], [(0.004, 0), (0.004, 0.010)], [(0.004, 0.010), (0.0095, 0.010)],
                  [(0.0095, 0.010), (0.0100, 0.011), (0.0100, 0.0165)],
                  [(0.0100, 0.0165), (0.0090, 0.018), (0, 0.0185)]], 40)
    pose = then(turn(X, 90), turn(Y, yaw_deg))
    group = glb.node("petzval lens", at=add(at, (0, r, 0)), rotation=pose)
    glb.node("barrel", group, mesh=glb.mesh("barrel", (body, m.brass), (bore, m.black)))
    glb.node("front element", group, mesh=glb.mesh("front element", (front, m.glass)))
    glb.node("rack knob", group, at=(0.0325, 0.040, 0), rotation=turn(Z, -90),
             mesh=glb.mesh("rack knob", (knob, m.brass)))


def lens_cap(radius, y, sag, steps=10):
    """Profile of a spherical surface from the axis to its rim at (radius, y); sag is how far its vertex rises."""
    return [(radius * k / steps, y + sag * (1 - (k / steps) ** 2)) for k in range(steps + 1)]


def wine_glass():
    """One closed body, 0.2 m high: foot, stem, bowl and the inside of the bowl."""
    foot = [(0, 0.0020), (0.022, 0.0010), (0.0325, 0.0003)]
    outside = spline([(0.0325, 0.0003), (0.0342, 0.0013), (0.0325, 0.0026), (0.020, 0.0048), (0.008, 0.0095),
                      (0.0042, 0.020), (0.0038, 0.050), (0.0043, 0.078), (0.0085, 0.0895), (0.021, 0.0985),
                      (0.0335, 0.1135), (0.0392, 0.1350), (0.0380, 0.1620), (0.0342, 0.1850), (0.0316, 0.2000)], 5)
    rim = arc((0.0310, 0.2000), 0.0006, 0, 180, 6)
    inside = spline([(0.0304, 0.2000), (0.0330, 0.1850), (0.0367, 0.1620), (0.0378, 0.1352), (0.0322, 0.1150),
                     (0.0200, 0.1008), (0.0080, 0.0945), (0, 0.0932)], 5)
    return lathe([foot, outside + rim[1:] + inside[1:]], 72)


def mug():
    """A copper mug without a handle: outside, rim and inside in one closed body."""
    outside = [(0, 0.001), (0.030, 0.0)] + arc((0.032, 0.004), 0.004, -90, -5, 4)
    wall = spline([(0.036, 0.004), (0.0405, 0.03), (0.0415, 0.055), (0.039, 0.092)], 5)
    rim = arc((0.0405, 0.0925), 0.0018, -150, 130, 10)
    inside = spline([(0.0388, 0.0930), (0.0400, 0.055), (0.0390, 0.03), (0.034, 0.006)], 4)
    return lathe([outside, wall, rim, inside, [(0.034, 0.006), (0, 0.005)]], 64)


def vase():
    outside = spline([(0.026, 0.0015), (0.030, 0.004), (0.052, 0.040), (0.062, 0.078), (0.054, 0.120), (0.030, 0.158),
                      (0.0205, 0.185), (0.0215, 0.205), (0.029, 0.222)], 6)
    rim = arc((0.0272, 0.2225), 0.0018, 0, 180, 6)
    inside = spline([(0.0254, 0.2220), (0.0185, 0.205), (0.0175, 0.185), (0.026, 0.160), (0.040, 0.120)], 4)
    return lathe([[(0, 0.002), (0.024, 0.002), (0.026, 0.0)], [(0.026, 0.0), (0.026, 0.0015)],
                  outside + rim[1:] + inside[1:], [(0.040, 0.120), (0, 0.110)]], 64)


def twigs(glb, m, at):
    """Five curved twigs that stand in the vase, each with a few berries at its side shoots."""
    rng = random.Random(43)
    wood, berry = Shape(), glb.mesh("berry", (sphere(0.0052, 7, 12), m.berry))
    group = glb.node("twigs", at=at)
    for k in range(6):
        azimuth = 2 * math.pi * k / 6 + rng.uniform(-0.4, 0.4)
        out, height = rng.uniform(0.06, 0.15), rng.uniform(0.34, 0.52)
        def along(t, a=azimuth, o=out, h=height):
            r = 0.008 + o * max(0.0, t - 0.38) ** 1.5 * 1.8
            return (r * math.cos(a + 0.5 * t), 0.12 + (h - 0.12) * t, r * math.sin(a + 0.5 * t))
        path = [along(i / 14) for i in range(15)]
        wood.join(tube(path, [0.0024 - 0.0016 * i / 14 for i in range(15)], 7))
        for i in range(6, 15):
            side = rng.uniform(0, 2 * math.pi)
            tip = add(path[i], (0.016 * math.cos(side), rng.uniform(0.006, 0.016), 0.016 * math.sin(side)))
            wood.join(tube([path[i], tip], [0.0009, 0.0007], 5))
            glb.node("berry", group, at=tip, scale=rng.uniform(0.75, 1.2), mesh=berry)
    glb.node("twig wood", group, mesh=glb.mesh("twig wood", (wood, m.twig)))


def lemon():
    """Long axis along y, with a nipple at one end."""
    return lathe([spline([(0, -0.0375), (0.004, -0.0365), (0.011, -0.0325), (0.022, -0.0215), (0.0275, -0.004),
                          (0.0265, 0.010), (0.0195, 0.0245), (0.0095, 0.0325), (0.0055, 0.0365), (0.0032, 0.0402),
                          (0, 0.0410)], 4)], 48)


def cherries(glb, m, at, yaw_deg):
    """A pair on joined stems, lying on the table."""
    fruit = lathe([spline([(0, -0.0108), (0.006, -0.0098), (0.0112, -0.0035), (0.0115, 0.003), (0.0075, 0.0088),
                           (0.003, 0.0090), (0.0012, 0.0072), (0, 0.0066)], 6)], 40)
    body = glb.mesh("cherry", (fruit, m.cherry))
    group = glb.node("cherries", at=at, rotation=turn(Y, yaw_deg))
    joint = (0.004, 0.006, -0.052)
    stems = Shape()
    for x, z, tilt in ((-0.0145, 0.0, -12), (0.0150, 0.006, 14)):
        glb.node("cherry", group, at=(x, 0.0108, z), rotation=then(turn(X, -14), turn(Z, tilt)), mesh=body)
        start = (x - 0.007 * math.sin(math.radians(tilt)), 0.0175, z - 0.002)
        bend = spline([start, (0.8 * x, 0.036, z - 0.014), (0.4 * x, 0.027, -0.036), joint], 6)
        stems.join(tube(bend, [0.0008] * len(bend), 7))
    stems.join(tube([joint, add(joint, (0.001, 0.001, -0.006))], [0.0015, 0.0019], 8))
    glb.node("stems", group, mesh=glb.mesh("stems", (stems, m.stem)))


def chess_base(scale):
    """Profiles of the underside and of the moulded foot, 14 mm high; scale widens it."""
    foot = ((0.0155, 0), (0.0168, 0.003), (0.0160, 0.006), (0.0135, 0.008), (0.0132, 0.011), (0.0105, 0.014))
    return [(0, 0), (scale * 0.0155, 0)], spline([(scale * r, y) for r, y in foot], 5)


def pawn():
    floor, base = chess_base(0.95)
    stem = spline([(0.0100, 0.014), (0.0068, 0.022), (0.0052, 0.034)], 8)
    collar = arc((0.0080, 0.0358), 0.0016, -90, 90, 6)
    return lathe([floor, base, stem, [(0.0052, 0.0342)] + collar + [(0.0055, 0.0374)],
                  [(max(r, 0), y) for r, y in arc((0, 0.0450), 0.0093, -56, 90, 12)]], 36)


def bishop():
    floor, base = chess_base(1.05)
    stem = spline([(0.0110, 0.014), (0.0072, 0.024), (0.0056, 0.048)], 8)
    collar = arc((0.0092, 0.0500), 0.0018, -90, 90, 6)
    head = spline([(0.0058, 0.0518), (0.0100, 0.0590), (0.0098, 0.0655), (0.0050, 0.0745), (0.0022, 0.0778)], 6)
    return lathe([floor, base, stem, [(0.0056, 0.0482)] + collar + [(0.0058, 0.0518)], head,
                  [(max(r, 0), y) for r, y in arc((0, 0.0798), 0.0029, -45, 90, 8)]], 36)


def books(glb, m, at, yaw_deg):
    """Two old books, the upper one turned a little."""
    y = 0.0
    for i, (w, h, d, yaw) in enumerate(((0.20, 0.034, 0.145, 0), (0.18, 0.028, 0.125, 11))):
        board, inset = 0.0028, 0.004
        cover = rounded_box((w, board, d), 0.0010)
        spine = rounded_box((w, h, 0.004), 0.0018)
        case = Shape().join(cover, (0, board / 2, 0)).join(cover, (0, h - board / 2, 0))
        case.join(spine, (0, h / 2, d / 2)).map_uv(lambda a, b: (a / 0.12, b / 0.12))
        block = rounded_box((w - 2 * inset, h - 2 * board, d - inset - 0.003), 0.0005)
        leaves = Shape().join(block, (0, h / 2, (inset - 0.003) / 2))
        bands = Shape()
        for x in (-0.32, -0.27, 0.27, 0.32):
            bands.join(rounded_box((0.0035, h + 0.0006, 0.0052), 0.002), (x * w, h / 2, d / 2))
        glb.node("book %d" % i, at=add(at, (0, y, 0)), rotation=turn(Y, yaw_deg + yaw),
                 mesh=glb.mesh("book %d" % i, (case, m.cover[i]), (leaves, m.pages), (bands, m.brass)))
        y += h + 0.0003
    return add(at, (0, y, 0))


def paper_lanterns(glb, m, spots):
    """Paper cylinders that glow, with a lacquered ring at each end."""
    r, h = 0.055, 0.17
    paper = lathe([[(r, 0.008 + h * k / 4) for k in range(5)]], 40)
    ring = lathe([[(0, 0), (r + 0.002, 0)], [(r + 0.002, 0), (r + 0.002, 0.009)], [(r + 0.002, 0.009), (0, 0.009)]], 48)
    frame = Shape().join(ring).join(ring, (0, h + 0.007, 0))
    mesh = glb.mesh("paper lantern", (paper, m.paper_lantern), (frame, m.black))
    for x, y, z, scale in spots:
        glb.node("paper lantern", at=(x, y + 0.0002, z), scale=scale, mesh=mesh)
