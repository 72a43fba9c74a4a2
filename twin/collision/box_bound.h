// twin/collision/box_bound.h - how far bodies are apart at least, by boxes: a bound that costs next
// to nothing.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "stock/stock_model.h"
#include "twin/collision/solid.h"

namespace kerf {

/// A solid as a few boxes that hold all of it: those of its pieces, or of parts of its tree.
class SolidBoxes {
 public:
  static constexpr std::size_t kMost = 16;
  explicit SolidBoxes(const Solid& solid);
  /// The solid is no nearer than this.
  double gap_mm(const Box& box) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Box& own : boxes_) least = std::min(least, box_gap_mm(own, box));
    return least;
  }

 private:
  std::vector<Box> boxes_;
};

/// Around the tip's way, in a frame. nullopt: the tool does not stand along that frame's Z
/// throughout, or goes on an arc about another axis.
std::optional<Box> upright_tip_box(const CutMove& move, const Pose& frame_from_workpiece);

}  // namespace kerf
