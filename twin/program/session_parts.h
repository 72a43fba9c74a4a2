// twin/program/session_parts.h - what dry runs and live sessions are set up from: workpiece, tools.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "interp_bridge/program.h"
#include "stock/blank.h"
#include "twin/findings/outcome.h"
#include "twin/job/stock_choice.h"
#include "twin/job/tools.h"
#include "twin/report/report.h"
#include "twin/tool_library/tool_library.h"

namespace kerf {

/// A workpiece with what the report says of it.
struct StockSetup {
  std::unique_ptr<StockModel> stock;
  StockReport facts;  ///< description and origin
};

/// The blank in the chosen model (a saved workpiece in its own), or in one that can hold it, unless
/// settings.kind asks for one. `origin`: what asked for it, for
/// messages. Null with diagnostics if there is not memory for it, the cells do not suit it, or a
/// saved workpiece cannot be read.
StockSetup make_stock(const Blank& blank, const StockChoice& choice, const StockSettings& settings,
                      const std::string& origin, Diagnostics& diagnostics, Outcome& outcome);

/// A blank written in a comment of the program. Nothing in `blank` if there is none; false, with a
/// diagnostic, if it cannot be understood.
struct CommentBlank {
  std::optional<Blank> blank;
  std::string origin;
};
bool find_comment_blank(const Program& program, const std::string& path, CommentBlank& found,
                        Diagnostics& diagnostics);

/// Shapes of tools from arguments, libraries, comments of the program (if there is one) and the
/// tool table. False with diagnostics if the table cannot be read; what is odd in libraries is a
/// warning.
bool gather_tool_sources(const std::vector<ToolShapeArgument>& arguments,
                         const std::vector<ToolLibrary>& libraries, const Program* program,
                         const ProgramOptions& options, ToolSources& sources,
                         Diagnostics& diagnostics);

/// The interpreter's diagnostics as findings. `end_remarked`: the last of them says that the
/// program has no end.
void add_interpreter_findings(const Diagnostics& said, bool end_remarked, FindingLog& log);

/// The stock part of the report, from the workpiece as it is now.
StockReport stock_report(const StockModel& stock, const StockReport& facts);

/// Peak resident memory of this process, MB.
double peak_rss_mb();
/// CPU time of the calling thread, s.
double thread_cpu_s();

Diagnostic general_error(std::string message, std::string hint = {});

}  // namespace kerf
