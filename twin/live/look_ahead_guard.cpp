#include "twin/live/look_ahead_guard.h"

#include <algorithm>
#include <limits>

#include "twin/job/stock_choice.h"

namespace kerf {
namespace {

/// A finding of the same line so much later is another one: a loop has come round. After a restart
/// the first motion is cut from its beginning again, so times move a little.
constexpr double kSameEvent_s = 1.0;

/// A head that meets a part which has tipped is a collision, as far as anybody can tell. So is what
/// would be one if blank, tool and machine are as they were guessed.
bool is_hit(const Finding& finding) {
  switch (finding.id) {
    case FindingId::kCrossesPart:
    case FindingId::kRapidContact:
    case FindingId::kSpindleOffContact:
    case FindingId::kBelowStock:
    case FindingId::kFixtureContact:
    case FindingId::kShankContact:
    case FindingId::kHolderContact:
    case FindingId::kSpindleContact:
    case FindingId::kMachineCollision:
      return finding.severity != Severity::kNote;
    default:
      return finding.severity == Severity::kError;
  }
}

}  // namespace

LookAheadGuard::LookAheadGuard(ToolSources tools, Options options)
    : tools_(std::move(tools)), options_(std::move(options)) {
  if (options_.own_thread) thread_ = std::jthread([this] { run(); });
}

LookAheadGuard::~LookAheadGuard() {
  stop_.request_stop();
  arrived_.notify_all();
}

void LookAheadGuard::restart(const StockModel& stock, const CutStage& stage,
                             const WorkpieceFrame& frame) {
  auto copy = std::make_unique<Copy>();
  copy->stock = stock.snapshot();
  copy->resolver = std::make_unique<ToolResolver>(tools_, row_of(stock).can_cut);
  copy->stage = std::make_unique<CutStage>(*copy->stock, *copy->resolver, copy->log,
                                           options_.timeline, *options_.process);
  copy->stage->check_by(options_.checks);
  if (!materials_.empty()) copy->stage->set_materials(materials_);
  copy->stage->go_on_from(stage);
  copy->stage->set_frame(frame);
  copy->stage->stop_by(stop_.get_token());
  fresh_ = std::move(copy);
  handed_materials_ = materials_.size();
  begun_ = finished_ = false;
  change_s_ = -std::numeric_limits<double>::infinity();
  ahead_.clear();
  ++copies_;
}

void LookAheadGuard::set_materials(std::span<const TorchMaterial> materials) {
  materials_.assign(materials.begin(), materials.end());
}

void LookAheadGuard::look(const ProgramAhead& program, double now_s, const RealTip& tip,
                          std::vector<AheadWarning>& out) {
  if (copies_ == 0) return;
  const auto& motions = program.motions();
  if (!begun_ && motions.empty()) return;
  if (!std::exchange(begun_, true)) next_ = program.forgotten();
  next_ = std::max(next_, program.forgotten());
  Work work;
  work.copy = std::move(fresh_);
  if (handed_materials_ != materials_.size()) {
    work.materials = materials_;
    handed_materials_ = materials_.size();
  }
  for (; next_ - program.forgotten() < motions.size(); ++next_) {
    const PlannedMotion& planned = motions[next_ - program.forgotten()];
    if (planned.start_s > now_s + options_.horizon_s) break;
    work.motions.push_back(planned);
    if (planned.motion.kind == MotionKind::kToolChange) change_s_ = planned.start_s;
    if (change_s_ < now_s) take_real_tip(tip, work.motions.back());
  }
  work.whole = !finished_ && program.complete() && next_ - program.forgotten() == motions.size();
  finished_ |= work.whole;
  if (work.copy || work.whole || !work.motions.empty() || !work.materials.empty()) {
    hand(std::move(work));
  }
  tell(now_s, out);
}

/// To the thread, if there is one.
void LookAheadGuard::hand(Work work) {
  if (!options_.own_thread) return cut(work, copies_);
  const std::lock_guard lock(mutex_);
  // What belongs to a copy that is to be forgotten need not be cut.
  if (work.copy) {
    works_.clear();
    found_.clear();
    newest_ = copies_;
  }
  works_.push_back(std::move(work));
  arrived_.notify_one();
}

bool LookAheadGuard::is_overtaken(std::uint64_t copies) const {
  if (!options_.own_thread) return false;
  const std::lock_guard lock(mutex_);
  return newest_ != copies;
}

void LookAheadGuard::run() {
  const std::stop_token stop = stop_.get_token();
  for (;;) {
    std::unique_lock lock(mutex_);
    if (!arrived_.wait(lock, stop, [this] { return !works_.empty(); })) return;
    Work work = std::move(works_.front());
    works_.pop_front();
    const std::uint64_t copies = newest_;
    lock.unlock();
    cut(work, copies);
  }
}

/// Motion by motion: after each, what it has brought is there for the owner, and a newer copy goes
/// first.
void LookAheadGuard::cut(Work& work, std::uint64_t copies) {
  if (work.copy) copy_ = std::move(work.copy);
  if (!copy_) return;
  CutStage& stage = *copy_->stage;
  if (!work.materials.empty()) stage.set_materials(work.materials);
  const auto collect = [&] {
    const std::vector<Finding>& kept = copy_->log.kept();
    if (copy_->collected == kept.size()) return;
    const std::lock_guard lock(mutex_);
    for (; copy_->collected < kept.size(); ++copy_->collected) {
      if (is_hit(kept[copy_->collected])) found_.push_back({kept[copy_->collected], copies});
    }
  };
  for (const PlannedMotion& planned : work.motions) {
    stage.take_timed(planned.motion, planned.step, planned.path);
    stage.complete();
    collect();
    if (stop_.stop_requested() || is_overtaken(copies)) return;
  }
  if (work.whole) stage.finish(false);
  collect();
}

/// What is due. A finding without a time is that of the program as a whole, and due at once.
void LookAheadGuard::tell(double now_s, std::vector<AheadWarning>& out) {
  {
    const std::lock_guard lock(mutex_);
    for (Found& found : found_) {
      if (found.copies == copies_ || !options_.own_thread) {
        ahead_.push_back(std::move(found.finding));
      }
    }
    found_.clear();
  }
  const auto is_due = [&](const Finding& finding) {
    return finding.time_s.value_or(now_s) <= now_s + options_.horizon_s;
  };
  for (const Finding& finding : ahead_) {
    if (!is_due(finding)) continue;
    const auto place = static_cast<std::uint64_t>(finding.source.file) << 32 | finding.source.line;
    const double at_s = finding.time_s.value_or(now_s);
    const auto [told, first] = told_.insert({{static_cast<int>(finding.id), place}, at_s});
    if (!first && at_s < told->second + kSameEvent_s) continue;
    told->second = at_s;
    AheadWarning warning{finding, 0, 0};
    warning.finding.time_s = at_s;
    warning.in_s = std::max(0.0, at_s - now_s);
    out.push_back(std::move(warning));
  }
  std::erase_if(ahead_, is_due);
}

}  // namespace kerf
