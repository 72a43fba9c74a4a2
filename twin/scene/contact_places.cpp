#include "twin/scene/contact_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <vector>

#include "base/mesh_patch.h"

namespace kerf {
namespace {

constexpr int kMostBoxes = 600;
constexpr double kPlaceExact_mm = 0.02;
/// So near to both is there: bodies that have just met overlap by micrometres.
constexpr double kThere_mm = 0.01, kGapExact_mm = 0.002;
/// Looked at around the tool's body, so that what hardly touches is met.
constexpr double kAround_mm = 0.5;
/// Depths that differ by less are the same: then the corner nearer to the rim is taken, which an
/// eye beside the tool sees.
constexpr double kSameDepth_mm = 0.02;

Convex convex_of(const std::array<Vec3, 2>& corners) {
  Convex box;
  box.kind = Convex::Kind::kBox;
  box.corners = corners;
  return box;
}

/// Of a still box, given in the workpiece frame, from a solid that lies in it as `pose` says.
double gap_mm(const Solid& solid, const Pose& solid_from_workpiece, const Convex& box,
              double cutoff_mm) {
  const MovingConvex still{box, solid_from_workpiece, solid_from_workpiece};
  return solid.gap_to(still, cutoff_mm, kGapExact_mm).low_mm;
}

/// A part of the workpiece frame in which both bodies may be.
struct Room {
  double gap_mm = 0;  ///< from the farther of the two
  Box box;
  bool operator<(const Room& other) const {
    if (gap_mm != other.gap_mm) return gap_mm > other.gap_mm;
    // Of equals the smaller: it goes down to one place first.
    const Vec3 a = box.size(), b = other.box.size();
    return std::max({a.x, a.y, a.z}) > std::max({b.x, b.y, b.z});
  }
};

}  // namespace

std::optional<Vec3> place_between(const Solid& a, const Pose& a_pose, const Solid& b,
                                  const Pose& b_pose) {
  Box box = box_around(a_pose, a.box_mm());
  const Box other = box_around(b_pose, b.box_mm());
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = std::max(box.min[axis] - kAround_mm, other.min[axis] - kAround_mm);
    box.max[axis] = std::min(box.max[axis] + kAround_mm, other.max[axis] + kAround_mm);
    if (box.min[axis] > box.max[axis]) return std::nullopt;
  }
  const Pose a_from_workpiece = a_pose.inverse(), b_from_workpiece = b_pose.inverse();
  const auto room_of = [&](const Box& part) {
    const std::array<Vec3, 2> corners{part.min, part.max};
    const Convex convex = convex_of(corners);
    constexpr double kFar = std::numeric_limits<double>::infinity();
    const double gap = std::max(gap_mm(a, a_from_workpiece, convex, kFar),
                                gap_mm(b, b_from_workpiece, convex, kFar));
    return Room{gap < kThere_mm ? 0.0 : gap, part};
  };
  std::priority_queue<Room> open;
  open.push(room_of(box));
  for (int count = 0; count < kMostBoxes; ++count) {
    const Room room = open.top();
    const Vec3 size = room.box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    if (size[axis] < kPlaceExact_mm) break;
    open.pop();
    Box low = room.box, high = room.box;
    low.max[axis] = high.min[axis] = 0.5 * (room.box.min[axis] + room.box.max[axis]);
    open.push(room_of(low));
    open.push(room_of(high));
  }
  const Box& found = open.top().box;
  return 0.5 * (found.min + found.max);
}

std::optional<Vec3> place_on_workpiece(const ToolBody& body, const Pose& tool,
                                       const StockModel& stock) {
  const double near_mm = 1.5 * stock.cell_mm();
  Box room = box_around(tool, body.solid->box_mm());
  room = {room.min - Vec3(near_mm), room.max + Vec3(near_mm)};
  const Pose tool_from_workpiece = tool.inverse();
  std::optional<Vec3> best;
  double best_mm = -near_mm, best_r = 0;
  const auto look_at = [&](const Vec3& corner) {
    const Vec3 p = tool_from_workpiece.point(corner);
    const double r = std::hypot(p.x, p.y);
    for (const Convex& piece : body.solid->pieces()) {
      if (piece.discs.empty()) continue;
      const RoundedDisc &low = piece.discs.front(), &high = piece.discs.back();
      const double depth_mm = std::min(
          {p.z - low.along_mm, high.along_mm - p.z, std::max(low.radius_mm, high.radius_mm) - r});
      if (depth_mm < best_mm - kSameDepth_mm) continue;
      if (depth_mm < best_mm + kSameDepth_mm && (best && r <= best_r)) continue;
      best = corner;
      best_mm = std::max(best_mm, depth_mm);
      best_r = r;
    }
  };
  for (std::uint32_t tile = 0; tile < stock.tile_count(); ++tile) {
    if (box_gap_mm(stock.tile_box(tile), room) > 0) continue;
    const MeshPatch patch = stock.patch(tile, 0);
    for (const MeshVertex& vertex : patch.vertices) {
      const Vec3 corner(vertex.position_mm);
      if (box_gap_mm({corner, corner}, room) > 0) continue;
      look_at(corner);
    }
  }
  return best;
}

std::optional<Vec3> place_on_workpiece(const Solid& body, const Pose& pose,
                                       const StockModel& stock) {
  double best_mm = 1.5 * stock.cell_mm();
  Box room = box_around(pose, body.box_mm());
  room = {room.min - Vec3(best_mm), room.max + Vec3(best_mm)};
  const Pose body_from_workpiece = pose.inverse();
  std::optional<Vec3> best;
  for (std::uint32_t tile = 0; tile < stock.tile_count(); ++tile) {
    if (box_gap_mm(stock.tile_box(tile), room) > 0) continue;
    const MeshPatch patch = stock.patch(tile, 0);
    for (const MeshVertex& vertex : patch.vertices) {
      const Vec3 corner(vertex.position_mm);
      if (box_gap_mm({corner, corner}, room) > 0) continue;
      const std::array<Vec3, 2> point{corner, corner};
      const double mm = gap_mm(body, body_from_workpiece, convex_of(point), best_mm);
      if (mm >= best_mm) continue;
      best_mm = mm;
      best = corner;
    }
  }
  return best;
}

}  // namespace kerf
