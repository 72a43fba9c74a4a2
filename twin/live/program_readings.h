// twin/live/program_readings.h - one program that a watched machine may run, read as seldom as can
// be.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "interp_bridge/program.h"
#include "twin/program/shared_reading.h"

namespace kerf {

/// A watch needs a program's motions many times: to guess the blank, to follow the machine, to find
/// it in the middle of the program, for how long all of it takes, and again for each run. Equal
/// inputs are interpreted once (SharedReading). Read anew is a program
///
///     from another start      what is relative (G91), or goes back to where it began (G98), comes
///                             out elsewhere
///     whose files changed     it, its subroutines, the tool table, the INI, the parameter file
///     that was not read on    the reading ended with the last one who wanted it
///
/// Keeps the reading from the start that the options have, and the newest from another one. Any
/// thread.
class ProgramReadings {
 public:
  using Start = std::array<double, 9>;  ///< InterpreterSetup::start

  /// Of a program that can be opened more than once: no standard input. Null with diagnostics, as
  /// Program::open().
  static std::shared_ptr<ProgramReadings> open(const ProgramOptions& options,
                                               Diagnostics& diagnostics);
  /// Opens nothing yet.
  explicit ProgramReadings(ProgramOptions options) : options_(std::move(options)) {}

  /// For what is known without interpreting. Of open() only, and before reader().
  const Program& source() const { return first_->source(); }
  /// Before reader().
  void give_tools(const KnownTools& tools);
  /// The program from its beginning, of a machine that stands there. Null with diagnostics: it has
  /// to be opened, and cannot be.
  std::unique_ptr<Program> reader(const Start& start, Diagnostics& diagnostics);

 private:
  /// What a file was when it was read.
  struct Stamp {
    std::string path;
    std::int64_t changed_ns = 0;
    std::int64_t size = -1;  ///< -1: it is not there
    bool operator==(const Stamp&) const = default;
  };
  struct Known {
    Start start{};
    std::vector<Stamp> stamps;
    std::int64_t opened_ns = 0;  ///< by the clock of files
    std::shared_ptr<SharedReading> reading;
  };
  static Stamp stamp_of(const std::string& path);
  std::vector<Stamp> stamps() const;
  bool is_fresh(const Known& known) const;
  Known open(const Start& start, Diagnostics& diagnostics) const;

  ProgramOptions options_;
  KnownTools tools_;
  std::shared_ptr<SharedReading> first_;
  std::mutex mutex_;          // of known_
  std::vector<Known> known_;  ///< at most two: from options_' start, and from another one
};

}  // namespace kerf
