#include "twin/app/run_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "twin/app/option_reader.h"

namespace kerf {
namespace {

constexpr OptionRange kCell{0, 1000, true, "mm"};
constexpr OptionRange kMeshTolerance{0, 1000, false, "mm"};
constexpr OptionRange kMargin{0, 10000, false, "mm"};
constexpr OptionRange kThreads{1, 256, false, "threads"};
constexpr OptionRange kLine{1, 4e9, false, "lines"};

void read_tools(const RunArguments& arguments, OptionReader& reader, SessionOptions& session) {
  for (const std::string& text : arguments.tools) {
    Result<ToolShapeArgument> tool = parse_tool_argument(text);
    if (!tool) {
      reader.fault("--tool", tool.error());
      continue;
    }
    if (tool->tool == 0) {
      reader.fault("--tool",
                   fmt::format("'{}': tool 0 is the empty spindle; numbers begin at 1", text));
      continue;
    }
    if (tool->cutter.undercuts()) {
      reader.fault("--tool", fmt::format("'{}': {} cuts undercuts, which the Z-map cannot hold",
                                         text, tool->cutter.spec()));
      continue;
    }
    if (const Done fit = ZMap::can_cut(tool->cutter); !fit) {
      reader.fault("--tool", fmt::format("'{}': {}", text, fit.error()));
      continue;
    }
    bool twice = false;
    for (const ToolShapeArgument& other : session.tools) twice |= other.tool == tool->tool;
    if (twice) {
      reader.fault("--tool", fmt::format("'{}': tool {} is given twice", text, tool->tool));
      continue;
    }
    session.tools.push_back(std::move(tool.value()));
  }
}

void read_stock(const RunArguments& arguments, OptionReader& reader, SessionOptions& session) {
  if (arguments.stock.empty()) return;
  Result<Blank> blank = parse_blank(arguments.stock);
  if (blank) {
    session.blank = std::move(blank.value());
  } else {
    reader.fault("--stock", blank.error());
  }
}

void read_choices(const RunArguments& a, OptionReader& reader, SessionOptions& session) {
  if (a.model == "mmap" || a.model == "octree" || a.model == "sheet" || a.model == "turning") {
    reader.fault("--model", fmt::format("{} is not in this version; allowed: zmap, auto", a.model));
  } else if (!a.model.empty() && a.model != "zmap" && a.model != "auto") {
    reader.fault("--model", fmt::format("'{}' is no model; allowed: zmap, auto", a.model));
  }
  if (a.path == "planned") {
    session.timeline.planner.with_path = true;
  } else if (!a.path.empty() && a.path != "programmed") {
    reader.fault("--path", fmt::format("'{}' is no path; allowed: programmed, planned", a.path));
  }
  if (a.kernel == "scalar") {
    session.kernel = ZMapKernel::kScalar;
  } else if (a.kernel == "avx2") {
    session.kernel = ZMapKernel::kAvx2;
    if (!zmap_has_avx2())
      reader.fault("--kernel", "this machine cannot run avx2; allowed: auto, scalar");
  } else if (!a.kernel.empty() && a.kernel != "auto") {
    reader.fault("--kernel",
                 fmt::format("'{}' is no kernel; allowed: auto, scalar, avx2", a.kernel));
  }
}

void read_lines(const RunArguments& a, OptionReader& reader, LineRange& lines) {
  lines.from =
      static_cast<std::uint32_t>(reader.whole_number("--from-line", a.from_line, kLine, 0));
  lines.until =
      static_cast<std::uint32_t>(reader.whole_number("--until-line", a.until_line, kLine, 0));
  if (lines.until == 0 || lines.from <= lines.until) return;
  reader.fault("--from-line",
               fmt::format("{} lies beyond --until-line {}", lines.from, lines.until));
}

/// One core is left to the interpreter.
int default_threads() {
  const unsigned cores = std::thread::hardware_concurrency();
  return cores > 2 ? static_cast<int>(std::min(cores - 1, 8U)) : 1;
}

}  // namespace

RunRequest understand(const RunArguments& a, Diagnostics& diagnostics) {
  OptionReader reader(diagnostics);
  RunRequest request;
  SessionOptions& session = request.session;
  ProgramRequest source = understand_program(a.source, reader);
  session.program = std::move(source.program);
  session.timeline = std::move(source.timeline);
  read_tools(a, reader, session);
  read_stock(a, reader, session);
  read_choices(a, reader, session);
  session.cell_mm = reader.number("--cell", a.cell, kCell, 0);
  session.margin_mm = reader.number("--margin", a.margin, kMargin, session.margin_mm);
  session.threads =
      static_cast<int>(reader.whole_number("--threads", a.threads, kThreads, default_threads()));
  read_lines(a, reader, session.lines);
  request.mesh_tolerance_mm = reader.number("--mesh-tolerance", a.mesh_tolerance, kMeshTolerance,
                                            request.mesh_tolerance_mm);
  request.outputs = a.outputs;
  request.quiet = a.quiet;
  check_output_arguments(request.outputs, diagnostics);
  return request;
}

}  // namespace kerf
