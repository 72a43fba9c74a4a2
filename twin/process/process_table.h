// twin/process/process_table.h - the processes that there are, and which one a job needs.
#pragma once

#include <span>
#include <string_view>

#include "twin/process/process.h"

namespace kerf {

struct ProcessRow {
  std::string_view name;
  /// With its settings; null: it is not the one for this job.
  ProcessPointer (*choose)(const ProcessWish& wish);
};

/// In the order in which they are asked; the last one takes every job.
std::span<const ProcessRow> processes();
/// The first that takes it; never null.
ProcessPointer choose_process(const ProcessWish& wish);

}  // namespace kerf
