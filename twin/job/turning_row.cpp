#include "twin/job/turning_row.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "base/portable_math.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"
#include "stock/cutter/insert_shape.h"
#include "stock/cutter/turning_flanks.h"

namespace kerf {
namespace {

/// Noses are sold up to a radius of 2.4 mm, drills from less: wider than this it is no nose.
constexpr double kWidestNose_mm = 5;
constexpr double kDrillPoint_deg = 118;
constexpr int kUsualOrientation = 2;

bool has_flanks(const ToolTableRow& row) {
  return row.front_angle_deg != 0 || row.back_angle_deg != 0;
}

/// A millionth of a millimetre: a table in inches leaves more figures than anybody wrote.
std::string nose_text(double mm) { return number_text(std::round(mm * 1e6) / 1e6); }

/// The orientation whose tip has these flanks behind it: of the eight the one nearest to their
/// middle.
int orientation_behind(const FlankAngles& angles) {
  const double middle = (angles.front_deg + angles.back_deg) / 2 * kRadPerDeg;
  const Vec2 way(portable::cos(middle), portable::sin(middle));
  int best = kUsualOrientation;
  double most = -2;
  for (int orientation = 1; orientation < kOrientations; ++orientation) {
    const double along = glm::dot(glm::normalize(nose_direction(orientation)), way);
    if (along <= most) continue;
    most = along;
    best = orientation;
  }
  return best;
}

TurningFacts facts_of(const ToolTableRow& row) {
  TurningFacts facts;
  facts.nose_diameter_mm = std::abs(row.diameter_mm);
  facts.orientation = row.orientation;
  facts.front_deg = row.front_angle_deg;
  facts.back_deg = row.back_angle_deg;
  return facts;
}

}  // namespace

double table_diameter_mm(const Cutter& cutter) {
  return 2 * (cutter.insert() ? cutter.insert_tip().nose_radius_mm : cutter.radius_mm());
}

std::map<int, TurningFacts> turning_facts(const std::vector<ToolTableRow>& rows) {
  std::map<int, TurningFacts> facts;
  for (const ToolTableRow& row : rows) facts.emplace(row.tool, facts_of(row));
  return facts;
}

std::optional<ShapeText> turning_remark_shape(const ToolTableRow& row) {
  return turning_shape_in_text(row.remark, false, facts_of(row));
}

ShapeText turning_row_shape(const ToolTableRow& row, bool drills) {
  const double diameter = std::abs(row.diameter_mm);
  const bool says_nothing = row.orientation == 0 && !has_flanks(row);
  if (says_nothing && diameter > 0 && (drills || diameter > kWidestNose_mm)) {
    return {fmt::format("drill:{}:{:g}", nose_text(diameter), kDrillPoint_deg), true,
            drills ? tr("Q, I and J are missing in its row of the tool table, and it only goes "
                        "straight down: taken for a drill")
                   : trf("Q, I and J are missing in its row of the tool table, and {:g} mm are no "
                         "nose: taken for a drill",
                         diameter)};
  }
  std::vector<std::string> missing;
  if (!row.has_diameter && diameter == 0) {
    missing.push_back(
        tr("D (twice the nose radius) is missing in its row of the tool table, taken "
           "for sharp"));
  }
  const std::optional<FlankAngles> given =
      has_flanks(row) ? nearest_flanks({row.front_angle_deg, row.back_angle_deg}) : std::nullopt;
  const bool is_pair = given && given->front_deg != given->back_deg;
  int orientation = row.orientation;
  if (orientation == 0) {
    orientation = is_pair ? orientation_behind(*given) : kUsualOrientation;
    missing.push_back(
        trf("Q (orientation) is missing in its row of the tool table, taken as {}", orientation));
  }
  std::string shape = fmt::format("turn:{}:{}", nose_text(diameter / 2), orientation);
  if (orientation != kOrientations) {
    FlankAngles angles{row.front_angle_deg, row.back_angle_deg};
    if (!is_pair || !fits_orientation(*given, orientation)) {
      angles = usual_flanks(orientation);
      missing.push_back(has_flanks(row) ? trf("I{:g} and J{:g} (front and back angle) do not lie "
                                              "behind a nose of orientation "
                                              "{}, taken as {:g} and {:g}",
                                              row.front_angle_deg, row.back_angle_deg, orientation,
                                              angles.front_deg, angles.back_deg)
                                        : trf("I and J (front and back angle) are missing in its "
                                              "row of the tool table, taken "
                                              "as {:g} and {:g}",
                                              angles.front_deg, angles.back_deg));
    }
    shape += fmt::format(":{}:{}", number_text(angles.front_deg), number_text(angles.back_deg));
  }
  return {shape, !missing.empty(), fmt::format("{}", fmt::join(missing, "; "))};
}

}  // namespace kerf
