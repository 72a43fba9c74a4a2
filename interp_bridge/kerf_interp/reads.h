// interp_bridge/kerf_interp/reads.h - which files a run hangs on, for who keeps its records.
#pragma once

#include <string_view>

#include "interp_bridge/kerf_interp/record_writer.h"

namespace kerf::interp {

/// A file was opened for reading, or could not be.
void note_read(std::string_view path, bool found);
/// The interpreter has looked at something that cannot be named: the list of a folder.
void note_hidden();
/// kRead of each file, of this program and of LinuxCNC's library; kHidden.
void write_reads(RecordWriter& records);

}  // namespace kerf::interp
