#include "twin/program/session_parts.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/translate.h"
#include "base/units.h"
#include "stock/cutter/turning_hints.h"
#include "stock/octree/octree.h"
#include "stock/sheet/sheet.h"
#include "stock/turning/turning_stock.h"
#include "stock/zmap/mmap/mmap.h"
#include "stock/zmap/zmap.h"
#include "twin/job/blank_choice.h"
#include "twin/job/blank_mesh.h"
#include "twin/job/placed_stock.h"
#include "twin/job/turning_row.h"
#include "twin/program/library_tools.h"

namespace kerf {
namespace {

/// Bytes that models of heights need at least for each cell. A surface (picture, mesh) takes as
/// much again and more.
constexpr double kBytesPerCell = 4.0;
/// And so many at least for each cell over a mesh that has undercuts: a gap.
constexpr double kBytesPerGap = 24.0;

double machine_memory_bytes() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

/// Cells that the model itself refuses are left to its own message.
bool refuse_memory(const Blank& blank, StockKind kind, double cell_mm, Diagnostics& diagnostics) {
  const Vec3 size = blank.bounds_mm().size();
  const double cells = std::ceil(size.x / cell_mm) * std::ceil(size.y / cell_mm);
  const bool hollow = kind == StockKind::kMmap && !need_of_mesh(blank).empty();
  const double bytes = cells * (kBytesPerCell + (hollow ? kBytesPerGap : 0));
  if (cells > static_cast<double>(ZMap::kMaxCells) || bytes <= machine_memory_bytes()) return false;
  diagnostics.push_back(
      general_error(trf("--cell: {:g} mm makes {:.0f} million cells, which take {:.1f} GB "
                        "of memory; this machine has {:.1f} GB",
                        cell_mm, cells / 1e6, bytes / 1e9, machine_memory_bytes() / 1e9),
                    tr("a greater --cell takes less: twice the cell, a quarter of the memory")));
  return true;
}

template <typename Model>
Result<std::unique_ptr<StockModel>> as_stock(Result<std::unique_ptr<Model>> model) {
  if (!model) return Error{model.error()};
  return std::unique_ptr<StockModel>(std::move(model.value()));
}

Result<std::unique_ptr<StockModel>> load_saved(StockKind kind, const std::string& path,
                                               const StockSettings& settings) {
  if (kind == StockKind::kSheet) return as_stock(Sheet::load(path));
  if (kind == StockKind::kTurning) return load_turned(path, settings);
  if (kind == StockKind::kOctree)
    return as_stock(Octree::load(path, settings.threads, octree_kernel(settings.kernel)));
  if (kind == StockKind::kMmap) {
    return as_stock(MMap::load(path, settings.threads, settings.kernel));
  }
  return as_stock(ZMap::load(path, settings.threads, settings.kernel));
}

std::unique_ptr<StockModel> load_stock(const Blank& blank, const StockChoice& choice,
                                       const StockSettings& settings, CarriedOver& carried,
                                       Diagnostics& diagnostics, Outcome& outcome) {
  StockKind saved = saved_kind(blank.state_file);
  if (choice.kind == StockKind::kTurning && is_milled_part(blank.state_file))
    saved = StockKind::kTurning;
  // A mill goes on with a turned part as an octree, and so do tilted tools with heights.
  const bool becomes_octree = choice.kind == StockKind::kOctree && saved != StockKind::kOctree &&
                              saved != StockKind::kSheet;
  const bool is_mill = choice.kind != StockKind::kTurning;
  if (settings.cell_mm > 0 && !becomes_octree) {
    diagnostics.push_back(
        general_error(tr("--cell: a saved workpiece keeps its own cells; leave --cell out")));
    return nullptr;
  }
  const bool is_other = settings.kind && *settings.kind != saved;
  if (!becomes_octree && (is_other || choice.kind > saved)) {
    const std::string why = choice.reason.empty() ? "" : fmt::format(" ({})", choice.reason);
    diagnostics.push_back(general_error(
        trf("{}: a workpiece saved as {}; the model {} is {}{}", blank.state_file,
            stock_model(saved).name, stock_model(choice.kind).name,
            is_other ? tr("asked for") : tr("needed"), why),
        trf("--stock with the blank's shape, or --model {}", stock_model(saved).name)));
    return nullptr;
  }
  auto loaded = load_saved(saved, blank.state_file, settings);
  if (!loaded) {
    diagnostics.push_back(general_error(loaded.error()));
    outcome = Outcome::kFailed;
    return nullptr;
  }
  auto placed = place_stock(std::move(loaded.value()), blank.saved_place.placement(),
                            becomes_octree, !is_mill, settings);
  if (!placed) {
    diagnostics.push_back(general_error(fmt::format("{}: {}", blank.state_file, placed.error())));
    return nullptr;
  }
  carried = placed->carried;
  return std::move(placed->stock);
}

std::unique_ptr<StockModel> fill_stock(const Blank& blank, const StockChoice& choice,
                                       const StockSettings& settings, const std::string& origin,
                                       Diagnostics& diagnostics) {
  if (blank.sheet) {
    auto sheet = stock_model(choice.kind).create(blank, settings);
    if (sheet) return std::move(sheet.value());
    diagnostics.push_back(general_error(fmt::format("{}: {}", origin, sheet.error())));
    return nullptr;
  }
  StockSettings fitting = settings;
  if (choice.kind == StockKind::kTurning) {
    auto turned = stock_model(choice.kind).create(blank, settings);
    if (turned) return std::move(turned.value());
    const std::string why =
        choice.reason.empty() ? "" : trf(" (this is for a lathe: {})", choice.reason);
    diagnostics.push_back(general_error(
        fmt::format("{}: {}{}", origin, turned.error(), why),
        tr("--stock cylinder:0,0,Z0:Z1:DIAMETER gives a bar, --as-mill mills it all the same")));
    return nullptr;
  }
  if (choice.kind != StockKind::kOctree) {
    if (fitting.cell_mm <= 0) fitting.cell_mm = suited_cell_mm(blank.bounds_mm(), choice.finest_mm);
    if (refuse_memory(blank, choice.kind, fitting.cell_mm, diagnostics)) return nullptr;
  }
  auto created = stock_model(choice.kind).create(blank, fitting);
  if (created) return std::move(created.value());
  // Of a blank that the model can hold nothing but the cells can be refused.
  const bool empty = (blank.bodies.empty() && !blank.mesh) || blank.bounds_mm().empty();
  const bool flat = choice.kind != StockKind::kZmap || need_of_mesh(blank).empty();
  const bool held = choice.kind == StockKind::kOctree || (need_of_blank(blank).empty() && flat);
  const bool by_cell = held && !empty;
  diagnostics.push_back(
      general_error(fmt::format("{}: {}", by_cell ? "--cell" : origin, created.error())));
  return nullptr;
}

}  // namespace

Diagnostic general_error(std::string message, std::string hint) {
  Diagnostic d;
  d.message = std::move(message);
  d.hint = std::move(hint);
  return d;
}

StockSetup make_stock(const Blank& blank, const StockChoice& choice, const StockSettings& settings,
                      const std::string& origin, Diagnostics& diagnostics, Outcome& outcome) {
  StockChoice fitting = choice;
  if (blank.sheet) {
    fitting = {StockKind::kSheet, settings.kind ? "" : tr("the blank is a sheet"), 0};
  } else if (!settings.kind && choice.kind != StockKind::kOctree &&
             choice.kind != StockKind::kTurning) {
    const std::string need = need_of_blank(blank);
    if (!need.empty()) fitting = {StockKind::kOctree, need, 0};
    const std::string undercut = need_of_mesh(blank);
    if (!undercut.empty() && choice.kind == StockKind::kZmap)
      fitting = {StockKind::kMmap, undercut, choice.finest_mm};
  }
  outcome = Outcome::kUsageError;
  StockSetup setup;
  setup.facts.origin = origin;
  setup.facts.description = describe(blank);
  setup.facts.model_reason = fitting.reason;
  const std::string trouble = misfit(settings, blank);
  if (!trouble.empty()) {
    diagnostics.push_back(general_error(trouble));
    return setup;
  }
  CarriedOver carried;
  setup.stock = blank.state_file.empty()
                    ? fill_stock(blank, fitting, settings, origin, diagnostics)
                    : load_stock(blank, fitting, settings, carried, diagnostics, outcome);
  if (carried.from != carried.to) setup.facts.carried = carried;
  const bool is_drawn = (blank.sheet && !blank.sheet->file.empty()) || !blank.profile_file.empty();
  if (!setup.stock && is_drawn) outcome = Outcome::kFailed;
  return setup;
}

bool find_comment_blank(const Program& program, const std::string& path, CommentBlank& found,
                        Diagnostics& diagnostics) {
  const auto hint = find_blank_hint(comments_with_units(program, path));
  if (!hint) return true;
  Result<Blank> blank = parse_blank(hint->spec);
  if (!blank) {
    Diagnostic d = general_error(blank.error(), tr("--stock SPEC overrides the comment"));
    d.file = path;
    d.line = static_cast<int>(hint->line);
    diagnostics.push_back(std::move(d));
    return false;
  }
  if (!read_blank_mesh(*blank, diagnostics)) return false;
  found.blank = std::move(blank.value());
  found.origin = trf("comment in line {} ({})", hint->line, hint->dialect);
  return true;
}

bool gather_tool_sources(const std::vector<ToolShapeArgument>& arguments,
                         const std::vector<ToolLibrary>& libraries, const Program* program,
                         const ProgramOptions& options, ToolSources& sources,
                         Diagnostics& diagnostics) {
  sources.arguments = arguments;
  add_library_tools(libraries, program, sources, diagnostics);
  std::vector<CommentText> comments;
  if (program) comments = comments_with_units(*program, options.path);
  sources.hints = find_tool_hints(comments);
  if (options.tool_table_path.empty()) {
    sources.turning_hints = find_turning_hints(comments);
    return true;
  }
  auto rows = read_tool_table(options.tool_table_path, diagnostics,
                              mm_of_unit(options.machine.inch_machine));
  if (!rows) {
    if (!has_error(diagnostics)) diagnostics.push_back(general_error(rows.error()));
    return false;
  }
  sources.table = std::move(rows.value());
  sources.turning_hints = find_turning_hints(comments, turning_facts(sources.table));
  compare_with_table(sources, diagnostics);
  return !has_error(diagnostics);
}

void add_interpreter_findings(const Diagnostics& said, bool end_remarked, FindingLog& log) {
  for (std::size_t i = 0; i < said.size(); ++i) {
    const Diagnostic& d = said[i];
    Finding finding;
    finding.severity = d.severity;
    finding.id = d.severity == Severity::kError ? FindingId::kInterpreterError
                                                : FindingId::kInterpreterWarning;
    if (end_remarked && i + 1 == said.size()) finding.id = FindingId::kNoProgramEnd;
    finding.file = d.file;
    finding.source.line = static_cast<std::uint32_t>(std::max(0, d.line));
    finding.text = d.message;
    finding.excerpt = d.excerpt;
    finding.hint = d.hint;
    log.add(std::move(finding));
  }
}

StockReport stock_report(const StockModel& stock, const StockReport& facts) {
  StockReport report = facts;
  report.model = stock.name();
  report.cell_mm = stock.cell_mm();
  report.blank_mm3 = stock.blank_mm3();
  report.remaining_mm3 = stock.remaining_mm3();
  report.bounds_mm = stock.bounds_mm();
  report.cells = stock.cell_count();
  report.digest = stock.digest();
  return report;
}

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

double thread_cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

}  // namespace kerf
