// stock/octree/edge_roots.h - where a sweep crosses the edges of a brick, kLanes edges at a time.
//
// Compiled once for each instruction set, as sweep_lanes.h is, and by the same rules.
#pragma once

#include <cstring>

#include "stock/octree/brick_work.h"
#include "stock/octree/lane_vectors.h"
#include "stock/octree/sweep_lanes.h"

namespace kerf::octree {
namespace {

/// Roots are found to this part of an edge: far below a crossing's 1 / kEdgeParts.
constexpr double kRootPart = 1e-7;
constexpr int kNewtonSteps = 12, kMaxRootSteps = 60;

/// F is found by iteration.
inline bool is_dear(Sweep::Kind kind) {
  return kind == Sweep::Kind::kRamp || kind == Sweep::Kind::kTurn;
}

inline int padded(int count) { return (count + W - 1) / W * W; }

inline int edge_of(unsigned edge) { return static_cast<int>(edge & (kLowerIsSolid - 1)); }
inline int axis_of(unsigned edge) { return static_cast<int>(edge >> 9 & 3u); }

/// Which way an edge goes from its solid end, by its number >> 9.
struct EdgeWay {
  double along[3];
};
constexpr EdgeWay kEdgeWays[8] = {{{-1, 0, 0}}, {{0, -1, 0}}, {{0, 0, -1}}, {{0, 0, 0}},
                                  {{1, 0, 0}},  {{0, 1, 0}},  {{0, 0, 1}},  {{0, 0, 0}}};

/// The solid end as a node.
struct SolidEnd {
  int i, j, k;
  explicit SolidEnd(unsigned edge) {
    const int up = (edge & kLowerIsSolid) ? 0 : 1, axis = axis_of(edge);
    i = static_cast<int>(edge >> 3 & 7u) + (axis == 0 ? up : 0);
    j = static_cast<int>(edge >> 6 & 7u) + (axis == 1 ? up : 0);
    k = static_cast<int>(edge & 7u) + (axis == 2 ? up : 0);
  }
  int block() const {
    return (i >= kNodeBlock ? 1 : 0) | (j >= kNodeBlock ? 2 : 0) | (k >= kNodeBlock ? 4 : 0);
  }
  int node() const { return j << 8 | i << 4 | k; }
};

/// Eight edges: where F is 0, from their solid ends (F >= 0) on.
struct Roots {
  Doubles x, y, z;     ///< solid ends
  Doubles dx, dy, dz;  ///< the way from there, of length 1
  Doubles length, start;
  Doubles low, high;     ///< bracket
  Doubles f_low, slope;  ///< at `low`
  Doubles nx, ny, nz;    ///< the sweep's normal there, of any length
  Doubles tried;
  Masks active;  ///< while the root is looked for
};

/// Eight edges by their numbers.
struct EdgeLanes {
  Ints up;       ///< all ones: the solid end is the upper one
  Ints x, y, z;  ///< all ones: it lies along this axis
  Ints i, j, k;  ///< the solid end
  explicit EdgeLanes(const std::uint16_t* edges) {
    Ints edge;
    widen(edges, edge);
    const auto is = [](const Ints& value, int number) { return value == all<Ints>(number); };
    up = is(edge & all<Ints>(int{kLowerIsSolid}), 0);
    const Ints axis = edge >> 9 & all<Ints>(3);
    x = is(axis, 0), y = is(axis, 1), z = is(axis, 2);
    // All ones are -1.
    i = (edge >> 3 & all<Ints>(7)) - (x & up);
    j = (edge >> 6 & all<Ints>(7)) - (y & up);
    k = (edge & all<Ints>(7)) - (z & up);
  }
  KERF_LANES Doubles place(const BrickWork& work, int axis) const {
    Doubles node;
    widen_to((axis == 0 ? i : axis == 1 ? j : k) + all<Ints>(work.first[axis]), node);
    return all(work.origin_mm[axis]) + node * all(work.cell_mm[axis]);
  }
  /// 1 or -1 along its axis, from the solid end; 0 along the others.
  KERF_LANES Doubles way(int axis) const {
    const Ints one = all<Ints>(1), sign = one + (up & all<Ints>(-2));
    Doubles out;
    widen_to((axis == 0 ? x : axis == 1 ? y : z) & sign, out);
    return out;
  }
  KERF_LANES Doubles length(const BrickWork& work) const {
    const auto part = [&](const Ints& is, double cell) {
      Doubles one;
      widen_to(is & all<Ints>(1), one);
      return one * all(cell);
    };
    return part(x, work.cell_mm[0]) + part(y, work.cell_mm[1]) + part(z, work.cell_mm[2]);
  }
};

inline void begin_roots(const BrickWork& work, const EdgeList& list, int first, Roots& r) {
  const EdgeLanes edges(list.edge + first);
  r.x = edges.place(work, 0), r.y = edges.place(work, 1), r.z = edges.place(work, 2);
  r.dx = edges.way(0), r.dy = edges.way(1), r.dz = edges.way(2);
  r.length = edges.length(work);
  const double numbers[W] = {0, 1, 2, 3, 4, 5, 6, 7};
  r.active = load_lanes<Doubles>(numbers) < all(double(list.count - first));
  r.start = r.tried = r.low = load_lanes<Doubles>(list.start + first);
  r.high = load_lanes<Doubles>(list.reach + first);
  r.f_low = r.slope = r.nx = r.ny = r.nz = all(0.0);
}

/// Takes in F and its gradient at r.tried, and sets the next places; false once all are found.
KERF_LANES bool narrow_roots(const Gradients& g, int step, Roots& r) {
  const Doubles zero = all(0.0);
  // From the first on, whatever F is there.
  const Masks below = step == 0 ? zero <= zero : zero <= g.f;
  const Masks rises = r.active & below, falls = r.active & ~below;
  r.low = choose(rises, r.tried, r.low);
  r.f_low = choose(rises, choose(zero < g.f, g.f, zero), r.f_low);
  r.slope = choose(rises, r.dx * g.x + r.dy * g.y + r.dz * g.z, r.slope);
  r.nx = choose(rises, g.x, r.nx);
  r.ny = choose(rises, g.y, r.ny);
  r.nz = choose(rises, g.z, r.nz);
  r.high = choose(falls, r.tried, r.high);
  // Newton's steps never pass the root, as F is convex along a line (all kinds but arcs and turns);
  // where they would, the bracket holds them.
  const Doubles near = all(kRootPart) * r.length;
  const Doubles newton = choose(r.slope < zero, r.low - r.f_low / r.slope, r.high);
  const Masks found =
      step >= kMaxRootSteps ? zero <= zero : (r.f_low <= near) | (r.high - r.low <= near);
  // Beyond the bracket, or too slow: halve it.
  const Doubles middle = all(0.5) * (r.low + r.high);
  const Doubles next = step <= kNewtonSteps ? choose(newton < r.high, newton, middle) : middle;
  const Masks ends = r.active & found;
  r.low = choose(ends, choose(r.high < newton, r.high, newton), r.low);
  r.active = r.active & ~found;
  r.tried = choose(r.active, next, r.tried);
  return any(r.active);
}

/// Edges as a body of revolution sees them that goes straight: from its axis or centre, all along
/// its path or square to it.
struct RoundWay {
  Points from, way;  ///< solid ends, and the way along the edges from there
  Doubles way2;      ///< its length, squared
  Vec3 step;
  double per_step2;

  RoundWay(const Sweep& s, const Roots& r) : step(s.step), per_step2(s.per_step2) {
    from_origin(s, {r.x, r.y, r.z}, from);
    way = {r.dx, r.dy, r.dz};
    way2 = all(1.0);
  }
  /// Seen along the spindle: for the wall of a ball nose.
  KERF_LANES void flatten(const Sweep& s) {
    const Doubles up = along(s.w, from.x, from.y, from.z), rise = along(s.w, way.x, way.y, way.z);
    from = {from.x - up * all(s.w.x), from.y - up * all(s.w.y), from.z - up * all(s.w.z)};
    way = {way.x - rise * all(s.w.x), way.y - rise * all(s.w.y), way.z - rise * all(s.w.z)};
    way2 = all(1.0) - rise * rise;
    step = {s.length_u * s.u.x, s.length_u * s.u.y, s.length_u * s.u.z};
    per_step2 = s.length_u > 0 ? 1 / (s.length_u * s.length_u) : 0;
  }
};

/// What a sphere (or a circle) sweeps that goes straight has two round ends, and a line enters it
/// once: by that of its three parts which is nearest to where it is entered. Lanes stay active that
/// are not found so, or that `counts` turns down, which gets the places.
template <class Counts>
KERF_LANES void enter_round(const Sweep& s, const RoundWay& round, Roots& r, const Counts& counts) {
  constexpr int kGuesses = 3;
  constexpr double kAlong = 1e-9;  // lines along the path or the wall are not seen to enter
  const double radius = s.body->elements[0].radius - s.shrink_mm;
  const Points &from = round.from, &way = round.way;
  const Vec3& step = round.step;
  const Doubles zero = all(0.0), one = all(1.0), per = all(round.per_step2);
  const Doubles start = along(step, from.x, from.y, from.z) * per;  // not held to 0..1
  const Doubles d = along(step, way.x, way.y, way.z), turn = d * per;
  Doubles part = unit_clamp(start + all(0.5) * (r.start + r.high) * turn);
  Masks open = r.active;
  for (int guess = 0; guess < kGuesses; ++guess) {
    const Masks inside = (zero < part) & (part < one);
    // Of the ends the way from their centres, of the middle square to the path.
    const Doubles at = choose(inside, start, part);
    const Doubles mx = from.x - at * all(step.x), my = from.y - at * all(step.y),
                  mz = from.z - at * all(step.z);
    const Doubles a = round.way2 - choose(inside, turn * d, zero),
                  b = mx * way.x + my * way.y + mz * way.z,
                  c = mx * mx + my * my + mz * mz - all(radius * radius);
    const Doubles inner = b * b - a * c;
    // The form that does not cancel: b is negative where a line enters.
    const Doubles t = c / greater(root(greater(inner, zero)) - b, all(kTiny));
    const Doubles next = unit_clamp(start + t * turn);
    const Masks stays =
        (inside & (zero < next) & (next < one)) | (~inside & (next <= part) & (part <= next));
    Masks found = open & stays & (zero <= inner) & (all(kAlong) < a);
    open = open & ~found;
    const Doubles low = greater(r.start, lesser(t, r.high));
    found = found & counts(low);
    r.low = choose(found, low, r.low);
    // Not of length 1, as nothing asks for.
    r.nx = choose(found, from.x + low * way.x - next * all(step.x), r.nx);
    r.ny = choose(found, from.y + low * way.y - next * all(step.y), r.ny);
    r.nz = choose(found, from.z + low * way.z - next * all(step.z), r.nz);
    r.active = r.active & ~found;
    if (!any(open)) return;
    part = next;
  }
}

/// Roots of ball noses and spheres have a closed form, but for walls that turn. False: all are
/// found.
KERF_LANES bool enter(const Sweep& s, Roots& r) {
  RoundWay round(s, r);
  const Points from = round.from, way = round.way;
  const auto at = [&](const Doubles& t) {
    return Points{from.x + t * way.x, from.y + t * way.y, from.z + t * way.z};
  };
  if (s.kind == Sweep::Kind::kSphere) {
    enter_round(s, round, r, [&](const Doubles& t) { return t <= t; });
  } else if (s.kind == Sweep::Kind::kTurn) {
    enter_round(s, round, r, [&](const Doubles& t) { return is_below_wall(s, at(t)); });
  } else {
    const auto is_wall = [&](const Doubles& t) {
      Doubles du, v;
      return sees_wall(s, at(t), du, v);
    };
    enter_round(s, round, r, [&](const Doubles& t) { return ~is_wall(t); });
    if (!any(r.active)) return false;
    round.flatten(s);
    enter_round(s, round, r, is_wall);
  }
  return any(r.active);
}

/// Where a path of added material begins outside of the blank, the surface is the blank's face.
inline void stop_at_faces(const Doubles& f, Roots& r) {
  const Doubles zero = all(0.0);
  const Masks stop = (zero < r.start) & (f < zero);
  r.low = choose(stop, r.start, r.low);
  r.nx = choose(stop, zero - r.dx, r.nx);
  r.ny = choose(stop, zero - r.dy, r.ny);
  r.nz = choose(stop, zero - r.dz, r.nz);
  r.active = r.active & ~stop;
}

/// Of the groups whose bits are in `open`; returns those whose roots are not all found yet.
inline unsigned step_roots(const BrickWork& work, const Sweep& sweep, int step, unsigned open,
                           Roots* roots) {
  unsigned left = 0;
  while (open != 0) {
    Points points[kSearchGroups];
    Gradients g[kSearchGroups];
    int count = 0;
    unsigned rest = open;
    for (; rest != 0 && count < kSearchGroups; rest &= rest - 1) {
      const Roots& r = roots[__builtin_ctz(rest)];
      points[count++] = {r.x + r.dx * r.tried, r.y + r.dy * r.tried, r.z + r.dz * r.tried};
    }
    evaluate<true>(sweep, points, count, g);
    for (int n = 0; open != rest; open &= open - 1, ++n) {
      Roots& r = roots[__builtin_ctz(open)];
      if (work.at_end && step == 0) stop_at_faces(g[n].f, r);
      if (narrow_roots(g[n], step, r)) left |= open & (~open + 1);
    }
  }
  return left;
}

/// Roots are looked for in so many groups at once.
constexpr int kRootGroups = 8;

/// Lane `from` of many groups in a row into lane `to` of others: all numbers of Roots are 8 bytes.
KERF_LANES void move_root(const Roots* groups, int from, Roots* others, int to) {
  constexpr std::size_t kNumber = sizeof(double);
  static_assert(sizeof(Roots) % (W * kNumber) == 0);
  const char* source = reinterpret_cast<const char*>(groups + from / W) + from % W * kNumber;
  char* target = reinterpret_cast<char*>(others + to / W) + to % W * kNumber;
  for (std::size_t n = 0; n < sizeof(Roots) / (W * kNumber); ++n)
    std::memcpy(target + n * W * kNumber, source + n * W * kNumber, kNumber);
}

/// Groups whose roots are looked for close up once fewer hold all that are left: some edges, along
/// a face, take many more steps than the others.
struct OpenRoots {
  Roots groups[kRootGroups];
  static constexpr std::uint8_t kNoResult = 0xff;
  std::uint8_t at[kRootGroups * W];  ///< lanes of the results
  std::int64_t active[kRootGroups * W];
  int count = 0;  ///< groups

  explicit OpenRoots(const Roots* all, int all_groups) : count(all_groups) {
    std::memcpy(static_cast<void*>(groups), all, sizeof(Roots) * static_cast<std::size_t>(count));
    for (int n = 0; n < count * W; ++n) at[n] = static_cast<std::uint8_t>(n);
  }
  void close_up(Roots* results) {
    int left = 0;
    for (int g = 0; g < count; ++g) store_lanes(groups[g].active, active + g * W);
    for (int n = 0; n < count * W; ++n) left += active[n] != 0 ? 1 : 0;
    if (left > (count - 1) * W) return;
    left = 0;
    for (int n = 0; n < count * W; ++n) {
      if (active[n] == 0) {
        if (at[n] != kNoResult) move_root(groups, n, results, at[n]);
        continue;
      }
      if (left < n) move_root(groups, n, groups, left);
      at[left++] = at[n];
    }
    count = (left + W - 1) / W;
    for (int n = left; n < count * W; ++n) {
      Masks& rest = groups[n / W].active;
      std::memset(reinterpret_cast<char*>(&rest) + n % W * sizeof(double), 0, sizeof(double));
      at[n] = kNoResult;
    }
  }
};

/// Of `count` groups of edges that have begun.
inline void search_roots(const BrickWork& work, const Sweep& sweep, int count, Roots* found) {
  const auto bits = [](int groups) { return (1u << groups) - 1; };
  if (count == 1 || !is_dear(sweep.kind)) {
    unsigned open = bits(count);
    for (int step = 0; open != 0; ++step) open = step_roots(work, sweep, step, open, found);
    return;
  }
  OpenRoots open(found, count);
  for (int step = 0; open.count > 0; ++step) {
    step_roots(work, sweep, step, bits(open.count), open.groups);
    open.close_up(found);
  }
}

/// Crossings as they are kept.
struct alignas(64) Crossings {
  std::int32_t place[W], share[W];
  std::uint32_t direction[W];
};

KERF_LANES Floats magnitude(const Floats& v) {
  const Floats zero = all<Floats>(0.0f);
  return choose(v < zero, zero - v, v);
}
KERF_LANES Floats sign_of(const Floats& v) {
  return choose(v < all<Floats>(0.0f), all<Floats>(-1.0f), all<Floats>(1.0f));
}

/// Rounds as lround() does.
KERF_LANES Ints steps_of(const Floats& value) {
  const Floats one = all<Floats>(1.0f), least = all<Floats>(-1.0f);
  const Floats scaled =
      choose(value < least, least, choose(one < value, one, value)) * all<Floats>(32767.0f);
  Ints whole;
  convert(scaled, whole);
  Floats back;
  convert(whole, back);
  const Floats rest = scaled - back;
  // A mask's lanes are -1.
  return whole - (all<Floats>(0.5f) <= rest) + (rest <= all<Floats>(-0.5f));
}

/// Into parts of an edge from its lower node.
KERF_LANES Ints places_of(const Roots& r) {
  const Doubles one = all(1.0), part = r.low / r.length;
  const Doubles lower = choose(all(0.0) < r.dx + r.dy + r.dz, part, one - part);
  const Doubles scaled = lesser(greater(lower * all(double{kEdgeParts}), all(0.0)), all(65536.0));
  Ints whole;
  whole_of(scaled, whole);
  Doubles back;
  widen_to(whole, back);
  const Doubles rounded = back + choose(all(0.5) <= scaled - back, one, all(0.0));
  whole_of(lesser(rounded, all(double{kEdgeParts - 1})), whole);
  return whole;
}

/// pack_direction() of brick.h, and then unpack_direction() along the edge, for its share of volume
/// (OpenBrick::share): the same steps.
inline void write_crossings(const Roots& r, const EdgeLanes& edges, Crossings& out) {
  constexpr float kScale = static_cast<float>(kNodeVolume / kEdgeParts);
  const Ints place = places_of(r);
  store_lanes(place, out.place);
  const Floats zero = all<Floats>(0.0f), one = all<Floats>(1.0f), full = all<Floats>(32767.0f);
  Floats nx, ny, nz;  // out of the material: against the sweep's
  narrow_to(r.nx, nx);
  narrow_to(r.ny, ny);
  narrow_to(r.nz, nz);
  nx = zero - nx, ny = zero - ny, nz = zero - nz;
  const Floats sum = magnitude(nx) + magnitude(ny) + magnitude(nz);
  const Floats x = nx / sum, y = ny / sum;
  const auto is_below = nz < zero;
  const Ints sx = steps_of(choose(is_below, (one - magnitude(y)) * sign_of(x), x));
  const Ints sy = steps_of(choose(is_below, (one - magnitude(x)) * sign_of(y), y));
  store_lanes((sx & all<Ints>(0xffff)) | (sy * all<Ints>(0x10000)), out.direction);
  Floats px, py;
  convert(sx, px);
  convert(sy, py);
  px = px / full;
  py = py / full;
  const Floats pz = one - magnitude(px) - magnitude(py);
  const auto is_back = pz < zero;
  const Floats ux = choose(is_back, (one - magnitude(py)) * sign_of(px), px);
  const Floats uy = choose(is_back, (one - magnitude(px)) * sign_of(py), py);
  const Floats scale = one / root(ux * ux + uy * uy + pz * pz);
  const Floats along = choose(edges.x, ux, choose(edges.y, uy, pz)) * scale;
  // Of upper ends with the other sign: -n is ~n + 1, and all ones are -1.
  const Ints from_middle = place - all<Ints>(kEdgeParts / 2);
  Floats beyond;
  convert((from_middle ^ edges.up) - edges.up, beyond);
  Ints share;
  convert(along * along * all<Floats>(kScale) * beyond, share);
  store_lanes(share, out.share);
}

}  // namespace
}  // namespace kerf::octree
