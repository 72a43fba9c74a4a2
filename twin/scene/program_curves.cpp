#include "twin/scene/program_curves.h"

#include <algorithm>
#include <utility>

#include "interp_bridge/motion_kinds.h"
#include "twin/scene/value_colors.h"

namespace kerf {

CurveMaker::CurveMaker(std::shared_ptr<const ProgramTrack> track,
                       const std::vector<NamedTool>& tools, std::shared_ptr<const CutQuery> cuts)
    : track_(std::move(track)), cuts_(std::move(cuts)), tools_(tools) {}

bool CurveMaker::wants(std::size_t motions_checked, Clock::time_point now) const {
  if (track_->empty() || is_complete()) return false;
  if (is_in_hand() || motions_checked == track_->size()) return true;
  return motions_checked > next_ && now - made_at_ >= kPeriod;
}

void CurveMaker::add(std::size_t i, double removed_mm3) {
  const Motion motion = track_->motion(i);
  const TimedStep step = track_->step(i);
  const bool feeds = is_feed(motion);
  const double rpm = motion.spindle == SpindleState::kStopped ? 0 : motion.spindle_rpm;
  // What corners that are rounded save of the way is no feed.
  const double most_mm = step.programmed_mm_per_min > 0
                             ? step.programmed_mm_per_min / 60 * step.duration_s
                             : step.length_mm;
  RunCurve::Share share{step.start_s, step.duration_s, removed_mm3,
                        feeds ? std::min(step.length_mm, most_mm) : 0, rpm};
  all_.add(share);
  if (!cuts_ || !feeds || !(removed_mm3 > 0) || !(rpm > 0)) return;
  const Cutter* const cutter = cuts_->cutter_at(i);
  if (cutter == nullptr || !cutter->teeth()) return;
  share.rpm *= *cutter->teeth();
  teeth_.add(share);
}

std::shared_ptr<const ProgramCurves> CurveMaker::make(std::size_t motions_checked,
                                                      const std::vector<float>& removed_mm3,
                                                      Clock::time_point deadline) {
  const std::size_t known = std::min({motions_checked, removed_mm3.size(), track_->size()});
  if (known == track_->size() && !is_last_) {
    is_last_ = true;
    next_ = 0;
    all_ = teeth_ = RunCurve();
  }
  constexpr std::size_t kBetweenLooks = 256;
  while (next_ < known) {
    for (const std::size_t end = std::min(known, next_ + kBetweenLooks); next_ < end; ++next_)
      add(next_, static_cast<double>(removed_mm3[next_]));
    if (Clock::now() >= deadline) break;
  }
  // While it is added up once more the curves before stay.
  if (is_last_ && next_ < known) return nullptr;
  made_at_ = Clock::now();
  return curves();
}

/// Of the tool that is in the spindle, as ColorBy::kTool has it.
std::uint32_t CurveMaker::color_at(double time_s) {
  const int tool = track_->tool(std::min(track_->place_at(time_s).motion, track_->size() - 1));
  const auto found = std::find_if(tools_.begin(), tools_.end(),
                                  [&](const NamedTool& t) { return t.number == tool; });
  const auto place = static_cast<std::size_t>(found - tools_.begin());
  if (found == tools_.end()) tools_.push_back({tool, ""});
  return color_of_number(place);
}

/// Their columns may be finer yet, or coarser where loads are known of what is not added up yet.
void CurveMaker::add_loads(ProgramCurves& curves) const {
  if (!loads_ || curves.color.empty()) return;
  const LoadCurve found = loads_->curve();
  for (std::size_t k = 0; k < kLoadKinds; ++k) {
    const auto nominal = found.nominal(static_cast<LoadKind>(k));
    const auto high = found.high(static_cast<LoadKind>(k));
    SceneLoadCurve& curve = curves.loads[k];
    curve.limit = limit_of(static_cast<CutLoadKind>(k), wish_);
    if (nominal.empty()) continue;
    curve.nominal.resize(curves.color.size());
    curve.high.resize(curves.color.size());
    for (std::size_t i = 0; i < nominal.size(); ++i) {
      // Steps are the same but for a power of two.
      const double begin_s = static_cast<double>(i) * found.step_s();
      const auto at = static_cast<std::size_t>(begin_s / curves.step_s + 1e-9);
      const auto end = std::max(
          at + 1, static_cast<std::size_t>((begin_s + found.step_s()) / curves.step_s + 1e-9));
      for (std::size_t to = at; to < std::min(end, curve.nominal.size()); ++to) {
        curve.nominal[to] = std::max(curve.nominal[to], nominal[i]);
        curve.high[to] = std::max(curve.high[to], high[i]);
      }
    }
  }
}

std::shared_ptr<const ProgramCurves> CurveMaker::curves() {
  auto made = std::make_shared<ProgramCurves>();
  made->step_s = all_.step_s();
  made->known_until_s = next_ == 0 ? 0 : track_->end_s(next_ - 1);
  for (const RunCurve::Column& column : all_.columns()) {
    const double begin_s = static_cast<double>(made->color.size()) * all_.step_s();
    made->color.push_back(color_at(begin_s + 0.5 * all_.step_s()));
    made->mm3_per_s.push_back(static_cast<float>(column.removed_mm3 / all_.step_s()));
    made->feed_mm_per_min.push_back(
        column.feed_s > 0 ? static_cast<float>(60 * column.feed_mm / column.feed_s) : 0);
  }
  add_loads(*made);
  if (teeth_.columns().empty()) return made;
  made->feed_per_tooth_mm.resize(made->color.size());
  // Its columns may be finer yet.
  for (std::size_t i = 0; i < made->color.size(); ++i) {
    const auto first =
        static_cast<std::size_t>(static_cast<double>(i) * all_.step_s() / teeth_.step_s() + 0.5);
    const auto end = static_cast<std::size_t>(
        static_cast<double>(i + 1) * all_.step_s() / teeth_.step_s() + 0.5);
    double feed_mm = 0, turns = 0;
    for (std::size_t k = first; k < std::min(end, teeth_.columns().size()); ++k) {
      feed_mm += teeth_.columns()[k].feed_mm;
      turns += teeth_.columns()[k].turns;
    }
    made->feed_per_tooth_mm[i] = turns > 0 ? static_cast<float>(feed_mm / turns) : 0;
  }
  return made;
}

}  // namespace kerf
