#include "interp_bridge/canonical_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "interp_bridge/program_prepare.h"

namespace kerf {
namespace {

constexpr std::size_t kBufferBytes = 256 * 1024;
constexpr std::size_t kBatchMotions = 4096;
/// A rigid tap gives two motions; a command never more.
constexpr std::size_t kMotionsPerCommand = 2;
constexpr std::chrono::milliseconds kOldBatch{40};
constexpr std::size_t kMaxForeignLines = 100;
constexpr std::size_t kMaxForeignBytes = 500;
constexpr std::uint64_t kMaxMalformedReports = 20;
constexpr std::size_t kMaxUnknownNames = 100;
constexpr std::size_t kExcerptBytes = 200;

std::string cut(std::string_view text, std::size_t bytes) {
  return std::string(text.substr(0, bytes));
}

bool before(const SourceRef& a, const SourceRef& b) {
  return a.file != b.file ? a.file < b.file : a.line < b.line;
}

}  // namespace

CanonicalReader::CanonicalReader(CanonicalReaderOptions options, const MotionSink& sink,
                                 ProgramSummary& summary, Diagnostics& diagnostics)
    : options_(std::move(options)),
      sink_(sink),
      summary_(summary),
      diagnostics_(diagnostics),
      fold_(options_.tool_by_index),
      buffer_(kBufferBytes) {
  batch_.reserve(kBatchMotions + kMotionsPerCommand);
}

std::span<char> CanonicalReader::room() { return std::span<char>(buffer_).subspan(filled_); }

bool CanonicalReader::received(std::size_t bytes) {
  filled_ += bytes;
  const char* p = buffer_.data();
  const char* const end = p + filled_;
  bool go_on = true;
  while (go_on && p != end) {
    const auto* newline =
        static_cast<const char*>(std::memchr(p, '\n', static_cast<std::size_t>(end - p)));
    if (newline == nullptr) break;
    go_on = take_line({p, static_cast<std::size_t>(newline - p)});
    p = newline + 1;
  }
  filled_ = static_cast<std::size_t>(end - p);
  std::memmove(buffer_.data(), p, filled_);
  if (go_on && filled_ == buffer_.size()) {
    // No line of a listing is nearly as long.
    filled_ = 0;
    go_on = take_line({buffer_.data(), buffer_.size()});
  }
  return go_on && flush_if_old();
}

bool CanonicalReader::take_line(std::string_view line) {
  ++listing_line_;
  parse_canonical_line(line, line_);
  switch (line_.kind) {
    case CanonicalLineKind::kCommand:
      take_command();
      break;
    case CanonicalLineKind::kUnknown:
      take_unknown();
      break;
    case CanonicalLineKind::kForeign:
      add_foreign(line);
      break;
    case CanonicalLineKind::kMalformed:
      take_malformed(line);
      break;
  }
  if (options_.max_commands != 0 && commands_ > options_.max_commands) {
    too_many_ = true;
    return false;
  }
  return batch_.size() < kBatchMotions || hand_over();
}

void CanonicalReader::locate(const CanonicalCommand& command) {
  if (!options_.numbered_source) {
    const bool usable =
        command.has_n && command.n > 0 && command.n <= std::numeric_limits<std::uint32_t>::max();
    source_ = {0, static_cast<std::uint32_t>(usable ? command.n : listing_line_)};
  } else if (command.has_n) {
    source_ = source_of_n(command.n);
  } else if (!options_.unnumbered.empty() && source_.line != 0) {
    // A line that was too long to be numbered: the next of them in the same file.
    const auto next =
        std::upper_bound(options_.unnumbered.begin(), options_.unnumbered.end(), source_, before);
    if (next != options_.unnumbered.end() && next->file == source_.file) source_ = *next;
  }
}

void CanonicalReader::take_command() {
  const CanonicalCommand& command = line_.command;
  ++commands_;
  if (command.spelling.size() == canonical_spelling(command.name).size()) {
    ++counts_[static_cast<std::size_t>(command.name)];
  } else {
    ++summary_.canonical_commands[std::string(command.spelling)];
  }
  locate(command);
  if (!command.text.empty()) remark_on_text(command);
  const bool first = batch_.empty();
  const FoldRemark said = fold_.fold(command, source_, batch_);
  if (first && !batch_.empty()) batch_since_ = std::chrono::steady_clock::now();
  if (said != FoldRemark::kNone) remark(said);
}

Diagnostic CanonicalReader::at_source(Severity severity, std::string message) const {
  Diagnostic diagnostic;
  diagnostic.severity = severity;
  if (source_.file < summary_.files.size()) diagnostic.file = summary_.files[source_.file];
  diagnostic.line = static_cast<int>(source_.line);
  diagnostic.message = std::move(message);
  return diagnostic;
}

void CanonicalReader::remark(FoldRemark said) {
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
}

void CanonicalReader::remark_on_text(const CanonicalCommand& command) {
  if (command.name == CanonicalName::kCanonError) {
    diagnostics_.push_back(at_source(Severity::kError, cut(command.text, kExcerptBytes)));
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

void CanonicalReader::take_unknown() {
  ++commands_;
  const std::string name(line_.command.spelling);
  auto& counts = summary_.canonical_commands;
  const auto found = counts.find(name);
  if (found != counts.end()) {
    ++found->second;
    return;
  }
  if (counts.size() >= kMaxUnknownNames) {
    ++counts["(other)"];
    return;
  }
  counts.emplace(name, 1);
  Diagnostic unknown;
  unknown.severity = Severity::kWarning;
  unknown.file = options_.listing_name;
  unknown.line = static_cast<int>(listing_line_);
  unknown.message = fmt::format("unknown canonical command {}; it is counted and passed over",
                                cut(name, kExcerptBytes));
  diagnostics_.push_back(std::move(unknown));
}

void CanonicalReader::take_malformed(std::string_view line) {
  if (++malformed_ > kMaxMalformedReports) return;
  Diagnostic malformed;
  malformed.file = options_.listing_name;
  malformed.line = static_cast<int>(listing_line_);
  malformed.column = line_.column;
  malformed.message = fmt::format("{}: {}", line_.command.spelling, line_.message);
  malformed.excerpt = cut(line, kExcerptBytes);
  if (static_cast<std::size_t>(malformed.column) > kExcerptBytes) malformed.excerpt.clear();
  diagnostics_.push_back(std::move(malformed));
}

void CanonicalReader::add_foreign(std::string_view line) {
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  if (line.find_first_not_of(" \t") == line.npos) return;
  ++summary_.foreign_line_count;
  if (summary_.foreign_lines.size() < kMaxForeignLines) {
    summary_.foreign_lines.push_back(cut(line, kMaxForeignBytes));
  }
}

bool CanonicalReader::hand_over() {
  if (batch_.empty() || sink_done_) return !sink_done_;
  sink_done_ = !sink_(batch_);
  batch_.clear();
  return !sink_done_;
}

bool CanonicalReader::flush_if_old() {
  if (batch_.empty()) return true;
  if (std::chrono::steady_clock::now() - batch_since_ < kOldBatch) return true;
  return hand_over();
}

void CanonicalReader::finish() {
  if (filled_ > 0 && !sink_done_ && !too_many_) take_line({buffer_.data(), filled_});
  filled_ = 0;
  hand_over();
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    if (counts_[i] == 0) continue;
    summary_.canonical_commands[std::string(canonical_spelling(static_cast<CanonicalName>(i)))] +=
        counts_[i];
  }
  counts_.fill(0);
  summary_.has_program_end = fold_.has_program_end();
  summary_.has_rotary_motion = fold_.has_rotary_motion();
  if (malformed_ > kMaxMalformedReports) {
    Diagnostic more;
    more.file = options_.listing_name;
    more.message =
        fmt::format("{} more lines could not be read", malformed_ - kMaxMalformedReports);
    diagnostics_.push_back(std::move(more));
  }
  if (splines_lost_ > 1) {
    Diagnostic more;
    more.severity = Severity::kWarning;
    if (!summary_.files.empty()) more.file = summary_.files[0];
    more.message = fmt::format("{} splines were not cut", splines_lost_);
    diagnostics_.push_back(std::move(more));
  }
}

}  // namespace kerf
