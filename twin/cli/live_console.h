// twin/cli/live_console.h - what a person beside a machine reads, and what other programs are told.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "machine_io/recorder.h"
#include "twin/live/live_json.h"
#include "twin/live/live_session.h"

namespace kerf {

/// "live  X12.34 Y5.00 Z-1.20  T3  part.ngc:118  2 min 05 s left", at most one line of a terminal.
std::string status_line(const LiveStatus& status);

/// Prints states, findings and warnings to stderr as they come; on a terminal a line below them
/// follows the machine. Writes the event stream (live_json.h) to `events`, if there is one, a line
/// at a time.
class LiveConsole final : public LiveObserver {
 public:
  /// `quiet`: errors and warnings of collisions only. `events` may be null; not closed here.
  LiveConsole(bool quiet, std::FILE* events);
  ~LiveConsole() override;
  /// Tells when this recording stops, as soon as it does. It outlives the calls of on_status().
  void watch(const Recorder& recorder) { recorder_ = &recorder; }

  void on_status(const LiveStatus& status) override;
  void on_finding(const Finding& finding, const std::vector<std::string>& files) override;
  void on_warning(const AheadWarning& warning, const std::vector<std::string>& files) override;
  void on_run(const LiveRun& run) override;

  /// The event stream could not be written (its reader has gone): errno of the first failure.
  int events_error() const { return events_error_; }
  /// Findings that were not printed, as there were too many.
  std::size_t unprinted() const { return unprinted_; }

 private:
  void say(const std::string& text);
  void send(const std::string& line);
  EventHead next_head();
  void wipe();
  void look_at_recorder();

  bool quiet_;
  bool terminal_;
  std::FILE* events_;
  EventHead head_;                      ///< of the event before
  const Recorder* recorder_ = nullptr;  ///< null: none, or its end is told
  int events_error_ = 0;
  bool drawn_ = false;
  LiveState state_ = LiveState::kWaiting;
  bool state_told_ = false;
  std::string trouble_;
  std::uint64_t errors_ = 0;
  std::uint64_t reconnects_ = 0;
  std::size_t printed_ = 0;
  std::size_t unprinted_ = 0;
};

}  // namespace kerf
