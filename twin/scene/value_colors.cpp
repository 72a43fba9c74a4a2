#include "twin/scene/value_colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "interp_bridge/motion_kinds.h"
#include "twin/scene/cut_colors.h"

namespace kerf {
namespace {

/// 0xAABBGGRR.
constexpr std::uint32_t rgb(std::uint32_t red, std::uint32_t green, std::uint32_t blue) {
  return 0xff000000u | blue << 16 | green << 8 | red;
}

constexpr std::uint32_t kBeyond = rgb(210, 0, 40), kOther = rgb(190, 190, 196);
constexpr double kUsualShare = 0.99;
/// What is above a limit by less is rounding.
constexpr double kOver = 1.005;
constexpr double kStraightDown_deg = 180.5;

static_assert(kCutLoadKinds == kLoadKinds);

std::vector<float> feeds_of(const ProgramTrack& track, const MoveFacts& facts, bool per_tooth) {
  std::vector<float> values(track.size(), 0.0f);
  for (std::size_t i = 0; i < std::min(track.size(), facts.removed_mm3.size()); ++i) {
    if (!(facts.removed_mm3[i] > 0)) continue;
    const Motion motion = track.motion(i);
    const TimedStep step = track.step(i);
    if (!is_feed(motion) || !(step.duration_s > 0)) continue;
    double mm_per_min = 60 * step.length_mm / step.duration_s;
    // What corners that are rounded save of the way is no feed.
    if (step.programmed_mm_per_min > 0)
      mm_per_min = std::min(mm_per_min, step.programmed_mm_per_min);
    if (!per_tooth) {
      values[i] = static_cast<float>(mm_per_min);
      continue;
    }
    const Cutter* const cutter = facts.cuts ? facts.cuts->cutter_at(i) : nullptr;
    const bool turns = motion.spindle != SpindleState::kStopped && motion.spindle_rpm > 0;
    if (!cutter || !cutter->teeth() || !turns) continue;
    values[i] = static_cast<float>(mm_per_min / (motion.spindle_rpm * *cutter->teeth()));
  }
  return values;
}

std::vector<float> values_of(ColorBy mode, const ProgramTrack& track, const MoveFacts& facts) {
  if (mode == ColorBy::kFeed || mode == ColorBy::kFeedPerTooth)
    return feeds_of(track, facts, mode == ColorBy::kFeedPerTooth);
  const auto load = load_of(mode);
  if (!load || !facts.loads) return {};
  return facts.loads->by_motion(static_cast<LoadKind>(*load));
}

/// What is not exceeded for kUsualShare of the time of the moves that have a value.
double usual(std::span<const float> values, const ProgramTrack& track) {
  std::vector<std::pair<float, float>> present;
  double whole_s = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(values[i] > 0)) continue;
    const double seconds = track.end_s(i) - track.start_s(i);
    present.emplace_back(values[i], static_cast<float>(seconds));
    whole_s += seconds;
  }
  std::sort(present.begin(), present.end());
  double sum_s = 0;
  for (const auto& [value, seconds] : present) {
    sum_s += static_cast<double>(seconds);
    if (sum_s >= kUsualShare * whole_s) return static_cast<double>(value);
  }
  return present.empty() ? 0 : static_cast<double>(present.back().first);
}

/// 1, 2, 2.5 or 5 times a power of ten, so that kRisingColors steps reach `end`.
double class_width(double end) {
  const double least = end / static_cast<double>(kRisingColors);
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 2.5, 5.0}) {
    if (factor * power >= least * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

/// Up to `end`, beyond which there is a colour of its own (`beyond`) or the last class goes on.
void add_classes(std::span<const float> values, double width, double end,
                 std::optional<LegendRange> beyond, CutColors& colors) {
  const double most = static_cast<double>(*std::max_element(values.begin(), values.end()));
  const auto count = std::clamp<std::size_t>(
      static_cast<std::size_t>(std::ceil(end / width * (1 - 1e-9))), 1, kRisingColors);
  std::array<bool, kRisingColors> is_there{};
  bool is_beyond_there = false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = static_cast<double>(values[i]);
    if (!(value > 0)) continue;
    if (beyond && value > beyond->from * kOver) {
      colors.of_move[i] = kBeyond;
      is_beyond_there = true;
      continue;
    }
    const auto place = static_cast<std::size_t>(std::max(0.0, std::ceil(value / width - 1e-6) - 1));
    const std::size_t at = std::min(place, count - 1);
    colors.of_move[i] = rising_colors()[at];
    is_there[at] = true;
  }
  for (std::size_t k = 0; k < count; ++k) {
    double to = static_cast<double>(k + 1) * width;
    if (k + 1 == count) to = beyond ? std::min(to, beyond->from) : std::max(to, most);
    colors.legend.push_back(
        {rising_colors()[k], {}, {}, LegendRange{static_cast<double>(k) * width, to}});
  }
  if (beyond && is_beyond_there) colors.legend.push_back({kBeyond, {}, {}, beyond});
}

}  // namespace

double limit_of(CutLoadKind kind, const CuttingWish& wish) {
  switch (kind) {
    case CutLoadKind::kTorque:
      return wish.spindle_torque_nm;
    case CutLoadKind::kPower:
      return wish.spindle_power_kw;
    case CutLoadKind::kBend:
      return wish.most_bend_mm;
    default:
      return 0;
  }
}

std::shared_ptr<CutColors> value_colors(ColorBy mode, const ProgramTrack& track,
                                        const MoveFacts& facts) {
  auto colors = std::make_shared<CutColors>();
  colors->mode = mode;
  colors->other = kOther;
  colors->of_move.assign(track.size(), colors->other);
  const std::vector<float> values = values_of(mode, track, facts);
  const double usual_most = usual(values, track);
  if (!(usual_most > 0)) return colors;
  if (mode == ColorBy::kAngle) {
    add_classes(values, 30, 180,
                LegendRange{kStraightDown_deg, 360, LegendRange::Kind::kStraightDown}, *colors);
    return colors;
  }
  const auto load = load_of(mode);
  const double limit = load && facts.wish ? limit_of(*load, *facts.wish) : 0;
  const double most = static_cast<double>(*std::max_element(values.begin(), values.end()));
  if (limit > 0 && most > limit * kOver) {
    const double end = std::min(usual_most, limit);
    const double width = class_width(end);
    add_classes(values, width, limit < usual_most ? limit : end,
                LegendRange{limit, most, LegendRange::Kind::kBeyondLimit}, *colors);
    return colors;
  }
  add_classes(values, class_width(usual_most), usual_most, std::nullopt, *colors);
  return colors;
}

}  // namespace kerf
