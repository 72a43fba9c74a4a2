"""Parts whose shape is known exactly, programs that make them without cutting into them, and the same programs with one gouge.

A part is a block with a pocket in its top (Z0): a rectangle at any angle, a circle, or a rectangle with a round boss left standing in
its middle. The blank is the block. Cutters go along the floor and no nearer to a wall than their radius: what they leave over does not
matter here. A gouge is one line too deep, or too far into a wall; how deep it is follows from its numbers alone:
    floor    the tip goes G below the floor, far from all walls: G
    wall     a cutter that is as wide as it gets goes G farther than the wall lets it: G (the wall is higher than G above that)
    arc      likewise around the circle or the boss: G
    top      a link that should pass above the block runs G below its top: G
"""

import dataclasses
import math
import struct

SIZE = 60.0  # of the block in X and Y, about 0
SIDE = 120
SEGMENTS = 1440  # of a circle: a chord is off by a hundred-thousandth of its radius

# spec, radius, height above the tip from which on it is as wide as its radius; None: no wall for it
CUTTERS = [
    ("flat:6", 3.0, 0.0),
    ("ball:6", 3.0, 3.0),
    ("bull:8:1.5", 4.0, 1.5),
    ("vee:6:90", 3.0, 3.0),
    ("vee:4:60:0.4", 2.0, (2.0 - 0.2) / math.tan(math.radians(30))),
    ("drill:5:118", 2.5, 2.5 / math.tan(math.radians(59))),
    ("taper:2:6:flute=12", None, None),
    ("flat:1.5", 0.75, 0.0),
    ("tslot:8:3:4", 4.0, None),
    ("lollipop:6:3", 3.0, None),
]


@dataclasses.dataclass
class Planted:
    kind: str
    what: str
    triangles: list
    arguments: list
    faulty: str
    sound: str
    lines: set  # any of them: the deepest place is common to all
    depth: float
    bound: float
    has_gaps: bool


def write_stl(path, triangles):
    with open(path, "wb") as file:
        file.write(b"known part".ljust(80, b"\0") + struct.pack("<I", len(triangles)))
        for triangle in triangles:
            file.write(struct.pack("<12fH", 0, 0, 0, *(v for corner in triangle for v in corner), 0))


def ring_between(outer, inner, z):
    """Triangles of a level ring between two outlines that are seen whole from 0, both counter-clockwise; seen from above."""
    def start(ring):
        first = min(range(len(ring)), key=lambda i: math.atan2(ring[i][1], ring[i][0]) % math.tau)
        return ring[first:] + ring[:first]

    outer, inner = start(outer), start(inner)

    def angle(ring, i):
        return math.atan2(ring[i % len(ring)][1], ring[i % len(ring)][0]) % math.tau + math.tau * (i // len(ring))

    out, i, j = [], 0, 0
    while i < len(outer) or j < len(inner):
        a, b = outer[i % len(outer)], inner[j % len(inner)]
        if j >= len(inner) or (i < len(outer) and angle(outer, i + 1) <= angle(inner, j + 1)):
            out.append(((*a, z), (*outer[(i + 1) % len(outer)], z), (*b, z)))
            i += 1
        else:
            out.append(((*a, z), (*inner[(j + 1) % len(inner)], z), (*b, z)))
            j += 1
    return out


def wall(ring, low, high, inward):
    """Of an outline counter-clockwise; `inward`: material is outside, the wall faces in."""
    out = []
    for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1]):
        quad = [((ax, ay, low), (bx, by, low), (bx, by, high)), ((ax, ay, low), (bx, by, high), (ax, ay, high))]
        out += [tuple(reversed(t)) for t in quad] if inward else quad
    return out


def disc(ring, z, upward):
    out = [((0, 0, z), (*a, z), (*b, z)) for a, b in zip(ring, ring[1:] + ring[:1])]
    return out if upward else [tuple(reversed(t)) for t in out]


def circle(radius):
    return [(radius * math.cos(math.tau * i / SEGMENTS), radius * math.sin(math.tau * i / SEGMENTS)) for i in range(SEGMENTS)]


def rectangle(half_x, half_y, angle):
    """With many points on each side: ring_between() goes by angles, and its triangles must not reach far around."""
    c, s = math.cos(angle), math.sin(angle)
    corners = [(-half_x, -half_y), (half_x, -half_y), (half_x, half_y), (-half_x, half_y)]
    points = [(ax + (bx - ax) * n / SIDE, ay + (by - ay) * n / SIDE)
              for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1]) for n in range(SIDE)]
    return [(x * c - y * s, x * s + y * c) for x, y in points]


def block(pocket, floor, bottom, boss=None):
    outer = rectangle(SIZE / 2, SIZE / 2, 0)
    out = wall(outer, bottom, 0.0, False) + disc(outer, bottom, False)
    out += ring_between(outer, pocket, 0.0) + wall(pocket, floor, 0.0, True)
    if boss is None:
        return out + disc(pocket, floor, True)
    return out + ring_between(pocket, boss, floor) + wall(boss, floor, 0.0, False) + disc(boss, 0.0, True)


class Program:
    def __init__(self):
        self.lines = ["G21 G17 G90 G54 G40", "T1 M6", "S9000 M3", "G0 Z10"]

    def add(self, text):
        self.lines.append(text)
        return len(self.lines)

    def text(self):
        return "\n".join([*self.lines, "G0 Z10", "M2", ""])


def at(x, y, angle=0.0):
    c, s = math.cos(angle), math.sin(angle)
    return f"X{x * c - y * s:.6f} Y{x * s + y * c:.6f}"


def lanes(half, reach):
    count = max(2, math.ceil(2 * half / reach))
    return [-half + 2 * half * i / count for i in range(count + 1)]


def rectangular(rng, spec, radius, width_from, depth, planted_at, gouge):
    """Lanes along X of the pocket's own axes."""
    half_x, half_y = rng.uniform(12, 16), rng.uniform(9, 12)
    angle = rng.choice([0.0, 0.0, math.pi / 2, rng.uniform(0, math.pi)])
    x1, y1 = half_x - radius, half_y - radius
    programs, lines = [], set()
    ys = lanes(y1, 1.2 * radius)
    fault_lane = rng.randrange(1, len(ys) - 1)
    dip = rng.uniform(-0.4 * x1, 0.3 * x1)
    for size in (gouge, 0.0):
        p = Program()
        if planted_at == "top":
            p.add(f"G0 {at(-x1, 0, angle)}")
            p.add("G1 Z0.5 F600")
        for n, y in enumerate(ys):
            ends = (-x1, x1) if n % 2 == 0 else (x1, -x1)
            p.add(f"{'G1' if n else 'G0'} {at(ends[0], y, angle)} F900")
            if n == 0:
                p.add(f"G1 Z{-depth:.6f} F300")
            if n == fault_lane and planted_at == "floor":
                way = 2.0 if ends[1] > ends[0] else -2.0
                p.add(f"G1 {at(dip, y, angle)}")
                a = p.add(f"G1 Z{-depth - size:.6f}")
                b = p.add(f"G1 {at(dip + way, y, angle)}")
                c = p.add(f"G1 Z{-depth:.6f}")
                lines = {a, b, c} if size else lines
            over = math.copysign(size, ends[1]) if n == fault_lane and planted_at == "wall" else 0.0
            a = p.add(f"G1 {at(ends[1] + over, y, angle)}")
            if over:
                lines = {a, a + 1}
            if planted_at == "wall" and n == fault_lane:
                p.add(f"G1 {at(ends[1], y, angle)}")
        if planted_at == "top":
            p.add("G0 Z10")
            p.add(f"G0 {at(0, half_y + 5, angle)}")
            a = p.add(f"G1 Z{-size if size else 0.5:.6f} F300")
            b = p.add(f"G1 {at(6, half_y + 5, angle)}")
            lines = {a, b, b + 1} if size else lines
        programs.append(p.text())
    return rectangle(half_x, half_y, angle), None, programs, lines


def round_one(rng, spec, radius, width_from, depth, planted_at, gouge):
    """Circles, from the middle out."""
    pocket = rng.uniform(12, 17)
    most = pocket - radius
    programs, lines = [], set()
    for size in (gouge, 0.0):
        p = Program()
        p.add("G0 X0 Y0")
        p.add(f"G1 Z{-depth:.6f} F300")
        for r in [most * k / 4 for k in range(1, 5)]:
            p.add(f"G1 X{r:.6f} Y0 F900")
            p.add(f"G3 X{r:.6f} Y0 I{-r:.6f} J0")
        if planted_at == "arc":
            r = most + size
            a = p.add(f"G1 X{r:.6f} Y0")
            b = p.add(f"G3 X0 Y{r:.6f} I{-r:.6f} J0")
            c = p.add("G1 X0 Y0")
            lines = {a, b, c} if size else lines
        programs.append(p.text())
    return circle(pocket), None, programs, lines


def bossed(rng, spec, radius, width_from, depth, planted_at, gouge):
    """Circles about the boss, from far to near."""
    boss = rng.uniform(3, 6)
    half = boss + 2 * radius + rng.uniform(3, 5)
    near = boss + radius
    programs, lines = [], set()
    for size in (gouge, 0.0):
        p = Program()
        p.add(f"G0 X{half - radius:.6f} Y0")
        p.add(f"G1 Z{-depth:.6f} F300")
        for share in (1.0, 0.5, 0.0):
            r = near + share * (half - radius - near)
            p.add(f"G1 X{r:.6f} Y0 F900")
            p.add(f"G2 X{r:.6f} Y0 I{-r:.6f} J0")
        if planted_at == "arc":
            r = near - size
            a = p.add(f"G1 X{r:.6f} Y0")
            b = p.add(f"G2 X0 Y{-r:.6f} I{-r:.6f} J0")
            c = p.add(f"G1 X0 Y{-near:.6f}")
            lines = {a, b, c} if size else lines
        programs.append(p.text())
    return rectangle(half, half, 0), circle(boss), programs, lines


def plant(rng, number):
    spec, radius, width_from = CUTTERS[number % len(CUTTERS)]
    depth = 8.0
    if radius is None:  # taper:2:6: its radius where the flutes end
        radius = 1 + 12 * math.tan(math.radians(6)) + 0.2
    gouge = round(math.exp(rng.uniform(math.log(0.02), math.log(2.0))), 4)
    kinds = [("rectangle", "floor"), ("rectangle", "top")]
    if width_from is not None:
        kinds += [("rectangle", "wall"), ("rectangle", "wall"), ("circle", "arc"), ("boss", "arc")]
    if "tslot" in spec or "lollipop" in spec:
        kinds = [("rectangle", "floor")]
    shape, planted_at = kinds[number // len(CUTTERS) % len(kinds)]
    has_gaps = "tslot" in spec or "lollipop" in spec
    is_octree = number % 8 == 3 and not has_gaps
    if is_octree:  # 8 % of a cell is taken off what is told, and that has to be more than the tolerance
        gouge = max(gouge, 0.05)
    if shape == "boss":
        gouge = min(gouge, 1.0)
    make = {"rectangle": rectangular, "circle": round_one, "boss": bossed}[shape]
    pocket, boss, (faulty, sound), lines = make(rng, spec, radius, width_from, depth, planted_at, gouge)
    bottom = -depth - 6.0
    cell = rng.choice([0.1, 0.15, 0.2])
    arguments = ["--stock", f"box:{-SIZE / 2:g},{-SIZE / 2:g},{bottom:g}:{SIZE / 2:g},{SIZE / 2:g},0", "--tool", f"1={spec}", "--cell",
                 f"{cell:g}"]
    if is_octree:
        cell = 0.2
        arguments[-1:] = ["0.2", "--model", "octree"]
    what = f"{shape}, {planted_at}, {spec}"
    return Planted(f"{'octree ' if is_octree else ''}{planted_at} {spec}", what, block(pocket, -depth, bottom, boss), arguments, faulty, sound, lines, gouge,
                   cell / 10 + 0.002, has_gaps)
