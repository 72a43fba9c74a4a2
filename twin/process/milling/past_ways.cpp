#include "twin/process/milling/past_ways.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "base/golden_section.h"

namespace kerf {
namespace {

constexpr std::size_t kReaches = 1024;
constexpr double kLevel_mm = 1e-9;
constexpr int kSlopeSteps = 20, kHeightSteps = 14;
constexpr double kNotThere = std::numeric_limits<double>::infinity();
/// An arc's ends may differ so much in their distance from its centre.
constexpr double kRound_mm = 1e-3;

double between(const std::vector<double>& table, double part) {
  const double scaled = std::clamp(part, 0.0, 1.0) * static_cast<double>(table.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(scaled), table.size() - 2);
  return table[k] + (scaled - static_cast<double>(k)) * (table[k + 1] - table[k]);
}

/// The angle of a point of a circle from where an arc begins, in its sense: 0 .. 2 pi.
double behind_start(double angle, double start, double sweep) {
  const double turned = std::fmod(sweep < 0 ? start - angle : angle - start, 2 * kPi);
  return turned < 0 ? turned + 2 * kPi : turned;
}

}  // namespace

double PastWays::Tool::reach_mm(double above_tip_mm) const {
  if (above_tip_mm < 0) return -1;
  if (is_flat || above_tip_mm >= high_mm) return radius_mm;
  // Even steps of the height's root: a ball's radius grows as that does.
  return between(radius, std::sqrt(above_tip_mm / high_mm));
}

double PastWays::Tool::lift_mm(double distance_mm) const {
  // Even steps of the root of what is left to its side, where the ends of its corners are steep.
  return between(lift, std::sqrt(std::max(0.0, 1 - distance_mm / radius_mm)));
}

void PastWays::clear() {
  ways_.clear();
  mounts_.clear();
  arcs_.clear();
  uprights_.clear();
  tools_.clear();
  last_.clear();
  lines_.clear();
  tool_ = 0;
}

void PastWays::mount(const Cutter& cutter, int number) {
  const auto found = std::find_if(tools_.begin(), tools_.end(), [&](const Tool& tool) {
    return tool.spec == cutter.spec() && tool.number == number;
  });
  tool_ = static_cast<std::size_t>(found - tools_.begin());
  if (found != tools_.end()) return;
  Tool tool;
  tool.spec = cutter.spec();
  tool.number = number;
  tool.radius_mm = cutter.radius_mm();
  for (std::size_t k = 0; k <= kReaches; ++k) {
    const double part = static_cast<double>(k) / kReaches;
    tool.lift.push_back(cutter.height_mm(tool.radius_mm * (1 - std::max(1e-12, part * part))));
  }
  tool.side = ToolSide::of(cutter);
  tool.high_mm = tool.lift.front();
  tool.is_flat = tool.high_mm <= 0;
  for (std::size_t k = 0; k <= kReaches && !tool.is_flat; ++k) {
    const double part = static_cast<double>(k) / kReaches, high = part * part * tool.high_mm;
    double low = 0, wide = tool.radius_mm;
    for (int n = 0; n < 40; ++n) {
      const double middle = 0.5 * (low + wide);
      (cutter.height_mm(middle) <= high ? low : wide) = middle;
    }
    tool.radius.push_back(low);
  }
  tools_.push_back(std::move(tool));
}

void PastWays::add(const CutMove& move) {
  if (move.id >= kMostNumbers || tools_.empty() || !move.is_vertical()) return;
  Way way;
  for (int i = 0; i < 3; ++i) {
    way.from[i] = static_cast<float>(move.from_mm[i]);
    way.to[i] = static_cast<float>(move.to_mm[i]);
  }
  if (const std::optional<UprightArc> upright = UprightArc::of(move)) {
    way.arc = kUpright + static_cast<std::uint32_t>(uprights_.size());
    uprights_.push_back(*upright);
  } else if (move.arc) {
    const CutArc& arc = *move.arc;
    const Vec2 center(arc.center_mm), from = Vec2(move.from_mm) - center;
    const double radius = glm::length(from);
    if (std::abs(arc.axis.z) < 1 - 1e-12 ||
        std::abs(glm::length(Vec2(move.to_mm) - center) - radius) > kRound_mm)
      return;
    way.arc = static_cast<std::uint32_t>(arcs_.size());
    arcs_.push_back({center, radius, std::atan2(from.y, from.x), arc.sweep_rad * arc.axis.z});
  }
  const auto number = static_cast<std::size_t>(move.id);
  if (last_.size() <= number) last_.resize(number + 1, kNone);
  way.before = last_[number];
  last_[number] = static_cast<std::uint32_t>(ways_.size());
  if (mounts_.empty() || mounts_.back().tool != tool_) mounts_.push_back({ways_.size(), tool_});
  ways_.push_back(way);
}

std::size_t PastWays::mount_before(std::size_t way) const {
  const auto after = std::upper_bound(
      mounts_.begin(), mounts_.end(), way,
      [](std::size_t asked, const Mount& mount) { return asked < mount.first_way; });
  return static_cast<std::size_t>(after - mounts_.begin()) - 1;
}

bool PastWays::covers(std::uint32_t number, const Vec2& point, double z_mm,
                      double margin_mm) const {
  if (number >= last_.size()) return false;
  int asked = 0;
  for (std::uint32_t n = last_[number]; n != kNone && asked < kMostOfOne; n = ways_[n].before) {
    if (covers(ways_[n], tools_[tool_of(n)], point, z_mm, margin_mm)) return true;
    ++asked;
  }
  return false;
}

bool PastWays::covers(const Way& way, const Tool& tool, const Vec2& point, double z_mm,
                      double margin_mm) const {
  if (way.arc != kNone && way.arc >= kUpright)
    return upright_height(way, tool, point, margin_mm) <= z_mm + margin_mm;
  if (static_cast<double>(std::min(way.from[2], way.to[2])) > z_mm + margin_mm) return false;
  return way.arc == kNone ? line_covers(way, tool, point, z_mm, margin_mm)
                          : arc_covers(way, tool, point, z_mm, margin_mm);
}

bool PastWays::line_covers(const Way& way, const Tool& tool, const Vec2& point, double z_mm,
                           double margin_mm) const {
  const Vec2 from(static_cast<double>(way.from[0]), static_cast<double>(way.from[1]));
  const Vec2 along = Vec2(static_cast<double>(way.to[0]), static_cast<double>(way.to[1])) - from;
  const auto z = static_cast<double>(way.from[2]), rise = static_cast<double>(way.to[2]) - z;
  const Vec2 arm = point - from;
  const double length2 = glm::dot(along, along);
  const double nearest = length2 > 0 ? glm::dot(arm, along) / length2 : 0;
  const auto distance = [&](double t) { return glm::length(arm - t * along); };
  if (std::abs(rise) < kLevel_mm || length2 == 0) {
    const double low = length2 == 0 ? std::min(z, z + rise) : z;
    return distance(std::clamp(nearest, 0.0, 1.0)) <=
           tool.reach_mm(z_mm + margin_mm - low) + margin_mm;
  }
  const double radius = tool.radius_mm + margin_mm;
  const double beside = distance(nearest);
  if (beside > radius) return false;
  const double half = std::sqrt((radius * radius - beside * beside) / length2);
  const double first = std::max(0.0, nearest - half), last = std::min(1.0, nearest + half);
  if (first > last) return false;
  if (tool.is_flat) return z + rise * (rise < 0 ? last : first) <= z_mm + margin_mm;
  const auto low_at = [&](double t) {
    return z + rise * t + tool.lift_mm(std::max(0.0, distance(t) - margin_mm));
  };
  const double length = std::sqrt(length2);
  if (const std::optional<double> lowest =
          tool.side.lowest_mm(rise / length, beside, half * length, margin_mm))
    return low_at(std::clamp(nearest + *lowest / length, first, last)) <= z_mm + margin_mm;
  return golden_section(low_at, first, last, kSlopeSteps).least <= z_mm + margin_mm;
}

double PastWays::height_mm(std::uint32_t number, const Vec2& point, double margin_mm) const {
  double low = kNotThere;
  if (number >= last_.size()) return low;
  int asked = 0;
  for (std::uint32_t n = last_[number]; n != kNone && asked < kMostOfOne; n = ways_[n].before) {
    low = std::min(low, height_of(n, tools_[tool_of(n)], point, margin_mm));
    ++asked;
  }
  return low;
}

double PastWays::height_of(std::uint32_t number, const Tool& tool, const Vec2& point,
                           double margin_mm) const {
  const Way& way = ways_[number];
  if (way.arc == kNone) return line_height(number, tool, point, margin_mm);
  return way.arc < kUpright ? arc_height(way, tool, point, margin_mm)
                            : upright_height(way, tool, point, margin_mm);
}

double PastWays::upright_height(const Way& way, const Tool& tool, const Vec2& point,
                                double margin_mm) const {
  const auto lift = [&](double mm) { return tool.lift_mm(std::max(0.0, mm - margin_mm)); };
  return uprights_[way.arc - kUpright].lowest_over(point, 0, 1, tool.radius_mm + margin_mm, lift);
}

const PastWays::Line& PastWays::line_of(std::uint32_t way) const {
  if (lines_.empty()) lines_.resize(kLines);
  Line& line = lines_[way % kLines];
  if (line.way == way) return line;
  const Way& of = ways_[way];
  line.way = way;
  line.from = Vec2(static_cast<double>(of.from[0]), static_cast<double>(of.from[1]));
  line.along = Vec2(static_cast<double>(of.to[0]), static_cast<double>(of.to[1])) - line.from;
  line.z = static_cast<double>(of.from[2]), line.rise = static_cast<double>(of.to[2]) - line.z;
  line.length2 = glm::dot(line.along, line.along), line.length = std::sqrt(line.length2);
  line.slope = line.length > 0 ? line.rise / line.length : 0;
  return line;
}

double PastWays::line_height(std::uint32_t way, const Tool& tool, const Vec2& point,
                             double margin_mm) const {
  const Line& line = line_of(way);
  const Vec2 along = line.along, arm = point - line.from;
  const double z = line.z, rise = line.rise, length2 = line.length2;
  const double radius = tool.radius_mm + margin_mm;
  const double nearest = length2 > 0 ? glm::dot(arm, along) / length2 : 0;
  const auto surface = [&](double t) {
    const double distance = glm::length(arm - t * along);
    return distance > radius ? kNotThere
                             : z + rise * t + tool.lift_mm(std::max(0.0, distance - margin_mm));
  };
  if (std::abs(rise) < kLevel_mm || length2 == 0)
    return length2 == 0 ? std::min(surface(0), surface(0) + rise)
                        : surface(std::clamp(nearest, 0.0, 1.0));
  const Vec2 beside = arm - nearest * along;
  const double half2 = radius * radius - glm::dot(beside, beside);
  if (half2 < 0) return kNotThere;
  const double half_mm = std::sqrt(half2), half = half_mm / line.length;
  const double first = std::max(0.0, nearest - half), last = std::min(1.0, nearest + half);
  if (first > last) return kNotThere;
  if (tool.is_flat) return z + rise * (rise < 0 ? last : first);
  if (const std::optional<double> lowest =
          tool.side.lowest_mm(line.slope, glm::length(beside), half_mm, margin_mm))
    return surface(std::clamp(nearest + *lowest / line.length, first, last));
  return golden_section(surface, first, last, kHeightSteps).least;
}

double PastWays::arc_height(const Way& way, const Tool& tool, const Vec2& point,
                            double margin_mm) const {
  const Arc& arc = arcs_[way.arc];
  const Vec2 arm = point - arc.center;
  const double out = glm::length(arm), sweep = std::abs(arc.sweep),
               radius = tool.radius_mm + margin_mm;
  const auto z = static_cast<double>(way.from[2]), rise = static_cast<double>(way.to[2]) - z;
  if (std::abs(out - arc.radius) > radius) return kNotThere;
  const double at = behind_start(std::atan2(arm.y, arm.x), arc.start, arc.sweep);
  const auto surface = [&](double angle) {
    const double distance = std::sqrt(std::max(
        0.0, out * out + arc.radius * arc.radius - 2 * out * arc.radius * std::cos(angle - at)));
    return distance > radius
               ? kNotThere
               : z + rise * angle / sweep + tool.lift_mm(std::max(0.0, distance - margin_mm));
  };
  if (std::abs(rise) < kLevel_mm)
    return at <= sweep ? surface(at) : std::min(surface(0), surface(sweep));
  const double cosine = (out * out + arc.radius * arc.radius - radius * radius) /
                        std::max(2 * out * arc.radius, 1e-12);
  const double half = std::acos(std::clamp(cosine, -1.0, 1.0));
  double low = kNotThere;
  for (int turn = -1; turn * 2 * kPi + at - half <= sweep; ++turn) {
    const double middle = at + turn * 2 * kPi;
    const double first = std::max(0.0, middle - half), last = std::min(sweep, middle + half);
    if (first > last) continue;
    low = std::min(low, tool.is_flat ? z + rise * (rise < 0 ? last : first) / sweep
                                     : golden_section(surface, first, last, kHeightSteps).least);
  }
  return low;
}

bool PastWays::arc_covers(const Way& way, const Tool& tool, const Vec2& point, double z_mm,
                          double margin_mm) const {
  const Arc& arc = arcs_[way.arc];
  const Vec2 arm = point - arc.center;
  const double out = glm::length(arm), sweep = std::abs(arc.sweep);
  const auto z = static_cast<double>(way.from[2]), rise = static_cast<double>(way.to[2]) - z;
  const double at = behind_start(std::atan2(arm.y, arm.x), arc.start, arc.sweep);
  const auto distance = [&](double angle) {
    return std::sqrt(std::max(
        0.0, out * out + arc.radius * arc.radius - 2 * out * arc.radius * std::cos(angle - at)));
  };
  if (std::abs(rise) < kLevel_mm) {
    const double nearest = at <= sweep ? at : at - sweep < 2 * kPi - at ? sweep : 0;
    return distance(nearest) <= tool.reach_mm(z_mm + margin_mm - z) + margin_mm;
  }
  const double radius = tool.radius_mm + margin_mm;
  if (std::abs(out - arc.radius) > radius) return false;
  const double cosine = (out * out + arc.radius * arc.radius - radius * radius) /
                        std::max(2 * out * arc.radius, 1e-12);
  const double half = std::acos(std::clamp(cosine, -1.0, 1.0));
  // It may come by again after a turn, and reach over where it begins.
  for (int turn = -1; turn * 2 * kPi + at - half <= sweep; ++turn) {
    const double middle = at + turn * 2 * kPi;
    const double first = std::max(0.0, middle - half), last = std::min(sweep, middle + half);
    if (first > last) continue;
    const auto low_at = [&](double angle) {
      return z + rise * angle / sweep + tool.lift_mm(std::max(0.0, distance(angle) - margin_mm));
    };
    const double low = tool.is_flat ? z + rise * (rise < 0 ? last : first) / sweep
                                    : golden_section(low_at, first, last, kSlopeSteps).least;
    if (low <= z_mm + margin_mm) return true;
  }
  return false;
}

}  // namespace kerf
