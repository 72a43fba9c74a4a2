#include "interp_bridge/motion_feeder.h"

#include <fmt/format.h>

#include <utility>

namespace kerf {
namespace {

constexpr std::size_t kBatchMotions = 4096;
/// A rigid tap gives two motions; no command but a spline gives more.
constexpr std::size_t kMotionsPerCommand = 2;
constexpr std::chrono::milliseconds kOldBatch{40};
constexpr std::size_t kMaxForeignLines = 100;
constexpr std::size_t kMaxForeignBytes = 500;
constexpr std::size_t kMaxUnknownNames = 100;
constexpr std::size_t kExcerptBytes = 200;

}  // namespace

MotionFeeder::MotionFeeder(MotionFeederOptions options, const MotionSink& sink,
                           ProgramSummary& summary, Diagnostics& diagnostics)
    : options_(std::move(options)),
      sink_(sink),
      summary_(summary),
      diagnostics_(diagnostics),
      fold_(options_.tool_by_index) {
  if (options_.start) fold_.stand_at(*options_.start);
  batch_.reserve(kBatchMotions + kMotionsPerCommand);
}

bool MotionFeeder::take(const CanonicalCommand& command, SourceRef source) {
  source_ = source;
  if (command.spelling.empty() ||
      command.spelling.size() == canonical_spelling(command.name).size()) {
    ++counts_[static_cast<std::size_t>(command.name)];
  } else {
    ++summary_.canonical_commands[std::string(command.spelling)];
  }
  if (!command.text.empty()) remark_on_text(command);
  const bool first = batch_.empty();
  const FoldRemark said = fold_.fold(command, source_, batch_);
  if (said != FoldRemark::kNone) remark(said);
  return took(first);
}

bool MotionFeeder::take_spline(const Spline& spline, SourceRef source) {
  source_ = source;
  ++counts_[static_cast<std::size_t>(CanonicalName::kNurbsFeed)];
  const bool first = batch_.empty();
  const FoldRemark said = fold_.fold_spline(spline, source_, batch_);
  if (said != FoldRemark::kNone) remark(said);
  return took(first);
}

bool MotionFeeder::took(bool batch_was_empty) {
  if (batch_was_empty && !batch_.empty()) batch_since_ = std::chrono::steady_clock::now();
  ++commands_;
  if (options_.max_commands != 0 && commands_ > options_.max_commands) too_many_ = true;
  return (batch_.size() < kBatchMotions || hand_over()) && !too_many_;
}

bool MotionFeeder::take_unknown(std::string_view name) {
  ++commands_;
  auto& counts = summary_.canonical_commands;
  const auto found = counts.find(std::string(name));
  if (found != counts.end()) {
    ++found->second;
    return false;
  }
  if (counts.size() >= kMaxUnknownNames) {
    ++counts["(other)"];
    return false;
  }
  counts.emplace(name, 1);
  return true;
}

Diagnostic MotionFeeder::at_source(Severity severity, std::string message) const {
  Diagnostic diagnostic;
  diagnostic.severity = severity;
  if (source_.file < summary_.files.size()) diagnostic.file = summary_.files[source_.file];
  diagnostic.line = static_cast<int>(source_.line);
  diagnostic.message = std::move(message);
  return diagnostic;
}

void MotionFeeder::remark(FoldRemark said) {
  if (said == FoldRemark::kSplineLost && splines_lost_++ == 0) {
    Diagnostic lost =
        at_source(Severity::kWarning,
                  "a spline (G5, G5.1, G5.2) is not cut: LinuxCNC's listing holds its "
                  "number of points only");
    lost.hint = "the move after a spline is not cut either, since its start is not known";
    diagnostics_.push_back(std::move(lost));
  }
  if (said == FoldRemark::kArcPlaneUnknown && !std::exchange(plane_reported_, true)) {
    diagnostics_.push_back(
        at_source(Severity::kWarning,
                  "an arc in a plane other than XY, YZ and XZ (G17, G19, G18) is not cut"));
  }
  if (said == FoldRemark::kSecondaryAxes && !std::exchange(secondary_reported_, true)) {
    diagnostics_.push_back(at_source(
        Severity::kWarning, "the program moves U, V or W; the cut is that of X, Y, Z alone"));
  }
}

void MotionFeeder::remark_on_text(const CanonicalCommand& command) {
  if (command.name == CanonicalName::kCanonError) {
    diagnostics_.push_back(
        at_source(Severity::kError, std::string(command.text.substr(0, kExcerptBytes))));
    return;
  }
  constexpr std::string_view kCompensation = "interpreter: cutter radius compensation on";
  if (options_.diameters_known || compensation_reported_ ||
      command.name != CanonicalName::kComment ||
      command.text.substr(0, kCompensation.size()) != kCompensation) {
    return;
  }
  compensation_reported_ = true;
  Diagnostic unknown = at_source(
      Severity::kWarning,
      "cutter radius compensation (G41, G42) without a tool table: the radius counts as 0");
  unknown.hint = "give the machine's table with --tool-table";
  diagnostics_.push_back(std::move(unknown));
}

void MotionFeeder::add_foreign(std::string_view line) {
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  if (line.find_first_not_of(" \t") == line.npos) return;
  ++summary_.foreign_line_count;
  if (summary_.foreign_lines.size() < kMaxForeignLines) {
    summary_.foreign_lines.emplace_back(line.substr(0, kMaxForeignBytes));
  }
}

bool MotionFeeder::hand_over() {
  if (batch_.empty() || sink_done_) return !sink_done_;
  if (options_.frame != nullptr && !frame_told_ && fold_.workpiece_frame_fixed()) {
    *options_.frame = fold_.workpiece_frame();
    frame_told_ = true;
  }
  sink_done_ = !sink_(batch_);
  batch_.clear();
  return !sink_done_;
}

bool MotionFeeder::flush_if_old() {
  if (batch_.empty()) return true;
  if (std::chrono::steady_clock::now() - batch_since_ < kOldBatch) return true;
  return hand_over();
}

void MotionFeeder::finish() {
  hand_over();
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    if (counts_[i] == 0) continue;
    summary_.canonical_commands[std::string(canonical_spelling(static_cast<CanonicalName>(i)))] +=
        counts_[i];
  }
  counts_.fill(0);
  summary_.has_program_end = fold_.has_program_end();
  summary_.has_rotary_motion = fold_.has_rotary_motion();
  summary_.lost_splines = splines_lost_;
  if (splines_lost_ > 1) {
    Diagnostic more;
    more.severity = Severity::kWarning;
    if (!summary_.files.empty()) more.file = summary_.files[0];
    more.message = fmt::format("{} splines were not cut", splines_lost_);
    diagnostics_.push_back(std::move(more));
  }
}

}  // namespace kerf
