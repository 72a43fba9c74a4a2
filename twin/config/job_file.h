// twin/config/job_file.h - a part that is made in several setups, as a YAML file says it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "twin/config/job_turn.h"
#include "twin/config/written_options.h"

namespace kerf {

/// Where something stands in the file.
struct JobPlace {
  std::string path;  ///< "setups[2].stock"
  int line = 0, column = 0;
};

struct JobSetup {
  std::string name;        ///< of the file; empty: it has none
  WrittenOptions options;  ///< of `kerf run`, the program as well; of the first one with --stock
  JobTurn turn;            ///< of the first one none
  double time_s = 0;       ///< to set it up
  JobPlace place;
  std::map<std::string, JobPlace, std::less<>> option_places;  ///< by option
};

struct JobFile {
  std::string path;
  std::vector<JobSetup> setups;
  WrittenOptions compare;  ///< --compare and what goes with it, of the last one; empty: none
  std::map<std::string, JobPlace, std::less<>> compare_places;

  /// "bottom", or "setup 2" of one without a name. Setups count from 0 here.
  std::string name_of(std::size_t setup) const;
  /// "setup 2 (bottom)", or "setup 2".
  std::string words_of(std::size_t setup) const;
};

/// All faults at once, each at its place, with what is allowed. Nothing if there is one. Files are
/// relative to `path`; programs must be there.
std::optional<JobFile> parse_job(std::string_view text, const std::string& path,
                                 Diagnostics& diagnostics);

/// Faults of options of a setup ("--cell: ..") where the file says them ("setups[2].cell_mm: ..").
/// `text` is the file's, for excerpts.
void place_faults(const JobFile& job, std::string_view text,
                  const std::map<std::string, JobPlace, std::less<>>& places,
                  Diagnostics& diagnostics);

/// A YAML file with setups.
bool is_job_file(const std::string& path);

}  // namespace kerf
