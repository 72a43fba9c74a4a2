// twin/batch/batch_run.h - runs the programs of a batch, here or by an engine.
#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "twin/batch/batch_engine.h"
#include "twin/batch/batch_result.h"

namespace kerf {

/// One program with what it is run with.
struct BatchUnit {
  std::string program;
  std::vector<std::string> words;  ///< run_words()
};

struct BatchPlan {
  std::string out;  ///< the folder; it is made
  std::vector<BatchUnit> units;
  BatchEngine engine = BatchEngine::kLocal;
  int jobs = 0;  ///< at most so many at a time; 0: as many as the engine likes, here one a core
  ProcessBounds bounds;
  /// Of each run whose words do not say --threads. No part of what a result depends on.
  int threads_each = 1;
  bool again = false;  ///< results that hold do not count
};

struct BatchEnd {
  /// Of those units that have one, in their order.
  std::vector<BatchResult> results;
  std::size_t reused = 0;    ///< of an earlier batch
  bool interrupted = false;  ///< by the stop request
  std::string fault;         ///< why it ended before all were run; empty: it did not
};

/// Runs all units that have no result that still_holds(), in their order. An engine has its files
/// in out/work, which goes away again where each unit has left a result. Each result is appended to
/// out/results.jsonl as it comes, and told to `told` with the number of those that are done.
/// Results of other programs, of another batch into the same folder, are kept there. A unit that
/// fails is a result. What cannot be written, or not be started, ends the batch, and so does a stop
/// request: runs that have not ended are ended, and have no result. Only one batch at a time may
/// have the folder.
BatchEnd run_batch(const BatchPlan& plan, const std::stop_token& stop,
                   const std::function<void(const BatchResult&, std::size_t done)>& told);

}  // namespace kerf
