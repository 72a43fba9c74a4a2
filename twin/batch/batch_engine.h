// twin/batch/batch_engine.h - the runs of a batch handed over to GNU parallel or to Slurm.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"

namespace kerf {

enum class BatchEngine : std::uint8_t { kLocal, kParallel, kSlurm };

/// "local", "parallel", "slurm": as --engine has them.
const char* to_string(BatchEngine engine);

/// What an engine is given. Paths are absolute.
struct EngineWork {
  std::string folder;              ///< for its own files, beside the units
  std::vector<std::string> units;  ///< files for `kerf batch-unit`
  int jobs = 0;                    ///< at most so many at a time; 0: as the engine likes
};

/// The engine's own command, in a process group of its own, until it has ended. GNU parallel runs
/// the units by itself; of Slurm it is one `sbatch --wait` for each array of at most 1000. What
/// users set for these goes on to hold: PARALLEL and ~/.parallel/config, SBATCH_*.
class EngineCall {
 public:
  /// Error: the command is not there, or the files could not be written.
  static Result<EngineCall> start(BatchEngine engine, const EngineWork& work);
  EngineCall(EngineCall&& other) noexcept = default;
  EngineCall& operator=(EngineCall&&) = delete;
  /// Ends what still runs.
  ~EngineCall();

  /// Looks whether it has ended; no run is left then.
  bool has_ended();
  /// Ends all runs, and waits for that, some seconds at most.
  void stop();
  /// All units have left their results: waits for the engine to see it, Slurm's is left alone.
  void finish();
  /// The end of what it has printed, where it has refused the work; empty: it has not.
  std::string refusal() const;

 private:
  struct Process {
    pid_t pid = -1;
    int status = -1;
    std::string said;  ///< file of both its outputs
  };
  EngineCall(BatchEngine engine) : engine_(engine) {}
  Done begin(const std::vector<std::string>& words, const std::string& said);
  void cancel() const;
  void await_end();

  BatchEngine engine_;
  std::vector<Process> processes_;
};

}  // namespace kerf
