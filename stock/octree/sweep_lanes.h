// stock/octree/sweep_lanes.h - the formulas of sweep_kernel.h, kLanes points at a time.
//
// Compiled once for each instruction set, so everything here is in an unnamed namespace, and calls
// nothing that a linker could take from another variant. No fused multiplications: equal bits
// everywhere.
#pragma once

#include "stock/octree/lane_vectors.h"
#include "stock/octree/sweep_kernel.h"

namespace kerf::octree {
namespace {

constexpr int W = kLanes;
/// Iterations of the search for s. Brackets shrink far below the slack long before.
constexpr int kMaxSteps = 40;
constexpr double kTiny = 1e-150;

KERF_LANES Doubles unit_clamp(const Doubles& s) { return greater(all(0.0), lesser(all(1.0), s)); }

/// Value of the body at (r, z) and where it grows.
struct Value {
  Doubles f, nr, nz;
};

KERF_LANES void add_line(const ToolElement& e, const Doubles& r, const Doubles& z, Value& out) {
  const Doubles f = all(e.nr) * r + all(e.nz) * z - all(e.offset);
  const auto above = out.f < f;
  out.f = choose(above, f, out.f);
  out.nr = choose(above, all(e.nr), out.nr);
  out.nz = choose(above, all(e.nz), out.nz);
}

KERF_LANES void add_arc(const ToolElement& e, const Doubles& r, const Doubles& z, Value& out) {
  const Doubles qr = r - all(e.center_r), qz = z - all(e.center_z), zero = all(0.0);
  const Doubles distance = root(qr * qr + qz * qz);
  const Doubles inverse = all(1.0) / greater(distance, all(kTiny));
  // Between the end normals the arc itself, else the nearer tangent.
  const auto within =
      (zero <= all(e.n0r) * qz - all(e.n0z) * qr) & (zero <= qr * all(e.n1z) - qz * all(e.n1r));
  const Doubles f0 = all(e.n0r) * qr + all(e.n0z) * qz, f1 = all(e.n1r) * qr + all(e.n1z) * qz;
  const auto first = f1 < f0;
  const Doubles f = choose(within, distance, choose(first, f0, f1)) - all(e.radius);
  const Doubles nr = choose(within, qr * inverse, choose(first, all(e.n0r), all(e.n1r)));
  const Doubles nz = choose(within, qz * inverse, choose(first, all(e.n0z), all(e.n1z)));
  const auto above = out.f < f;
  out.f = choose(above, f, out.f);
  out.nr = choose(above, nr, out.nr);
  out.nz = choose(above, nz, out.nz);
}

KERF_LANES void body_value(const ToolBody& body, const Doubles& r, const Doubles& z, Value& out) {
  out.f = all(-1e300);
  out.nr = out.nz = all(0.0);
  for (int i = 0; i < body.count; ++i) {
    const ToolElement& e = body.elements[i];
    if (e.arc)
      add_arc(e, r, z, out);
    else
      add_line(e, r, z, out);
  }
}

struct Points {
  Doubles x, y, z;
};
struct Gradients {
  Doubles f, x, y, z;
};

/// Points in the frame of the sweep.
struct Local {
  Doubles u, v, w;
};

KERF_LANES Doubles along(const Vec3& way, const Doubles& x, const Doubles& y, const Doubles& z) {
  return x * all(way.x) + y * all(way.y) + z * all(way.z);
}

KERF_LANES void to_local(const Sweep& s, const Points& p, Local& out) {
  const Doubles x = p.x - all(s.origin_mm.x), y = p.y - all(s.origin_mm.y),
                z = p.z - all(s.origin_mm.z);
  out.u = along(s.u, x, y, z);
  out.v = along(s.v, x, y, z);
  out.w = along(s.w, x, y, z);
}

/// The gradient from its parts along u, v, w.
KERF_LANES void to_workpiece(const Sweep& s, const Doubles& gu, const Doubles& gv,
                             const Doubles& gw, Gradients& out) {
  out.x = gu * all(s.u.x) + gv * all(s.v.x) + gw * all(s.w.x);
  out.y = gu * all(s.u.y) + gv * all(s.v.y) + gw * all(s.w.y);
  out.z = gu * all(s.u.z) + gv * all(s.v.z) + gw * all(s.w.z);
}

/// Where the tool's distance r from a point does not depend on its height: (du, dv) is the way from
/// the nearest point of the path.
template <bool kGradients>
KERF_LANES void finish_level(const Sweep& s, const Doubles& du, const Doubles& dv, const Local& p,
                             Gradients& out) {
  const Doubles r = root(du * du + dv * dv);
  Value value;
  body_value(*s.body, r, p.w, value);
  out.f = value.f;
  if constexpr (kGradients) {
    const Doubles inverse = value.nr / greater(r, all(kTiny));
    to_workpiece(s, du * inverse, dv * inverse, value.nz, out);
  }
}

template <bool kGradients>
KERF_LANES void level(const Sweep& s, const Points& points, Gradients& out) {
  Local p;
  to_local(s, points, p);
  const Doubles du = p.u - greater(all(0.0), lesser(all(s.length_u), p.u));
  finish_level<kGradients>(s, du, p.v, p, out);
}

template <bool kGradients>
KERF_LANES void arc(const Sweep& s, const Points& points, Gradients& out) {
  Local p;
  to_local(s, points, p);
  const Doubles distance = root(p.u * p.u + p.v * p.v);
  const Doubles scale = all(1.0) - all(s.arc_radius) / greater(distance, all(kTiny));
  const auto within = distance * all(s.cos_half) <= p.u;
  const Doubles end_v = choose(p.v < all(0.0), all(-s.end_v), all(s.end_v));
  const Doubles du = choose(within, p.u * scale, p.u - all(s.end_u));
  const Doubles dv = choose(within, p.v * scale, p.v - end_v);
  finish_level<kGradients>(s, du, dv, p, out);
}

KERF_LANES void from_origin(const Sweep& s, const Points& points, Points& out) {
  out.x = points.x - all(s.origin_mm.x);
  out.y = points.y - all(s.origin_mm.y);
  out.z = points.z - all(s.origin_mm.z);
}

/// From the nearest place of a sphere's centre, of points from its origin.
KERF_LANES void from_path(const Sweep& s, const Points& p, Points& out) {
  const Doubles at = unit_clamp(along(s.step, p.x, p.y, p.z) * all(s.per_step2));
  out.x = p.x - at * all(s.step.x);
  out.y = p.y - at * all(s.step.y);
  out.z = p.z - at * all(s.step.z);
}

template <bool kGradients>
KERF_LANES void round_value(const Sweep& s, const Points& way, const Doubles& distance,
                            Gradients& out) {
  out.f = distance - all(s.body->elements[0].radius);
  if constexpr (kGradients) {
    const Doubles inverse = all(1.0) / greater(distance, all(kTiny));
    out.x = way.x * inverse;
    out.y = way.y * inverse;
    out.z = way.z * inverse;
  }
}

template <bool kGradients>
KERF_LANES void sphere(const Sweep& s, const Points& points, Gradients& out) {
  Points p, way;
  from_origin(s, points, p);
  from_path(s, p, way);
  round_value<kGradients>(s, way, root(way.x * way.x + way.y * way.y + way.z * way.z), out);
}

/// Of points from a ball's origin: is its cylinder nearest, and not the ball? `du`, `v`: from the
/// nearest axis of it, along u and v.
KERF_LANES Masks sees_wall(const Sweep& s, const Points& p, Doubles& du, Doubles& v) {
  const double per_u = s.length_u > 0 ? 1 / s.length_u : 0;
  const Doubles u = along(s.u, p.x, p.y, p.z), w = along(s.w, p.x, p.y, p.z);
  v = along(s.v, p.x, p.y, p.z);
  // Nearest seen along the spindle; that is where the cylinder above the ball is nearest.
  const Doubles above = unit_clamp(u * all(per_u));
  du = u - above * all(s.length_u);
  return all(0.0) <= w - above * all(s.length_w);
}

/// Of points from a turning ball's origin: are they below its cylinder, on all of its way?
KERF_LANES Masks is_below_wall(const Sweep& s, const Points& p) {
  // The height above the centre is a parabola along the way.
  const double bulge = s.step.x * s.turn.x + s.step.y * s.turn.y + s.step.z * s.turn.z;
  const Doubles first = along(s.w, p.x, p.y, p.z);
  const Doubles x = p.x - all(s.step.x), y = p.y - all(s.step.y), z = p.z - all(s.step.z);
  const Doubles last = along(s.w, x, y, z) + along(s.turn, x, y, z);
  return greater(first, last) + all(bulge > 0 ? 0.25 * bulge : 0.0) <= all(0.0);
}

/// Ball noses: bits below the cylinder are those of the sphere.
template <bool kGradients>
KERF_LANES void ball(const Sweep& s, const Points& points, Gradients& out) {
  Points p, way;
  from_origin(s, points, p);
  from_path(s, p, way);
  Doubles du, v;
  const Masks by_cylinder = sees_wall(s, p, du, v);
  const Doubles distance2 =
      choose(by_cylinder, du * du + v * v, way.x * way.x + way.y * way.y + way.z * way.z);
  if constexpr (kGradients) {
    way.x = choose(by_cylinder, du * all(s.u.x) + v * all(s.v.x), way.x);
    way.y = choose(by_cylinder, du * all(s.u.y) + v * all(s.v.y), way.y);
    way.z = choose(by_cylinder, du * all(s.u.z) + v * all(s.v.z), way.z);
  }
  round_value<kGradients>(s, way, root(distance2), out);
}

/// Value, slope in s, and gradient, at each lane's own s.
struct Trial {
  Doubles s, f, slope, x, y, z;
};

/// What is no more than this is no slope: rounding must not decide.
constexpr double kNoSlope = 1e-9;

struct RampPath {
  const Sweep& sweep;
  using Place = Local;
  KERF_LANES void place(const Points& points, Place& p) const { to_local(sweep, points, p); }
  /// Gradients along u, v, w.
  KERF_LANES void at(const Place& p, Trial& t) const {
    const Doubles du = p.u - t.s * all(sweep.length_u);
    const Doubles r = root(du * du + p.v * p.v), z = p.w - t.s * all(sweep.length_w);
    Value value;
    body_value(*sweep.body, r, z, value);
    const Doubles inverse = value.nr / greater(r, all(kTiny));
    t.f = value.f;
    t.x = du * inverse;
    t.y = p.v * inverse;
    t.z = value.nz;
    t.slope = all(-sweep.length_u) * t.x - all(sweep.length_w) * t.z;
  }
  KERF_LANES void finish(const Doubles& gu, const Doubles& gv, const Doubles& gw,
                         Gradients& out) const {
    to_workpiece(sweep, gu, gv, gw, out);
  }
  /// F that falls by more than this at its end is nowhere less than there.
  KERF_LANES Doubles least_fall(const Place&) const { return all(kNoSlope); }
};

struct TurnPath {
  const Sweep& sweep;
  using Place = Points;  ///< from the origin
  KERF_LANES void place(const Points& points, Place& p) const { from_origin(sweep, points, p); }
  KERF_LANES void at(const Place& p, Trial& t) const {
    const Vec3 &step = sweep.step, &turn = sweep.turn;
    const Doubles x = p.x - t.s * all(step.x), y = p.y - t.s * all(step.y),
                  zz = p.z - t.s * all(step.z);
    const Doubles ax = all(sweep.w.x) + t.s * all(turn.x), ay = all(sweep.w.y) + t.s * all(turn.y),
                  az = all(sweep.w.z) + t.s * all(turn.z);
    const Doubles per = all(1.0) / root(ax * ax + ay * ay + az * az);
    const Doubles wx = ax * per, wy = ay * per, wz = az * per;
    const Doubles z = x * wx + y * wy + zz * wz;
    // Square to the spindle, not from |rel|^2 - z^2: nothing cancels.
    const Doubles rx = x - z * wx, ry = y - z * wy, rz = zz - z * wz;
    const Doubles r = root(rx * rx + ry * ry + rz * rz);
    Value value;
    body_value(*sweep.body, r, z + all(sweep.origin_above_mm), value);
    const Doubles inverse = value.nr / greater(r, all(kTiny)), nz = value.nz;
    const Doubles gx = rx * inverse + nz * wx, gy = ry * inverse + nz * wy,
                  gz = rz * inverse + nz * wz;
    // The tool's point there moves with the origin and turns about it; a turn by w' carries
    // z * w + out to z * w' - (out . w') * w.
    const Doubles ahead = all(turn.x) * wx + all(turn.y) * wy + all(turn.z) * wz;
    const Doubles tx = (all(turn.x) - ahead * wx) * per, ty = (all(turn.y) - ahead * wy) * per,
                  tz = (all(turn.z) - ahead * wz) * per;
    const Doubles back = rx * tx + ry * ty + rz * tz;
    const Doubles mx = all(step.x) + z * tx - back * wx, my = all(step.y) + z * ty - back * wy,
                  mz = all(step.z) + z * tz - back * wz;
    t.f = value.f;
    t.slope = all(0.0) - (gx * mx + gy * my + gz * mz);
    t.x = gx;
    t.y = gy;
    t.z = gz;
  }
  KERF_LANES void finish(const Doubles& gx, const Doubles& gy, const Doubles& gz,
                         Gradients& out) const {
    out.x = gx;
    out.y = gy;
    out.z = gz;
  }
  /// See RampPath: F bends the wrong way by no more than bend_mm() of sweep.h has it, of points as
  /// far away as these.
  KERF_LANES Doubles least_fall(const Place& p) const {
    const Doubles zero = all(0.0);
    const Doubles far =
        greater(p.x, zero - p.x) + greater(p.y, zero - p.y) + greater(p.z, zero - p.z);
    const double turn = 2 * sweep.off_rad;
    const double way = sweep.length_u + (sweep.length_w < 0 ? -sweep.length_w : sweep.length_w);
    const double margin = 1.05;
    return far * all(margin * 0.5 * turn * turn) +
           all(margin * way * turn * (1 + 0.5 * turn) + kNoSlope);
  }
};

/// Which place is tried next.
enum class Try : std::uint8_t {
  kLevel,    ///< where the slopes' straight line is 0: finds smooth minima
  kBeyond,   ///< a little beyond that, seen from the nearer end: brings the other end near, too
  kTangents  ///< where the tangents meet: finds kinks
};

/// The way from one end to the other within which F may bend as it likes.
inline double near_width(double bend_mm) {
  return bend_mm > 0 ? __builtin_sqrt(0.5 * kSweepSlack_mm / bend_mm) : 0;
}

/// The next place to try between a (falling) and b (rising). `gap`: F at the lower end is too great
/// by at most this.
KERF_LANES void next_trial(const Trial& a, const Trial& b, double bend_mm, Try which, Trial& c,
                           Doubles& gap) {
  const Doubles width = b.s - a.s;
  const Doubles steepness = greater(b.slope - a.slope, all(kTiny));
  const Doubles meet = (a.f - b.f + b.slope * width) / steepness;
  gap = lesser(a.f, b.f) - (a.f + a.slope * meet) + all(bend_mm) * width * width;
  Doubles at = meet;
  if (which != Try::kTangents) at = (all(0.0) - a.slope) * width / steepness;
  if (which == Try::kBeyond) {
    const Doubles margin = all(near_width(bend_mm));
    at = choose(at <= width - at, all(2.0) * at + margin, all(2.0) * at - width - margin);
  }
  c.s = a.s + greater(all(1e-3) * width, lesser(all(0.999) * width, at));
}

/// Puts lanes of c in place of those of a or b.
KERF_LANES void narrow(const Trial& c, const Masks& searching, Trial& a, Trial& b) {
  const Masks falls = c.slope <= all(0.0);
  const auto take = [&](const Masks& yes, Trial& to) {
    to.s = choose(yes, c.s, to.s);
    to.f = choose(yes, c.f, to.f);
    to.slope = choose(yes, c.slope, to.slope);
    to.x = choose(yes, c.x, to.x);
    to.y = choose(yes, c.y, to.y);
    to.z = choose(yes, c.z, to.z);
  };
  take(searching & falls, a);
  take(searching & ~falls, b);
}

/// Eight points on their way.
template <class Path>
struct Search {
  typename Path::Place place;
  Trial a, b;
  Masks ahead;
};
/// Searches of so many groups go on by turns: each step of one waits for its own last, not for
/// others'. A group of many small vectors has such turns in itself.
constexpr int kSearchGroups = kVectorBytes >= 64 ? 4 : 2;

/// False: F of all points is least at the end.
template <class Path>
KERF_LANES bool begin_search(const Path& path, const Points& points, Search<Path>& s) {
  path.place(points, s.place);
  s.b.s = all(1.0);
  path.at(s.place, s.b);
  // What lies ahead of the tool, as most does that it cuts, is nearest to its end.
  s.ahead = s.b.slope < all(0.0) - path.least_fall(s.place);
  return any(~s.ahead);
}

/// False: nothing is left to be found.
template <class Path>
KERF_LANES bool step_search(const Path& path, int step, Search<Path>& s) {
  Trial c;
  Doubles gap;
  // Without a bend tangents alone show that a minimum is one.
  constexpr Try kTurns[3] = {Try::kLevel, Try::kBeyond, Try::kTangents};
  const Try which = path.sweep.bend_mm > 0 ? kTurns[step % 3]
                    : step % 2 == 0        ? Try::kLevel
                                           : Try::kTangents;
  next_trial(s.a, s.b, path.sweep.bend_mm, which, c, gap);
  // A path that rises from its start or falls to its end has its minimum there.
  const Doubles zero = all(0.0);
  const Masks searching = (s.a.slope < zero) & (zero < s.b.slope) & (all(kSweepSlack_mm) < gap);
  if (!any(searching)) return false;
  path.at(s.place, c);
  narrow(c, searching, s.a, s.b);
  return true;
}

template <bool kGradients, class Path>
KERF_LANES void end_search(const Path& path, const Search<Path>& s, Gradients& out) {
  const Doubles zero = all(0.0);
  const Trial &a = s.a, &b = s.b;
  out.f = lesser(a.f, b.f);
  if constexpr (kGradients) {
    const Masks inside = (a.slope < zero) & (zero < b.slope);
    // Where neither way is down, or both: the lower end.
    const Doubles between = (zero - a.slope) / greater(b.slope - a.slope, all(kTiny));
    const Doubles part = choose(inside, between, choose(a.f <= b.f, zero, all(1.0)));
    const auto mix = [&](const Doubles& at_a, const Doubles& at_b) {
      return choose(s.ahead, at_b, at_a + part * (at_b - at_a));
    };
    path.finish(mix(a.x, b.x), mix(a.y, b.y), mix(a.z, b.z), out);
  }
}

/// Of up to kSearchGroups groups.
template <bool kGradients, class Path>
inline void search(const Path& path, const Points* points, int count, Gradients* out) {
  Search<Path> searches[kSearchGroups];
  unsigned starting = 0;
  for (int g = 0; g < count; ++g) {
    Search<Path>& s = searches[g];
    if (begin_search(path, points[g], s)) {
      starting |= 1u << g;
      continue;
    }
    out[g].f = s.b.f;
    if constexpr (kGradients) path.finish(s.b.x, s.b.y, s.b.z, out[g]);
  }
  for (unsigned rest = starting; rest != 0; rest &= rest - 1) {
    Search<Path>& s = searches[__builtin_ctz(rest)];
    s.a.s = all(0.0);
    path.at(s.place, s.a);
  }
  unsigned open = starting;
  for (int step = 0; step < kMaxSteps && open != 0; ++step) {
    for (unsigned rest = open; rest != 0; rest &= rest - 1) {
      const int g = __builtin_ctz(rest);
      if (!step_search(path, step, searches[g])) open &= ~(1u << g);
    }
  }
  for (unsigned rest = starting; rest != 0; rest &= rest - 1) {
    const int g = __builtin_ctz(rest);
    end_search<kGradients>(path, searches[g], out[g]);
  }
}

/// A ball nose whose spindle turns: what is below the cylinder all the way sees a sphere.
template <bool kGradients>
inline void turning_ball(const Sweep& s, const Points* points, int count, Gradients* out) {
  Points others[kSearchGroups];
  Masks below[kSearchGroups];
  int which[kSearchGroups], left = 0;
  for (int g = 0; g < count; ++g) {
    Points p, way;
    from_origin(s, points[g], p);
    from_path(s, p, way);
    round_value<kGradients>(s, way, root(way.x * way.x + way.y * way.y + way.z * way.z), out[g]);
    below[left] = is_below_wall(s, p);
    if (!any(~below[left])) continue;
    others[left] = points[g];
    which[left++] = g;
  }
  if (left == 0) return;
  Gradients found[kSearchGroups];
  search<kGradients>(TurnPath{s}, others, left, found);
  for (int n = 0; n < left; ++n) {
    Gradients& g = out[which[n]];
    g.f = choose(below[n], g.f, found[n].f);
    if constexpr (kGradients) {
      g.x = choose(below[n], g.x, found[n].x);
      g.y = choose(below[n], g.y, found[n].y);
      g.z = choose(below[n], g.z, found[n].z);
    }
  }
}

/// Of up to kSearchGroups groups of eight points.
template <bool kGradients>
inline void evaluate(const Sweep& s, const Points* points, int count, Gradients* out) {
  switch (s.kind) {
    case Sweep::Kind::kLevel:
      for (int g = 0; g < count; ++g) level<kGradients>(s, points[g], out[g]);
      break;
    case Sweep::Kind::kArc:
      for (int g = 0; g < count; ++g) arc<kGradients>(s, points[g], out[g]);
      break;
    case Sweep::Kind::kBall:
      for (int g = 0; g < count; ++g) ball<kGradients>(s, points[g], out[g]);
      break;
    case Sweep::Kind::kSphere:
      for (int g = 0; g < count; ++g) sphere<kGradients>(s, points[g], out[g]);
      break;
    case Sweep::Kind::kRamp:
      search<kGradients>(RampPath{s}, points, count, out);
      break;
    default:
      if (s.body->shape == ToolBody::Shape::kBall)
        turning_ball<kGradients>(s, points, count, out);
      else
        search<kGradients>(TurnPath{s}, points, count, out);
      break;
  }
  for (int g = 0; g < count; ++g) out[g].f = out[g].f + all(s.shrink_mm);
}

KERF_LANES Points load_points(const double* x, const double* y, const double* z, int first) {
  return {load_lanes<Doubles>(x + first), load_lanes<Doubles>(y + first),
          load_lanes<Doubles>(z + first)};
}

/// Calls each(first, out) for all groups of n points.
template <bool kGradients, class Each>
KERF_LANES void evaluate_points(const Sweep& s, int n, const double* x, const double* y,
                                const double* z, const Each& each) {
  Points points[kSearchGroups];
  Gradients out[kSearchGroups];
  for (int first = 0; first < n; first += kSearchGroups * W) {
    int count = 0;
    for (; count < kSearchGroups && first + count * W < n; ++count)
      points[count] = load_points(x, y, z, first + count * W);
    evaluate<kGradients>(s, points, count, out);
    for (int g = 0; g < count; ++g) each(first + g * W, out[g]);
  }
}

void lanes_distance(const Sweep& s, int n, const double* x, const double* y, const double* z,
                    double* f) {
  evaluate_points<false>(s, n, x, y, z,
                         [&](int i, const Gradients& out) { store_lanes(out.f, f + i); });
}

void lanes_gradient(const Sweep& s, int n, const double* x, const double* y, const double* z,
                    double* f, double* gx, double* gy, double* gz) {
  evaluate_points<true>(s, n, x, y, z, [&](int i, const Gradients& out) {
    store_lanes(out.f, f + i);
    store_lanes(out.x, gx + i);
    store_lanes(out.y, gy + i);
    store_lanes(out.z, gz + i);
  });
}

}  // namespace
}  // namespace kerf::octree
