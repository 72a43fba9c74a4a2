// Which move has made which edge of a turned part.
#include <algorithm>

#include "stock/turning/turned_part.h"

namespace kerf {

using turning::Contour;
using turning::Point;

void TurnedPart::cut_marked(std::uint64_t id) {
  const auto mark = static_cast<std::uint32_t>(
      std::min<std::uint64_t>(id, MeshPatch::kNotCut - std::uint64_t{1}));
  if (scratch_.marked_cut.look(*marked_, scratch_.swept)) scratch_.marked_cut.apply(*marked_, mark);
}

void TurnedPart::keep_cut_ids(bool keep) {
  marked_.reset();
  if (keep) {
    turning::ContourBuilder builder;
    marked_.emplace();
    for (const Contour& contour : contours_) {
      for (const Point& p : contour.ring()) builder.append(p, MeshPatch::kNotCut);
      marked_->push_back(builder.close());
    }
  }
  touch_all();
}

std::optional<std::uint32_t> TurnedPart::cut_id_at(const Vec2& zr_mm, double angle_rad,
                                                   double within_mm) const {
  if (!marked_ || threads_.empty()) return cut_id_at(zr_mm, within_mm);
  TurnedPart flat = *this;
  flat.threads_.carve(angle_rad / (2 * kPi), zr_mm.x - within_mm, zr_mm.x + within_mm,
                      flat.scratch_.cut, *flat.marked_);
  return flat.cut_id_at(zr_mm, within_mm);
}

std::optional<std::uint32_t> TurnedPart::cut_id_at(const Vec2& zr_mm, double within_mm) const {
  if (!marked_) return std::nullopt;
  /// As near as doubles tell.
  constexpr double kEqual_mm = 1e-9;
  double nearest = within_mm;
  std::uint32_t id = MeshPatch::kNotCut;
  for (const Contour& contour : *marked_) {
    turning::each_edge(contour, [&](const Point& a, const Point& b, std::uint32_t mark) {
      if (a.Y == 0 && b.Y == 0) return;  // the axis is no surface
      const double off = turning::distance_to_edge_mm(zr_mm, turning::to_mm(a), turning::to_mm(b));
      if (off > nearest + kEqual_mm) return;
      id = off < nearest - kEqual_mm ? mark : std::min(id, mark);
      nearest = std::min(nearest, off);
    });
  }
  if (id == MeshPatch::kNotCut) return std::nullopt;
  return id;
}

}  // namespace kerf
