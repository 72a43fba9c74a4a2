// stock/zmap/tool_lanes.h - the lower surface of convex tools, eight cells at a time.
//
// A straight sweep in the frame of the move: u along the track (XY), v across, slope s = dz/du. A
// tool standing at t covers the cell at (u, v) with height z(t) + f(sqrt((u-t)^2 + v^2)). f is
// convex, so this is convex in t and has one minimum, at t = u - rho with rho depending on s and v
// only ("contact"). See also Maeng, Baek, Shin, Choi, "A Z-map update method for linearly moving
// tools", CAD 35(11), 2003: one equation in one unknown for each grid vector.
#pragma once

#ifndef KERF_LANES_NAMESPACE
#error "define KERF_LANES_NAMESPACE before including tool_lanes.h"
#endif

namespace kerf::KERF_LANES_NAMESPACE {

inline double scalar_sqrt(double x) { return __builtin_sqrt(x); }

/// Contact of the sweep with the column over a cell: tool axis is `rho` behind it along the track,
/// surface there at `z`.
template <class T>
struct ContactLanes {
  T rho;
  T z;
  T half_chord;  ///< sqrt(radius^2 - v^2), where the shape has used it: see rho_like()
};

/// A slope s with k = s / m and m = sqrt(1 + s^2).
struct SlopeTerms {
  double s = 0, m = 1;
};

template <class T>
struct FlatLanes {
  static constexpr bool kMayHaveEdges = true;  ///< on a slope the contact may lie on the rim
  using S = typename T::Scalar;
  T radius2, base, slope, sign;
  FlatLanes(const ConvexTool& tool, SlopeTerms slope_terms)
      : radius2(T::all(static_cast<S>(tool.radius * tool.radius))),
        base(T::all(static_cast<S>(tool.base_z))),
        slope(T::all(static_cast<S>(slope_terms.s))),
        sign(T::all(static_cast<S>((slope_terms.s > 0) - (slope_terms.s < 0)))) {}
  /// zu: height of the (extended) track at u; v2 = v*v <= radius2.
  ContactLanes<T> contact(T zu, T v2, typename T::Mask&) const {
    const T w = sqrt(max(radius2 - v2, T::all(0)));
    const T rho = sign * w;
    return {rho, zu + base - slope * rho, w};
  }
  /// rho of this slope where `other` is the contact of another slope over the same v.
  T rho_like(const ContactLanes<T>& other, T, typename T::Mask&) const {
    return sign * other.half_chord;
  }
  T surface(T) const { return base; }
};

template <class T>
struct BallLanes {
  static constexpr bool kMayHaveEdges = false;
  using S = typename T::Scalar;
  T radius2, top, k, m;
  BallLanes(const ConvexTool& tool, SlopeTerms slope)
      : radius2(T::all(static_cast<S>(tool.radius * tool.radius))),
        top(T::all(static_cast<S>(tool.base_z + tool.radius))),
        k(T::all(static_cast<S>(slope.s / slope.m))),
        m(T::all(static_cast<S>(slope.m))) {}
  ContactLanes<T> contact(T zu, T v2, typename T::Mask&) const {
    const T w = sqrt(max(radius2 - v2, T::all(0)));
    return {k * w, zu + top - m * w, w};
  }
  T rho_like(const ContactLanes<T>& other, T, typename T::Mask&) const {
    return k * other.half_chord;
  }
  T surface(T d2) const { return top - sqrt(max(radius2 - d2, T::all(0))); }
};

/// Any chain of line and arc pieces.
template <class T>
struct PieceLanes {
  static constexpr bool kMayHaveEdges = true;
  using S = typename T::Scalar;
  const ConvexTool& tool;
  T radius2, slope;
  double s;
  PieceLanes(const ConvexTool& t, SlopeTerms slope_terms)
      : tool(t),
        radius2(T::all(static_cast<S>(t.radius * t.radius))),
        slope(T::all(static_cast<S>(slope_terms.s))),
        s(slope_terms.s) {}

  static T all(double x) { return T::all(static_cast<S>(x)); }

  static T piece_height(const ToolPiece& p, T d) {
    if (!p.arc) return all(p.z0) + all(p.slope) * (d - all(p.r0));
    const T y = d - all(p.center_r);
    return all(p.center_z) - sqrt(max(all(p.radius * p.radius) - y * y, all(0)));
  }
  T surface(T d2) const {
    const T d = sqrt(d2);
    T z = piece_height(tool.pieces[0], d);
    for (int i = 1; i < tool.piece_count; ++i)
      z = select(d >= all(tool.pieces[i].r0), piece_height(tool.pieces[i], d), z);
    return z;
  }

  /// Sets `unsure` where single precision did not settle.
  ContactLanes<T> contact(T zu, T v2, typename T::Mask& unsure) const {
    T rho = all(0);
    if (s != 0) {
      if constexpr (sizeof(S) == sizeof(double))
        rho = bisect(v2);
      else
        rho = solve_by_pieces(v2, unsure);
      if (s < 0) rho = all(0) - rho;
    }
    return {rho, zu - slope * rho + surface(rho * rho + v2), rho};
  }
  T rho_like(const ContactLanes<T>&, T v2, typename T::Mask& unsure) const {
    return contact(all(0), v2, unsure).rho;
  }

 private:
  /// Root of f'(d) rho / d = |s| by bisection: slow, exact to the last bits, no assumption but
  /// convexity.
  T bisect(T v2) const {
    const T steep = all(s < 0 ? -s : s);
    T low = all(0), high = sqrt(max(radius2 - v2, all(0)));
    for (int step = 0; step < 48; ++step) {
      const T rho = all(0.5) * (low + high);
      const T d = sqrt(rho * rho + v2);
      // Compare as f' numerator / denominator to stay finite where the surface turns vertical.
      T rise = all(tool.pieces[0].slope), run = all(1);
      for (int i = 0; i < tool.piece_count; ++i) {
        const ToolPiece& p = tool.pieces[i];
        const auto here = d >= all(p.r0);
        if (p.arc) {
          const T y = d - all(p.center_r);
          rise = select(here, y, rise);
          run = select(here, sqrt(max(all(p.radius * p.radius) - y * y, all(0))), run);
        } else {
          rise = select(here, all(p.slope), rise);
          run = select(here, all(1), run);
        }
      }
      const auto below = rise * rho < steep * d * run;
      low = select(below, rho, low);
      high = select(below, high, rho);
    }
    return all(0.5) * (low + high);
  }

  /// The stationary point within each piece, held to the piece; the last piece whose start still
  /// descends has it.
  T solve_by_pieces(T v2, typename T::Mask& unsure) const {
    const double a = s < 0 ? -s : s;
    const T steep = all(a);
    T rho = all(0);
    for (int i = 0; i < tool.piece_count; ++i) {
      const ToolPiece& p = tool.pieces[i];
      const T begin = sqrt(max(all(p.r0 * p.r0) - v2, all(0)));
      const T end = sqrt(max(all(p.r1 * p.r1) - v2, all(0)));
      T at;
      if (!p.arc) {
        at = a < p.slope ? all(a / scalar_sqrt(p.slope * p.slope - a * a)) * sqrt(v2) : end;
      } else {
        at = arc_contact(p, steep, a, v2, begin, end, unsure);
      }
      at = min(max(at, begin), end);
      rho = i == 0 ? at : select(at > begin, at, rho);
    }
    return rho;
  }

  /// Newton on rho*y - |s|*d*q = 0 with y = d - center_r, q = sqrt(radius^2 - y^2). The first guess
  /// is exact for a ball (center_r = 0) and for a sharp edge (radius = 0).
  T arc_contact(const ToolPiece& p, T steep, double a, T v2, T begin, T end,
                typename T::Mask& unsure) const {
    const double k = a / scalar_sqrt(1 + a * a);
    const double reach = p.center_r + p.radius;
    const T q2_max = all(p.radius * p.radius);
    T rho =
        all(p.center_r + p.radius * k) * sqrt(max(all(1) - v2 * all(1 / (reach * reach)), all(0)));
    rho = min(max(rho, begin), end);
    T last = all(0);
    for (int step = 0; step < 4; ++step) {
      const T d = max(sqrt(rho * rho + v2), all(1e-6));
      const T y = d - all(p.center_r);
      const T q = max(sqrt(max(q2_max - y * y, all(0))), all(1e-6));
      const T value = rho * y - steep * d * q;
      const T slope_d = rho / d;
      const T derivative = y + rho * slope_d - steep * slope_d * (q - d * y / q);
      const T next = min(max(rho - value / max(derivative, all(1e-6)), begin), end);
      last = abs(next - rho);
      rho = next;
    }
    unsure = unsure | (last > all(1e-3 * scalar_sqrt(p.radius < 1 ? p.radius : 1)));
    return rho;
  }
};

}  // namespace kerf::KERF_LANES_NAMESPACE
