#include "twin/cli/live_console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <utility>

#include "base/translate.h"
#include "twin/cli/console.h"
#include "twin/live/live_text.h"
#include "twin/report/shown_lengths.h"

namespace kerf {
namespace {

/// Findings printed one by one; the rest are only counted (and all are in --json).
constexpr std::size_t kFindingsShown = 50;

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

std::string status_line(const LiveStatus& status) {
  const ToolState& place = status.place;
  std::string out = tr(to_string(status.state));
  if (status.state == LiveState::kStale || status.state == LiveState::kLost) {
    out += trf(" {} old", short_age_text(status.age_s));
  }
  if (place.known) {
    out += fmt::format("  X{:.2f} Y{:.2f} Z{:.2f}", place.tip_mm.x, place.tip_mm.y, place.tip_mm.z);
  } else if (!place.missing_axes.empty()) {
    out += trf("  no position of {}", place.missing_axes);
  }
  if (place.tool >= 0) out += fmt::format("  T{}", place.tool);
  if (place.has_program_place()) {
    out += fmt::format("  {}:{}", std::filesystem::path(status.file).filename().string(),
                       place.source.line);
  } else if (status.off_path_mm > 0) {
    out += trf("  {:.2f} mm off the path", status.off_path_mm);
  }
  if (place.has_program_place() && status.remaining_s >= 0) {
    out += trf("  {} left", time_left_text(status.remaining_s));
  }
  if (status.load) out += trf("  load {}", text_of(*status.load));
  if (status.collision_in_s >= 0) {
    out += trf("  COLLISION in {:.1f} s, line {}", status.collision_in_s, status.collision_line);
  }
  return out;
}

LiveConsole::LiveConsole(bool quiet, std::FILE* events)
    : quiet_(quiet), terminal_(!quiet && isatty(STDERR_FILENO) != 0), events_(events) {
  head_.instance_id = static_cast<std::uint64_t>(now_ns() / 1000);
  head_.sequence = 0;
}

LiveConsole::~LiveConsole() { wipe(); }

void LiveConsole::wipe() {
  if (!drawn_) return;
  kerf::print(stderr, "\r\033[K");
  drawn_ = false;
}

void LiveConsole::say(const std::string& text) {
  wipe();
  kerf::print(stderr, "{}", text);
  flush_console();
}

void LiveConsole::send(const std::string& line) {
  if (!events_ || events_error_ != 0) return;
  if (std::fwrite(line.data(), 1, line.size(), events_) == line.size() &&
      std::fflush(events_) == 0) {
    return;
  }
  events_error_ = errno != 0 ? errno : EIO;
}

EventHead LiveConsole::next_head() {
  ++head_.sequence;
  head_.time_ns = now_ns();
  return head_;
}

/// At the end of the watch, which may be hours away, it is told as an error.
void LiveConsole::look_at_recorder() {
  if (recorder_ == nullptr) return;
  const std::string trouble = recorder_->status().trouble;
  if (trouble.empty()) return;
  say(trf("kerf: {}; the machine is watched on\n", trouble));
  recorder_ = nullptr;
}

void LiveConsole::on_status(const LiveStatus& status) {
  send(status_json(status, next_head()));
  look_at_recorder();
  const bool changed = !state_told_ || status.state != state_;
  // What goes wrong is worth a line when it begins, not each time that it is tried again.
  const bool counts = status.source.errors > errors_ || status.source.reconnects > reconnects_ ||
                      status.state == LiveState::kWaiting;
  const bool trouble = status.source.trouble != trouble_ && counts;
  if (!quiet_ && trouble && !status.source.trouble.empty()) {
    say(fmt::format("kerf: {}\n", status.source.trouble));
    trouble_ = status.source.trouble;
  }
  errors_ = status.source.errors;
  reconnects_ = status.source.reconnects;
  if (changed && !quiet_ && status.state != LiveState::kEnded) {
    const bool waiting = status.state == LiveState::kWaiting;
    const std::string why =
        waiting && !status.source.trouble.empty() ? ": " + status.source.trouble : std::string();
    say(fmt::format("kerf: {}{}\n", in_unit(status_line(status), shown_unit()), why));
    if (waiting) trouble_ = status.source.trouble;
  }
  state_told_ = true;
  state_ = status.state;
  if (!terminal_) return;
  if (status.state == LiveState::kEnded) {
    wipe();
    return;
  }
  kerf::print(stderr, "\r\033[K{:.100}", in_unit(status_line(status), shown_unit()));
  flush_console();
  drawn_ = true;
}

void LiveConsole::on_finding(const Finding& finding, const std::vector<std::string>& files) {
  send(finding_event_json(finding, files, next_head()));
  if (quiet_ && finding.severity != Severity::kError) return;
  if (printed_ == kFindingsShown) {
    ++unprinted_;
    return;
  }
  ++printed_;
  say(to_string(in_unit(diagnostic_of(finding, files), shown_unit())));
}

void LiveConsole::on_warning(const AheadWarning& warning, const std::vector<std::string>& files) {
  send(ahead_json(warning, files, next_head()));
  Diagnostic ahead = diagnostic_of(warning.finding, files);
  ahead.message = trf("in {:.1f} s: {}", warning.in_s, ahead.message);
  // Each is one of a kind, and what kerf is there for.
  say(to_string(in_unit(std::move(ahead), shown_unit())));
}

/// The one that the watch ends with is in the report, and alone it is the whole watch.
void LiveConsole::on_run(const LiveRun& run) {
  send(run_event_json(run, next_head()));
  if (quiet_) return;
  say(trf("kerf: run {} of {}: {}, part {}\n", run.number,
          std::filesystem::path(run.program).filename().string(), tr(to_string(run.end)),
          run.part));
}

}  // namespace kerf
