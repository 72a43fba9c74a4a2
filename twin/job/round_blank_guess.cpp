#include "twin/job/round_blank_guess.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

constexpr double kWholeTurn_deg = 360 - 1e-6;
/// The tip's distance from the axis is what the program says, if it turns about Y0 Z0.
constexpr double kSameLine_mm = 1e-3;
constexpr double kLeastDiameter_mm = 1;

double from_axis_mm(const Vec3& at_mm) { return std::sqrt(at_mm.y * at_mm.y + at_mm.z * at_mm.z); }

bool turns_about_x(const Motion& m, std::span<const CutMove> moves) {
  const auto fits = [&](const CutMove& move) {
    return std::abs(from_axis_mm(move.to_mm) - from_axis_mm(m.to_mm)) < kSameLine_mm;
  };
  // After a whole turn about any line the tip is back.
  const bool stays_out = m.from_mm.y == m.to_mm.y && m.from_mm.z == m.to_mm.z;
  if (stays_out) return std::all_of(moves.begin(), moves.end(), fits);
  return moves.empty() || fits(moves.back());
}

/// Along X or around it.
bool is_beside(const Motion& m) {
  return m.from_mm.x != m.to_mm.x || m.from_abc_deg[0] != m.to_abc_deg[0];
}

}  // namespace

void RoundBlankGuess::add(const Motion& m, std::span<const CutMove> moves, double tool_radius_mm) {
  if (is_other_ || m.unknown_to != 0) return;
  if (is_traverse(m)) {
    const double start = m.start_known ? from_axis_mm(m.from_mm) : 0;
    passed_mm_ = std::min(passed_mm_, std::max(start, from_axis_mm(m.to_mm)));
  } else if (is_feed(m) && m.start_known) {
    add_feed(m, moves, tool_radius_mm);
  }
}

void RoundBlankGuess::add_feed(const Motion& m, std::span<const CutMove> moves,
                               double tool_radius_mm) {
  for (const std::array<double, 3>* abc : {&m.from_abc_deg, &m.to_abc_deg}) {
    least_a_deg_ = std::min(least_a_deg_, (*abc)[0]);
    most_a_deg_ = std::max(most_a_deg_, (*abc)[0]);
    is_other_ = is_other_ || (*abc)[1] != 0 || (*abc)[2] != 0;
  }
  const Box way = bounds_of(m);
  is_other_ = is_other_ || !turns_about_x(m, moves);
  low_mm_ = std::min(low_mm_, way.min.x - tool_radius_mm);
  high_mm_ = std::max(high_mm_, way.max.x + tool_radius_mm);
  const auto [near, far] = std::minmax({from_axis_mm(m.from_mm), from_axis_mm(m.to_mm)});
  farthest_mm_ = std::max(farthest_mm_, is_beside(m) ? far : near);
  begun_mm_ = std::max(begun_mm_, far);
}

std::optional<Blank> RoundBlankGuess::blank() const {
  const double halfway = 0.5 * (farthest_mm_ + passed_mm_);
  const double radius = std::max(farthest_mm_, std::min(begun_mm_, halfway));
  const double diameter = std::round(2e3 * radius) / 1e3;
  if (is_other_ || !(most_a_deg_ - least_a_deg_ >= kWholeTurn_deg) ||
      diameter < kLeastDiameter_mm) {
    return std::nullopt;
  }
  const double low = std::floor(low_mm_ - margin_mm_) + 0.0;
  const double high = std::max(low + 1, std::ceil(high_mm_ + margin_mm_)) + 0.0;
  BlankBody bar;
  bar.kind = BlankBody::Kind::kCylinder;
  bar.axis = 'x';
  bar.diameter_mm = diameter;
  const double r = diameter / 2;
  bar.bounds_mm = Box{{low, -r, -r}, {high, r, r}};
  Blank blank;
  blank.bodies.push_back(bar);
  return blank;
}

}  // namespace kerf
