#include "stock/cutter/cutting_shank.h"

#include <algorithm>
#include <cassert>
#include <span>
#include <utility>
#include <vector>

#include "stock/cutter/mill_forms.h"

namespace kerf {
namespace {

/// What is wider by less is as wide: diameters come in inches, too.
constexpr double kWider_mm = 0.001;

/// Neck and shank upward; empty: nobody says where they begin.
std::vector<ToolSection> carried(const Cutter& cutter) {
  if (!cutter.flute_length_mm() || cutter.is_flute_length_assumed()) return {};
  std::vector<ToolSection> sections(cutter.neck().begin(), cutter.neck().end());
  const double from_mm = sections.empty() ? *cutter.flute_length_mm() : sections.back().to_z_mm;
  if (cutter.shank_diameter_mm())
    sections.push_back({*cutter.shank_diameter_mm(), from_mm, from_mm});
  return sections;
}

}  // namespace

bool has_wider_shank(const Cutter& cutter) {
  const double widest = cutter.undercuts() ? *cutter.neck_radius_mm() : cutter.radius_mm();
  return std::ranges::any_of(carried(cutter), [&](const ToolSection& section) {
    return section.diameter_mm / 2 > widest + kWider_mm;
  });
}

std::optional<Cutter> with_cutting_shank(const Cutter& cutter) {
  if (cutter.undercuts() || !has_wider_shank(cutter)) return std::nullopt;
  std::vector<ProfilePiece> pieces(cutter.profile().begin(), cutter.profile().end());
  double r = pieces.back().r1, z = pieces.back().z1;
  for (const ToolSection& section : carried(cutter)) {
    const double radius = section.diameter_mm / 2;
    if (radius <= r + kWider_mm) continue;
    if (section.from_z_mm > z) {
      pieces.push_back(line_piece(r, z, r, section.from_z_mm));
      z = section.from_z_mm;
    }
    pieces.push_back(line_piece(r, z, radius, z));
    r = radius;
  }
  Result<Cutter> made = Cutter::from_profile(cutter.spec() + "+shank", std::move(pieces));
  assert(made);
  Cutter& wider = made.value();
  wider.set_flute_length_mm(*cutter.flute_length_mm());
  if (cutter.shank_diameter_mm()) wider.set_shank_diameter_mm(*cutter.shank_diameter_mm());
  wider.set_neck({cutter.neck().begin(), cutter.neck().end()});
  wider.set_holder({cutter.holder().begin(), cutter.holder().end()});
  if (cutter.teeth()) wider.set_teeth(*cutter.teeth());
  wider.set_edge_traits(cutter.edge_traits());
  return wider;
}

}  // namespace kerf
