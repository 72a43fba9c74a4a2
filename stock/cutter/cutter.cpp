#include "stock/cutter/cutter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kerf {
namespace {

using Kind = ProfilePiece::Kind;

/// Ends of neighbouring pieces may differ by this much, and so may an arc's ends from its circle:
/// one nanometre, far below what a stock model can hold, far above the rounding of decimals in mm.
constexpr double kJoinTolerance_mm = 1e-6;
/// No coordinate of a real cutter is beyond it; keeps every square in the formulas well inside
/// double.
constexpr double kMaxCoordinate_mm = 1e4;
constexpr double kMaxArcRadius_mm = 1e6;

bool within(double value, double limit) { return std::isfinite(value) && std::abs(value) <= limit; }

/// Height of the arc at radius r. Measured from the arc's lowest (highest) point, so that nothing
/// cancels near it.
double arc_height_mm(const ProfilePiece& arc, double r) {
  const double d = r - arc.center_r;
  const double root = std::sqrt(std::max(0.0, (arc.radius - d) * (arc.radius + d)));
  if (!arc.convex) return arc.center_z + root;
  return (arc.center_z - arc.radius) + std::min(arc.radius, d * d / (arc.radius + root));
}

double piece_height_mm(const ProfilePiece& piece, double r) {
  if (piece.r0 == piece.r1) return std::min(piece.z0, piece.z1);
  if (piece.kind == Kind::kArc) return arc_height_mm(piece, r);
  return piece.z0 + (piece.z1 - piece.z0) * ((r - piece.r0) / (piece.r1 - piece.r0));
}

double lowest_mm(const ProfilePiece& piece) {
  const bool passes_bottom = piece.kind == Kind::kArc && piece.convex &&
                             piece.r0 < piece.center_r && piece.center_r < piece.r1;
  return passes_bottom ? piece.center_z - piece.radius : std::min(piece.z0, piece.z1);
}

/// What is wrong with an arc, or "".
std::string arc_fault(const ProfilePiece& arc) {
  if (!within(arc.center_r, kMaxArcRadius_mm) || !within(arc.center_z, kMaxArcRadius_mm) ||
      !within(arc.radius, kMaxArcRadius_mm) || arc.radius <= 0) {
    return fmt::format("the arc radius is {}; must be above 0 and at most {} (mm)", arc.radius,
                       kMaxArcRadius_mm);
  }
  for (const bool outer : {false, true}) {
    const double r = outer ? arc.r1 : arc.r0;
    const double z = outer ? arc.z1 : arc.z0;
    const double distance = std::hypot(r - arc.center_r, z - arc.center_z);
    if (std::abs(distance - arc.radius) > kJoinTolerance_mm) {
      return fmt::format("the {} end is {} mm from the centre, but the arc radius is {} mm",
                         outer ? "outer" : "inner", distance, arc.radius);
    }
    if (arc.convex ? z > arc.center_z + kJoinTolerance_mm : z < arc.center_z - kJoinTolerance_mm) {
      return fmt::format("the arc turns back past the {} end; split or shorten it",
                         outer ? "outer" : "inner");
    }
  }
  return "";
}

/// What is wrong with a piece by itself and with its join to (r, z), the end of the one before; or
/// "".
std::string piece_fault(const ProfilePiece& piece, double r, double z) {
  for (const double value : {piece.r0, piece.z0, piece.r1, piece.z1}) {
    if (!within(value, kMaxCoordinate_mm)) {
      return fmt::format("{} is not allowed; coordinates are at most {} mm", value,
                         kMaxCoordinate_mm);
    }
  }
  if (std::hypot(piece.r0 - r, piece.z0 - z) > kJoinTolerance_mm) {
    return fmt::format("starts at R{} Z{}, but must start at R{} Z{}", piece.r0, piece.z0, r, z);
  }
  if (piece.r1 < piece.r0 - kJoinTolerance_mm) {
    return fmt::format("the radius falls from {} to {} mm; it must not fall from the tip upward",
                       piece.r0, piece.r1);
  }
  if (std::hypot(piece.r1 - piece.r0, piece.z1 - piece.z0) <= kJoinTolerance_mm) {
    return "has no length";
  }
  return piece.kind == Kind::kArc ? arc_fault(piece) : "";
}

}  // namespace

Result<Cutter> Cutter::from_profile(std::string spec, std::vector<ProfilePiece> pieces) {
  if (pieces.empty()) return Error{"profile: has no pieces; at least one is needed"};
  double r = 0;
  double z = pieces.front().z0;
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    ProfilePiece& piece = pieces[i];
    const std::string fault = piece_fault(piece, r, z);
    if (!fault.empty()) return Error{fmt::format("profile piece {}: {}", i + 1, fault)};
    // Join exactly: a gap within the tolerance would leave a ring without height.
    piece.r0 = r;
    piece.z0 = z;
    piece.r1 = std::max(piece.r1, r);
    r = piece.r1;
    z = piece.z1;
    lowest = std::min(lowest, lowest_mm(piece));
  }
  if (std::abs(lowest) > kJoinTolerance_mm) {
    return Error{
        fmt::format("profile: the lowest point is at Z{}; it must be at Z0, the tip", lowest)};
  }
  if (r <= kJoinTolerance_mm) return Error{"profile: the last radius is 0; it must be above 0"};
  Cutter cutter;
  cutter.spec_ = std::move(spec);
  cutter.pieces_ = std::move(pieces);
  return cutter;
}

double Cutter::height_mm(double r) const {
  r = std::abs(r);
  double height = std::numeric_limits<double>::infinity();
  for (const ProfilePiece& piece : pieces_) {
    if (r < piece.r0) break;
    if (r <= piece.r1) height = std::min(height, piece_height_mm(piece, r));
  }
  return height;
}

}  // namespace kerf
