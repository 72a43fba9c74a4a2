#include "twin/machine/torch_moves.h"

#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// Circles of a hole that is wider than two kerfs overlap by a tenth of the kerf: what lies between
/// them must not stay, whatever the rounding.
constexpr double kCircleStep = 0.9;
/// Holes that are wider than the kerf by less are as wide as the kerf: the sheet's own step.
constexpr double kSameWidth_mm = 1e-4;
/// A hole has no more circles than this: a pierce diameter that wants more is a slip of the pen,
/// and must not take hours.
constexpr int kMostCircles = 100;

CutMove circle(const Vec3& center_mm, double radius_mm, std::uint64_t id) {
  CutMove move;
  move.from_mm = move.to_mm = center_mm + Vec3(radius_mm, 0, 0);
  move.arc = CutArc{center_mm, {0, 0, 1}, 2 * kPi};
  move.id = id;
  return move;
}

CutMove spot(const Vec3& place_mm, std::uint64_t id) {
  CutMove move;
  move.from_mm = move.to_mm = place_mm;
  move.id = id;
  return move;
}

}  // namespace

bool TorchMoves::moves_or_dwells(const Motion& m) {
  return m.kind == MotionKind::kTraverse || m.kind == MotionKind::kDwell || is_feed(m);
}

void TorchMoves::append_hole(const Vec3& place_mm, double kerf_mm, std::uint64_t id,
                             std::vector<CutMove>& out) const {
  double radius = (pierce_mm_ - kerf_mm) / 2;
  for (int i = 0; i < kMostCircles; ++i, radius -= kCircleStep * kerf_mm) {
    if (radius <= kSameWidth_mm / 2) {
      out.push_back(spot(place_mm, id));
      return;
    }
    out.push_back(circle(place_mm, radius, id));
    if (radius <= kerf_mm / 2) return;  // its kerf covers the middle
  }
}

void TorchMoves::append(const Motion& m, bool pierces, const Cutter& kerf, std::uint64_t id,
                        std::vector<CutMove>& out) const {
  const double kerf_mm = 2 * kerf.radius_mm();
  const bool dwells = m.kind == MotionKind::kDwell;
  if (pierces && (dwells || pierce_mm_ > kerf_mm + kSameWidth_mm)) {
    append_hole(m.from_mm, kerf_mm, id, out);
  }
  if (!dwells) out.push_back(cut_move_from(m, id));
}

}  // namespace kerf
