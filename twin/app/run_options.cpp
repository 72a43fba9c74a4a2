#include "twin/app/run_options.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <thread>

namespace kerf {
namespace {

/// Numbers an option may have.
struct Range {
  double least;
  double most;
  bool least_excluded;
  const char* unit;
};

constexpr Range kCell{0, 1000, true, "mm"};
constexpr Range kMeshTolerance{0, 1000, false, "mm"};
constexpr Range kMargin{0, 10000, false, "mm"};
constexpr Range kTraverseRate{0, 1e6, true, "mm/min"};
constexpr Range kThreads{1, 256, false, "threads"};
constexpr Range kLine{1, 4e9, false, "lines"};
constexpr Range kMaxCommands{1, 1e12, false, "commands"};
constexpr Range kMaxSeconds{0, 1e6, true, "s"};

class Reader {
 public:
  explicit Reader(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  void fault(const char* option, const std::string& message, std::string hint = {}) {
    Diagnostic d;
    d.message = fmt::format("{}: {}", option, message);
    d.hint = std::move(hint);
    diagnostics_.push_back(std::move(d));
  }

  /// `fallback` if the option is not given or wrong.
  double number(const char* option, const std::string& text, const Range& range, double fallback) {
    if (text.empty()) return fallback;
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    const std::string allowed = fmt::format("must be {} {:g} and at most {:g} ({})",
                                            range.least_excluded ? "above" : "at least",
                                            range.least, range.most, range.unit);
    if (error != std::errc() || stop != end || !std::isfinite(value)) {
      fault(option, fmt::format("'{}' is not a number; {}", text, allowed));
      return fallback;
    }
    if (value < range.least || value > range.most ||
        (range.least_excluded && value == range.least)) {
      fault(option, fmt::format("{} is not allowed; {}", text, allowed));
      return fallback;
    }
    return value;
  }

  double whole_number(const char* option, const std::string& text, const Range& range,
                      double fallback) {
    const double value = number(option, text, range, fallback);
    if (value == std::floor(value)) return value;
    fault(option, fmt::format("{} is not a whole number", text));
    return fallback;
  }

 private:
  Diagnostics& diagnostics_;
};

void read_tools(const RunArguments& arguments, Reader& reader, SessionOptions& session) {
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

void read_stock(const RunArguments& arguments, Reader& reader, SessionOptions& session) {
  if (arguments.stock.empty()) return;
  Result<Blank> blank = parse_blank(arguments.stock);
  if (blank) {
    session.blank = std::move(blank.value());
  } else {
    reader.fault("--stock", blank.error());
  }
}

void read_choices(const RunArguments& a, Reader& reader, SessionOptions& session) {
  if (a.model == "mmap" || a.model == "octree" || a.model == "sheet" || a.model == "turning") {
    reader.fault("--model", fmt::format("{} is not in this version; allowed: zmap, auto", a.model));
  } else if (!a.model.empty() && a.model != "zmap" && a.model != "auto") {
    reader.fault("--model", fmt::format("'{}' is no model; allowed: zmap, auto", a.model));
  }
  if (a.interp == "bridge") {
    reader.fault("--interp", "bridge is not in this version; allowed: text");
  } else if (!a.interp.empty() && a.interp != "text") {
    reader.fault("--interp", fmt::format("'{}' is no interpreter; allowed: text", a.interp));
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
  if (a.block_delete == "off") {
    session.program.block_delete = false;
  } else if (!a.block_delete.empty() && a.block_delete != "on") {
    reader.fault("--block-delete", fmt::format("'{}' is not allowed; on or off", a.block_delete));
  }
}

void read_lines(const RunArguments& a, Reader& reader, LineRange& lines) {
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
  Reader reader(diagnostics);
  RunRequest request;
  SessionOptions& session = request.session;
  session.program.path = a.program;
  session.program.tool_table_path = a.tool_table;
  read_tools(a, reader, session);
  read_stock(a, reader, session);
  read_choices(a, reader, session);
  session.cell_mm = reader.number("--cell", a.cell, kCell, 0);
  session.margin_mm = reader.number("--margin", a.margin, kMargin, session.margin_mm);
  session.timeline.traverse_mm_per_min = reader.number(
      "--traverse-rate", a.traverse_rate, kTraverseRate, session.timeline.traverse_mm_per_min);
  session.threads =
      static_cast<int>(reader.whole_number("--threads", a.threads, kThreads, default_threads()));
  session.program.max_commands = static_cast<std::uint64_t>(
      reader.whole_number("--max-commands", a.max_commands, kMaxCommands,
                          static_cast<double>(session.program.max_commands)));
  session.program.max_silent_s =
      reader.number("--max-seconds", a.max_seconds, kMaxSeconds, session.program.max_silent_s);
  read_lines(a, reader, session.lines);
  request.mesh_tolerance_mm = reader.number("--mesh-tolerance", a.mesh_tolerance, kMeshTolerance,
                                            request.mesh_tolerance_mm);
  request.outputs = a.outputs;
  request.quiet = a.quiet;
  check_output_arguments(request.outputs, diagnostics);
  return request;
}

}  // namespace kerf
