#include "twin/cli/run_options.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

#include "base/translate.h"
#include "twin/cli/cutting_options.h"
#include "twin/cli/draw_option.h"
#include "twin/cli/live_place.h"
#include "twin/cli/option_reader.h"
#include "twin/cli/serve_option.h"

namespace kerf {
namespace {

void read_lines(OptionReader& reader, LineRange& lines) {
  lines.from = static_cast<std::uint32_t>(reader.whole_number("--from-line"));
  lines.until = static_cast<std::uint32_t>(reader.whole_number("--until-line"));
  if (lines.until == 0 || lines.from <= lines.until) return;
  reader.fault("--from-line", trf("{} lies beyond --until-line {}", lines.from, lines.until));
}

/// --at: the machine itself says it.
constexpr const char* kLive = "live";

/// Nothing: --at does not say.
std::optional<Vec3> read_place(OptionReader& reader) {
  const std::string& text = reader.text("--at");
  if (text.empty() || text == kLive) return std::nullopt;
  const std::optional<Vec3> place = three_lengths(text, reader.unit());
  if (!place) {
    reader.fault("--at", trf("'{}' is no place; X,Y,Z is (three lengths), or live", text));
  }
  return place;
}

EntryWish understand_entry(OptionReader& reader, const SessionOptions& session,
                           const Arguments& arguments, Diagnostics& diagnostics) {
  EntryWish wish;
  wish.at_mm = read_place(reader);
  const bool is_live = reader.text("--at") == kLive;
  if (!reader.is_yes("--enter")) {
    if (wish.at_mm || is_live)
      reader.fault("--at", tr("is for --enter; nothing else asks where it stands"));
    return wish;
  }
  wish.line = session.lines.from;
  if (wish.line < 2) reader.fault("--enter", tr("needs --from-line N, from 2 on"));
  if (session.program.interpreter == InterpreterChoice::kText || session.program.path == "-") {
    reader.fault("--enter", tr("needs an NC file and kerf-interp: rs274 and listings begin at the "
                               "beginning alone"));
  }
  if (is_live) wish.find_place = live_place_finder(arguments, diagnostics);
  return wish;
}

/// A beam and a punch go through a sheet whatever Z says.
void note_sheet(SessionOptions& session) {
  session.program.machine.z_matters = !session.blank || !is_sheet(*session.blank);
}

}  // namespace

std::optional<LiveConfig> read_config(const WrittenOptions& options, Diagnostics& diagnostics) {
  if (!options.has("--config") && !options.has("--set")) return std::nullopt;
  return read_config(options.text("--config"), options.texts("--set"), diagnostics);
}

OptionLayers layers_of(const Arguments& arguments, const LiveConfig* config) {
  return {arguments.command, &arguments.options, config == nullptr ? nullptr : &config->said, {}};
}

ProgramSurroundings surroundings_of(const LiveConfig* config) {
  if (config == nullptr) return {};
  const ConfigMachine& machine = config->machine;
  return {machine.kinematics, machine.joints, machine.work_offset, {}};
}

RunRequest understand_cut(const LiveConfig* config, OptionReader& reader) {
  RunRequest request;
  request.units = reader.unit();
  SessionOptions& session = request.session;
  TorchOptions torch;
  session.beam = understand_torch(reader, torch);
  ProgramSurroundings around = surroundings_of(config);
  around.hal_pins = torch.hal_values;
  ProgramRequest source = understand_program("PROGRAM", around, reader);
  source.program.torch = std::move(torch);
  session.turret = understand_turret(reader, source.program);
  // A window shows the program all the same, beside the lathe.
  const bool refuses_lathe = reader.command() == kRun || reader.command() == kOptimize;
  if (refuses_lathe && config && config->machine.drawn.kind == MachineKind::kLathe) {
    source.program.lathe = tr("machine.model is lathe");
  }
  session.program = std::move(source.program);
  session.timeline = std::move(source.timeline);
  WorkRequest work = understand_work(config, reader);
  session.tools = std::move(work.tools);
  session.libraries = std::move(work.libraries);
  session.tools_named = work.tools_named;
  session.blank = std::move(work.blank);
  session.stock = work.stock;
  session.margin_mm = work.margin_mm;
  session.below_mm = work.below_mm;
  session.spindle_max_rpm = work.spindle_max_rpm;
  session.timeline.planner.spindle.max_rpm = work.spindle_max_rpm;
  session.collisions = std::move(work.collisions);
  note_sheet(session);
  session.timeline.planner.with_path = work.planned_path;
  if (session.turret && work.planned_path) {
    reader.fault("--path", tr("planned is for cutting; a punch strikes where the program says"));
  }
  read_lines(reader, session.lines);
  session.guess = !reader.is_yes("--no-guess");
  request.quiet = reader.is_yes("--quiet");
  request.ini = reader.text("--ini");
  if (config) request.machine = config->machine.drawn;
  // A turret is a machine's: it is drawn, unless another one is asked for.
  if (session.turret && !request.machine.is_chosen()) request.machine.kind = MachineKind::kPunch;
  return request;
}

RunRequest understand_run(const Arguments& arguments, Diagnostics& diagnostics) {
  const std::optional<LiveConfig> read = read_config(arguments.options, diagnostics);
  const LiveConfig* const config = read ? &*read : nullptr;
  OptionReader reader(diagnostics, layers_of(arguments, config));
  RunRequest request = understand_cut(config, reader);
  request.written = arguments;
  request.mesh_tolerance_mm = reader.length_mm("--mesh-tolerance");
  request.outputs = understand_outputs(reader);
  check_outline_wishes(request.session.blank, request.outputs, reader);
  request.verbose = reader.is_yes("--verbose");
  if (request.quiet && request.verbose) {
    reader.fault("--verbose", tr("--quiet wants no summary at all"));
  }
  request.finding_png = reader.text("--finding-png");
  if (!request.finding_png.empty() && request.session.program.path == "-") {
    reader.fault("--finding-png",
                 tr("the program comes from standard input, which cannot be read again"));
  }
  request.entry = understand_entry(reader, request.session, arguments, diagnostics);
  request.compare = understand_compare(reader, request.session.tools);
  // Tools may be named for what is left alone.
  if (request.compare.rest_mm > 0) request.session.tools_named = false;
  request.session.cutting = understand_cutting(reader);
  request.engagement = reader.is_yes("--engagement") || !request.outputs.engagement_png.empty() ||
                       request.session.cutting.is_wanted() || has_tool_limits(request.session);
  request.serve = understand_serve(reader);
  request.view = reader.is_yes("--view");
  if (request.view && request.compare.is_fitted) {
    reader.fault("--compare-fit",
                 tr("is for the report; the window shows designs as they are given"));
  }
  request.draw = understand_draw(reader);
  if (request.draw && !request.view) {
    reader.fault("--draw", tr("is for the window; there is no --view"));
  }
  request.outputs.section = understand_section(reader);
  if (request.outputs.section != SectionKind::kNone && request.outputs.png.empty()) {
    reader.fault("--section", tr("is for --png; the window has a key for it"));
  }
  if (request.view && request.session.program.path == "-") {
    reader.fault("--view", tr("the program comes from standard input, which cannot be read again"));
  }
  check_output_arguments(request.outputs, diagnostics);
  return request;
}

}  // namespace kerf
