"""Distances of tools on their way from fixtures and blanks, by formulas of their own: nothing of kerf's geometry is in them.

A part of a tool is a list of pieces about its axis, Z from the tip up, mm:
    Cylinder(radius, low, high, round_mm)  a cylinder and all that is no farther from it than round_mm: discs are balls, bull noses
    Cone(radius_low, radius_high, low, high)
An obstacle is a list of convex bodies in a frame that is turned about Z and shifted: Block, Rod, Bar, Pipe (a tube, which is
not convex, but round). Upright tools are held against them in closed form; tilted ones by descent of the squared distance of a point
from the piece (convex and smooth, so that it ends at the least): to and fro, with a swing.
"""

import heapq
import math

EPSILON = 1e-9
# Distances of tools that lean are known to this.
EXACT_mm = 2e-6
# Least ones of tools that turn as they go to this.
BENT_EXACT_mm = 5e-4
# Farther than anything is measured.
FAR_mm = 0.5


class Cylinder:
    def __init__(self, radius, low, high, round_mm=0.0, seated=False):
        """seated: on a rounded one that ends at Z0, which it is one with."""
        self.radius, self.low, self.high, self.round_mm, self.seated = radius, low, high, round_mm, seated

    def reach(self):
        return math.hypot(self.radius + self.round_mm, max(abs(self.low), abs(self.high)) + self.round_mm)

    def eroded(self, depth):
        """Thinner by depth all around; None: nothing is left. Less than 0: thicker."""
        from_round = min(self.round_mm, depth)
        rest = depth - from_round
        low = max(self.low, rest) if self.seated else self.low + rest
        if rest > self.radius or (rest > 0 and low > self.high - rest):
            return None
        if rest > 0:
            return Cylinder(self.radius - rest, low, self.high - rest, 0.0, self.seated)
        return Cylinder(self.radius, self.low, self.high, self.round_mm - from_round)

    def to_quadrant(self, beside, low, high):
        """From all that is at least so far from the axis, between two heights."""
        across = max(beside - self.radius, 0.0)
        along = max(low - self.high, self.low - high, 0.0)
        return math.hypot(across, along) - self.round_mm

    def to_point(self, across, along):
        """The nearest place (across, along) in the core; the distance from that is one to the piece, but for round_mm."""
        return min(across, self.radius), min(max(along, self.low), self.high)

    def rims(self):
        return (self.radius, self.low), (self.radius, self.high)

    def farthest(self, across, along):
        """Of the core, in a direction with these parts."""
        return self.radius * across + max(self.low * along, self.high * along)


class Cone:
    """Below a cylinder of the same width."""

    round_mm = 0.0

    def __init__(self, radius_low, radius_high, low, high):
        self.corners = ((0.0, low), (radius_low, low), (radius_high, high), (0.0, high))
        self.low, self.high = low, high

    def reach(self):
        return max(math.hypot(*corner) for corner in self.corners)

    def eroded(self, depth):
        (_, low), (r_low, _), (r_high, _), (_, high) = self.corners
        if low + depth >= high or r_high <= depth:
            return None
        return Cone(max(r_low - depth, 0.0), r_high - depth, low + depth, high)

    def to_quadrant(self, beside, low, high):
        _, a, b, _ = self.corners
        return 0.0 if self.within(beside, low, high) else segments_gap(a, b, beside, low, high)

    def within(self, beside, low, high):
        (r0, z0), (r1, z1) = self.corners[1], self.corners[2]
        top = min(high, z1)
        if top < max(low, z0):
            return False
        return r0 + (r1 - r0) * (top - z0) / (z1 - z0) >= beside

    def rims(self):
        return self.corners[1], self.corners[2]

    def farthest(self, across, along):
        return max(r * across + z * along for r, z in self.corners)

    def to_point(self, across, along):
        (r0, z0), (r1, z1) = self.corners[1], self.corners[2]
        if z0 <= along <= z1 and across <= r0 + (r1 - r0) * (along - z0) / (z1 - z0):
            return across, along
        best = None
        for (ar, az), (br, bz) in zip(self.corners, self.corners[1:]):
            length2 = (br - ar) ** 2 + (bz - az) ** 2
            t = 0.0 if length2 == 0 else min(max(((across - ar) * (br - ar) + (along - az) * (bz - az)) / length2, 0.0), 1.0)
            place = (ar + t * (br - ar), az + t * (bz - az))
            distance = math.hypot(across - place[0], along - place[1])
            if best is None or distance < best[0]:
                best = (distance, place)
        return best[1]


def segments_gap(a, b, beside, low, high):
    """From the side of a cone to a quadrant, where they are apart: at a corner of one of the two."""
    gap = math.inf
    for r, z in (a, b):
        gap = min(gap, math.hypot(max(beside - r, 0.0), max(low - z, z - high, 0.0)))
    for r, z in ((beside, low), (beside, high)):
        length2 = (b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2
        t = min(max(((r - a[0]) * (b[0] - a[0]) + (z - a[1]) * (b[1] - a[1])) / length2, 0.0), 1.0)
        gap = min(gap, math.hypot(r - a[0] - t * (b[0] - a[0]), z - a[1] - t * (b[1] - a[1])))
    return gap


class Block:
    """A box from one corner to the other."""

    def __init__(self, low, high):
        self.low, self.high = tuple(low), tuple(high)

    def upright(self, piece, tip):
        beside = math.hypot(max(self.low[0] - tip[0], tip[0] - self.high[0], 0.0), max(self.low[1] - tip[1], tip[1] - self.high[1], 0.0))
        return piece.to_quadrant(beside, self.low[2] - tip[2], self.high[2] - tip[2])

    def tilted(self, piece, tip, axis, memory):
        """memory: keeps the place where the last one was nearest. What is FAR_mm away may be said to be nearer, but not that near."""
        far = ball_gap(piece, tip, axis, self)
        return far if far > FAR_mm and "exact" not in memory else nearest_gap(self, piece, tip, axis, memory)[0]

    def middle(self):
        return tuple((a + b) / 2 for a, b in zip(self.low, self.high))

    def nearest(self, p):
        return tuple(min(max(x, low), high) for x, low, high in zip(p, self.low, self.high))

    def least_along(self, n):
        """Of n * p over its places p."""
        return sum(min(x * low, x * high) for x, low, high in zip(n, self.low, self.high))


def ball_gap(piece, tip, axis, body):
    """From a ball around the piece."""
    middle, half = (piece.low + piece.high) / 2, (piece.high - piece.low) / 2
    center = [t + middle * a for t, a in zip(tip, axis)]
    return math.dist(center, body.nearest(center)) - math.hypot(half, width_of([piece]) - piece.round_mm) - piece.round_mm


def core_gap(piece, tip, axis, p):
    """Distance of p from a piece that leans, and the way from the nearest place to p."""
    d = (p[0] - tip[0], p[1] - tip[1], p[2] - tip[2])
    along = d[0] * axis[0] + d[1] * axis[1] + d[2] * axis[2]
    across = (d[0] - along * axis[0], d[1] - along * axis[1], d[2] - along * axis[2])
    length = math.sqrt(across[0] ** 2 + across[1] ** 2 + across[2] ** 2)
    r, z = piece.to_point(length, along)
    share = 1 - r / length if length > 0 else 0.0
    rest = along - z
    way = (share * across[0] + rest * axis[0], share * across[1] + rest * axis[1], share * across[2] + rest * axis[2])
    return math.sqrt(way[0] ** 2 + way[1] ** 2 + way[2] ** 2), way


def plane_gap(body, piece, tip, axis, n):
    """How far apart they are in the direction n, from the piece to the body, both between planes square to it: their gap is no less."""
    along = n[0] * axis[0] + n[1] * axis[1] + n[2] * axis[2]
    across = math.sqrt(max(0.0, 1 - along * along))
    tip_along = n[0] * tip[0] + n[1] * tip[1] + n[2] * tip[2]
    return body.least_along(n) - tip_along - piece.farthest(across, along) - piece.round_mm


def nearest_gap(body, piece, tip, axis, memory):
    """(gap of a leaning piece from a convex body, where on the body): the squared distance of its places from the piece is convex and smooth,
    and goes down fastest by steps to the nearest place and back that keep their swing, until they would go up. It is known when planes square
    to it are as far apart. memory["normal"]: its direction, from the piece to the body; None: they touch."""
    p = memory.get((body, piece), body.middle())
    before, swing, last = p, 1.0, math.inf
    for count in range(3000):
        further = (1 + math.sqrt(1 + 4 * swing * swing)) / 2
        y = tuple(a + (swing - 1) / further * (a - b) for a, b in zip(p, before))
        _, way = core_gap(piece, tip, axis, y)
        new = body.nearest(tuple(a - w for a, w in zip(y, way)))
        now, apart = core_gap(piece, tip, axis, new)
        if now > last and swing > 1:
            swing, before = 1.0, p
            continue
        moved = math.dist(new, p)
        if moved < 1e-8 and swing > 1:  # with its swing it only came back to the same rim
            swing, before = 1.0, p
            continue
        before, p, swing, last = p, new, further, now
        if now <= EPSILON or moved < 1e-8:
            break
        if count % 4 == 3 and plane_gap(body, piece, tip, axis, [w / now for w in apart]) > now - piece.round_mm - EXACT_mm:
            break
    memory[(body, piece)] = p
    apart = core_gap(piece, tip, axis, p)[1]
    memory["normal"] = [w / last for w in apart] if last > EPSILON else None
    return last - piece.round_mm, p


class Rod:
    """A cylinder that stands."""

    def __init__(self, center, radius, low, high):
        self.center, self.radius, self.low, self.high = tuple(center), radius, low, high

    def upright(self, piece, tip):
        beside = max(math.hypot(tip[0] - self.center[0], tip[1] - self.center[1]) - self.radius, 0.0)
        return piece.to_quadrant(beside, self.low - tip[2], self.high - tip[2])

    def tilted(self, piece, tip, axis, memory):
        far = ball_gap(piece, tip, axis, self)
        return far if far > FAR_mm and "exact" not in memory else nearest_gap(self, piece, tip, axis, memory)[0]

    def middle(self):
        return (*self.center, (self.low + self.high) / 2)

    def nearest(self, p):
        x, y = within_circle(p[0] - self.center[0], p[1] - self.center[1], self.radius)
        return (self.center[0] + x, self.center[1] + y, min(max(p[2], self.low), self.high))

    def least_along(self, n):
        return (n[0] * self.center[0] + n[1] * self.center[1] - self.radius * math.hypot(n[0], n[1])
                + min(n[2] * self.low, n[2] * self.high))


def within_circle(x, y, radius):
    length = math.hypot(x, y)
    return (x, y) if length <= radius else (x * radius / length, y * radius / length)


class Bar:
    """A cylinder that lies along X; upright tools are beside its ends never."""

    def __init__(self, center_y, center_z, radius, low_x, high_x):
        self.center, self.radius, self.low_x, self.high_x = (center_y, center_z), radius, low_x, high_x

    def upright(self, piece, tip):
        assert self.low_x <= tip[0] <= self.high_x and isinstance(piece, Cylinder)
        across = max(abs(self.center[0] - tip[1]) - piece.radius, 0.0)
        along = max(tip[2] + piece.low - self.center[1], self.center[1] - tip[2] - piece.high, 0.0)
        return max(math.hypot(across, along) - self.radius, 0.0) - piece.round_mm

    def tilted(self, piece, tip, axis, memory):
        far = ball_gap(piece, tip, axis, self)
        return far if far > FAR_mm and "exact" not in memory else nearest_gap(self, piece, tip, axis, memory)[0]

    def middle(self):
        return ((self.low_x + self.high_x) / 2, *self.center)

    def nearest(self, p):
        y, z = within_circle(p[1] - self.center[0], p[2] - self.center[1], self.radius)
        return (min(max(p[0], self.low_x), self.high_x), self.center[0] + y, self.center[1] + z)

    def least_along(self, n):
        return (n[1] * self.center[0] + n[2] * self.center[1] - self.radius * math.hypot(n[1], n[2])
                + min(n[0] * self.low_x, n[0] * self.high_x))


class TooDeep(Exception):
    """A tool's axis within the wall of a pipe: what is drawn here is outside or inside of it."""


class Pipe:
    """A tube that stands; the tool stays outside (then it is as good as solid), or inside."""

    def __init__(self, center, radius, inner, low, high, inside):
        self.center, self.radius, self.inner, self.low, self.high, self.inside = tuple(center), radius, inner, low, high, inside

    def upright(self, piece, tip):
        away = math.hypot(tip[0] - self.center[0], tip[1] - self.center[1])
        if (away > self.inner) if self.inside else (away < self.inner):
            raise TooDeep
        beside = self.inner - away if self.inside else max(away - self.radius, 0.0)
        return piece.to_quadrant(beside, self.low - tip[2], self.high - tip[2])


    def tilted(self, piece, tip, axis, memory):
        if self.inside:
            return self.tilted_inside(piece, tip, axis)
        far = ball_gap(piece, tip, axis, self)
        if far > FAR_mm and "exact" not in memory:
            return far
        gap, p = nearest_gap(self, piece, tip, axis, memory)
        # Over its hole a tube is not what a rod is.
        if gap < FAR_mm and math.hypot(p[0] - self.center[0], p[1] - self.center[1]) < self.inner:
            raise TooDeep
        return gap

    def middle(self):
        return (*self.center, (self.low + self.high) / 2)

    def nearest(self, p):
        return Rod.nearest(self, p)

    def least_along(self, n):
        return Rod.least_along(self, n)

    def tilted_inside(self, piece, tip, axis):
        """What is farthest from the tube's axis lies on one of the piece's rims; the tube goes on above and below them."""
        rims = []
        for radius, along in piece.rims():
            x, y = (tip[k] + along * axis[k] - self.center[k] for k in range(2))
            if not self.low + piece.round_mm + radius < tip[2] + along * axis[2] < self.high - piece.round_mm - radius:
                raise TooDeep
            rims.append((radius, x, y))
        least = self.inner - piece.round_mm - max(math.hypot(x, y) + radius for radius, x, y in rims)
        if least > FAR_mm:
            return least
        farthest = max(self.farthest_of(*rim, axis) for rim in rims)
        if farthest > self.radius:
            raise TooDeep
        return self.inner - farthest - piece.round_mm

    def farthest_of(self, radius, x, y, axis):
        """Of a rim about (x, y), from the tube's axis."""
        u = unit_across(axis)
        v = (axis[1] * u[2] - axis[2] * u[1], axis[2] * u[0] - axis[0] * u[2], axis[0] * u[1] - axis[1] * u[0])

        def away(angle):
            c, s = radius * math.cos(angle), radius * math.sin(angle)
            return math.hypot(x + c * u[0] + s * v[0], y + c * u[1] + s * v[1])

        # An ellipse about another place: two maxima at most, far from each other.
        step = math.pi / 8
        at = max((k * step for k in range(16)), key=away)
        low, high = at - step, at + step
        for _ in range(32):
            a, b = low + (high - low) / 3, high - (high - low) / 3
            low, high = (a, high) if away(a) < away(b) else (low, b)
        return away((low + high) / 2)


def unit_across(axis):
    """A unit vector square to it."""
    other = (1.0, 0.0, 0.0) if abs(axis[0]) < 0.6 else (0.0, 1.0, 0.0)
    out = (axis[1] * other[2] - axis[2] * other[1], axis[2] * other[0] - axis[0] * other[2], axis[0] * other[1] - axis[1] * other[0])
    length = math.sqrt(sum(x * x for x in out))
    return tuple(x / length for x in out)


class Obstacle:
    """Bodies that are turned about Z by turn_deg, then shifted."""

    def __init__(self, bodies, at=(0.0, 0.0, 0.0), turn_deg=0.0):
        self.bodies, self.at, self.turn_deg = bodies, tuple(at), turn_deg
        self.cosine, self.sine = math.cos(math.radians(turn_deg)), math.sin(math.radians(turn_deg))

    def moved(self, by):
        return Obstacle(self.bodies, tuple(a + b for a, b in zip(self.at, by)), self.turn_deg)

    def direction(self, v):
        return (self.cosine * v[0] + self.sine * v[1], self.cosine * v[1] - self.sine * v[0], v[2])


class Move:
    """Of one line: the tip's way and the spindle's, by t from 0 to 1, in the frame of the workpiece."""

    def __init__(self, line, start, end, turn=None, from_ac=(0.0, 0.0), to_ac=(0.0, 0.0)):
        """turn: (center, axis number, radians) of an arc; it climbs along its axis evenly. A and C in degrees."""
        self.line, self.start, self.end, self.turn = line, tuple(start), tuple(end), turn
        self.from_ac, self.to_ac = from_ac, to_ac
        self.leans = any(abs(a) > 0 for a in (from_ac[0], to_ac[0]))
        self.turns = from_ac != to_ac

    def tip(self, t):
        if self.turn is None:
            return tuple(a + t * (b - a) for a, b in zip(self.start, self.end))
        center, number, angle = self.turn
        u, v = (number + 1) % 3, (number + 2) % 3
        x, y = self.start[u] - center[u], self.start[v] - center[v]
        c, s = math.cos(t * angle), math.sin(t * angle)
        out = [0.0, 0.0, 0.0]
        out[u], out[v] = center[u] + c * x - s * y, center[v] + s * x + c * y
        out[number] = self.start[number] + t * (self.end[number] - self.start[number])
        return tuple(out)

    def axis(self, t):
        """Where the spindle points in the workpiece: the table turns it by C about Z, then by A about X."""
        a, c = (math.radians(p + t * (q - p)) for p, q in zip(self.from_ac, self.to_ac))
        return (math.sin(a) * math.sin(c), math.sin(a) * math.cos(c), math.cos(a))

    def speed(self, reach):
        """No point of the tool within reach of the tip goes farther while t goes from 0 to 1."""
        if self.turn is None:
            tip = math.dist(self.start, self.end)
        else:
            center, number, angle = self.turn
            u, v = (number + 1) % 3, (number + 2) % 3
            radius = math.hypot(self.start[u] - center[u], self.start[v] - center[v])
            tip = math.hypot(radius * angle, self.end[number] - self.start[number])
        swing = math.radians(abs(self.to_ac[0] - self.from_ac[0]) + abs(self.to_ac[1] - self.from_ac[1]))
        return tip + swing * reach


    def bend(self, reach):
        """The second derivative of no such point's place is more: the tip goes straight, A and C turn one after the other."""
        return math.radians(abs(self.to_ac[0] - self.from_ac[0]) + abs(self.to_ac[1] - self.from_ac[1])) ** 2 * reach


class TurnedMove(Move):
    """On a table that A turns about X, left-handed, about the line Y0 Z0: start and end are the machine's X Y Z, the spindle stands upright."""

    def __init__(self, line, start, end, from_a, to_a):
        super().__init__(line, start, end, None, (from_a, 0.0), (to_a, 0.0))

    def on_table(self, p, t):
        a = math.radians(self.from_ac[0] + t * (self.to_ac[0] - self.from_ac[0]))
        c, s = math.cos(a), math.sin(a)
        return (p[0], c * p[1] - s * p[2], s * p[1] + c * p[2])

    def tip(self, t):
        return self.on_table(super().tip(t), t)

    def axis(self, t):
        return self.on_table((0.0, 0.0, 1.0), t)

    def speed(self, reach):
        away = max(math.hypot(p[1], p[2]) for p in (self.start, self.end))
        return math.dist(self.start, self.end) + math.radians(abs(self.to_ac[0] - self.from_ac[0])) * (away + reach)

    def bend(self, reach):
        """Of a turn about a line while X Y Z go straight."""
        away = max(math.hypot(p[1], p[2]) for p in (self.start, self.end))
        turn = math.radians(abs(self.to_ac[0] - self.from_ac[0]))
        return turn * turn * (away + reach) + 2 * turn * math.dist(self.start, self.end)


class Pair:
    """One piece against one body of an obstacle, on one move."""

    def __init__(self, piece, body, obstacle, move):
        self.piece, self.body, self.obstacle, self.move = piece, body, obstacle, move
        self.memory = {}
        self.speed = move.speed(piece.reach())
        is_straight = move.turn is None and not move.turns
        is_inside = isinstance(body, Pipe) and body.inside
        self.is_convex = is_straight and not is_inside
        # In a tube that goes on above and below: what is farthest from its axis is a convex figure of the way.
        self.is_concave = is_straight and is_inside and move.leans
        # Where it turns, planes bound what is between two places.
        self.is_bent = move.leans and move.turns and move.turn is None and not is_inside
        if self.is_bent:
            self.bend = move.bend(piece.reach())
        if self.is_convex or self.is_bent:  # bounds of what is far are not convex
            self.memory["exact"] = True

    def place(self, t):
        """Tip and axis in the body's frame."""
        tip = self.obstacle.direction(tuple(a - b for a, b in zip(self.move.tip(t), self.obstacle.at)))
        return tip, self.obstacle.direction(self.move.axis(t))

    def bound(self, a, b, beaten):
        """(gap in the middle or less, no less than that from a to b); the second counts if it is not less than `beaten`. Of a body between two
        places each point is beside their hull by an eighth of its bend, and the hull is behind a plane that both are behind."""
        middle, part = (a + b) / 2, b - a
        half = self.speed * part / 2
        tip, axis = self.place(middle)
        far = ball_gap(self.piece, tip, axis, self.body)
        if far > FAR_mm and far - half >= beaten:
            return far, far - half
        gap = self.body.tilted(self.piece, tip, axis, self.memory)
        if gap <= EPSILON:
            return -EPSILON, gap - half
        n = self.memory["normal"]
        apart = min(plane_gap(self.body, self.piece, *self.place(t), n) for t in (a, b))
        return gap, max(gap - half, min(apart - self.bend * part * part / 8, gap))

    def least_of_bent(self, below):
        """The most promising parts first."""
        best, waiting = (below, None), [(-math.inf, 0.0, 1.0)]
        while waiting:
            low, a, b = heapq.heappop(waiting)
            if low >= best[0] - BENT_EXACT_mm:
                break
            middle = (a + b) / 2
            gap, low = self.bound(a, b, best[0] - BENT_EXACT_mm)
            if gap < best[0]:
                best = (gap, middle)
            if best[0] <= 0:
                break
            if low < best[0] - BENT_EXACT_mm:
                heapq.heappush(waiting, (low, a, middle))
                heapq.heappush(waiting, (low, middle, b))
        return best

    def first_of_bent(self, a=0.0, b=1.0):
        gap, low = self.bound(a, b, 0.0)
        if low > 0:
            return None
        middle = (a + b) / 2
        if self.speed * (b - a) / 2 < 1e-5:
            return middle if gap <= 1e-5 else None
        first = self.first_of_bent(a, middle)
        return first if first is not None else self.first_of_bent(middle, b)

    def gap(self, t):
        """Negative: they overlap, or touch."""
        tip = self.move.tip(t)
        tip = self.obstacle.direction(tuple(a - b for a, b in zip(tip, self.obstacle.at)))
        if not self.move.leans:
            gap = self.body.upright(self.piece, tip)
        else:
            gap = self.body.tilted(self.piece, tip, self.obstacle.direction(self.move.axis(t)), self.memory)
        # Pieces without roundness have no depth here: to touch is to overlap.
        return -EPSILON if gap <= EPSILON else gap

    def least(self, below=math.inf):
        """(gap, t): the least on the way, if it is below that; touching ends the search."""
        if self.gap(0.5) - self.speed / 2 >= below:
            return below, None
        if self.is_convex:
            return self.least_of_convex()
        if self.is_concave:
            return min((below, None), (self.gap(0.0), 0.0), (self.gap(1.0), 1.0), key=lambda pair: pair[0])
        if self.is_bent:
            return self.least_of_bent(below)
        best = [below, None]
        exact = 2e-4

        def search(a, b):
            middle = (a + b) / 2
            gap = self.gap(middle)
            if gap < best[0]:
                best[:] = [gap, middle]
            if best[0] <= 0:
                return
            half = self.speed * (b - a) / 2
            if gap - half < best[0] - exact:
                search(a, middle)
                search(middle, b)

        search(0.0, 1.0)
        return best[0], best[1]

    def least_of_convex(self):
        a, b = 0.0, 1.0
        ends = min((self.gap(0.0), 0.0), (self.gap(1.0), 1.0))
        ratio = (math.sqrt(5) - 1) / 2
        x, y = b - ratio * (b - a), a + ratio * (b - a)
        at_x, at_y = self.gap(x), self.gap(y)
        while self.speed * (b - a) > 1e-6:
            if at_x <= 0 or at_y <= 0:
                break
            if at_x < at_y:
                b, y, at_y = y, x, at_x
                x = b - ratio * (b - a)
                at_x = self.gap(x)
            else:
                a, x, at_x = x, y, at_y
                y = a + ratio * (b - a)
                at_y = self.gap(y)
        return min(ends, (at_x, x), (at_y, y))

    def first(self):
        """The first t at which they touch; None."""
        if self.gap(0.5) > self.speed / 2:
            return None
        if self.is_convex:
            gap, t = self.least_of_convex()
            if gap > 0:
                return None
            if self.gap(0.0) <= 0:
                return 0.0
            low, high = 0.0, t
            while self.speed * (high - low) > 1e-6:
                middle = (low + high) / 2
                low, high = (low, middle) if self.gap(middle) <= 0 else (middle, high)
            return high

        if self.is_bent:
            return self.first_of_bent()
        if self.is_concave:
            if self.gap(0.0) <= 0:
                return 0.0
            if self.gap(1.0) > 0:
                return None
            low, high = 0.0, 1.0
            while self.speed * (high - low) > 1e-6:
                middle = (low + high) / 2
                low, high = (low, middle) if self.gap(middle) <= 0 else (middle, high)
            return high

        def search(a, b):
            middle = (a + b) / 2
            half = self.speed * (b - a) / 2
            gap = self.gap(middle)
            if gap > half:
                return None
            if half < 1e-5:
                return middle if gap <= 1e-5 else None
            first = search(a, middle)
            return first if first is not None else search(middle, b)

        return search(0.0, 1.0)


def least_gap(pieces, obstacles, moves, below=math.inf):
    """Of all pieces from all obstacles on all moves, if it is below that; else that."""
    best = below
    for move in moves:
        for obstacle in obstacles:
            for piece in pieces:
                for body in obstacle.bodies:
                    best = min(best, Pair(piece, body, obstacle, move).least(best)[0])
                    if best <= 0:
                        return best
    return best


def first_touch(pieces, obstacles, moves):
    """(move, t) of the first touch; None."""
    for move in moves:
        found = [
            t
            for obstacle in obstacles
            for piece in pieces
            for body in obstacle.bodies
            if (t := Pair(piece, body, obstacle, move).first()) is not None
        ]
        if found:
            return move, min(found)
    return None


def heights_of(pieces):
    return min(p.low - p.round_mm for p in pieces), max(p.high + p.round_mm for p in pieces)


def width_of(pieces):
    """From the axis to its farthest place."""
    return max(p.radius + p.round_mm if isinstance(p, Cylinder) else p.corners[2][0] for p in pieces)


def eroded(pieces, depth):
    return [thin for piece in pieces if (thin := piece.eroded(depth)) is not None]


def depth_of(pieces, obstacles, moves, thinner=eroded, exact=0.001):
    """By how much the pieces would have to be thinner all around, so that none touches."""

    def touches(depth):
        return least_gap(thinner(pieces, depth), obstacles, moves, 2e-4) <= 0

    low, high = 0.0, 1.0
    while touches(high):
        low, high = high, 2 * high
    while high - low > exact:
        middle = (low + high) / 2
        if touches(middle):
            low = middle
        else:
            high = middle
    return (low + high) / 2
