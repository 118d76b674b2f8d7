# SPDX-License-Identifier: Apache-2.0
"""Procedural textures of the built-in scene, and the PNG encoder that packs them. Values are 8-bit codes."""
import math
import random
import struct
import zlib

# Five columns by seven rows, top row first, most significant bit on the left.
GLYPHS = {
    "0": "0e11131519110e", "1": "040c040404040e", "2": "0e11010204081f", "3": "1f02040201110e", "4": "02060a121f0202",
    "5": "1f101e0101110e", "6": "0608101e11110e", "7": "1f010204080808", "8": "0e11110e11110e", "9": "0e11110f01020c",
    "A": "0e11111f111111", "E": "1f10101e10101f", "F": "1f10101e101010", "G": "0e11101711110f", "H": "1111111f111111",
    "I": "0e04040404040e", "L": "1010101010101f", "P": "1e11111e101010", "R": "1e11111e141211", "S": "0f10100e01011e",
    "T": "1f040404040404", "V": "11111111110a04", "Z": "1f01020408101f", "/": "01010204081010", "-": "0000001f000000",
    " ": "00000000000000"}


def png(rows):
    """8-bit RGB PNG (ISO/IEC 15948) of rows of flat r, g, b codes; the better of filters Sub and Up."""
    width, height = len(rows[0]) // 3, len(rows)
    black = bytes(width * 3)
    rows = [bytes(row) for row in rows]
    left = b"".join(b"\1" + bytes((a - b) & 255 for a, b in zip(row, b"\0\0\0" + row)) for row in rows)
    up = b"".join(b"\2" + bytes((a - b) & 255 for a, b in zip(row, above))
                  for row, above in zip(rows, [black] + rows))
    data = min((zlib.compress(filtered, 9) for filtered in (left, up)), key=len)

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", data) + chunk(b"IEND", b""))


def noise(rng, width, height, nx, ny):
    """Rows of smooth noise in [0, 1] that tile, with nx by ny random values (value noise)."""
    lattice = [[rng.random() for _ in range(nx)] for _ in range(ny)]

    def stops(n, cells):
        for i in range(n):
            k, t = divmod(i * cells / n, 1)
            yield int(k), (int(k) + 1) % cells, t * t * (3 - 2 * t)
    columns = list(stops(width, nx))
    field = []
    for j0, j1, t in stops(height, ny):
        line = [a + (b - a) * t for a, b in zip(lattice[j0], lattice[j1])]
        field.append([line[i0] + (line[i1] - line[i0]) * s for i0, i1, s in columns])
    return field


def blend(weights_and_fields):
    """Weighted sum of fields."""
    weights = [w for w, _ in weights_and_fields]
    return [[sum(w * v for w, v in zip(weights, values)) for values in zip(*rows)]
            for rows in zip(*(f for _, f in weights_and_fields))]


def ramp(field, stops, step=2):
    """Colours a field by (value, '#rrggbb') stops; codes are rounded to multiples of step, which packs better."""
    table = []
    colours = [(v, [int(c[i:i + 2], 16) for i in (1, 3, 5)]) for v, c in stops]
    for k in range(256):
        x = k / 255
        low = max((s for s in colours if s[0] <= x), key=lambda s: s[0], default=colours[0])
        high = min((s for s in colours if s[0] > x), key=lambda s: s[0], default=colours[-1])
        t = 0 if high[0] <= low[0] else (x - low[0]) / (high[0] - low[0])
        table.append([min(255, round((a + (b - a) * t) / step) * step) for a, b in zip(low[1], high[1])])
    return [[c for value in row for c in table[min(255, max(0, int(value * 255)))]] for row in field]


def normals(height, strength, step=2):
    """Tangent-space normal map of a tiling height field, x to the right and y up (glTF 2.0, 3.9.3)."""
    rows = []
    for j, row in enumerate(height):
        above, below = height[j - 1], height[(j + 1) % len(height)]
        out = []
        for west, east, north, south in zip(row[-1:] + row[:-1], row[1:] + row[:1], above, below):
            x, y = strength * (west - east), strength * (south - north)
            s = 127 / math.sqrt(x * x + y * y + 1)
            out += (128 + step * round(x * s / step), 128 + step * round(y * s / step), min(255, 128 + round(s)))
        rows.append(out)
    return rows


def wood(size=1024):
    """Base colour, roughness and normal map of oiled oak; the grain runs along u, the tile is 1.4 x 0.28 m."""
    rng = random.Random(7)
    broad = noise(rng, size, size, 3, 3)
    waver = noise(rng, size, size, 9, 8)
    fibre = noise(rng, size, size, 24, 256)
    thread = noise(rng, size, size, 80, 512)
    pores = noise(rng, size, size, 64, 340)
    colour, height, shine = [], [], []
    for j in range(size):
        row_c, row_h = [], []
        for b, w, f, t, p in zip(broad[j], waver[j], fibre[j], thread[j], pores[j]):
            ring = (5 * j / size + 2.6 * b + 0.35 * w) % 1
            late = ring ** 3 if ring < 0.93 else (1 - ring) / 0.07 * 0.8
            pore = max(0.0, p - 0.72 + 0.12 * late) * 2.2
            row_c.append(0.62 - 0.33 * late + 0.26 * (f - 0.5) + 0.14 * (t - 0.5) - 0.7 * pore + 0.2 * (w - 0.5))
            row_h.append(0.5 * f + 0.3 * t - 1.5 * pore - 0.3 * late)
        colour.append(row_c)
        height.append(row_h)
    for c_row in colour[::2]:
        shine.append([c for v in c_row[::2] for c in (0, 4 * min(63, max(0, round(40 - 22 * v))), 0)])
    stops = [(0, "#24130a"), (0.3, "#5a3519"), (0.6, "#96642f"), (1, "#c69a5c")]
    return png(ramp(colour, stops, 4)), png(shine), png(normals(height, 1.1, 6))


def weave(size=256, threads=16):
    """Normal map of a plain weave, and a soft thread shade to go under it."""
    rng = random.Random(11)
    warp = [[rng.uniform(0.75, 1) for _ in range(threads)] for _ in range(2)]
    slub = noise(rng, size, size, 24, 24)
    height = []
    for j in range(size):
        row = []
        for i in range(size):
            x, y = i * threads / size, j * threads / size
            over = (int(x) + int(y)) % 2
            across, along = (x % 1 - 0.5, y % 1 - 0.5) if over else (y % 1 - 0.5, x % 1 - 0.5)
            thick = warp[over][int(x) if over else int(y)]
            bulge = math.sqrt(max(0.0, 1 - (2 * across / thick) ** 2)) * (0.4 + 0.6 * math.cos(math.pi * along))
            row.append(bulge + 0.35 * slub[j][i])
        height.append(row)
    return png(normals(height, 1.6))


def linen(width=512, height=1024):
    """Base colour of the runner: natural linen with two groups of indigo stripes along v."""
    rng = random.Random(13)
    along, across = noise(rng, width, height, width // 2, 20), noise(rng, width, height, 16, height // 2)
    wear = noise(rng, width, height, 6, 12)
    rows = []
    for j in range(height):
        row = []
        for i in range(width):
            x = abs(i / width - 0.5)
            stripe = 0.36 < x < 0.40 or 0.415 < x < 0.425 or 0.345 < x < 0.35
            f = 0.80 + 0.16 * (along[j][i] + across[j][i] - 1) + 0.1 * (wear[j][i] - 0.5)
            base = (52, 70, 112) if stripe else (206, 190, 162)
            row += (3 * min(85, round(c * f / 3)) for c in base)
        rows.append(row)
    return png(rows)


def write(rows, text, x, y, scale, ink=(20, 20, 22)):
    """Draws text with its top left corner at pixel (x, y)."""
    for glyph in text:
        code = GLYPHS[glyph]
        for r in range(7):
            bits = int(code[2 * r:2 * r + 2], 16)
            for c in range(5):
                if bits >> (4 - c) & 1:
                    fill(rows, x + c * scale, y + r * scale, scale, scale, ink)
        x += 6 * scale


def fill(rows, x, y, w, h, ink=(20, 20, 22)):
    for row in rows[y:y + h]:
        row[3 * x:3 * (x + w)] = bytes(ink) * w


def focus_chart(width=720, height=960):
    """A Siemens star of 36 spokes, a slanted edge (5 degrees, as ISO 12233 has it), line pairs, and figures."""
    paper = (236, 230, 216)
    rows = [bytearray(bytes(paper) * width) for _ in range(height)]
    for x, y, w, h in ((20, 20, 680, 4), (20, 936, 680, 4), (20, 20, 4, 920), (696, 20, 4, 920)):
        fill(rows, x, y, w, h)
    cx, cy, radius = 360, 350, 250
    for y in range(cy - radius, cy + radius):
        for x in range(cx - radius, cx + radius):
            dx, dy = x + 0.5 - cx, y + 0.5 - cy
            r = math.hypot(dx, dy)
            if 3 < r < radius:
                # Distance to the nearest spoke's edge in pixels gives the coverage of this one.
                phase = math.sin(36 * math.atan2(dy, dx)) * r / 36
                cover = min(1, max(0, 0.5 + phase)) if r < radius - 1 else 0.5
                rows[y][3 * x:3 * x + 3] = bytes(round(20 + (p - 20) * cover) for p in paper)
    for r in (80, 160):
        for k in range(2000):
            a = 2 * math.pi * k / 2000
            fill(rows, cx + round(r * math.cos(a)), cy + round(r * math.sin(a)), 2, 2, (176, 52, 40))
    write(rows, "PETZVAL", 44, 44, 5)
    write(rows, "FIRST LIGHT", 470, 44, 3)
    for k, pitch in enumerate((20, 14, 10, 8, 6, 4)):
        x = 44 + 74 * k
        for s in range(0, 60 - pitch // 2 + 1, pitch):
            fill(rows, x + s, 640, pitch // 2, 64)
            fill(rows, x, 716 + s, 60, pitch // 2)
        write(rows, str(round(120 / pitch)), x, 788, 2)
    for y in range(640, 776):
        edge = 590 + round((y - 708) * math.tan(math.radians(5)))
        fill(rows, edge, y, 676 - edge, 1)
    for k in range(4):
        write(rows, "0123456789 1/2 1/4 - FIRST LIGHT 36", 44, 822 + (0, 36, 66, 90)[k], (3, 2, 2, 1)[k])
    for k in range(11):
        level = round(236 * (k / 10) ** 0.5)
        fill(rows, 430 + 22 * k, 880, 22, 40, (level, level, level))
    return png(rows)


def folding_rule(pieces, width=1000, row_height=80):
    """One strip for each 0.2 m piece of a folding rule, millimetre ticks and centimetre figures."""
    rng = random.Random(17)
    grain = noise(rng, width, pieces * row_height, 30, pieces * row_height // 4)
    rows = [bytearray(3 * round((c - 30 * g) / 3) for g in line for c in (238, 206, 116)) for line in grain]
    for piece in range(pieces):
        top = piece * row_height
        for mm in range(200):
            length = 26 if mm % 10 == 0 else 20 if mm % 5 == 0 else 13
            fill(rows, 5 * mm, top, 2 if mm % 10 == 0 else 1, length)
            fill(rows, 5 * mm, top + row_height - length // 2, 1, length // 2)
        for cm in range(20):
            number = str(piece * 20 + cm)
            big = cm % 10 == 0
            scale, ink = (4, (170, 40, 30)) if big else (2, (20, 20, 22))
            write(rows, number, min(50 * cm + 5, width - 6 * scale * len(number)), top + 30, scale, ink)
    return png(rows)


def speckle(size, stops, seed, cells, weight=0.25):
    """Mottled colour along v by stops, for glaze and for skin."""
    rng = random.Random(seed)
    broad, fine = noise(rng, size, size, cells, cells), noise(rng, size, size, size // 3, size // 3)
    field = [[j / size + weight * (b - 0.5) - max(0.0, f - 0.86) * 1.5 for b, f in zip(broad[j], fine[j])]
             for j in range(size)]
    return png(ramp(field, stops, 2))


def dimples(size=256, cells=22):
    """Normal map of citrus peel: round pits, one in each jittered cell."""
    rng = random.Random(19)
    height = [[1.0] * size for _ in range(size)]
    pit = size / cells * 0.42
    for cell in range(cells * cells):
        cx, cy = ((cell % cells + rng.random()) * size / cells, (cell // cells + rng.random()) * size / cells)
        for y in range(int(cy - pit), int(cy + pit) + 2):
            for x in range(int(cx - pit), int(cx + pit) + 2):
                d = math.hypot(x - cx, y - cy) / pit
                if d < 1:
                    height[y % size][x % size] -= 0.8 * (1 - d * d) ** 2
    return png(normals(height, 1.2, 4))


def brushed(width=256, height=256):
    """Roughness of turned metal: fine rings along v, with smears; 0.5 on average before the factor."""
    rng = random.Random(23)
    rings, smears = noise(rng, width, height, 4, height), noise(rng, width, height, 8, 8)
    return png([[c for r, s in zip(*lines) for c in (0, 2 * round(30 + 25 * r + 40 * s), 255)]
                for lines in zip(rings, smears)])


def dusk(width=512, height=256):
    """The sky from zenith side (row 0) to horizon, streaked by thin cloud; dithered against banding."""
    rng = random.Random(29)
    cloud = blend([(0.6, noise(rng, width, height, 4, 14)), (0.4, noise(rng, width, height, 11, 40))])
    stops = [(0, "#232f5c"), (0.35, "#374878"), (0.58, "#6d6790"), (0.74, "#bb7c82"), (0.87, "#f0995f"),
             (1, "#ffb45a")]
    field = [[j / height + 0.22 * (c - 0.5) * (0.3 + j / height) for c in cloud[j]] for j in range(height)]
    rows = ramp(field, stops, 1)
    return png([[min(255, c + rng.getrandbits(1)) for c in row] for row in rows])


def paper_glow(width=256, height=128):
    """Glow of a paper lantern: brightest where the flame stands, with ribs and fibres."""
    rng = random.Random(31)
    fibres = noise(rng, width, height, 60, 40)
    field = []
    for j in range(height):
        y = 1 - j / height
        hot = math.exp(-((y - 0.35) / 0.33) ** 2)
        rib = 0.72 if j % 16 < 2 else 1.0
        field.append([rib * (0.25 + 0.7 * hot) * (0.85 + 0.15 * f) for f in fibres[j]])
    return png(ramp(field, [(0, "#000000"), (0.35, "#c05a20"), (0.7, "#f7a850"), (1, "#ffe2a8")]))
