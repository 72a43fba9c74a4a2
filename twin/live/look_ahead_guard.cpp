#include "twin/live/look_ahead_guard.h"

#include <algorithm>

#include "twin/stock_choice.h"

namespace kerf {
namespace {

/// A finding of the same line so much later is another one: a loop has come round. After a restart
/// the plan begins from standstill, so times move a little.
constexpr double kSameEvent_s = 1.0;

}  // namespace

LookAheadGuard::LookAheadGuard(ToolSources tools, TimelineOptions timeline, double horizon_s,
                               std::optional<BeamSettings> beam, TurretPointer turret)
    : tools_(std::move(tools)),
      timeline_(std::move(timeline)),
      horizon_s_(horizon_s),
      beam_(std::move(beam)),
      turret_(std::move(turret)) {}

LookAheadGuard::~LookAheadGuard() = default;

void LookAheadGuard::restart(const StockModel& stock, const CutStage& stage,
                             const WorkpieceFrame& frame) {
  stage_.reset();
  stock_ = stock.snapshot();
  book_ = std::make_unique<ToolBook>(tools_, row_of(stock).can_cut);
  log_ = std::make_unique<FindingLog>();
  stage_ = std::make_unique<CutStage>(*stock_, *book_, *log_, timeline_);
  stage_->check_by(checks_);
  if (turret_) {
    stage_->punch(turret_);
  } else if (beam_) {
    stage_->burn(*beam_);
  }
  stage_->go_on_from(stage);
  stage_->set_frame(frame);
  begun_ = finished_ = false;
  collected_ = 0;
}

void LookAheadGuard::set_materials(std::span<const TorchMaterial> materials) {
  if (beam_) beam_->materials.assign(materials.begin(), materials.end());
  if (stage_) stage_->set_materials(materials);
}

void LookAheadGuard::look(const ProgramAhead& program, double now_s, int program_tool,
                          int real_tool, std::vector<AheadWarning>& out) {
  if (!stage_ || finished_) return;
  const auto& motions = program.motions();
  if (!begun_) {
    if (motions.empty()) return;
    next_ = program.forgotten();
    base_s_ = motions.front().start_s;
    begun_ = true;
  }
  next_ = std::max(next_, program.forgotten());
  const bool other_tool = real_tool >= 0 && real_tool != program_tool;
  const double until_s = now_s + horizon_s_ - base_s_;
  while (stage_->timeline().clock_s() < until_s && next_ - program.forgotten() < motions.size()) {
    Motion motion = motions[next_ - program.forgotten()].motion;
    // Until the program changes it, the tool is what it is.
    if (other_tool && motion.tool == program_tool) motion.tool = real_tool;
    stage_->take({&motion, 1});
    ++next_;
  }
  if (program.complete() && next_ - program.forgotten() == motions.size()) {
    stage_->finish(false);
    finished_ = true;
  } else {
    stage_->complete();
  }
  collect(now_s, out);
}

void LookAheadGuard::collect(double now_s, std::vector<AheadWarning>& out) {
  for (; collected_ < log_->kept().size(); ++collected_) {
    const Finding& finding = log_->kept()[collected_];
    // A head that meets a part which has tipped is a collision, as far as anybody can tell.
    // So is what would be one if the blank is as it was guessed.
    const bool hits =
        finding.severity == Severity::kError || finding.id == FindingId::kCrossesPart ||
        finding.id == FindingId::kRapidContact || finding.id == FindingId::kSpindleOffContact ||
        finding.id == FindingId::kBelowStock;
    if (!hits) continue;
    const auto place = static_cast<std::uint64_t>(finding.source.file) << 32 | finding.source.line;
    const double at_s = base_s_ + finding.time_s.value_or(now_s - base_s_);
    const auto [told, first] = told_.insert({{static_cast<int>(finding.id), place}, at_s});
    if (!first && at_s < told->second + kSameEvent_s) continue;
    told->second = at_s;
    AheadWarning warning{finding, 0};
    warning.finding.time_s = at_s;
    warning.in_s = std::max(0.0, at_s - now_s);
    out.push_back(std::move(warning));
  }
}

}  // namespace kerf
