#include "twin/app/run_options.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "twin/app/draw_option.h"
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

/// A beam and a punch go through a sheet whatever Z says.
void note_sheet(SessionOptions& session) {
  session.program.machine.z_matters = !session.blank || !is_sheet(*session.blank);
}

}  // namespace

void complete_arguments(const LiveConfig& config, LengthUnit unit, RunArguments& arguments) {
  ProgramArguments& source = arguments.source;
  if (source.ini.empty()) source.ini = config.machine.ini.value_or("");
  if (source.tool_table.empty()) source.tool_table = config.machine.tool_table.value_or("");
  source.as_mill = source.as_mill || config.machine.as_mill;
  source.kinematics = config.machine.kinematics;
  source.joints = config.machine.joints;
  source.configured_offset = config.machine.work_offset;
  complete_torch(config, unit, arguments.torch);
}

void complete_session(const LiveConfig& config, const RunArguments& a, SessionOptions& session) {
  if (session.tools.empty()) session.tools = config.tools;
  if (!session.blank) session.blank = config.stock.blank;
  if (a.work.model.empty()) session.stock.kind = config.stock.model;
  if (a.work.cell.empty() && config.stock.cell_mm) session.stock.cell_mm = *config.stock.cell_mm;
  if (a.work.margin.empty()) session.margin_mm = config.stock.margin_mm;
  note_sheet(session);
  if (a.work.below.empty()) session.below_mm = config.stock.below_mm;
}

RunRequest understand(const RunArguments& given, Diagnostics& diagnostics) {
  RunArguments a = given;
  std::optional<LiveConfig> config;
  if (!a.config.empty() || !a.sets.empty()) config = read_config(a.config, a.sets, diagnostics);
  RunRequest request;
  request.written = given;
  request.units =
      understand_units(a.source.units, config ? config->units : std::nullopt, diagnostics);
  if (config) complete_arguments(*config, request.units, a);
  OptionReader reader(diagnostics, request.units);
  SessionOptions& session = request.session;
  TorchOptions torch;
  session.beam = understand_torch(a.torch, reader, torch);
  a.source.hal_pins = torch.hal_values;
  ProgramRequest source = understand_program(a.source, reader);
  source.program.torch = std::move(torch);
  session.turret = understand_turret(a.torch, reader, source.program);
  if (config && config->machine.drawn.kind == MachineKind::kLathe) {
    source.program.lathe = "machine.model is lathe";
  }
  session.program = std::move(source.program);
  session.timeline = std::move(source.timeline);
  WorkRequest work = understand_work(a.work, reader);
  session.tools = std::move(work.tools);
  session.tools_named = !session.tools.empty();
  session.blank = std::move(work.blank);
  session.stock = work.stock;
  session.margin_mm = work.margin_mm;
  note_sheet(session);
  session.below_mm = work.below_mm;
  if (config) complete_session(*config, a, session);
  session.timeline.planner.with_path = work.planned_path.value_or(false);
  if (session.turret && work.planned_path.value_or(false)) {
    reader.fault("--path", "planned is for cutting; a punch strikes where the program says");
  }
  read_lines(a, reader, session.lines);
  request.mesh_tolerance_mm = reader.length_mm("--mesh-tolerance", a.mesh_tolerance, kMeshTolerance,
                                               request.mesh_tolerance_mm);
  request.outputs = a.outputs;
  check_outline_wishes(request.session.blank, request.outputs, reader);
  request.quiet = a.quiet;
  request.verbose = a.verbose;
  session.guess = !a.no_guess;
  if (a.quiet && a.verbose) reader.fault("--verbose", "--quiet wants no summary at all");
  request.view = a.view;
  request.ini = a.source.ini;
  if (config) request.machine = config->machine.drawn;
  // A turret is a machine's: it is drawn, unless another one is asked for.
  if (session.turret && !request.machine.is_chosen()) request.machine.kind = MachineKind::kPunch;
  request.draw = understand_draw(a.draw, reader);
  if (request.draw && !a.view) reader.fault("--draw", "is for the window; there is no --view");
  if (a.view && a.source.program == "-") {
    reader.fault("--view", "the program comes from standard input, which cannot be read again");
  }
  check_output_arguments(request.outputs, diagnostics);
  return request;
}

}  // namespace kerf
