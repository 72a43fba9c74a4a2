#include "twin/scene/tool_shape.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string_view>
#include <vector>

namespace kerf {
namespace {

/// Arcs of a profile are drawn in steps of this angle.
constexpr double kArcStep_rad = 5.0 * kPi / 180.0;
/// Where nothing is known.
constexpr double kFlutesPerDiameter = 2.0;
constexpr double kShankPerDiameter = 2.0;

ProfilePoint point(double radius_mm, double height_mm) {
  return {static_cast<float>(radius_mm), static_cast<float>(height_mm)};
}

void add_arc(const ProfilePiece& piece, std::vector<ProfilePoint>& outline) {
  const double begin = std::atan2(piece.z0 - piece.center_z, piece.r0 - piece.center_r);
  const double end = std::atan2(piece.z1 - piece.center_z, piece.r1 - piece.center_r);
  double turn = end - begin;
  // Outward and upward: convex arcs run counter-clockwise in (r, z), hollow ones clockwise.
  if (piece.convex && turn < 0) turn += 2 * kPi;
  if (!piece.convex && turn > 0) turn -= 2 * kPi;
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(turn) / kArcStep_rad)));
  for (int i = 1; i < steps; ++i) {
    const double angle = begin + turn * i / steps;
    outline.push_back(point(piece.center_r + piece.radius * std::cos(angle),
                            piece.center_z + piece.radius * std::sin(angle)));
  }
  outline.push_back(point(piece.r1, piece.z1));
}

/// Insert and holder: thickness, and how much lower the holder's face lies.
constexpr double kInsert_mm = 5, kHolder_mm = 20, kBelowFace_mm = 0.2;

glm::vec2 plate_point(const Vec2& zx) { return glm::vec2(zx); }

}  // namespace

ToolPlate plate_of(const InsertPart& part) {
  ToolPlate plate;
  const auto is_cutting = [](InsertSide side) { return side < InsertSide::kBody; };
  bool has_edge = false;
  Vec2 from = part.back().end_mm;
  for (const InsertEdge& edge : part) {
    const bool cuts = is_cutting(edge.side);
    has_edge = has_edge || cuts;
    int steps = 1;
    if (edge.center_mm) {
      const Vec2 a = from - *edge.center_mm, b = edge.end_mm - *edge.center_mm;
      double turn = std::atan2(a.x * b.y - a.y * b.x, glm::dot(a, b));
      if (turn <= 0) turn += 2 * kPi;
      steps = std::max(1, static_cast<int>(std::ceil(turn / kArcStep_rad)));
      for (int i = 0; i < steps; ++i) {
        const double angle = turn * i / steps;
        const double c = std::cos(angle), s = std::sin(angle);
        plate.corners.push_back(
            {plate_point(*edge.center_mm + Vec2(c * a.x - s * a.y, s * a.x + c * a.y)), cuts});
      }
    } else {
      plate.corners.push_back({plate_point(from), cuts});
    }
    from = edge.end_mm;
  }
  plate.is_holder = !has_edge;
  const double high_mm = has_edge ? 0 : -kBelowFace_mm;
  plate.high_y_mm = static_cast<float>(high_mm);
  plate.low_y_mm = static_cast<float>(high_mm - (has_edge ? kInsert_mm : kHolder_mm));
  return plate;
}

std::shared_ptr<const ToolShape> tool_shape_of(const Cutter& cutter,
                                               std::span<const ToolSection> spindle,
                                               double nose_z_mm) {
  auto shape = std::make_shared<ToolShape>();
  if (cutter.insert()) {
    for (const InsertPart& part : cutter.insert()->parts) shape->plates.push_back(plate_of(part));
    return shape;
  }
  shape->cutter.push_back(point(0, 0));
  for (const ProfilePiece& piece : cutter.profile()) {
    if (piece.kind == ProfilePiece::Kind::kArc) {
      add_arc(piece, shape->cutter);
    } else {
      shape->cutter.push_back(point(piece.r1, piece.z1));
    }
  }
  const double radius_mm = cutter.neck_radius_mm().value_or(cutter.radius_mm());
  const double profile_top_mm = cutter.profile().back().z1;
  const double flutes_mm = std::max(
      profile_top_mm, cutter.flute_length_mm().value_or(std::max(
                          profile_top_mm * 1.05, 2 * cutter.radius_mm() * kFlutesPerDiameter)));
  if (cutter.neck_radius_mm()) shape->cutter.push_back(point(radius_mm, profile_top_mm));
  shape->cutter.push_back(point(radius_mm, flutes_mm));
  const double shank_mm = cutter.shank_diameter_mm().value_or(2 * radius_mm) / 2;
  double shank_top_mm = flutes_mm + 2 * shank_mm * kShankPerDiameter;
  if (!cutter.holder().empty()) {
    shank_top_mm = std::max(flutes_mm, cutter.holder().front().from_z_mm);
  }
  double neck_top_mm = flutes_mm;
  for (const ToolSection& section : cutter.neck()) {
    shape->shank.push_back(point(section.diameter_mm / 2, neck_top_mm));
    neck_top_mm = std::max(neck_top_mm, section.to_z_mm);
    shape->shank.push_back(point(section.diameter_mm / 2, neck_top_mm));
  }
  shank_top_mm = std::max(shank_top_mm, neck_top_mm);
  if (shank_top_mm > flutes_mm) {
    shape->shank.push_back(point(shank_mm, neck_top_mm));
    shape->shank.push_back(point(shank_mm, shank_top_mm));
  }
  for (const ToolSection& section : cutter.holder()) {
    shape->holder.push_back(point(section.diameter_mm / 2, section.from_z_mm));
    shape->holder.push_back(point(section.diameter_mm / 2, section.to_z_mm));
  }
  const double top_mm = cutter.holder().empty() ? 0 : cutter.holder().back().to_z_mm;
  const double nose_mm = std::max(top_mm, nose_z_mm);
  for (const ToolSection& section : spindle) {
    if (nose_mm <= 0) break;  // it is not known where it is
    shape->spindle.push_back(point(section.diameter_mm / 2, nose_mm + section.from_z_mm));
    shape->spindle.push_back(point(section.diameter_mm / 2, nose_mm + section.to_z_mm));
  }
  return shape;
}

std::string tool_name_of(const Cutter& cutter) {
  // "bull:10:2:flute=22": what is named (flute=..., shank=...) is not what people call a tool by.
  std::string name;
  std::string_view rest = cutter.spec();
  while (!rest.empty()) {
    const std::string_view part = rest.substr(0, rest.find(':'));
    rest.remove_prefix(std::min(rest.size(), part.size() + 1));
    if (part.find('=') != std::string_view::npos) break;
    if (!name.empty()) name += ' ';
    name += part;
  }
  return name;
}

}  // namespace kerf
