// twin/cli/job_run.h - the setups of a job, one after the other, and the workpiece from each to the
// next.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostic.h"
#include "interp_bridge/private_folder.h"
#include "twin/cli/run_command.h"
#include "twin/config/job_file.h"
#include "twin/job/placed_stock.h"
#include "twin/process/cut_labels.h"
#include "twin/process/kept_moves.h"

namespace kerf {

/// What a job came to.
struct JobResult {
  struct Setup {
    std::string name;    ///< "bottom", "setup 2"
    std::string words;   ///< "setup 2 (bottom)", "setup 2"
    std::string report;  ///< kerf-report/1; empty: it came to none
    double machining_s = 0, setup_s = 0;
    std::optional<CarriedOver> carried;  ///< how the workpiece came to it; of the first one none
    std::string lies;                    ///< "flipped about X"; empty: as before
    std::vector<ToolUse> tools;
    std::optional<Comparison> comparison;
    std::vector<std::string> files;  ///< of the program: what SourceRef::file means
    std::string article;             ///< of the page over all; empty: none was asked for
    std::string table;               ///< its motions, a file of the job's; empty: none, or not run
    std::size_t errors = 0, warnings = 0, notes = 0;
    /// Who of the setups before made gouges of `comparison` that this one did not: by the number of
    /// their region.
    struct MadeBefore {
      std::size_t region = 0, setup = 0;  ///< `setup` from 1
      std::string name, words, file;      ///< of the setup; of its program
      std::uint32_t line = 0;
      int tool = 0;
    };
    std::vector<MadeBefore> made_before;
    bool is_whole = false;  ///< its program was run to its end
  };
  std::vector<Setup> setups;  ///< those that have been run
  std::vector<std::string> not_run;
  bool stopped_between = false;  ///< the workpiece could not go on, for a reason of the job file
  std::vector<ListedProgram> listed;
  int code = kExitGood;

  double machining_s() const;
  double setup_s() const;
};

/// Runs them in this process. The workpiece goes from one to the next by a file of a private folder
/// (kerf-state/1), as it lies there and in a model that the next one can cut: place_stock(). Where
/// a later setup lays it on its side or in between, an octree is cut from the beginning: so nothing
/// has to be made anew from what heights know.
class JobRun {
 public:
  /// `asked`: the command line; what of it is for all setups is theirs.
  static std::optional<JobRun> open(const Arguments& asked, const std::string& path,
                                    Diagnostics& diagnostics);

  std::size_t count() const { return job_.setups.size(); }
  const JobFile& job() const { return job_; }
  /// All options of all setups, as far as they can be checked before anything is cut.
  void check(Diagnostics& diagnostics) const;

  /// Which files the last setup is to leave, and what else is asked of it.
  struct Wishes {
    OutputPaths last;    ///< of the last setup; json, junit and sarif are the job's own
    std::string folder;  ///< of pictures; empty: none
    bool keeps_pages = false, keeps_tables = false;  ///< Setup::article and ::table
    bool on_stderr = false;                          ///< summaries: standard output is a file's
    bool compares = true;
  };
  /// Setups `first` (0-based) up to before `end`, each after the one before has left its workpiece.
  /// Ends early where one does not come to its end. Messages are printed as they come.
  void run(std::size_t first, std::size_t end, const Wishes& wishes);
  const JobResult& result() const { return result_; }
  /// The workpiece for this setup is there.
  bool is_ready(std::size_t setup) const { return setup == 0 || ready_ >= setup; }
  /// For a window: the command line of `kerf view` of that setup. `is_asked`: it is the one that
  /// the command line is about, and what that says of blank and tools goes before the file.
  Arguments view_arguments(std::size_t setup, bool is_asked = true) const;
  /// "setup 2 of 3: bottom"
  std::string title_of(std::size_t setup) const;
  /// "what setup 1 (top) has left, flipped about X"; of the first one nothing.
  std::string blank_words(std::size_t setup) const;
  /// The workpiece that setup `next` begins with, as --stock has it.
  std::string carried_blank(std::size_t next) const { return "state:" + state_of(next); }
  /// What a setup has left goes on to the next one, as run() does it: is_ready() of that one from
  /// then on, of no later one. False: why not.
  bool carry_over(std::size_t next, const StockModel& stock, Diagnostics& diagnostics);
  /// What this setup leaves is not known any more.
  void forget_after(std::size_t setup) { ready_ = std::min(ready_, setup); }

 private:
  JobRun(const Arguments& asked, JobFile job, std::string text, PrivateFolder folder);
  Arguments arguments_of(std::size_t setup, const Wishes& wishes) const;
  RunRequest request_of(std::size_t setup, const Wishes& wishes, const Arguments& arguments,
                        Diagnostics& diagnostics) const;
  std::string state_of(std::size_t setup) const;
  std::string table_of(std::size_t setup) const;
  std::string need_of_octree(std::size_t after) const;
  Diagnostic fault_at(const JobPlace& place, std::string message, std::string hint = {}) const;
  void take(std::size_t setup, const Wishes& wishes, const FinishedRun& run,
            Diagnostics& diagnostics);

  /// What a setup did, for who asks after later ones.
  struct Past {
    KeptMoves moves;
    std::vector<CutLabel> labels;
    std::vector<std::string> files;
    Placement to_next;
  };
  std::optional<JobResult::Setup::MadeBefore> made_before(Vec3 point_mm, double cell_mm) const;

  std::vector<Past> past_;
  Arguments asked_;
  JobFile job_;
  std::string text_;
  PrivateFolder folder_;
  JobResult result_;
  std::size_t ready_ = 0;
  std::map<std::size_t, CarriedOver> carried_;
};

/// A tool over all setups that have it with that shape.
struct ToolOfSetups {
  ToolUse use;
  std::vector<std::size_t> setups;  ///< from 1
};
std::vector<ToolOfSetups> tools_of(const JobResult& result);

/// kerf-job/1.
std::string job_json(const JobResult& result, const std::string& path, const std::string& version);
/// What is said last: times, tools, comparison over all.
std::string job_text(const JobResult& result, LengthUnit units);
/// "flipped about X, then turned by 0, 0, 90 degrees"; empty: it lies as before.
std::string words_of(const JobTurn& turn);

}  // namespace kerf
