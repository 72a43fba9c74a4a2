#include "stock/zmap/mmap/headed_tool.h"

#include <algorithm>
#include <cmath>

#include "base/portable_math.h"
#include "stock/zmap/cutter_components.h"
#include "stock/zmap/path_builder.h"

namespace kerf {
namespace {

/// Steps that arc_points() is asked for, and how many of them make a piece below half a turn.
constexpr double kHelixStep_rad = 0.5;
constexpr int kStepsPerPiece = 6;

/// What of a lower side lies within `radius` of the axis.
std::vector<ProfilePiece> within(std::span<const ProfilePiece> profile, double radius) {
  std::vector<ProfilePiece> out;
  for (const ProfilePiece& piece : profile) {
    if (piece.r0 >= radius) break;
    ProfilePiece& part = out.emplace_back(piece);
    if (part.r1 <= radius) continue;
    const double along = (radius - part.r0) / (part.r1 - part.r0);
    part.z1 = part.z0 + along * (part.z1 - part.z0);
    part.r1 = radius;
    if (part.kind == ProfilePiece::Kind::kArc) {
      const double d = radius - part.center_r;
      const double rise = std::sqrt(std::max(0.0, part.radius * part.radius - d * d));
      part.z1 = part.center_z + (part.convex ? -rise : rise);
    }
  }
  return out;
}

/// The upper side as the lower side of a tool that is turned over: from the axis outward.
std::vector<ProfilePiece> turned_over(std::span<const ProfilePiece> upper) {
  std::vector<ProfilePiece> out;
  for (auto piece = upper.rbegin(); piece != upper.rend(); ++piece) {
    ProfilePiece& turned = out.emplace_back(*piece);
    turned.r0 = piece->r1;
    turned.z0 = -piece->z1;
    turned.r1 = piece->r0;
    turned.z1 = -piece->z0;
    turned.center_z = -piece->center_z;
  }
  ProfilePiece& inner = out.front();
  const bool is_ball =
      inner.kind == ProfilePiece::Kind::kArc && inner.convex && std::abs(inner.center_r) < 1e-12;
  if (is_ball) {
    // Where the neck is it does not matter how high the head is: a whole ball is cut fastest.
    inner.r0 = 0;
    inner.z0 = inner.center_z - inner.radius;
  } else {
    ProfilePiece foot;
    foot.z0 = foot.z1 = inner.z0;
    foot.r1 = inner.r0;
    out.insert(out.begin(), foot);
  }
  return out;
}

CutMove straight(const CutMove& of, const Vec3& from, const Vec3& to) {
  CutMove part = of;
  part.arc.reset();
  part.from_mm = from;
  part.to_mm = to;
  return part;
}

std::vector<CutMove> helix_pieces(const CutMove& move) {
  const double sweep = std::abs(move.arc->sweep_rad);
  const int pieces =
      std::max(1, static_cast<int>(std::ceil(sweep / (kHelixStep_rad * kStepsPerPiece))));
  const std::vector<Vec3> points = arc_points(move, pieces * kStepsPerPiece);
  std::vector<CutMove> out;
  for (std::size_t i = kStepsPerPiece - 1; i < points.size(); i += kStepsPerPiece) {
    CutMove& part = out.emplace_back(move);
    part.arc->sweep_rad = move.arc->sweep_rad / pieces;
    part.from_mm = out.size() == 1 ? move.from_mm : out[out.size() - 2].to_mm;
    part.to_mm = points[i];
  }
  return out;
}

}  // namespace

HeadedTool headed_tool(const Cutter& cutter) {
  HeadedTool tool;
  tool.radius_mm = cutter.radius_mm();
  if (!cutter.undercuts()) {
    tool.rays = convex_components(cutter.profile());
    return tool;
  }
  tool.rays = convex_components(within(cutter.profile(), *cutter.neck_radius_mm()));
  tool.lower = convex_components(cutter.profile());
  tool.upper = convex_components(turned_over(cutter.upper_profile()));
  return tool;
}

std::vector<CutMove> head_sweeps(const CutMove& move, double radius_mm) {
  if (!move.arc) return {move};
  if (is_circle_in_xy(move)) {
    if (std::abs(move.to_mm.z - move.from_mm.z) < 1e-9) return {move};
    const Vec3 arm = move.from_mm - move.arc->center_mm;
    if (portable::hypot(arm.x, arm.y) >= radius_mm + kArcRadiusSlack_mm) return helix_pieces(move);
  }
  std::vector<CutMove> out;
  Vec3 from = move.from_mm;
  for (const Vec3& to : arc_chord_points(move, kChordTolerance_mm)) {
    out.push_back(straight(move, from, to));
    from = to;
  }
  return out;
}

CutMove turned_over(const CutMove& move) {
  CutMove turned = move;
  turned.from_mm.z = -move.from_mm.z;
  turned.to_mm.z = -move.to_mm.z;
  if (turned.arc) turned.arc->center_mm.z = -move.arc->center_mm.z;
  return turned;
}

}  // namespace kerf
