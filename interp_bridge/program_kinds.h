// interp_bridge/program_kinds.h - the two kinds of Program behind Program::open().
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "interp_bridge/program.h"
#include "interp_bridge/repeat_watch.h"
#include "interp_bridge/source_text.h"

namespace kerf {

/// NC code, interpreted by a child rs274 from a numbered copy (program_prepare.h). `rs274` is the
/// full path.
std::unique_ptr<Program> make_nc_program(const ProgramOptions& options, std::string rs274,
                                         std::vector<ToolTableRow> tools, TextSurvey survey,
                                         TorchRun torch);

/// NC code, interpreted by a child kerf-interp where it stands. `kerf_interp` is the full path.
std::unique_ptr<Program> make_bridge_program(const ProgramOptions& options, std::string kerf_interp,
                                             std::vector<ToolTableRow> tools, TextSurvey survey,
                                             TorchRun torch);

/// Canonical text: a file, or stdin if options.path is "-". Lines of motions: the N column, else
/// the listing's own line.
std::unique_ptr<Program> make_listing_program(const ProgramOptions& options,
                                              std::vector<int> tool_by_index, TextSurvey survey,
                                              TorchRun torch);

/// How long a reader sleeps at most before it looks at its stop token and at waiting motions.
inline constexpr int kReaderPatience_ms = 20;

/// What is said of ChildEnding::kRepeating and kTooLong.
std::string repeat_message(const RepeatWatch& repeats);
std::string cpu_message(const ProgramOptions& options);

}  // namespace kerf
