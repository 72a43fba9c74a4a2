#include "twin/cli/work_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "base/suggest.h"
#include "base/translate.h"
#include "stock/zmap/zmap_kernel.h"
#include "twin/config/tool_library_reader.h"
#include "twin/job/blank_mesh.h"
#include "twin/machine/machine_setup.h"
#include "twin/machines/builtin_models.h"
#include "twin/machines/machine_bodies.h"
#include "twin/machines/machine_choice.h"

namespace kerf {
namespace {

void read_model(OptionReader& reader, WorkRequest& work) {
  work.stock.additive = reader.is_yes("--additive");
  const std::string model = reader.text("--model");
  if (work.stock.additive && model != "auto" && model != "octree") {
    reader.fault("--additive", trf("the model {} only removes; allowed: octree", model));
  }
  // The words are auto, then the models in their order.
  if (const int word = reader.word("--model"); word > 0) {
    work.stock.kind = stock_models()[static_cast<std::size_t>(word) - 1].kind;
  }
}

void read_tool(const std::string& text, OptionReader& reader, WorkRequest& work) {
  Result<ToolShapeArgument> tool = parse_tool_argument(text, reader.unit());
  if (!tool) {
    reader.fault("--tool", tool.error());
    return;
  }
  if (tool->tool == 0) {
    reader.fault("--tool", trf("'{}': tool 0 is the empty spindle; numbers begin at 1", text),
                 tr("--tool 1=SHAPE, if it is the only --tool, is what is in the spindle of a "
                    "program that changes no tool"));
    return;
  }
  if (const Done fit = can_be_cut(work.stock.kind, tool->cutter); !fit) {
    reader.fault("--tool", fmt::format("'{}': {}", text, fit.error()));
    return;
  }
  bool twice = false;
  for (const ToolShapeArgument& other : work.tools) twice |= other.tool == tool->tool;
  if (twice) {
    reader.fault("--tool", trf("'{}': tool {} is given twice", text, tool->tool));
    return;
  }
  work.tools.push_back(std::move(tool.value()));
}

void read_tools(const LiveConfig* config, OptionReader& reader, WorkRequest& work) {
  const ValueFrom from = reader.choose("--tool").from;
  if (from == ValueFrom::kConfig) work.tools = config->tools;
  if (from != ValueFrom::kCommandLine) return;
  for (const std::string& text : reader.texts("--tool")) read_tool(text, reader, work);
  work.tools_named = !work.tools.empty();
}

void read_libraries(const LiveConfig* config, OptionReader& reader, WorkRequest& work) {
  const ValueFrom from = reader.choose("--tools").from;
  if (from == ValueFrom::kConfig) {
    work.libraries = read_tool_libraries(config->tool_libraries, reader.diagnostics());
  }
  if (from == ValueFrom::kCommandLine) {
    work.libraries = read_tool_libraries(reader.texts("--tools"), reader.diagnostics());
  }
}

void read_stock(const LiveConfig* config, OptionReader& reader, WorkRequest& work) {
  const ChosenValue stock = reader.choose("--stock");
  if (stock.from == ValueFrom::kConfig) work.blank = config->stock.blank;
  if (work.blank) read_blank_mesh(*work.blank, reader.diagnostics());
  if (stock.from != ValueFrom::kCommandLine) return;
  Result<Blank> blank = parse_blank(stock.text, reader.unit());
  if (blank) {
    read_blank_mesh(*blank, reader.diagnostics());
    work.blank = std::move(blank.value());
  } else {
    reader.fault("--stock", blank.error());
  }
}

bool is_mill(MachineKind kind) {
  switch (kind) {
    case MachineKind::kKneeMill:
    case MachineKind::kGantry:
    case MachineKind::kTrunnion:
    case MachineKind::kBridgeMill:
    case MachineKind::kSwivelMill:
      return true;
    case MachineKind::kNone:
    case MachineKind::kLathe:
    case MachineKind::kPlasma:
    case MachineKind::kPunch:
      break;
  }
  return false;
}

/// From its tip to the nose, of tools of which nobody knows it: as far as machines are built for.
constexpr double kUsualTool_mm = 100;

/// A machine of that kind, as far as the INI says how large it is.
void build_in(MachineKind kind, const std::string& ini, WorkRequest& work) {
  Diagnostics said;  // by whoever reads it for the program
  MachineSetup setup;
  if (!read_machine_setup(ini, setup, said)) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const AxisLimits& limits = setup.timeline.limits.axes[axis];
    if (!limits.present || !std::isfinite(limits.min) || !std::isfinite(limits.max)) return;
  }
  work.collisions.built_in = [kind, setup](const WorkpieceFrame& frame, const Box& blank_mm) {
    return bodies_of(
        builtin_machine(kind, machine_room(&setup, frame, blank_mm, {}, kUsualTool_mm)));
  };
}

/// What moves, as far as somebody has described it, and who may touch whom.
void read_machine(const LiveConfig* config, OptionReader& reader, WorkRequest& work) {
  if (!config) return;
  const ConfigMachine& machine = config->machine;
  work.collisions.rules = {machine.ignore, config->clearances};
  if (!machine.collisions) return;
  if (machine.drawn.links) {
    work.collisions.machine = bodies_of(*machine.drawn.links, reader.diagnostics());
  } else if (machine.drawn.kind && is_mill(*machine.drawn.kind) && !reader.text("--ini").empty()) {
    build_in(*machine.drawn.kind, reader.text("--ini"), work);
  }
}

void fault(Diagnostics& diagnostics, std::string message, std::string hint = {}) {
  diagnostics.push_back(general_error(std::move(message), std::move(hint)));
}

std::string nearest_of(const std::string& word, const std::vector<std::string>& allowed) {
  const std::vector<std::string_view> words(allowed.begin(), allowed.end());
  return did_you_mean(word, words);
}

/// Fixtures stand on links that there are, and rules are about bodies that there are. The links of
/// a machine that is built in are named where it is made.
void check_names(const LiveConfig* config, const std::vector<FixtureSpec>& fixtures,
                 const std::vector<std::string>& holding, Diagnostics& diagnostics) {
  std::vector<std::string> links, bodies;
  const bool has_links = config && config->machine.drawn.links;
  if (has_links)
    for (const LinkSpec& link : config->machine.drawn.links->links)
      links.push_back(link.chain.name);
  bodies = links;
  bodies.insert(bodies.end(), holding.begin(), holding.end());
  for (const FixtureSpec& fixture : fixtures) {
    bodies.push_back(fixture.name);
    if (fixture.on.empty()) continue;
    if (!has_links) {
      fault(diagnostics,
            trf("fixture '{}' stands on '{}', but there are no links", fixture.name, fixture.on),
            tr("machine.links of a configuration describes the machine"));
    } else if (std::ranges::find(links, fixture.on) == links.end()) {
      fault(diagnostics,
            trf("fixture '{}' stands on '{}', which is no link{} There are {}", fixture.name,
                fixture.on, nearest_of(fixture.on, links), fmt::join(links, ", ")));
    }
  }
  if (!config || config->machine.drawn.kind) return;
  const std::vector<std::string> known = PairRules::names(bodies);
  const auto check = [&](const char* key, const NamedPair& pair) {
    for (const std::string& name : pair) {
      if (std::ranges::find(known, name) != known.end()) continue;
      fault(diagnostics, trf("{}: '{}' is no link and no fixture{} There are {}", key, name,
                             nearest_of(name, known), fmt::join(known, ", ")));
    }
  };
  for (const NamedPair& pair : config->machine.ignore) check("machine.ignore", pair);
  for (const PairClearance& one : config->clearances) check("clearances", one.pair);
}

/// What holds a workpiece that turns.
void read_holding(OptionReader& reader, WorkHolding& holding) {
  const ChosenValue said_chuck = reader.choose("--chuck");
  if (said_chuck.is_said()) {
    Result<ChuckSpec> chuck = parse_chuck(said_chuck.text, reader.unit_of(said_chuck));
    if (chuck) {
      holding.chuck = std::move(chuck.value());
    } else {
      reader.fault("--chuck", chuck.error());
    }
  }
  const ChosenValue said_tailstock = reader.choose("--tailstock");
  if (!said_tailstock.is_said()) return;
  Result<TailstockSpec> tailstock =
      parse_tailstock(said_tailstock.text, reader.unit_of(said_tailstock));
  if (tailstock) {
    holding.tailstock = std::move(tailstock.value());
  } else {
    reader.fault("--tailstock", tailstock.error());
  }
}

/// Those of the command line, else those of the configuration. Meshes are read at once: what is
/// wrong with one is said before anything runs.
void read_fixtures(const LiveConfig* config, OptionReader& reader, WorkRequest& work) {
  std::vector<FixtureSpec> specs;
  if (config) specs = config->fixtures;
  const std::vector<std::string>& texts = reader.texts("--fixture");
  if (!texts.empty()) specs.clear();
  for (const std::string& text : texts) {
    Result<FixtureSpec> spec = parse_fixture(text, reader.unit());
    if (spec) {
      specs.push_back(std::move(spec.value()));
    } else {
      reader.fault("--fixture", spec.error());
    }
  }
  name_fixtures(specs);
  read_machine(config, reader, work);
  read_holding(reader, work.collisions.holding);
  check_names(config, specs, names_of(work.collisions.holding), reader.diagnostics());
  work.collisions.fixtures = load_fixtures(specs, reader.diagnostics());
  work.collisions.clearance_mm = reader.length_mm("--clearance");
  work.collisions.cut_by_shank = reader.is_yes("--cut-by-shank");
  if (config) work.collisions.spindle = config->machine.spindle;
}

void read_choices(OptionReader& reader, WorkRequest& work) {
  work.path_from = reader.choose("--path").from;
  work.planned_path = reader.word("--path") == 1;
  reader.word("--kernel",
              {ZMapKernel::kAuto, ZMapKernel::kScalar, ZMapKernel::kSse2, ZMapKernel::kAvx2,
               ZMapKernel::kNeon},
              work.stock.kernel);
  if (!zmap_can_run(work.stock.kernel)) {
    std::string allowed(to_string(ZMapKernel::kAuto));
    for (const ZMapKernel kernel : zmap_kernels())
      allowed += fmt::format(", {}", to_string(kernel));
    reader.fault("--kernel", trf("this machine cannot run {}; allowed: {}",
                                 to_string(work.stock.kernel), allowed));
  }
}

/// One core is left to the interpreter.
int default_threads() {
  const unsigned cores = std::thread::hardware_concurrency();
  return cores > 2 ? static_cast<int>(std::min(cores - 1, 8U)) : 1;
}

}  // namespace

WorkRequest understand_work(const LiveConfig* config, OptionReader& reader) {
  WorkRequest work;
  read_model(reader, work);
  read_tools(config, reader, work);
  read_libraries(config, reader, work);
  read_stock(config, reader, work);
  read_fixtures(config, reader, work);
  read_choices(reader, work);
  work.stock.cell_mm = reader.length_mm("--cell");
  work.below_mm = reader.length_mm("--below");
  work.spindle_max_rpm = reader.number("--spindle-max");
  work.margin_mm = reader.length_mm("--margin");
  if (work.blank && reader.choose("--margin").from == ValueFrom::kCommandLine) {
    reader.fault("--margin",
                 tr("is for a blank that is guessed from the program; this one is given"),
                 tr("without --stock it is guessed, and a wider --stock needs no margin"));
  }
  work.stock.threads = static_cast<int>(reader.whole_number("--threads", default_threads()));
  return work;
}

}  // namespace kerf
