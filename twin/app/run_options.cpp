#include "twin/app/run_options.h"

#include <fmt/format.h>

#include <utility>

#include "twin/app/option_reader.h"

namespace kerf {
namespace {

constexpr OptionRange kMeshTolerance{0, 1000, false, "mm"};
constexpr OptionRange kLine{1, 4e9, false, "lines"};

void read_lines(const RunArguments& a, OptionReader& reader, LineRange& lines) {
  lines.from =
      static_cast<std::uint32_t>(reader.whole_number("--from-line", a.from_line, kLine, 0));
  lines.until =
      static_cast<std::uint32_t>(reader.whole_number("--until-line", a.until_line, kLine, 0));
  if (lines.until == 0 || lines.from <= lines.until) return;
  reader.fault("--from-line",
               fmt::format("{} lies beyond --until-line {}", lines.from, lines.until));
}

/// What can be known before anything is cut: that there will be no sheet to write.
void read_outline_wishes(const RunRequest& request, OptionReader& reader) {
  if (request.session.blank && request.session.blank->sheet) return;
  for (const auto& [option, path] :
       {std::pair("--dxf", &request.outputs.dxf), std::pair("--svg", &request.outputs.svg)}) {
    if (path->empty()) continue;
    reader.fault(option, "only a sheet has outlines to write",
                 "--stock sheet:x0,y0:x1,y1:THICKNESS cuts from one");
  }
}

}  // namespace

RunRequest understand(const RunArguments& a, Diagnostics& diagnostics) {
  OptionReader reader(diagnostics);
  RunRequest request;
  SessionOptions& session = request.session;
  ProgramRequest source = understand_program(a.source, reader);
  session.beam = understand_torch(a.torch, reader, source.program.torch);
  session.program = std::move(source.program);
  session.timeline = std::move(source.timeline);
  WorkRequest work = understand_work(a.work, reader);
  session.tools = std::move(work.tools);
  session.blank = std::move(work.blank);
  session.stock = work.stock;
  session.margin_mm = work.margin_mm;
  session.timeline.planner.with_path = work.planned_path.value_or(false);
  read_lines(a, reader, session.lines);
  request.mesh_tolerance_mm = reader.number("--mesh-tolerance", a.mesh_tolerance, kMeshTolerance,
                                            request.mesh_tolerance_mm);
  request.outputs = a.outputs;
  read_outline_wishes(request, reader);
  request.quiet = a.quiet;
  request.view = a.view;
  if (a.view && a.source.program == "-") {
    reader.fault("--view", "the program comes from standard input, which cannot be read again");
  }
  check_output_arguments(request.outputs, diagnostics);
  return request;
}

}  // namespace kerf
