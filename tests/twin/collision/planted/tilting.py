"""Programs for a table that tilts (xyzac-trt-kins): X Y Z are the tip's place in the workpiece, A and C lean the tool in it."""

import math

from oracle import Move, Obstacle, TurnedMove, heights_of
from programs import HIGH_mm, SHAPES, Program, draw_shape, draw_tool, plus, settle

# While the table turns, the way is taken as pieces that are so near to it.
WAY_mm = 0.01


def draw_tilting(rng, number, part):
    kind = rng.choice(SHAPES)
    way_kind = rng.choice(("tilted feed", "tilted rapid", "tilting feed", "swinging feed"))
    tool = draw_tool(rng, ("flat", "ball", "bull"))
    middle = tuple(round(x, 4) for x in (rng.uniform(80, 140), rng.uniform(60, 120), rng.uniform(-20, 5)))
    along_angle = rng.uniform(0, 2 * math.pi)
    along = (math.cos(along_angle), math.sin(along_angle), rng.uniform(-0.2, 0.2))
    first = (rng.uniform(-40, 40), rng.uniform(-90, 90))
    second = first
    if way_kind == "tilting feed":
        second = (first[0] + rng.uniform(-20, 20), first[1])
    elif way_kind == "swinging feed":
        second = (first[0] + rng.uniform(-10, 10), first[1] + rng.uniform(-30, 30))
    half = 12
    start, end = plus(middle, along, -half), plus(middle, along, half)
    program = Program()
    program.go((start[0], start[1], HIGH_mm), "G0", first)
    program.go(start, "G0", first)
    program.go(end, "G0" if way_kind == "tilted rapid" else "G1", second)
    program.go((end[0], end[1], HIGH_mm), "G0", second)
    program.lines += ["M5", "M2"]
    axis = Move(0, middle, middle, None, first, second).axis(0.5)
    arguments = ["--set", "machine.kinematics=xyzac-trt-kins", "--cell", "1"]
    return settle_beside(rng, number, part, way_kind, kind, tool, program, middle, axis, (0.0, 0.0, 0.0), arguments, first != second)


def draw_fourth(rng, number, part):
    """A turns the workpiece about X; the machine's X Y Z are those of the program."""
    kind = rng.choice(SHAPES)
    way_kind = rng.choice(("fourth indexed", "fourth rapid", "fourth wrapped", "fourth turning"))
    tool = draw_tool(rng, ("flat", "ball", "bull"))
    middle = tuple(round(x, 4) for x in (rng.uniform(80, 140), rng.uniform(-8, 8), rng.uniform(15, 50)))
    first = rng.uniform(-170, 170)
    second = first
    if way_kind in ("fourth wrapped", "fourth turning"):
        second = first + rng.choice((-1, 1)) * rng.uniform(20, 70)
    half = 0.0 if way_kind == "fourth turning" else 12.0
    along = (math.cos(rng.uniform(-0.5, 0.5)), rng.uniform(-0.3, 0.3), rng.uniform(-0.1, 0.1))
    start, end = plus(middle, along, -half), plus(middle, along, half)
    program = Program()
    program.letters = "A"
    program.make_move = lambda line, start, end, turn, from_a, to_a: TurnedMove(line, start, end, from_a[0], to_a[0])
    program.ac = (0.0,)
    program.go((start[0], start[1], HIGH_mm), "G0", (first,))
    program.go(start, "G0", (first,))
    program.go(end, "G0" if way_kind in ("fourth rapid", "fourth turning") else "G1", (second,))
    program.go((end[0], end[1], HIGH_mm), "G0", (second,))
    program.lines += ["M5", "M2"]
    turned = TurnedMove(0, middle, middle, first, second)
    axis, place = turned.axis(0.5), turned.tip(0.5)
    return settle_beside(rng, number, part, way_kind, kind, tool, program, place, axis, axis, ["--cell", "1"], first != second)


def settle_beside(rng, number, part, way_kind, kind, tool, program, middle, axis, not_along, arguments, turns):
    """The obstacle's middle waits beside the part's when the tip is in the middle of its way; it is pushed level, or square to not_along."""
    if kind == "bore" and turns:
        return None
    low, high = heights_of(tool.parts[part])
    height = low + rng.uniform(0.3, 0.7) * min(high - low, 16.0)
    deep = rng.choice((6.0, 20.0)) if kind != "bore" else 1000.0
    shape = draw_shape(rng, kind, 0.0 if kind != "bore" else 500.0, deep)
    there = plus(middle, axis, height)
    lift = deep / 2 if kind != "bore" else 0.0
    base = (there[0], there[1], round(there[2], 4) + lift + shape.lift)
    angle = rng.uniform(0, 2 * math.pi)
    push = (math.cos(angle), math.sin(angle), 0.0)
    if any(not_along):
        push = plus((math.cos(angle), math.sin(angle), rng.uniform(-1, 1)), not_along, -sum(a * b for a, b in zip(push, not_along)))
        length = math.sqrt(sum(x * x for x in push))
        push = tuple(x / length for x in push)
    turn = rng.choice((0.0, 30.0, -17.5)) if kind not in ("rod", "pipe", "bore", "screw") else 0.0
    far = shape.half_mm + 40
    way_mm = WAY_mm if turns else 0.0
    tries = [x / 2 for x in range(160)] if kind == "bore" else [far - 2 * x for x in range(0, int(far / 2))]
    return settle(rng, number, part, way_kind, kind, tool, program, shape, Obstacle(shape.bodies, base, turn), push, tries, arguments, way_mm)
