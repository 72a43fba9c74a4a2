#include "stock/cutter/cutter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/portable_math.h"
#include "base/translate.h"

namespace kerf {
namespace {

using Kind = ProfilePiece::Kind;

/// Ends of neighbouring pieces may differ by this much, and so may an arc's ends from its circle:
/// one nanometre, far below what a stock model can hold, far above the rounding of decimals in mm.
constexpr double kJoinTolerance_mm = 1e-6;
/// No coordinate of a real cutter is beyond it; keeps every square in the formulas well inside
/// double.
constexpr double kMaxProfile_mm = 1e4;
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
    return trf("the arc radius is {}; must be above 0 and at most {} (mm)", arc.radius,
               kMaxArcRadius_mm);
  }
  for (const bool outer : {false, true}) {
    const double r = outer ? arc.r1 : arc.r0;
    const double z = outer ? arc.z1 : arc.z0;
    const double distance = portable::hypot(r - arc.center_r, z - arc.center_z);
    if (std::abs(distance - arc.radius) > kJoinTolerance_mm) {
      return trf("the {} end is {} mm from the centre, but the arc radius is {} mm",
                 outer ? tr("outer") : tr("inner"), distance, arc.radius);
    }
    if (arc.convex ? z > arc.center_z + kJoinTolerance_mm : z < arc.center_z - kJoinTolerance_mm) {
      return trf("the arc turns back past the {} end; split or shorten it",
                 outer ? tr("outer") : tr("inner"));
    }
  }
  return "";
}

/// What is wrong with the ends of a piece and with its join to (r, z), the end of the one before;
/// or "".
std::string ends_fault(const ProfilePiece& piece, double r, double z) {
  for (const double value : {piece.r0, piece.z0, piece.r1, piece.z1}) {
    if (!within(value, kMaxProfile_mm)) {
      return trf("{} is not allowed; coordinates are at most {} mm", value, kMaxProfile_mm);
    }
  }
  if (portable::hypot(piece.r0 - r, piece.z0 - z) > kJoinTolerance_mm) {
    return trf("starts at R{} Z{}, but must start at R{} Z{}", piece.r0, piece.z0, r, z);
  }
  if (portable::hypot(piece.r1 - piece.r0, piece.z1 - piece.z0) <= kJoinTolerance_mm) {
    return tr("has no length");
  }
  return "";
}

/// What is wrong with a piece of the lower side; or "".
std::string piece_fault(const ProfilePiece& piece, double r, double z) {
  std::string fault = ends_fault(piece, r, z);
  if (!fault.empty()) return fault;
  if (piece.r1 < piece.r0 - kJoinTolerance_mm) {
    return trf("the radius falls from {} to {} mm; it must not fall from the tip upward", piece.r0,
               piece.r1);
  }
  return piece.kind == Kind::kArc ? arc_fault(piece) : "";
}

/// As the lower side sees it: from the neck outward, upside down.
ProfilePiece turned_over(const ProfilePiece& piece) {
  ProfilePiece turned = piece;
  turned.r0 = piece.r1;
  turned.z0 = -piece.z1;
  turned.r1 = piece.r0;
  turned.z1 = -piece.z0;
  turned.center_z = -piece.center_z;
  return turned;
}

/// What is wrong with a piece of the upper side; or "".
std::string upper_piece_fault(const ProfilePiece& piece, double r, double z) {
  std::string fault = ends_fault(piece, r, z);
  if (!fault.empty()) return fault;
  if (piece.r1 > piece.r0 + kJoinTolerance_mm) {
    return trf("the radius rises from {} to {} mm; above the head it must not rise again", piece.r0,
               piece.r1);
  }
  if (piece.z1 < piece.z0 - kJoinTolerance_mm) {
    return trf("the height falls from {} to {} mm; the upper side must not fall", piece.z0,
               piece.z1);
  }
  if (piece.kind != Kind::kArc) return "";
  const bool passes_side = piece.convex ? piece.r1 < piece.center_r - kJoinTolerance_mm
                                        : piece.r0 > piece.center_r + kJoinTolerance_mm;
  if (passes_side) return tr("the arc turns back downward; split or shorten it");
  return arc_fault(turned_over(piece));
}

}  // namespace

Result<Cutter> Cutter::from_profile(std::string spec, std::vector<ProfilePiece> pieces) {
  if (pieces.empty()) return Error{tr("profile: has no pieces; at least one is needed")};
  double r = 0;
  double z = pieces.front().z0;
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    ProfilePiece& piece = pieces[i];
    const std::string fault = piece_fault(piece, r, z);
    if (!fault.empty()) return Error{trf("profile piece {}: {}", i + 1, fault)};
    // Join exactly: a gap within the tolerance would leave a ring without height.
    piece.r0 = r;
    piece.z0 = z;
    piece.r1 = std::max(piece.r1, r);
    r = piece.r1;
    z = piece.z1;
    lowest = std::min(lowest, lowest_mm(piece));
  }
  if (std::abs(lowest) > kJoinTolerance_mm) {
    return Error{trf("profile: the lowest point is at Z{}; it must be at Z0, the tip", lowest)};
  }
  if (r <= kJoinTolerance_mm) return Error{tr("profile: the last radius is 0; it must be above 0")};
  Cutter cutter;
  cutter.spec_ = std::move(spec);
  cutter.pieces_ = std::move(pieces);
  return cutter;
}

Cutter Cutter::from_insert(std::string spec, InsertOutline outline, InsertTip tip) {
  ProfilePiece flat;
  flat.r1 = outline_reach_mm(outline);
  Cutter cutter;
  cutter.spec_ = std::move(spec);
  cutter.pieces_ = {flat};
  cutter.insert_ = std::make_shared<const InsertOutline>(std::move(outline));
  cutter.insert_tip_ = tip;
  return cutter;
}

Done Cutter::set_upper_profile(std::vector<ProfilePiece> pieces) {
  if (pieces.empty()) return Error{tr("upper profile: has no pieces; at least one is needed")};
  double r = radius_mm();
  double z = pieces_.back().z1;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    ProfilePiece& piece = pieces[i];
    const std::string fault = upper_piece_fault(piece, r, z);
    if (!fault.empty()) return Error{trf("upper profile piece {}: {}", i + 1, fault)};
    piece.r0 = r;
    piece.z0 = z;
    piece.r1 = std::min(piece.r1, r);
    piece.z1 = std::max(piece.z1, z);
    r = piece.r1;
    z = piece.z1;
  }
  if (r <= kJoinTolerance_mm || r >= radius_mm() - kJoinTolerance_mm) {
    return Error{
        trf("upper profile: the neck has radius {}; must be above 0 and below the head's, {} (mm)",
            r, radius_mm())};
  }
  upper_pieces_ = std::move(pieces);
  neck_radius_mm_ = r;
  return std::monostate{};
}

double Cutter::upper_height_mm(double r) const {
  r = std::max(std::abs(r), neck_radius_mm_.value_or(0));
  double height = -std::numeric_limits<double>::infinity();
  for (const ProfilePiece& piece : upper_pieces_) {
    if (r < piece.r1 || r > piece.r0) continue;
    height = std::max(height, -piece_height_mm(turned_over(piece), r));
  }
  return height;
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
