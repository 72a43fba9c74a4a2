#include "twin/collision/box_bound.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

namespace kerf {
namespace {

/// Of the sines and cosines of a frame that is turned about Z: rounding.
constexpr double kLeaning = 1e-12;

}  // namespace

SolidBoxes::SolidBoxes(const Solid& solid) {
  const auto pieces = solid.pieces();
  if (pieces.size() <= kMost) {
    for (const Convex& piece : pieces) boxes_.push_back(piece.box_mm());
    return;
  }
  // From the top of the tree down, the largest first, as far as there is room.
  const auto nodes = solid.nodes();
  std::vector<std::uint32_t> open{0};
  const auto size_of = [&](std::uint32_t node) {
    return nodes[node].count > 0 ? -1.0 : glm::length(nodes[node].box_mm.size());
  };
  while (open.size() < kMost) {
    const auto largest = std::ranges::max_element(open, {}, size_of);
    const std::uint32_t node = *largest;
    if (nodes[node].count > 0) break;
    *largest = node + 1;
    open.push_back(nodes[node].first);
  }
  for (const std::uint32_t node : open) boxes_.push_back(nodes[node].box_mm);
}

std::optional<Box> upright_tip_box(const CutMove& move, const Pose& frame_from_workpiece) {
  constexpr Vec3 kUp{0, 0, 1};
  const Vec3& up = frame_from_workpiece.rotation[2];
  const bool upright = move.axis_from == kUp && move.axis_to == kUp && up.z > 0 &&
                       std::max(std::abs(up.x), std::abs(up.y)) < kLeaning &&
                       (!move.arc || move.arc->axis == kUp || move.arc->axis == -kUp);
  if (!upright) return std::nullopt;
  Box box;
  box.extend(frame_from_workpiece.point(move.from_mm));
  box.extend(frame_from_workpiece.point(move.to_mm));
  if (!move.arc) return box;
  const Vec3 middle = frame_from_workpiece.point(move.arc->center_mm);
  const Vec3 from = move.from_mm - move.arc->center_mm, to = move.to_mm - move.arc->center_mm;
  const double radius = std::max(glm::length(Vec2(from)), glm::length(Vec2(to)));
  for (int axis = 0; axis < 2; ++axis) {
    box.min[axis] = std::min(box.min[axis], middle[axis] - radius);
    box.max[axis] = std::max(box.max[axis], middle[axis] + radius);
  }
  return box;
}

}  // namespace kerf
