// stock/zmap/helix_eval.h - the height that a helical move leaves over eight cells; double
// precision only.
#pragma once

#ifndef KERF_LANES_NAMESPACE
#error "define KERF_LANES_NAMESPACE before including helix_eval.h"
#endif

#include "stock/zmap/sweep_evals.h"

namespace kerf::KERF_LANES_NAMESPACE {

/// Angle of (x, y), -pi..pi, from correctly rounded operations only (libm differs between hosts).
/// Error below 1e-13.
inline D8 angle_of(D8 y, D8 x) {
  const D8 ax = abs(x), ay = abs(y), one = D8::all(1);
  D8 r = min(ax, ay) / max(max(ax, ay), D8::all(1e-300));
  for (int halving = 0; halving < 2; ++halving) r = r / (one + sqrt(one + r * r));
  const D8 r2 = r * r;
  D8 series = D8::all(1.0 / 21);
  for (int n = 19; n >= 1; n -= 2) series = D8::all(1.0 / n) - r2 * series;
  D8 angle = D8::all(4) * r * series;
  angle = select(ay > ax, D8::all(1.57079632679489661923) - angle, angle);
  angle = select(x < D8::all(0), D8::all(3.14159265358979323846) - angle, angle);
  return select(y < D8::all(0), D8::all(0) - angle, angle);
}

/// Helix that descends along its angle phi = 0..length: height z - slope*phi + f(distance). Over
/// one cell the distance d is periodic in phi; on each turn the height has one minimum behind the
/// axis (psi in 0..pi), where the tool's surface rises as fast as its path falls:
///
///     f'(d) * product * sin(psi) = slope * d        product = |cell| * radius of the path
///
/// For flat and ball that is solved outright, for others by bisection over d. The last turn that
/// holds the minimum is the lowest. Ends are caps.
struct HelixEval {
  const ConvexTool& tool;
  const SweepOp& op;
  HelixEval(const ConvexTool& t, const SweepOp& o) : tool(t), op(o) {}
  static D8 all(double x) { return D8::all(x); }

  /// f'(d) * a < b, kept finite where f' is infinite.
  MaskD descends(D8 d, D8 a, D8 b) const {
    D8 rise = all(0), run = all(1);
    for (int i = 0; i < tool.piece_count; ++i) {
      const ToolPiece& p = tool.pieces[i];
      const MaskD here = d >= all(p.r0);
      const D8 y = d - all(p.center_r);
      rise = select(here, p.arc ? y : all(p.slope), rise);
      run = select(here, p.arc ? sqrt(max(all(p.radius * p.radius) - y * y, all(0))) : all(1), run);
    }
    return rise * a < b * run;
  }
  D8 surface(D8 d2) const {
    switch (tool.kind) {
      case ConvexTool::Kind::kFlat:
        return FlatLanes<D8>(tool, {}).surface(d2);
      case ConvexTool::Kind::kBall:
        return BallLanes<D8>(tool, {}).surface(d2);
      case ConvexTool::Kind::kPieces:
        return PieceLanes<D8>(tool, {}).surface(d2);
    }
    return all(0);
  }

  template <bool kInterior>
  D8 at(D8 x, D8 y, D8, MaskD& unsure) const {
    unsure = all(0) > all(0);
    const D8 rr = sqrt(x * x + y * y);
    const D8 path = all(op.radius);
    const D8 closest = abs(rr - path), farthest = rr + path;
    const D8 product = max(rr * path, all(1e-30));
    const D8 squares = rr * rr + path * path;
    const D8 limit = min(farthest, all(tool.radius + kEdgeTie_mm));
    const D8 fall = all(op.slope);
    const D8 d = distance(closest, limit, squares, product, max(rr, path), min(rr, path));
    // Ended at the far side of the path without a minimum: the height falls through the whole turn.
    const MaskD none = (d >= farthest - all(1e-9)) & (limit >= farthest);
    const D8 cosine = (squares - d * d) / (all(2) * product);
    const D8 psi = angle_of(sqrt(max(all(1) - cosine * cosine, all(0))), cosine);
    D8 theta = angle_of(all(op.over_half ? -1 : 1) * (all(op.cos) * y - all(op.sin) * x),
                        all(op.cos) * x + all(op.sin) * y);
    theta = select(theta < all(0), theta + all(kTurn), theta);
    const D8 first = theta + psi;
    const D8 turns = floor((all(op.length) - first) / all(kTurn));
    const D8 phi = first + turns * all(kTurn);
    const MaskD inside = (closest <= all(tool.radius + kEdgeTie_mm)) & (phi >= all(0));
    const D8 z = all(op.z) - fall * phi + surface(min(d * d, all(tool.radius * tool.radius)));
    return select(and_not(inside, none), z, all(kNowhere));
  }

 private:
  static constexpr double kTurn = 6.28318530717958647693;
  /// The last of this many halvings of at most a few hundred mm is less than a nanometre, which the
  /// height, being at its minimum, does not show.
  static constexpr int kHalvings = 30;

  /// Of the cell from the tip where the height is lowest; `limit` if it falls up to there.
  D8 distance(D8 closest, D8 limit, D8 squares, D8 product, D8 wide, D8 narrow) const {
    const D8 fall = all(op.slope);
    switch (tool.kind) {
      case ConvexTool::Kind::kFlat:
        return limit;
      case ConvexTool::Kind::kBall: {
        // With u = d^2: product^2 - (squares - u)^2 / 4 = slope^2 * (R^2 - u), the smaller root.
        const D8 fall2 = fall * fall, r2 = all(tool.radius * tool.radius);
        const D8 root = product * product + fall2 * (squares + fall2 - r2);
        const D8 u = squares + all(2) * fall2 - all(2) * sqrt(max(root, all(0)));
        return select(root > all(0), min(max(sqrt(max(u, all(0))), closest), limit), limit);
      }
      case ConvexTool::Kind::kPieces:
        break;
    }
    // sin(psi)/d grows up to the peak and shrinks from there.
    const D8 peak = min(max(sqrt(max(wide * wide - narrow * narrow, all(0))), closest), limit);
    const MaskD still_falling = falls(peak, squares, product, fall);
    D8 low = select(still_falling, peak, closest);
    D8 high = select(still_falling, limit, peak);
    for (int step = 0; step < kHalvings; ++step) {
      const D8 d = all(0.5) * (low + high);
      const MaskD falling = falls(d, squares, product, fall);
      low = select(falling, d, low);
      high = select(falling, high, d);
    }
    return all(0.5) * (low + high);
  }

  MaskD falls(D8 d, D8 squares, D8 product, D8 fall) const {
    const D8 cosine = (squares - d * d) / (all(2) * product);
    const D8 sine = sqrt(max(all(1) - cosine * cosine, all(0)));
    return descends(d, product * sine, fall * d);
  }
};

}  // namespace kerf::KERF_LANES_NAMESPACE
