#include "twin/optimize/feed_survey.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>
#include <utility>

#include "interp_bridge/motion_kinds.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// Of a motion that is soft all along, as sums of lengths are.
constexpr double kWhole = 0.999;

/// Limits of what does not hang on what is removed.
FeedAims without_rate(FeedAims aims) {
  aims.most[CutLimit::kRate].reset();
  return aims;
}

bool goes_down_steeply(const Motion& m, double length_mm) {
  const double down_mm = m.from_mm.z - m.to_mm.z;
  return down_mm > 0 && down_mm > std::sin(FeedSurvey::kSteep_rad) * length_mm;
}

}  // namespace

void FeedSurvey::restart() { *this = FeedSurvey(aims_); }

void FeedSurvey::on_step(std::uint64_t number, const Motion& m, const TimedStep& step) {
  seconds_[m.tool] += step.duration_s;
  in_feed_ = is_feed(m) || m.kind == MotionKind::kProbe;
  // Words that move nothing (G1 F300) do not take the tool out of the material, either.
  const bool goes = !stands_still(m) || !m.start_known;
  if (!in_feed_ || !goes) {
    if (is_move(m) && goes) is_fresh_ = true;
    in_feed_ = false;
    return;
  }
  SurveyedMotion& motion = motions_.emplace_back();
  motion.number = number;
  motion.source = m.source;
  motion.from_mm = m.from_mm;
  motion.to_mm = m.to_mm;
  motion.feed_mm_per_min = m.feed_mm_per_min;
  if (step.allowed_mm_per_min > 0) motion.allowed_mm_per_min = step.allowed_mm_per_min;
  motion.first_part = parts_.size();
  motion.kind = m.kind;
  motion.is_per_turn = m.feed_per_rev;
  motion.goes_down = goes_down_steeply(m, step.length_mm);
  rpm_ = m.spindle == SpindleState::kStopped ? 0 : m.spindle_rpm;
  if (aims_.spindle_max_rpm > 0) rpm_ = std::min(rpm_, aims_.spindle_max_rpm);
  // Through a rounded corner LinuxCNC goes at the faster one of two feeds: the other one's cut is
  // over by then.
  speed_mm_per_min_ = step.programmed_mm_per_min;
  if (step.peak_mm_per_min > 0)
    speed_mm_per_min_ = std::min(speed_mm_per_min_, step.peak_mm_per_min);
  motion.speed_mm_per_min = speed_mm_per_min_;
}

void FeedSurvey::on_cut(std::uint64_t number, double removed_mm3, double /*depth_mm*/) {
  while (cut_ < motions_.size() && motions_[cut_].number < number) ++cut_;
  if (cut_ < motions_.size() && motions_[cut_].number == number)
    motions_[cut_].removed_mm3 += removed_mm3;
}

void FeedSurvey::on_mount(int tool, const Cutter& cutter) {
  limits_.emplace(cutter, aims_.material);
  tool_ = tool;
  shape_ = cutter.spec();
  diameter_mm_ = 2 * cutter.radius_mm();
  is_fresh_ = true;
}

void FeedSurvey::on_part(const EngagementLook& look, double length_mm) {
  if (!in_feed_ || !limits_ || motions_.empty()) return;
  SurveyedMotion& motion = motions_.back();
  ++motion.parts;
  motion.is_measured = true;
  SurveyedPart& part = parts_.emplace_back();
  part.length_mm = length_mm;
  part.diameter_mm = static_cast<float>(diameter_mm_);
  part.is_engaged = look.is_engaged();
  part.is_fresh = std::exchange(is_fresh_, false);
  if (!part.is_engaged) return;
  motion.is_engaged = true;
  if (!limits_->knows_teeth()) toothless_.emplace(tool_, shape_);
  if (!limits_->knows_stickout()) unheld_.emplace(tool_, shape_);
  const CutLimits::Place place = limits_->place(look, rpm_);
  part.limit_mm_per_min = CutLimits::most_feed(without_rate(aims_), place);
  part.section_mm2 = limits_->section_mm2(look);
  part.is_rounded = limits_->is_rounded() && !look.is_plunge;
  const PerLimit<double> loads = CutLimits::loads(place, speed_mm_per_min_);
  for (const CutLimit limit : kCutLimits) {
    if (limit == CutLimit::kRate) continue;  // limit_rates()
    if (loads[limit] > peaks_[limit].most) peaks_[limit] = {loads[limit], motion.source};
  }
}

void FeedSurvey::on_unmeasured(double /*length_mm*/) {
  if (in_feed_ && !motions_.empty()) motions_.back().is_measured = false;
  in_feed_ = false;
  is_fresh_ = true;
}

/// A stretch of cutting ends where the tool comes from elsewhere, or has been in the air for as
/// long as a zone.
void FeedSurvey::soften() {
  const auto walk = [](std::span<SurveyedPart> stretch) {
    double way_mm = 0;
    const auto soft_mm = [&way_mm](const SurveyedPart& part) {
      if (!part.is_engaged) return 0.0;
      const double zone_mm = kSoftWay * static_cast<double>(part.diameter_mm);
      const double left_mm = std::max(0.0, zone_mm - way_mm);
      way_mm += part.length_mm;
      return std::min(part.length_mm, left_mm);
    };
    for (SurveyedPart& part : stretch) part.soft_front_mm = soft_mm(part);
    way_mm = 0;
    for (auto part = stretch.rbegin(); part != stretch.rend(); ++part)
      part->soft_back_mm = soft_mm(*part);
  };
  std::size_t begin = 0;
  double air_mm = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const SurveyedPart& part = parts_[i];
    air_mm = part.is_engaged || part.is_fresh ? 0 : air_mm + part.length_mm;
    const bool is_over = air_mm > kSoftWay * static_cast<double>(part.diameter_mm);
    if (!part.is_fresh && !is_over) continue;
    walk(std::span(parts_).subspan(begin, i - begin));
    begin = i;
  }
  walk(std::span(parts_).subspan(begin));
}

void FeedSurvey::limit_rates(std::size_t from, std::size_t to, double share) {
  PeakLoad& peak = peaks_[CutLimit::kRate];
  for (const SurveyedMotion& motion : std::span(motions_).subspan(from, to - from)) {
    for (SurveyedPart& part : std::span(parts_).subspan(motion.first_part, motion.parts)) {
      if (!part.is_engaged || part.section_mm2 <= 0) continue;
      const double section_mm2 = part.section_mm2 * (part.is_rounded ? share : 1);
      const double rate = section_mm2 * motion.speed_mm_per_min / 60;
      if (rate > peak.most) peak = {rate, motion.source};
      if (const auto& most = aims_.most[CutLimit::kRate]; most && section_mm2 > 0)
        part.limit_mm_per_min = std::min(part.limit_mm_per_min, 60 * *most / section_mm2);
    }
  }
}

/// The section that is seen ahead of a ball is more than what it takes beside an earlier pass. What
/// motions in a row have removed says how much more; not where the tool enters or leaves material
/// meanwhile.
void FeedSurvey::limit_rates() {
  std::size_t from = 0;
  double removed_mm3 = 0, most_mm3 = 0, way_mm = 0;
  bool has_end = false;
  const auto close = [&](std::size_t to) {
    const bool is_within = !has_end && most_mm3 > 0 && removed_mm3 > 0;
    limit_rates(from, to, is_within ? std::min(1.0, removed_mm3 / most_mm3) : 1);
    from = to;
    removed_mm3 = most_mm3 = way_mm = 0;
    has_end = false;
  };
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const SurveyedMotion& motion = motions_[i];
    const auto its = std::span(parts_).subspan(motion.first_part, motion.parts);
    removed_mm3 += motion.removed_mm3;
    double diameter_mm = 0;
    for (const SurveyedPart& part : its) {
      // Softened are half a diameter behind the entry and ahead of the exit.
      has_end = has_end || part.is_fresh || !part.is_engaged || part.soft_mm() > 0;
      if (!part.is_engaged) continue;
      way_mm += part.length_mm;
      most_mm3 += part.section_mm2 * part.length_mm;
      diameter_mm = static_cast<double>(part.diameter_mm);
    }
    if (diameter_mm > 0 && way_mm >= kRateWay * diameter_mm) close(i + 1);
  }
  close(motions_.size());
}

void FeedSurvey::settle() {
  soften();
  limit_rates();
  for (SurveyedMotion& motion : motions_) {
    double engaged_mm = 0, soft_mm = 0;
    for (const SurveyedPart& part : std::span(parts_).subspan(motion.first_part, motion.parts)) {
      if (!part.is_engaged) continue;
      engaged_mm += part.length_mm;
      soft_mm += part.soft_mm();
      motion.limit_mm_per_min = std::min(motion.limit_mm_per_min, part.limit_mm_per_min);
    }
    const double least = aims_.splits ? kWhole : kSoftBlock;
    const bool is_soft = engaged_mm > 0 && soft_mm >= least * engaged_mm;
    if (is_soft && !motion.goes_down) motion.limit_mm_per_min *= kSoftShare;
  }
}

}  // namespace kerf
