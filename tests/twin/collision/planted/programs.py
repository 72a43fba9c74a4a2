"""Programs with one planted fault each, and their sound twins: the same with the obstacle clear by CLEAR_mm.

draw_standing() draws tool, obstacle and motions, pushes the obstacle towards the tool's way until the oracle says that CLEAR_mm are
left, and a little further for the fault. What is not one clear fault of one part is None, and to be drawn again.
"""

import dataclasses
import math
import random

from oracle import Bar, Block, Cone, Cylinder, Move, Obstacle, Pipe, Rod, depth_of, eroded, first_touch, heights_of, least_gap, width_of

CLEAR_mm = 0.02
# Other parts of the tool stay this clear, so that it is plain what touches.
OTHERS_mm = 0.1
# kerf calls it no contact up to 0.01 mm; programs in which that would decide on the line are drawn again.
SURELY_NONE_mm, SURELY_ONE_mm = 0.004, 0.0145
# Of the place of a contact, along the tool's way.
PLACE_mm = 0.01
# So deep rounding may be: of a tool that runs almost along an obstacle the place is not sharper than that.
ROUNDING_mm = 1.5e-4
# Farther than this nothing is measured.
NEAR_mm = 0.1
HIGH_mm = 150.0
PARTS = ("cutter", "shank", "holder", "spindle")


@dataclasses.dataclass
class Tool:
    shape: str
    parts: dict  # name: pieces
    spindle: str


def draw_tool(rng, kinds=("flat", "ball", "bull", "vee")):
    kind = rng.choice(kinds)
    d = rng.choice((3.0, 4.0, 6.0, 8.0, 10.0, 12.0))
    r, flutes = d / 2, rng.choice((12.0, 16.0, 20.0, 25.0))
    if kind == "flat":
        shape, cutter = f"flat:{d}", [Cylinder(r, 0, flutes)]
    elif kind == "ball":
        shape, cutter = f"ball:{d}", [Cylinder(0, r, r, r), Cylinder(r, r, flutes, seated=True)]
    elif kind == "bull":
        corner = rng.choice((0.5, 1.0))
        shape, cutter = f"bull:{d}:{corner}", [Cylinder(r - corner, corner, corner, corner), Cylinder(r, corner, flutes, seated=True)]
    else:
        angle = rng.choice((60.0, 90.0))
        high = r / math.tan(math.radians(angle / 2))
        shape, cutter = f"vee:{d}:{angle}", [Cone(0, r, 0, high), Cylinder(r, high, flutes)]
    shank = rng.choice((d - 1, d + 1, d + 2))
    stickout = flutes + rng.choice((8.0, 15.0, 22.0))
    wide, wider = rng.choice((16.0, 19.0, 28.0, 34.0)), rng.choice((40.0, 46.0))
    low, high = rng.choice((10.0, 20.0)), rng.choice((12.0, 30.0))
    top = stickout + low + high
    nose, nose_high = rng.choice((60.0, 80.0)), 60.0
    parts = {
        "cutter": cutter,
        "shank": [Cylinder(shank / 2, flutes, stickout)],
        "holder": [Cylinder(wide / 2, stickout, stickout + low), Cylinder(wider / 2, stickout + low, top)],
        "spindle": [Cylinder(nose / 2, top, top + nose_high)],
    }
    text = f"{shape}:flute={flutes}:shank={shank}:holder={wide}x{low}+{wider}x{high}:stickout={stickout}"
    return Tool(text, parts, f"{nose}x{nose_high}")


class Program:
    """Writes lines, and knows what they do."""

    def __init__(self):
        self.lines, self.moves, self.at, self.ac = [], [], None, (0.0, 0.0)
        self.make_move, self.letters = Move, "AC"
        for line in ("G21 G17 G90 G54 G40 G49", "T1 M6", "S8000 M3"):
            self.lines.append(line)

    def text(self):
        return "\n".join(self.lines) + "\n"

    def word(self, code, place, ac=None, extra=""):
        place = tuple(round(x, 4) for x in place)
        words = " ".join(f"{letter}{x:.4f}" for letter, x in zip("XYZ", place))
        if ac is not None:
            words += "".join(f" {letter}{x:.4f}" for letter, x in zip(self.letters, ac))
        self.lines.append(f"{code} {words}{extra}")
        return place

    def go(self, place, code="G1", ac=None, turn=None, extra=""):
        ac = None if ac is None else tuple(round(a, 4) for a in ac)
        place = self.word(code, place, ac, extra + (" F600" if code != "G0" else ""))
        self.note(len(self.lines), place, ac, turn)

    def note(self, line, place, ac=None, turn=None):
        """A move that the line makes."""
        ac = self.ac if ac is None else ac
        if self.at is not None:
            self.moves.append(self.make_move(line, self.at, place, turn, self.ac, ac))
        self.at, self.ac = place, ac


@dataclasses.dataclass
class Way:
    """What write() does near the middle, and from where obstacles are pushed towards it."""

    write: object
    push: tuple  # unit, away from the tool's way
    inside: bool = False  # the obstacle lies around it


def unit(angle):
    return (math.cos(angle), math.sin(angle), 0.0)


def plus(p, q, times=1.0):
    return tuple(a + times * b for a, b in zip(p, q))


def draw_way(rng, middle, kind):
    """middle: where the tip is when it comes nearest, about."""
    angle = rng.uniform(0, 2 * math.pi)
    along, across = unit(angle), unit(angle + math.pi / 2)
    code = "G0" if kind == "rapid" else "G1"
    if kind in ("feed", "rapid", "slope"):
        rise = rng.uniform(-6, 6) if kind == "slope" else 0.0
        start = plus(plus(middle, along, -30), (0, 0, rise))
        end = plus(plus(middle, along, 30), (0, 0, -rise))

        def write(program):
            approach(program, start)
            program.go(end, code)

        return Way(write, across)
    if kind in ("arc", "helix"):
        return draw_arc(rng, middle, angle, kind)
    if kind == "plunge":
        top = plus(middle, (0, 0, 25))
        code = rng.choice(("G0", "G1"))

        def write(program):
            approach(program, top)
            program.go(middle, code)

        return Way(write, (0.0, 0.0, -1.0))
    if kind == "dip":
        radius = rng.choice((15.0, 25.0))
        center = plus(middle, (0, 0, radius))
        plane, number, sign = rng.choice((("G18", 1, 1), ("G19", 0, 1)))
        u = (number + 1) % 3 if number == 0 else 0

        def place(theta):
            out = list(center)
            out[u] += sign * radius * math.sin(theta)
            out[2] -= radius * math.cos(theta)
            return tuple(out)

        start, end = place(-1.0), place(1.0)

        def write(program):
            approach(program, start)
            at = program.at
            rounded = tuple(round(x, 4) for x in center)
            words = {0: ("J", "K"), 1: ("I", "K")}[number]
            offsets = f" {words[0]}{rounded[u] - at[u]:.4f} {words[1]}{rounded[2] - at[2]:.4f}"
            # About +X a place goes from +Y to +Z; about +Y from +Z to +X.
            turn = 2.0 if number == 0 else -2.0
            code = "G3" if turn > 0 else "G2"
            program.lines.append(plane)
            program.go(end, code, turn=(rounded, number, turn), extra=offsets)
            program.lines.append("G17")

        return Way(write, (0.0, 0.0, -1.0))
    if kind == "steps":
        return draw_steps(rng, middle, along, across)
    if kind == "incremental":
        start = tuple(round(x, 4) for x in plus(middle, along, -30))
        step = tuple(round(x, 4) for x in plus((0, 0, 0), along, 20))

        def write(program):
            approach(program, start)
            program.lines.append("G91")
            for _ in range(3):
                at = program.at
                program.word("G1", step, extra=" F600")
                program.note(len(program.lines), tuple(round(x, 4) for x in plus(at, step)))
            program.lines.append("G90")

        return Way(write, across)
    assert kind == "subroutine"
    return draw_subroutine(rng, middle, along, across)


def draw_arc(rng, middle, angle, kind):
    radius = rng.uniform(8, 40)
    outward = unit(angle)
    center = tuple(round(x, 4) for x in plus(middle, outward, -radius))
    half = rng.uniform(0.5, 2.2)
    sign = rng.choice((1, -1))
    rise = rng.uniform(-4, 4) if kind == "helix" else 0.0

    def place(theta, z):
        return (center[0] + radius * math.cos(angle + theta), center[1] + radius * math.sin(angle + theta), middle[2] + z)

    start, end = place(-sign * half, rise), place(sign * half, -rise)

    def write(program):
        approach(program, start)
        at = program.at
        code = "G3" if sign > 0 else "G2"
        extra = f" I{center[0] - at[0]:.4f} J{center[1] - at[1]:.4f}"
        begin = math.atan2(at[1] - center[1], at[0] - center[0])
        final = tuple(round(x, 4) for x in end)
        turn = (math.atan2(final[1] - center[1], final[0] - center[0]) - begin) % (2 * math.pi)
        if sign < 0:
            turn -= 2 * math.pi
        program.go(end, code, turn=(center, 2, turn), extra=extra)

    return Way(write, outward, inside=True)


def draw_steps(rng, middle, along, across):
    """A wave of many short lines."""
    high, count = rng.uniform(2, 6), 40

    def write(program):
        for i in range(count + 1):
            x = -20 + 40 * i / count
            place = plus(plus(middle, along, x), across, high * math.cos(x * math.pi / 20) - high)
            if i == 0:
                approach(program, place)
            else:
                program.go(place)

    return Way(write, across)


def draw_subroutine(rng, middle, along, across):
    """Called three times beside each other; the obstacle waits beside the last."""
    apart = 9.0
    start, end = (tuple(round(x, 4) for x in plus(middle, along, x)) for x in (-25, 25))

    def write(program):
        # The body of it comes first in the file.
        dx, dy = round(across[0], 4), round(across[1], 4)
        body = len(program.lines) + 2
        program.lines += [
            "o100 sub",
            f"G0 X[{start[0]:.4f}+#1*{dx:.4f}] Y[{start[1]:.4f}+#1*{dy:.4f}]",
            f"G0 Z{start[2]:.4f}",
            f"G1 X[{end[0]:.4f}+#1*{dx:.4f}] Y[{end[1]:.4f}+#1*{dy:.4f}] F600",
            f"G0 Z{HIGH_mm}",
            "o100 endsub",
        ]
        program.go((start[0], start[1], HIGH_mm), "G0")
        for beside in (-2 * apart, -apart, 0.0):
            program.lines.append(f"o100 call [{beside}]")
            x, y = beside * dx, beside * dy
            program.note(body, (start[0] + x, start[1] + y, HIGH_mm))
            program.note(body + 1, (start[0] + x, start[1] + y, start[2]))
            program.note(body + 2, (end[0] + x, end[1] + y, start[2]))
            program.note(body + 3, (end[0] + x, end[1] + y, HIGH_mm))

    return Way(write, across)


def approach(program, place, ac=None):
    program.go((place[0], place[1], HIGH_mm), "G0", ac)
    program.go(place, "G0", ac)


def finish(program):
    program.go((program.at[0], program.at[1], HIGH_mm), "G0")
    program.lines += ["M5", "M2"]


def text_of(values):
    return ",".join(f"{x:.6f}" for x in values)


@dataclasses.dataclass
class Shape:
    """An obstacle's text without its place; bodies; half of its size across, files that it needs."""

    text: str
    bodies: list
    half_mm: float
    files: dict = dataclasses.field(default_factory=dict)
    lift: float = 0.0  # of its frame's origin


def box_shape(name, low, high):
    half = max(math.hypot(x, y) for x in (low[0], high[0]) for y in (low[1], high[1]))
    return Shape(f"box:{text_of(low)}:{text_of(high)}", [Block(low, high)], half)


def draw_shape(rng, kind, top, deep):
    """Its top is at Z `top`, its bottom `deep` below. Figures are round, so that files of floats have them as they are."""
    a, b = rng.choice((4.0, 8.0, 15.0)), rng.choice((5.0, 12.0, 30.0))
    low = top - deep
    if kind == "box":
        return box_shape(kind, (-a, -b, low), (a, b, top))
    if kind == "wall":
        return box_shape(kind, (-0.1, -b, low), (0.1, b, top))
    if kind == "rod":
        return Shape(f"cylinder:0,0,{low:.6f}:{top:.6f}:{2 * a}", [Rod((0, 0), a, low, top)], a)
    if kind == "bar":
        return Shape(f"cylinder:-100,0,{top - a:.6f}:100:{2 * a}:x", [Bar(0, top - a, a, -100, 100)], a)
    if kind in ("pipe", "bore"):
        inner = a - rng.choice((0.2, 1.0, 2.0)) if kind == "pipe" else 60.0
        outer = a if kind == "pipe" else 60.2
        return Shape(f"tube:0,0,{low:.6f}:{top:.6f}:{2 * outer}:{2 * inner}", [Pipe((0, 0), outer, inner, low, top, kind == "bore")], outer)
    if kind == "vise":
        width, opening = 40.0, rng.choice((10.0, 24.0))
        thick, half = width / 4, width / 2
        bodies = [
            Block((-half, opening / 2, 0), (half, opening / 2 + thick, deep)),
            Block((-half, -opening / 2 - thick, 0), (half, -opening / 2, deep)),
            Block((-half, -opening / 2 - thick, -thick), (half, opening / 2 + thick, 0)),
        ]
        shape = Shape(f"vise:{width}:{opening}:{deep}", bodies, math.hypot(half, opening / 2 + thick))
        shape.lift = low
        return shape
    if kind == "clamp":
        shape = Shape(f"clamp:{2 * a}:{b}:{deep}", [Block((0, -b / 2, 0), (2 * a, b / 2, deep))], math.hypot(2 * a, b / 2))
        shape.lift = low
        return shape
    if kind == "screw":
        bodies = [Rod((0, 0), a / 2, -deep, 0), Rod((0, 0), a, 0, a)]
        shape = Shape(f"screw:{a}:{deep}", bodies, a)
        shape.lift = top - a
        return shape
    assert kind == "mesh"
    return mesh_shape(a, b, deep, low)


def mesh_shape(a, b, deep, lift):
    """An L of two boxes, closed, in a file."""
    outline = ((-a, -b), (a, -b), (a, 0.0), (0.0, 0.0), (0.0, b), (-a, b))
    triangles = []
    for k in range(1, 5):  # a fan from the inner corner
        p, q = outline[(3 + k) % 6], outline[(4 + k) % 6]
        triangles.append(((*outline[3], deep), (*p, deep), (*q, deep)))
        triangles.append(((*outline[3], 0.0), (*q, 0.0), (*p, 0.0)))
    for p, q in zip(outline, outline[1:] + outline[:1]):
        triangles.append(((*p, 0.0), (*q, 0.0), (*q, deep)))
        triangles.append(((*p, 0.0), (*q, deep), (*p, deep)))
    lines = ["solid part"]
    for triangle in triangles:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {x:.6f} {y:.6f} {z:.6f}" for x, y, z in triangle]
        lines += ["endloop", "endfacet"]
    lines += ["endsolid part", ""]
    bodies = [Block((-a, -b, 0), (a, 0, deep)), Block((-a, 0, 0), (0, b, deep))]
    shape = Shape("stl:part.stl", bodies, math.hypot(a, b), {"part.stl": "\n".join(lines)})
    shape.lift = lift
    return shape


@dataclasses.dataclass
class Planted:
    """One program, the fault, and its sound twin."""

    number: int
    title: str
    finding: str
    arguments: list
    shape: Shape
    program: str
    sound_at: tuple
    fault_at: tuple
    turn_deg: float
    line: int
    place: tuple
    depth: float
    place_mm: float  # how far off it may be
    way_mm: float
    part: str
    on_blank: bool = False  # the obstacle is the blank


WAYS = ("feed", "rapid", "slope", "arc", "helix", "plunge", "dip", "steps", "incremental", "subroutine")
SHAPES = ("box", "wall", "rod", "bar", "pipe", "bore", "vise", "clamp", "screw", "mesh")


def obstacle_arguments(planted, at):
    """What describes it to kerf."""
    if not planted.on_blank:
        turn = f":turn={planted.turn_deg}" if planted.turn_deg else ""
        return ["--stock", "box:0,0,-200:4,4,-196", "--fixture", f"it={planted.shape.text}:at={text_of(at)}{turn}"]
    body = planted.shape.bodies[0]
    if isinstance(body, Rod):
        center = f"{at[0]:.6f},{at[1]:.6f}"
        return ["--stock", f"cylinder:{center},{body.low + at[2]:.6f}:{body.high + at[2]:.6f}:{2 * body.radius}"]
    return ["--stock", f"box:{text_of(plus(body.low, at))}:{text_of(plus(body.high, at))}"]


def draw_standing(rng, number, part):
    """A program for three axes."""
    kind, way_kind = rng.choice(SHAPES), rng.choice(WAYS)
    if kind == "bar":
        tool = draw_tool(rng, ("flat", "ball", "bull"))
        if way_kind in ("subroutine", "steps", "incremental"):
            return None
    else:
        tool = draw_tool(rng)
    middle = tuple(round(x, 4) for x in (rng.uniform(80, 140), rng.uniform(60, 120), rng.uniform(-20, 5)))
    way = draw_way(rng, middle, way_kind)
    program = Program()
    way.write(program)
    finish(program)
    low, high = heights_of(tool.parts[part])
    if way.push[2] < 0:
        # From below: beside what is lower and thinner.
        top = middle[2] + low - 0.5
        thinner = max([width_of(tool.parts[p]) for p in PARTS[: PARTS.index(part)]], default=0.0)
        wide = width_of(tool.parts[part])
        beside = rng.uniform(thinner + 0.5, wide - 0.5) if part != "cutter" else 0.0
    else:
        top = middle[2] + low + rng.uniform(0.4, min(high - low, 10.0))
        beside = None
    shape = draw_shape(rng, kind, round(top, 2), rng.choice((6.0, 20.0)))
    turn = rng.choice((0.0, 30.0, -17.5)) if kind not in ("bar", "rod", "pipe", "bore", "screw") else 0.0
    lift = shape.lift
    angle = rng.uniform(0, 2 * math.pi)
    if kind == "bore":
        if not way.inside:
            return None
        base = (middle[0], middle[1], lift)
        tries = [x / 2 for x in range(0, 200)]
    elif beside is not None:
        outer = beside + shape.half_mm if part != "cutter" else 0.0
        base = plus((middle[0], middle[1], lift), unit(angle), outer)
        tries = [4 - x / 4 for x in range(0, 40)]
    else:
        base = (middle[0], middle[1], lift)
        tries = [width_of(tool.parts[part]) + shape.half_mm + 4 - x / 2 for x in range(0, 80)]
    obstacle = Obstacle(shape.bodies, base, turn)
    return settle(rng, number, part, way_kind, kind, tool, program, shape, obstacle, way.push, tries)


def settle(rng, number, part, way_kind, kind, tool, program, shape, obstacle, push, tries, arguments=(), way_mm=0.0,
           thinner=eroded):
    """Pushes the obstacle until CLEAR_mm are left, and then a little further. way_mm: so far kerf's way may be beside the tool's, or its walls
    beside those of a blank. thinner(pieces, depth): what a part that deep would have to be, to be clear."""
    pieces, moves = tool.parts[part], program.moves

    def gap_at(s):
        return least_gap(pieces, [obstacle.moved(tuple(s * x for x in push))], moves, NEAR_mm)

    clear, gap = None, None
    for s in tries:
        gap = gap_at(s)
        if gap <= 0:
            break
        clear = s
    if clear is None or gap > 0:
        return None
    touching = s
    for _ in range(60):
        s = (clear + touching) / 2
        gap = gap_at(s)
        if gap > CLEAR_mm:
            clear = s
        else:
            touching = s
        if abs(gap - CLEAR_mm) < 4e-4:
            break
    if abs(gap - CLEAR_mm) > 4e-4:
        return None
    sound_s = s
    grazing = max(0.02, 3 * way_mm if thinner is not eroded else 0)
    further = CLEAR_mm + rng.choice((grazing, grazing, rng.uniform(max(grazing, 0.05), 0.4), rng.uniform(0.5, 3)))
    fault_s = sound_s - further if tries[1] < tries[0] else sound_s + further
    sound = obstacle.moved(tuple(round(sound_s * x, 6) for x in push))
    fault = obstacle.moved(tuple(round(fault_s * x, 6) for x in push))
    if not others_are_clear(tool, part, moves, (sound, fault)):
        return None
    touch = first_touch(pieces, [fault], moves)
    if touch is None:
        return None
    move, t = touch
    sure = first_touch(eroded(pieces, SURELY_ONE_mm), [fault], moves)
    if sure is None or sure[0] is not move or first_touch(eroded(pieces, SURELY_NONE_mm), [fault], moves)[0] is not move:
        return None
    place_mm = PLACE_mm
    for by in (max(way_mm, ROUNDING_mm), -max(way_mm, ROUNDING_mm)):
        other = first_touch(eroded(pieces, by), [fault], [move])
        if other:
            place_mm = max(place_mm, PLACE_mm + math.dist(move.tip(t), move.tip(other[1])))
    return Planted(
        number,
        f"{part} against {kind}, {way_kind}",
        "fixture-contact",
        ["--tool", f"1={tool.shape}", "--set", f"machine.spindle={tool.spindle}", *arguments],
        shape,
        program.text(),
        sound.at,
        fault.at,
        obstacle.turn_deg,
        move.line,
        move.tip(t),
        depth_of(pieces, [fault], moves, thinner),
        place_mm,
        way_mm,
        part,
    )


def others_are_clear(tool, part, moves, obstacles):
    for other, pieces in tool.parts.items():
        if other == part:
            continue
        for obstacle in obstacles:
            if least_gap(pieces, [obstacle], moves, OTHERS_mm) < OTHERS_mm:
                return False
    return True
