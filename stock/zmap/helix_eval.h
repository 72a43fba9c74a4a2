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
/// one cell the distance is periodic in phi; on each turn the height has one minimum behind the
/// axis (psi in 0..pi), found by bisection over the distance d; the last turn that holds it is the
/// lowest. Ends are caps.
struct HelixEval {
  const ConvexTool& tool;
  const SweepOp& op;
  HelixEval(const ConvexTool& t, const SweepOp& o) : tool(t), op(o) {}
  static D8 all(double x) { return D8::all(x); }

  /// f'(d) * a >= b * 1, kept finite where f' is infinite.
  MaskD descends(D8 d, D8 a, D8 b) const {
    D8 rise = all(0), run = all(1);
    if (tool.kind == ConvexTool::Kind::kBall) {
      rise = d;
      run = sqrt(max(all(tool.radius * tool.radius) - d * d, all(0)));
    } else if (tool.kind == ConvexTool::Kind::kPieces) {
      for (int i = 0; i < tool.piece_count; ++i) {
        const ToolPiece& p = tool.pieces[i];
        const MaskD here = d >= all(p.r0);
        const D8 y = d - all(p.center_r);
        rise = select(here, p.arc ? y : all(p.slope), rise);
        run =
            select(here, p.arc ? sqrt(max(all(p.radius * p.radius) - y * y, all(0))) : all(1), run);
      }
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
    // sin(psi)/d grows up to d_peak and shrinks from there.
    const D8 wide = max(rr, path), narrow = min(rr, path);
    const D8 peak = min(max(sqrt(max(wide * wide - narrow * narrow, all(0))), closest), limit);
    const MaskD still_falling = falls(peak, squares, product, fall);
    D8 low = select(still_falling, peak, closest);
    D8 high = select(still_falling, limit, peak);
    for (int step = 0; step < 50; ++step) {
      const D8 d = all(0.5) * (low + high);
      const MaskD falling = falls(d, squares, product, fall);
      low = select(falling, d, low);
      high = select(falling, high, d);
    }
    const D8 d = all(0.5) * (low + high);
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
  MaskD falls(D8 d, D8 squares, D8 product, D8 fall) const {
    const D8 cosine = (squares - d * d) / (all(2) * product);
    const D8 sine = sqrt(max(all(1) - cosine * cosine, all(0)));
    return descends(d, product * sine, fall * d);
  }
};

}  // namespace kerf::KERF_LANES_NAMESPACE
