"""Programs in which shank, holder or spindle come to a blank that nothing has cut: a block, a rod."""

import math

from oracle import Cylinder, Obstacle, heights_of, width_of
from programs import Program, Tool, draw_shape, draw_tool, draw_way, finish, plus, settle, unit

CELL_mm = 0.025
# A wall is where the cells have it, and is touched when the middle of one is reached: a place may be late by the diagonal of one.
WALL_mm = CELL_mm * math.sqrt(2)
# They go on upward: nothing is above that would be clear of it.
ENDLESS_mm = 500.0
WAYS = ("feed", "rapid", "slope", "arc", "helix", "plunge", "steps", "incremental", "subroutine")
FINDINGS = {"shank": "shank-contact", "holder": "holder-contact", "spindle": "spindle-contact"}


def raised(pieces, by):
    """So much higher: what a longer tool would do."""
    return [Cylinder(p.radius, p.low + by, p.high) for p in pieces if p.low + by < p.high]


def draw_on_blank(rng, number):
    part = ("shank", "holder", "spindle")[number // 6 % 3]
    tool = draw_tool(rng, ("flat", "ball", "bull"))
    low = heights_of(tool.parts[part])[0]
    below = [name for name in tool.parts if heights_of(tool.parts[name])[0] < low]
    pieces = [Cylinder(p.radius, p.low, p.low + ENDLESS_mm) for p in tool.parts[part]]
    tool = Tool(tool.shape, {**{name: tool.parts[name] for name in below}, part: pieces}, tool.spindle)
    way_kind, kind = rng.choice(WAYS), rng.choice(("box", "rod"))
    middle = tuple(round(x, 4) for x in (rng.uniform(80, 140), rng.uniform(60, 120), rng.uniform(-20, 5)))
    way = draw_way(rng, middle, way_kind)
    program = Program()
    way.write(program)
    finish(program)
    thinner = max(width_of(tool.parts[name]) for name in below)
    wide = width_of(pieces)
    if way.push[2] < 0:
        if thinner + 1 > wide:
            return None
        top, beside = middle[2] + low - 0.5, rng.uniform(thinner + 0.5, wide - 0.5)
    else:
        top, beside = middle[2] + low + rng.uniform(0.4, 6.0), None
    shape = draw_shape(rng, kind, round(top, 2), 6.0)
    base, tries = middle[:2] + (0.0,), [wide + shape.half_mm + 4 - x / 2 for x in range(80)]
    if beside is not None:
        base = plus(base, unit(rng.uniform(0, 2 * math.pi)), beside + shape.half_mm)
        tries = [4 - x / 4 for x in range(40)]
    planted = settle(rng, number, part, way_kind, f"a blank ({kind})", tool, program, shape, Obstacle(shape.bodies, base), way.push, tries,
                     ["--cell", str(CELL_mm)], WALL_mm, raised)
    if planted is None:
        return None
    planted.finding, planted.on_blank = FINDINGS[part], True
    return planted
