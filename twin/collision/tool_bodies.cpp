#include "twin/collision/tool_bodies.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/portable_math.h"
#include "base/translate.h"

namespace kerf {
namespace {

using Hull = std::vector<RoundedDisc>;
constexpr double kChord_mm = 0.002;
constexpr int kMostChords = 256;
/// Of a tool of which nothing but its cutting part is known.
constexpr double kKnownDiameters = 4;

/// Corners of a piece of a profile from its start to its end; arcs as chords.
std::vector<Vec2> corners_of(const ProfilePiece& piece) {
  std::vector<Vec2> out{{piece.r0, piece.z0}};
  if (piece.kind == ProfilePiece::Kind::kArc && piece.radius > 0) {
    const double from = portable::atan2(piece.z0 - piece.center_z, piece.r0 - piece.center_r);
    double sweep = portable::atan2(piece.z1 - piece.center_z, piece.r1 - piece.center_r) - from;
    if (sweep > kPi) sweep -= 2 * kPi;
    if (sweep < -kPi) sweep += 2 * kPi;
    const double step = 2 * portable::acos(std::max(1 - kChord_mm / piece.radius, -1.0));
    const int chords =
        std::clamp(static_cast<int>(std::ceil(std::abs(sweep) / step)), 1, kMostChords);
    for (int i = 1; i < chords; ++i) {
      const double angle = from + sweep * i / chords;
      out.emplace_back(piece.center_r + piece.radius * portable::cos(angle),
                       piece.center_z + piece.radius * portable::sin(angle));
    }
  }
  out.emplace_back(piece.r1, piece.z1);
  return out;
}

/// A quarter of a circle, or less of one, that the hull of a rounded disc has as it is: it begins
/// right below its middle.
bool is_rounded_edge(const ProfilePiece& piece) {
  return piece.kind == ProfilePiece::Kind::kArc && piece.convex &&
         std::abs(piece.r0 - piece.center_r) < 1e-9 && std::abs(piece.z1 - piece.center_z) < 1e-9 &&
         piece.z0 < piece.center_z;
}

/// What of the tool lies under `top_mm`, of pieces that go outward and upward.
void add_lower_side(std::span<const ProfilePiece> pieces, double top_mm, std::vector<Hull>& out) {
  for (const ProfilePiece& piece : pieces) {
    if (is_rounded_edge(piece)) {
      out.push_back({{piece.center_r, piece.center_z, piece.radius},
                     {piece.r1, std::max(top_mm, piece.z1), 0}});
      continue;
    }
    const std::vector<Vec2> corners = corners_of(piece);
    const bool bulges = piece.kind == ProfilePiece::Kind::kArc && piece.convex;
    Hull hull;
    for (std::size_t i = 1; i < corners.size(); ++i) {
      if (hull.empty()) hull.push_back({corners[i - 1].x, corners[i - 1].y, 0});
      hull.push_back({corners[i].x, corners[i].y, 0});
      if (bulges && i + 1 < corners.size()) continue;
      hull.push_back({corners[i].x, std::max(top_mm, corners[i].y), 0});
      out.push_back(std::move(hull));
      hull.clear();
    }
  }
}

/// The upper side of a head: frustums, from its widest place to the neck.
void add_upper_side(std::span<const ProfilePiece> pieces, std::vector<Hull>& out) {
  for (const ProfilePiece& piece : pieces) {
    const std::vector<Vec2> corners = corners_of(piece);
    for (std::size_t i = 1; i < corners.size(); ++i) {
      // All of the tool between two heights, as far in as its axis.
      out.push_back({{corners[i - 1].x, corners[i - 1].y, 0}, {corners[i].x, corners[i].y, 0}});
    }
  }
}

Hull cylinder(double radius_mm, double from_z_mm, double to_z_mm) {
  return {{radius_mm, from_z_mm, 0}, {radius_mm, to_z_mm, 0}};
}

class Bodies {
 public:
  void add(ToolPart part, const std::vector<Hull>& hulls) {
    double width = 0, low = std::numeric_limits<double>::infinity();
    for (const Hull& hull : hulls) {
      for (const RoundedDisc& disc : hull) {
        width = std::max(width, 2 * (disc.radius_mm + disc.round_mm));
        low = std::min(low, disc.along_mm - disc.round_mm);
      }
    }
    bodies.push_back({part, Solid::of_hulls(hulls), width, low});
  }
  std::vector<ToolBody> bodies;
};

}  // namespace

const char* to_string(ToolPart part) {
  switch (part) {
    case ToolPart::kCutter:
      return "cutter";
    case ToolPart::kShank:
      return "shank";
    case ToolPart::kHolder:
      return "holder";
    case ToolPart::kSpindle:
      break;
  }
  return "spindle";
}

std::string name_of(ToolPart part) {
  switch (part) {
    case ToolPart::kCutter:
      return tr("cutter");
    case ToolPart::kShank:
      return tr("shank");
    case ToolPart::kHolder:
      return tr("holder");
    case ToolPart::kSpindle:
      break;
  }
  return tr("spindle");
}

std::vector<ToolBody> tool_bodies(const Cutter& cutter, std::span<const ToolSection> spindle,
                                  double nose_z_mm) {
  Bodies out;
  const ProfilePiece& widest = cutter.profile().back();
  const double radius = cutter.radius_mm();
  double head_top = widest.z1;
  std::vector<Hull> hulls;
  if (cutter.undercuts() && !cutter.upper_profile().empty())
    head_top = cutter.upper_profile().back().z1;
  const double neck = cutter.neck_radius_mm().value_or(radius);
  const double flutes = std::max(cutter.flute_length_mm().value_or(0), head_top);
  const double known = std::max(flutes, 2 * radius * kKnownDiameters);
  const double holder_z = cutter.holder().empty() ? known : cutter.holder().front().from_z_mm;
  const bool has_shank = cutter.flute_length_mm() && !cutter.is_flute_length_assumed();
  const double cutter_top = has_shank ? std::min(flutes, holder_z) : holder_z;
  if (cutter.undercuts()) {
    add_lower_side(cutter.profile(), widest.z1, hulls);
    add_upper_side(cutter.upper_profile(), hulls);
    if (cutter_top > head_top) hulls.push_back(cylinder(neck, head_top, cutter_top));
  } else {
    add_lower_side(cutter.profile(), std::max(cutter_top, widest.z1), hulls);
  }
  out.add(ToolPart::kCutter, hulls);
  if (has_shank && holder_z > cutter_top) {
    const double width = cutter.shank_diameter_mm().value_or(2 * neck);
    std::vector<Hull> shank;
    double from_z = cutter_top;
    for (const ToolSection& section : cutter.neck()) {
      shank.push_back(cylinder(section.diameter_mm / 2, section.from_z_mm, section.to_z_mm));
      from_z = section.to_z_mm;
    }
    if (holder_z > from_z) shank.push_back(cylinder(width / 2, from_z, holder_z));
    out.add(ToolPart::kShank, shank);
  }
  double top = 0;
  hulls.clear();
  for (const ToolSection& section : cutter.holder()) {
    hulls.push_back(cylinder(section.diameter_mm / 2, section.from_z_mm, section.to_z_mm));
    top = std::max(top, section.to_z_mm);
  }
  if (!hulls.empty()) out.add(ToolPart::kHolder, hulls);
  const double nose_z = std::max(top, nose_z_mm);
  if (spindle.empty() || nose_z <= 0) return std::move(out.bodies);
  hulls.clear();
  for (const ToolSection& section : spindle) {
    hulls.push_back(
        cylinder(section.diameter_mm / 2, nose_z + section.from_z_mm, nose_z + section.to_z_mm));
  }
  out.add(ToolPart::kSpindle, hulls);
  return std::move(out.bodies);
}

}  // namespace kerf
