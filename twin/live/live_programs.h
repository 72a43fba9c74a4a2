// twin/live/live_programs.h - the programs that a watched machine may run.
#pragma once

#include <atomic>
#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "interp_bridge/program.h"
#include "twin/live/live_shift.h"
#include "twin/live/program_readings.h"
#include "twin/machine/timeline.h"

namespace kerf {

/// Opened in this order: open(), start(), then the rest, by one thread; measure() and total_s() by
/// any. Of standard input there is but one reading, that of take_followed().
class LivePrograms {
 public:
  /// The first one; what is known of it without interpreting is there from now on. False with
  /// diagnostics, as Program::open().
  bool open(const ProgramOptions& first, Diagnostics& diagnostics);
  /// With the tools' diameters, which all readings need, and the paths of the others, of the same
  /// settings. Not without open(). False with diagnostics.
  bool start(const KnownTools& tools, std::span<const std::string> others,
             Diagnostics& diagnostics);

  /// The first one, for what is known without interpreting; null: there is none.
  const Program* first() const { return first_; }
  /// The first one can be read more than once.
  bool can_read_again() const { return !readings_.empty() && readings_[0] != nullptr; }
  /// All motions of the first one, from its beginning. Only if can_read_again(); null with
  /// diagnostics.
  std::unique_ptr<Program> read(Diagnostics& diagnostics) const;
  /// The first one, to be followed. Once; null: there is none.
  std::unique_ptr<Program> take_followed() { return std::move(followed_); }

  /// As a shift wants them, the first one first.
  const std::vector<ShiftProgram>& all() const { return all_; }

  /// Finds out how long each takes, for what remains of it.
  void measure(const TimelineOptions& timeline, std::stop_token stop);
  /// < 0: not known (yet).
  double total_s(std::size_t index) const {
    return index < total_s_.size() ? total_s_[index].load() : -1;
  }

 private:
  ProgramOptions options_;
  /// One a program, the first one's empty if it is standard input.
  std::vector<std::shared_ptr<ProgramReadings>> readings_;
  const Program* first_ = nullptr;
  std::unique_ptr<Program> followed_;
  std::vector<ShiftProgram> all_;
  std::vector<std::atomic<double>> total_s_;
};

}  // namespace kerf
