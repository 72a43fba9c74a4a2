// twin/cli/program_setup.h - blank, tools and fixtures of a program, as they were set in the
// window, remembered from one time to the next.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "twin/config/written_options.h"
#include "viewer/scene.h"

namespace kerf {

/// Texts as their options take them; empty: as if there were none.
struct ProgramSetup {
  std::string stock, cell, model;
  std::vector<std::pair<int, std::string>> tools;  ///< number and SHAPE
  std::vector<std::string> fixtures;

  bool operator==(const ProgramSetup&) const = default;
};

/// What of it a command line says. Tools without a number are left out.
ProgramSetup setup_of(const WrittenOptions& options);
/// What it says takes the place of what is there; of what it leaves empty, that stays.
void lay_over(const ProgramSetup& setup, WrittenOptions& options);
/// The tools that a program uses and those that the set-up gives, by number.
std::vector<JobTool> job_tools(std::vector<JobTool> used, const ProgramSetup& setup);

/// A file of set-ups, by the path of the program: JSON, those that were set last first, kMost of
/// them. Another kerf may write it, too: the file is whole at all times, and read at each call.
class SetupMemory {
 public:
  static constexpr std::size_t kMost = 500;

  /// `path` empty: nothing is remembered.
  explicit SetupMemory(std::string path) : path_(std::move(path)) {}
  /// Nothing: the program has none. Error: the file cannot be read, or is something else.
  Result<std::optional<ProgramSetup>> find(const std::string& program) const;
  /// An empty one is forgotten. Error: as of find(), and the file stays as it is; or it cannot be
  /// written.
  Done keep(const std::string& program, const ProgramSetup& setup) const;

 private:
  std::string path_;
};

/// $XDG_STATE_HOME/kerf/programs.json, else below $HOME/.local/state; empty if neither is set.
std::string setup_memory_path();

}  // namespace kerf
