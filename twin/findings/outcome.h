// twin/findings/outcome.h - how a session ended.
#pragma once

namespace kerf {

/// The order is that of the exit codes it leads to, not of badness.
enum class Outcome {
  kFinished,     ///< the program (the log, the time asked for) was run to its end
  kLossy,        ///< so it was, but data was lost: moves that the interpreter's listing lacks
                 ///< (splines), samples of a source
  kUsageError,   ///< what was asked for makes no sense (cell larger than the blank, ...)
  kFailed,       ///< a file, the interpreter or a source failed; the report covers what was run
  kInterrupted,  ///< stopped from outside; the report covers what was run
};

}  // namespace kerf
