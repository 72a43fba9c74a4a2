// stock/octree/sweep_lanes.h - the formulas of sweep_kernel.h, kLanes points at a time.
//
// Compiled once for each instruction set, so everything here is in an unnamed namespace, and calls
// nothing that a linker could take from another variant. Plain loops over arrays: the compiler
// makes vectors of them. No fused multiplications: equal bits everywhere.
#pragma once

#include <cmath>

#include "stock/octree/sweep_kernel.h"

namespace kerf::octree {
namespace {

constexpr int W = kLanes;
/// Iterations of the search for s. Brackets shrink far below the slack long before.
constexpr int kMaxSteps = 40;
constexpr double kTiny = 1e-150;

struct alignas(64) Lane {
  double at[W];
};

inline double least(double a, double b) { return a < b ? a : b; }
inline double most(double a, double b) { return a > b ? a : b; }
inline double unit_clamp(double s) { return most(0.0, least(1.0, s)); }

/// Value of the body at (r, z) and where it grows.
struct Value {
  Lane f, nr, nz;
};

inline void add_line(const ToolElement& e, const Lane& r, const Lane& z, Value& out) {
  for (int l = 0; l < W; ++l) {
    const double f = e.nr * r.at[l] + e.nz * z.at[l] - e.offset;
    const bool above = f > out.f.at[l];
    out.f.at[l] = above ? f : out.f.at[l];
    out.nr.at[l] = above ? e.nr : out.nr.at[l];
    out.nz.at[l] = above ? e.nz : out.nz.at[l];
  }
}

inline void add_arc(const ToolElement& e, const Lane& r, const Lane& z, Value& out) {
  for (int l = 0; l < W; ++l) {
    const double qr = r.at[l] - e.center_r, qz = z.at[l] - e.center_z;
    const double distance = std::sqrt(qr * qr + qz * qz);
    const double inverse = 1 / most(distance, kTiny);
    // Between the end normals the arc itself, else the nearer tangent.
    const bool within = (e.n0r * qz - e.n0z * qr >= 0) & (qr * e.n1z - qz * e.n1r >= 0);
    const double f0 = e.n0r * qr + e.n0z * qz, f1 = e.n1r * qr + e.n1z * qz;
    const bool first = f0 > f1;
    const double tangent = first ? f0 : f1;
    const double tangent_r = first ? e.n0r : e.n1r, tangent_z = first ? e.n0z : e.n1z;
    const double f = (within ? distance : tangent) - e.radius;
    const double nr = within ? qr * inverse : tangent_r, nz = within ? qz * inverse : tangent_z;
    const bool above = f > out.f.at[l];
    out.f.at[l] = above ? f : out.f.at[l];
    out.nr.at[l] = above ? nr : out.nr.at[l];
    out.nz.at[l] = above ? nz : out.nz.at[l];
  }
}

inline void body_value(const ToolBody& body, const Lane& r, const Lane& z, Value& out) {
  for (int l = 0; l < W; ++l) out.f.at[l] = -1e300;
  for (int i = 0; i < body.count; ++i) {
    const ToolElement& e = body.elements[i];
    if (e.arc)
      add_arc(e, r, z, out);
    else
      add_line(e, r, z, out);
  }
}

struct Points {
  Lane x, y, z;
};
struct Gradients {
  Lane f, x, y, z;
};

/// Points in the frame of the sweep.
struct Local {
  Lane u, v, w;
};

inline void to_local(const Sweep& s, const Points& p, Local& out) {
  for (int l = 0; l < W; ++l) {
    const double x = p.x.at[l] - s.origin_mm.x, y = p.y.at[l] - s.origin_mm.y,
                 z = p.z.at[l] - s.origin_mm.z;
    out.u.at[l] = x * s.u.x + y * s.u.y + z * s.u.z;
    out.v.at[l] = x * s.v.x + y * s.v.y + z * s.v.z;
    out.w.at[l] = x * s.w.x + y * s.w.y + z * s.w.z;
  }
}

/// The gradient from its parts along u, v, w.
inline void to_workpiece(const Sweep& s, const Lane& gu, const Lane& gv, const Lane& gw,
                         Gradients& out) {
  for (int l = 0; l < W; ++l) {
    out.x.at[l] = gu.at[l] * s.u.x + gv.at[l] * s.v.x + gw.at[l] * s.w.x;
    out.y.at[l] = gu.at[l] * s.u.y + gv.at[l] * s.v.y + gw.at[l] * s.w.y;
    out.z.at[l] = gu.at[l] * s.u.z + gv.at[l] * s.v.z + gw.at[l] * s.w.z;
  }
}

/// Where the tool's distance r from a point does not depend on its height: (du, dv) is the way from
/// the nearest point of the path.
inline void finish_level(const Sweep& s, const Lane& du, const Lane& dv, const Local& p,
                         bool gradients, Gradients& out) {
  Lane r;
  for (int l = 0; l < W; ++l) r.at[l] = std::sqrt(du.at[l] * du.at[l] + dv.at[l] * dv.at[l]);
  Value value;
  body_value(*s.body, r, p.w, value);
  out.f = value.f;
  if (!gradients) return;
  Lane gu, gv;
  for (int l = 0; l < W; ++l) {
    const double inverse = value.nr.at[l] / most(r.at[l], kTiny);
    gu.at[l] = du.at[l] * inverse;
    gv.at[l] = dv.at[l] * inverse;
  }
  to_workpiece(s, gu, gv, value.nz, out);
}

inline void level(const Sweep& s, const Points& points, bool gradients, Gradients& out) {
  Local p;
  to_local(s, points, p);
  Lane du;
  for (int l = 0; l < W; ++l) du.at[l] = p.u.at[l] - most(0.0, least(s.length_u, p.u.at[l]));
  finish_level(s, du, p.v, p, gradients, out);
}

inline void arc(const Sweep& s, const Points& points, bool gradients, Gradients& out) {
  Local p;
  to_local(s, points, p);
  Lane du, dv;
  for (int l = 0; l < W; ++l) {
    const double u = p.u.at[l], v = p.v.at[l];
    const double distance = std::sqrt(u * u + v * v);
    const double scale = 1 - s.arc_radius / most(distance, kTiny);
    const bool within = u >= distance * s.cos_half;
    const double end_v = v < 0 ? -s.end_v : s.end_v;
    du.at[l] = within ? u * scale : u - s.end_u;
    dv.at[l] = within ? v * scale : v - end_v;
  }
  finish_level(s, du, dv, p, gradients, out);
}

/// Ball noses and spheres: s has a closed form.
inline void ball(const Sweep& s, const Points& points, bool gradients, Gradients& out) {
  Local p;
  to_local(s, points, p);
  const ToolElement& e = s.body->elements[0];
  const bool whole = s.kind == Sweep::Kind::kSphere;
  const double length2 = s.length_u * s.length_u + s.length_w * s.length_w;
  const double per_length2 = length2 > 0 ? 1 / length2 : 0;
  const double per_u = s.length_u > 0 ? 1 / s.length_u : 0;
  Lane gu, gv, gw;
  for (int l = 0; l < W; ++l) {
    const double u = p.u.at[l], v = p.v.at[l], w = p.w.at[l] - e.center_z;
    // Nearest seen along the spindle; that is where the cylinder above the ball is nearest.
    const double above = unit_clamp(u * per_u);
    const double nearest = unit_clamp((u * s.length_u + w * s.length_w) * per_length2);
    const bool by_cylinder = !whole & (w - above * s.length_w >= 0);
    const double at = by_cylinder ? above : nearest;
    const double du = u - at * s.length_u, dw = by_cylinder ? 0 : w - at * s.length_w;
    const double distance = std::sqrt(du * du + v * v + dw * dw);
    const double inverse = 1 / most(distance, kTiny);
    out.f.at[l] = distance - e.radius;
    gu.at[l] = du * inverse;
    gv.at[l] = v * inverse;
    gw.at[l] = dw * inverse;
  }
  if (gradients) to_workpiece(s, gu, gv, gw, out);
}

/// Value, slope in s, and gradient, at each lane's own s.
struct Trial {
  Lane s, f, slope, x, y, z;
};

struct RampPath {
  const Sweep& sweep;
  Local p;
  RampPath(const Sweep& s, const Points& points) : sweep(s) { to_local(s, points, p); }
  /// Gradients along u, v, w.
  void at(Trial& t) const {
    Lane r, z;
    for (int l = 0; l < W; ++l) {
      const double du = p.u.at[l] - t.s.at[l] * sweep.length_u;
      r.at[l] = std::sqrt(du * du + p.v.at[l] * p.v.at[l]);
      z.at[l] = p.w.at[l] - t.s.at[l] * sweep.length_w;
    }
    Value value;
    body_value(*sweep.body, r, z, value);
    for (int l = 0; l < W; ++l) {
      const double du = p.u.at[l] - t.s.at[l] * sweep.length_u;
      const double inverse = value.nr.at[l] / most(r.at[l], kTiny);
      t.f.at[l] = value.f.at[l];
      t.x.at[l] = du * inverse;
      t.y.at[l] = p.v.at[l] * inverse;
      t.z.at[l] = value.nz.at[l];
      t.slope.at[l] = -sweep.length_u * t.x.at[l] - sweep.length_w * t.z.at[l];
    }
  }
  void finish(const Lane& gu, const Lane& gv, const Lane& gw, Gradients& out) const {
    to_workpiece(sweep, gu, gv, gw, out);
  }
};

struct TurnPath {
  const Sweep& sweep;
  Points p;  ///< from the tip's start
  TurnPath(const Sweep& s, const Points& points) : sweep(s) {
    for (int l = 0; l < W; ++l) {
      p.x.at[l] = points.x.at[l] - s.origin_mm.x;
      p.y.at[l] = points.y.at[l] - s.origin_mm.y;
      p.z.at[l] = points.z.at[l] - s.origin_mm.z;
    }
  }
  void at(Trial& t) const {
    Lane r, z, wx, wy, wz, per;
    for (int l = 0; l < W; ++l) {
      const double s = t.s.at[l];
      const double x = p.x.at[l] - s * sweep.step.x, y = p.y.at[l] - s * sweep.step.y,
                   zz = p.z.at[l] - s * sweep.step.z;
      const double ax = sweep.w.x + s * sweep.turn.x, ay = sweep.w.y + s * sweep.turn.y,
                   az = sweep.w.z + s * sweep.turn.z;
      per.at[l] = 1 / std::sqrt(ax * ax + ay * ay + az * az);
      wx.at[l] = ax * per.at[l];
      wy.at[l] = ay * per.at[l];
      wz.at[l] = az * per.at[l];
      z.at[l] = x * wx.at[l] + y * wy.at[l] + zz * wz.at[l];
      // Square to the spindle, not from |rel|^2 - z^2: nothing cancels.
      const double rx = x - z.at[l] * wx.at[l], ry = y - z.at[l] * wy.at[l],
                   rz = zz - z.at[l] * wz.at[l];
      r.at[l] = std::sqrt(rx * rx + ry * ry + rz * rz);
      t.x.at[l] = rx;
      t.y.at[l] = ry;
      t.z.at[l] = rz;
    }
    Value value;
    body_value(*sweep.body, r, z, value);
    for (int l = 0; l < W; ++l) {
      const double inverse = value.nr.at[l] / most(r.at[l], kTiny), nz = value.nz.at[l];
      const double gx = t.x.at[l] * inverse + nz * wx.at[l],
                   gy = t.y.at[l] * inverse + nz * wy.at[l],
                   gz = t.z.at[l] * inverse + nz * wz.at[l];
      // The tool's point there moves with the tip and turns about it; a turn by w' carries
      // z * w + out to z * w' - (out . w') * w.
      const double along =
          (sweep.turn.x * wx.at[l] + sweep.turn.y * wy.at[l] + sweep.turn.z * wz.at[l]);
      const double tx = (sweep.turn.x - along * wx.at[l]) * per.at[l],
                   ty = (sweep.turn.y - along * wy.at[l]) * per.at[l],
                   tz = (sweep.turn.z - along * wz.at[l]) * per.at[l];
      const double back = t.x.at[l] * tx + t.y.at[l] * ty + t.z.at[l] * tz;
      const double height = z.at[l];
      const double mx = sweep.step.x + height * tx - back * wx.at[l],
                   my = sweep.step.y + height * ty - back * wy.at[l],
                   mz = sweep.step.z + height * tz - back * wz.at[l];
      t.f.at[l] = value.f.at[l];
      t.slope.at[l] = -(gx * mx + gy * my + gz * mz);
      t.x.at[l] = gx;
      t.y.at[l] = gy;
      t.z.at[l] = gz;
    }
  }
  void finish(const Lane& gx, const Lane& gy, const Lane& gz, Gradients& out) const {
    out.x = gx;
    out.y = gy;
    out.z = gz;
  }
};

/// The next place to try between a (falling) and b (rising): in turn where the tangents meet (finds
/// kinks) and where the slopes' straight line is 0 (finds smooth minima). `gap`: F at the lower end
/// is too great by at most this.
inline void next_trial(const Trial& a, const Trial& b, double bend_mm, bool tangents, Trial& c,
                       Lane& gap) {
  for (int l = 0; l < W; ++l) {
    const double sa = a.s.at[l], sb = b.s.at[l], ga = a.slope.at[l], gb = b.slope.at[l];
    const double fa = a.f.at[l], fb = b.f.at[l], width = sb - sa;
    const double steepness = most(gb - ga, kTiny);
    const double meet = (fa - fb + gb * width) / steepness;
    gap.at[l] = least(fa, fb) - (fa + ga * meet) + bend_mm * width * width;
    const double at = tangents ? meet : -ga * width / steepness;
    c.s.at[l] = sa + most(1e-3 * width, least(0.999 * width, at));
  }
}

/// Puts lane l of c in place of that of a or b.
inline void narrow(const Trial& c, const Lane& gap, Trial& a, Trial& b) {
  for (int l = 0; l < W; ++l) {
    const bool searching = gap.at[l] > kSweepSlack_mm;
    const bool low = searching & (c.slope.at[l] <= 0), high = searching & !(c.slope.at[l] <= 0);
    const auto take = [l](bool yes, const Lane& from, Lane& to) {
      to.at[l] = yes ? from.at[l] : to.at[l];
    };
    take(low, c.s, a.s), take(low, c.f, a.f), take(low, c.slope, a.slope);
    take(low, c.x, a.x), take(low, c.y, a.y), take(low, c.z, a.z);
    take(high, c.s, b.s), take(high, c.f, b.f), take(high, c.slope, b.slope);
    take(high, c.x, b.x), take(high, c.y, b.y), take(high, c.z, b.z);
  }
}

template <class Path>
inline void search(const Path& path, bool gradients, Gradients& out) {
  Trial a, b, c;
  for (int l = 0; l < W; ++l) {
    a.s.at[l] = 0;
    b.s.at[l] = 1;
  }
  path.at(a);
  path.at(b);
  Lane gap;
  for (int step = 0; step < kMaxSteps; ++step) {
    next_trial(a, b, path.sweep.bend_mm, step % 2 == 0, c, gap);
    bool any = false;
    for (int l = 0; l < W; ++l) {
      // A path that rises from its start or falls to its end has its minimum there.
      const bool inside = (a.slope.at[l] < 0) & (b.slope.at[l] > 0);
      gap.at[l] = inside ? gap.at[l] : 0;
      any |= gap.at[l] > kSweepSlack_mm;
    }
    if (!any) break;
    path.at(c);
    narrow(c, gap, a, b);
  }
  Lane gx, gy, gz;
  for (int l = 0; l < W; ++l) {
    const double ga = a.slope.at[l], gb = b.slope.at[l];
    const bool inside = (ga < 0) & (gb > 0);
    // Where neither way is down, or both: the lower end.
    const double part = inside ? -ga / most(gb - ga, kTiny) : (a.f.at[l] <= b.f.at[l] ? 0.0 : 1.0);
    out.f.at[l] = least(a.f.at[l], b.f.at[l]);
    gx.at[l] = a.x.at[l] + part * (b.x.at[l] - a.x.at[l]);
    gy.at[l] = a.y.at[l] + part * (b.y.at[l] - a.y.at[l]);
    gz.at[l] = a.z.at[l] + part * (b.z.at[l] - a.z.at[l]);
  }
  if (gradients) path.finish(gx, gy, gz, out);
}

inline void evaluate(const Sweep& s, const Points& points, bool gradients, Gradients& out) {
  switch (s.kind) {
    case Sweep::Kind::kLevel:
      level(s, points, gradients, out);
      break;
    case Sweep::Kind::kArc:
      arc(s, points, gradients, out);
      break;
    case Sweep::Kind::kBall:
    case Sweep::Kind::kSphere:
      ball(s, points, gradients, out);
      break;
    case Sweep::Kind::kRamp:
      search(RampPath(s, points), gradients, out);
      break;
    case Sweep::Kind::kTurn:
      search(TurnPath(s, points), gradients, out);
      break;
  }
  for (int l = 0; l < W; ++l) out.f.at[l] += s.shrink_mm;
}

inline void load(const double* x, const double* y, const double* z, int first, Points& p) {
  for (int l = 0; l < W; ++l) {
    p.x.at[l] = x[first + l];
    p.y.at[l] = y[first + l];
    p.z.at[l] = z[first + l];
  }
}

void lanes_distance(const Sweep& s, int n, const double* x, const double* y, const double* z,
                    double* f) {
  Points p;
  Gradients out;
  for (int i = 0; i < n; i += W) {
    load(x, y, z, i, p);
    evaluate(s, p, false, out);
    for (int l = 0; l < W; ++l) f[i + l] = out.f.at[l];
  }
}

void lanes_gradient(const Sweep& s, int n, const double* x, const double* y, const double* z,
                    double* f, double* gx, double* gy, double* gz) {
  Points p;
  Gradients out;
  for (int i = 0; i < n; i += W) {
    load(x, y, z, i, p);
    evaluate(s, p, true, out);
    for (int l = 0; l < W; ++l) {
      f[i + l] = out.f.at[l];
      gx[i + l] = out.x.at[l];
      gy[i + l] = out.y.at[l];
      gz[i + l] = out.z.at[l];
    }
  }
}

/// What F is not less than between a and b. With F'' >= -8 bend, F - 4 bend s (1 - s) is convex and
/// nowhere above F: where the tangents of that meet.
inline void add_bound(const Trial& a, const Trial& b, double bend_mm, Lane& bound) {
  for (int l = 0; l < W; ++l) {
    const double width = b.s.at[l] - a.s.at[l], fa = a.f.at[l], fb = b.f.at[l];
    const double ga = a.slope.at[l] - 4 * bend_mm * width, gb = b.slope.at[l] + 4 * bend_mm * width;
    const double meet = (fa - fb + gb * width) / most(gb - ga, kTiny);
    const double ends = least(fa, fb);
    const double inside = fa + ga * most(0.0, least(width, meet));
    bound.at[l] = least(bound.at[l], ((ga < 0) & (gb > 0)) ? least(ends, inside) : ends);
  }
}

inline void turn_bound(const Sweep& s, const Points& points, double level, Lane& bound) {
  constexpr int kParts = 4;
  const TurnPath path(s, points);
  Trial ends[kParts + 1];
  const auto look = [&](int n) {
    for (int l = 0; l < W; ++l) ends[n].s.at[l] = static_cast<double>(n) / kParts;
    path.at(ends[n]);
  };
  look(0);
  look(kParts);
  for (int stride = kParts; stride > 0; stride /= 2) {
    for (int n = stride; stride < kParts && n < kParts; n += 2 * stride) look(n);
    for (int l = 0; l < W; ++l) bound.at[l] = 1e300;
    for (int n = 0; n < kParts; n += stride) add_bound(ends[n], ends[n + stride], s.bend_mm, bound);
    bool any = false;
    for (int l = 0; l < W; ++l) {
      double low = 1e300;
      for (int n = 0; n <= kParts; n += stride) low = least(low, ends[n].f.at[l]);
      any |= (bound.at[l] < level) & (low >= level);
    }
    if (!any) return;
  }
}

void lanes_turn_bound(const Sweep& s, double level, int n, const double* x, const double* y,
                      const double* z, double* f) {
  Points p;
  Lane bound;
  for (int i = 0; i < n; i += W) {
    load(x, y, z, i, p);
    turn_bound(s, p, level - s.shrink_mm, bound);
    for (int l = 0; l < W; ++l) f[i + l] = bound.at[l] + s.shrink_mm;
  }
}

}  // namespace
}  // namespace kerf::octree
