// twin/cli/view_setups.h - the setups of a part in a window, which plays them one after the other.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "twin/cli/file_watch.h"
#include "twin/cli/job_run.h"

namespace kerf {

/// Which setup is shown, what its command line is, and the workpiece from one to the next: made of
/// what has been played to its end, and kept, so that going back and forth costs no cutting.
/// Nothing of what a setup leaves counts any more once its files have changed, or it is cut
/// otherwise. The job file itself is read once. For one thread.
class ViewSetups {
 public:
  /// `asked`: `kerf view JOB`, with what goes with it. Null: what is wrong is in the diagnostics.
  static std::unique_ptr<ViewSetups> open(const Arguments& asked, Diagnostics& diagnostics);

  /// Runs those before `first` unseen, as `kerf job` does, and shows that one. Nothing: it is
  /// shown; else the exit code of what has come to no end, or of a workpiece that does not go on.
  std::optional<int> begin(std::size_t first);

  std::size_t count() const { return run_.count(); }
  std::size_t shown() const { return shown_; }
  const std::string& path() const { return run_.job().path; }
  /// "1  top": for a list.
  std::vector<std::string> names() const;
  /// "housing.yaml, setup 1 of 2: top"
  std::string title() const;
  /// What is cut by these arguments in the one that is shown: "what setup 1 (top) has left, flipped
  /// about X"; empty: a blank.
  std::string blank_words(const Arguments& shown) const;
  /// As --stock has it; empty: of the first one.
  std::string carried_blank() const;

  /// `kerf view PROGRAM` for the one that is shown, as it was left.
  Arguments arguments() const;
  /// `kerf view JOB --setup N` with what of `shown` is otherwise than the job has it.
  Arguments job_arguments(const Arguments& shown) const;

  /// Of this one and those before it the last whose workpiece is there, of files as they are now.
  std::size_t last_ready(std::size_t setup) const;
  /// Of those before the one that is shown the first whose files have changed since.
  std::optional<std::size_t> changed_before() const { return changed_before(shown_); }
  /// Shows another one, which is last_ready(). `left`: how the one before was shown, by which
  /// files.
  void choose(std::size_t setup, const Arguments& left, const FileWatch& files);
  /// What is shown is cut anew, or otherwise: what it leaves is not known any more.
  void forget_next() { run_.forget_after(shown_); }
  /// `left` goes on to the next one. False: why not.
  bool carry(const StockModel& left, Diagnostics& diagnostics) {
    return run_.carry_over(shown_ + 1, left, diagnostics);
  }

 private:
  ViewSetups(Arguments asked, JobRun run) : asked_(std::move(asked)), run_(std::move(run)) {}

  std::optional<std::size_t> changed_before(std::size_t setup) const;

  struct Left {
    Arguments arguments;
    FileWatch files;
  };
  Arguments asked_;
  JobRun run_;
  std::size_t first_ = 0, shown_ = 0;
  std::map<std::size_t, Left> left_;
};

}  // namespace kerf
