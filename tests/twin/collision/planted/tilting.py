"""Programs for a table that tilts (xyzac-trt-kins): X Y Z are the tip's place in the workpiece, A and C lean the tool in it."""

import math

from oracle import Cylinder, Obstacle, Move, heights_of
from programs import Program, HIGH_mm, approach, draw_shape, draw_tool, settle, plus

# While the table turns, the way is taken as pieces that are so near to it.
WAY_mm = 0.01


def draw_tilting(rng, number, part):
    kind = rng.choice(("box", "wall", "clamp", "mesh", "vise"))
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
    # The obstacle's middle waits beside the part's when the tip is in the middle.
    axis = Move(0, middle, middle, None, first, second).axis(0.5)
    low, high = heights_of(tool.parts[part])
    height = low + rng.uniform(0.3, 0.7) * min(high - low, 16.0)
    deep = rng.choice((6.0, 20.0))
    shape = draw_shape(rng, kind, 0.0, deep)
    there = plus(middle, axis, height)
    base = (there[0], there[1], round(there[2], 4) + deep / 2 + shape.lift)
    angle = rng.uniform(0, 2 * math.pi)
    push = (math.cos(angle), math.sin(angle), 0.0)
    turn = rng.choice((0.0, 30.0, -17.5))
    far = shape.half_mm + 40
    arguments = ["--set", "machine.kinematics=xyzac-trt-kins", "--cell", "1"]
    way_mm = WAY_mm if first != second else 0.0
    tries = [far - 2 * x for x in range(0, int(far / 2))]
    return settle(rng, number, part, way_kind, kind, tool, program, shape, Obstacle(shape.bodies, base, turn), push, tries, arguments, way_mm)
