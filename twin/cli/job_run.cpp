#include "twin/cli/job_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "base/small_file.h"
#include "base/translate.h"
#include "twin/cli/console.h"
#include "twin/cli/page_output.h"
#include "twin/cli/torch_options.h"
#include "twin/config/config_tree.h"
#include "twin/page/job_page.h"
#include "twin/program/session_parts.h"
#include "twin/program/turning.h"

namespace kerf {
namespace {

constexpr std::size_t kMostJobBytes = 1U << 20U;
/// What a command line says for all setups.
constexpr const char* kForAll[] = {"--threads", "--interp", "--interp-fast", "--interp-cache",
                                   "--interp-cache-size"};

/// Whether the program of the next setup is for a lathe, by what is known before it is run.
bool is_for_lathe(const RunRequest& request) {
  const SessionOptions& session = request.session;
  if (session.program.as_mill) return false;
  if (session.stock.kind) return *session.stock.kind == StockKind::kTurning;
  Diagnostics unheard;
  const std::unique_ptr<Program> program = Program::open(session.program, unheard);
  ToolSources tools;
  if (!program || !gather_tool_sources(session.tools, session.libraries, program.get(),
                                       session.program, tools, unheard)) {
    return false;
  }
  return note_turning(session.program, program.get(), std::nullopt, std::nullopt, tools, unheard) &&
         tools.turning;
}

bool keeps_z(const JobTurn& turn) {
  const std::optional<AxisTurn> by_axes = turn.turn().by_axes();
  return by_axes && by_axes->keeps_z();
}

}  // namespace

double JobResult::machining_s() const {
  double sum = 0;
  for (const Setup& setup : setups) sum += setup.machining_s;
  return sum;
}

double JobResult::setup_s() const {
  double sum = 0;
  for (const Setup& setup : setups) sum += setup.setup_s;
  return sum;
}

JobRun::JobRun(const Arguments& asked, JobFile job, std::string text, PrivateFolder folder)
    : asked_(asked), job_(std::move(job)), text_(std::move(text)), folder_(std::move(folder)) {}

std::optional<JobRun> JobRun::open(const Arguments& asked, const std::string& path,
                                   Diagnostics& diagnostics) {
  const Result<std::string> text = read_small_file(path, kMostJobBytes);
  if (!text) {
    diagnostics.push_back(general_error(text.error()));
    return std::nullopt;
  }
  std::optional<JobFile> job = parse_job(*text, path, diagnostics);
  if (!job) return std::nullopt;
  Result<PrivateFolder> folder = PrivateFolder::create();
  if (!folder) {
    diagnostics.push_back(general_error(folder.error()));
    return std::nullopt;
  }
  return JobRun(asked, std::move(*job), *text, std::move(folder.value()));
}

std::string JobRun::state_of(std::size_t setup) const {
  return fmt::format("{}/setup-{}.state", folder_.path(), setup + 1);
}

std::string JobRun::table_of(std::size_t setup) const {
  return fmt::format("{}/setup-{}.csv", folder_.path(), setup + 1);
}

std::string JobRun::title_of(std::size_t setup) const {
  const std::string& name = job_.setups[setup].name;
  return name.empty() ? trf("setup {} of {}", setup + 1, count())
                      : trf("setup {} of {}: {}", setup + 1, count(), name);
}

Diagnostic JobRun::fault_at(const JobPlace& place, std::string message, std::string hint) const {
  return ConfigText(text_, job_.path)
      .diagnostic(place.line, place.column, fmt::format("{}: {}", place.path, message),
                  std::move(hint));
}

/// Why a setup from `after` on needs an octree; empty: none does.
std::string JobRun::need_of_octree(std::size_t after) const {
  for (std::size_t n = after; n < count(); ++n) {
    if (keeps_z(job_.setups[n].turn)) continue;
    return trf("{} lays it otherwise than flat", job_.words_of(n));
  }
  return {};
}

Arguments JobRun::arguments_of(std::size_t setup, const Wishes& wishes) const {
  Arguments out;
  out.command = kRun;
  out.words = asked_.words;
  out.options = job_.setups[setup].options;
  for (const char* const option : kForAll) {
    const std::string text = asked_.options.text(option);
    if (!text.empty()) out.options.set(option, text);
  }
  if (asked_.options.has("--quiet")) out.options.set_flag("--quiet");
  if (asked_.options.has("--verbose")) out.options.set_flag("--verbose");
  if (setup > 0) out.options.set("--stock", "state:" + state_of(setup));
  if (!wishes.folder.empty()) {
    const std::filesystem::path folder = wishes.folder;
    out.options.set("--png", (folder / fmt::format("setup-{}.png", setup + 1)).string());
    const std::string section = asked_.options.text("--section");
    if (!section.empty()) out.options.set("--section", section);
  }
  if (wishes.keeps_tables) out.options.set("--csv", table_of(setup));
  if (setup + 1 < count()) return out;
  if (wishes.compares) {
    for (const char* const option : {"--compare", "--tolerance", "--compare-at", "--compare-unit"})
      if (job_.compare.has(option)) out.options.set(option, job_.compare.text(option));
    if (job_.compare.has("--compare-fit")) out.options.set_flag("--compare-fit");
  }
  for (const auto& [option, path] : wishes.last.named())
    if (!path->empty()) out.options.set(option, *path);
  const std::string tolerance = asked_.options.text("--mesh-tolerance");
  if (!tolerance.empty()) out.options.set("--mesh-tolerance", tolerance);
  return out;
}

RunRequest JobRun::request_of(std::size_t setup, const Wishes& wishes, const Arguments& arguments,
                              Diagnostics& diagnostics) const {
  Diagnostics said;
  RunRequest request = understand_run(arguments, said);
  check_sheet_options(request.session.blank, arguments, said);
  place_faults(job_, text_, job_.setups[setup].option_places, said);
  place_faults(job_, text_, job_.compare_places, said);
  for (Diagnostic& d : said) {
    // What no key of the file says is the command line's own.
    diagnostics.push_back(std::move(d));
  }
  request.session.stock.later_need = need_of_octree(setup + 1);
  request.is_of_job = true;
  request.keeps_moves = wishes.compares && job_.compare.has("--compare") && setup + 1 < count();
  request.summary_on_stderr = wishes.on_stderr;
  request.units = shown_unit();
  request.session.blank_words = blank_words(setup);
  return request;
}

std::string JobRun::blank_words(std::size_t setup) const {
  if (setup == 0) return {};
  const std::string lies = words_of(job_.setups[setup].turn);
  const std::string words = trf("what {} has left", job_.words_of(setup - 1));
  return lies.empty() ? words : words + ", " + lies;
}

void JobRun::check(Diagnostics& diagnostics) const {
  for (std::size_t setup = 0; setup < count(); ++setup)
    request_of(setup, {}, arguments_of(setup, {}), diagnostics);
}

Arguments JobRun::view_arguments(std::size_t setup, bool is_asked) const {
  const Arguments own = arguments_of(setup, {});
  Arguments out = asked_;
  out.command = kView;
  out.options.clear("--setup");
  if (!is_asked) {
    out.options.clear("--at-line");
    for (const Setting& setting : setting_table())
      if (is_passed_on(setting)) out.options.clear(setting.option);
  }
  out.options.set("PROGRAM", own.options.text("PROGRAM"));
  for (const Setting& setting : setting_table()) {
    const std::string_view option = setting.option;
    if ((setting.commands & kView) == 0 || option.empty() || !own.options.has(option) ||
        out.options.has(option)) {
      continue;
    }
    // It is in the model that was asked for, or in more (carry_over()).
    if (setup > 0 && (option == "--model" || option == "--cell")) continue;
    if (!setting.flag.empty()) {
      out.options.set_flag(option);
    } else if (setting.repeatable) {
      out.options.set_all(option, own.options.texts(option));
    } else {
      out.options.set(option, own.options.text(option));
    }
  }
  if (setup == 0 && !need_of_octree(1).empty() && !out.options.has("--model")) {
    Diagnostics unheard;  // check() has told it
    if (!is_for_lathe(request_of(0, {}, own, unheard))) out.options.set("--model", "octree");
  }
  return out;
}

bool JobRun::carry_over(std::size_t next, const StockModel& stock, Diagnostics& diagnostics) {
  const JobSetup& setup = job_.setups[next];
  Diagnostics unheard;  // check() has told it
  const RunRequest request = request_of(next, {}, arguments_of(next, {}), unheard);
  const StockSettings& wish = request.session.stock;
  std::unique_ptr<StockModel> left = stock.snapshot();
  const Placement placement =
      setup.turn.is_none() ? Placement() : setup.turn.placement(solid_bounds(*left));
  const bool needs_octree = wish.kind == StockKind::kOctree || !need_of_octree(next + 1).empty();
  const bool lathe = left->turned() != nullptr && is_for_lathe(request);
  Result<PlacedStock> placed =
      place_stock(std::move(left), placement, needs_octree && !lathe, lathe, wish);
  if (!placed) {
    diagnostics.push_back(fault_at(setup.place, placed.error()));
    return false;
  }
  const StockKind kind = row_of(*placed->stock).kind;
  const auto model = setup.option_places.find("--model");
  if (wish.kind && *wish.kind != kind && model != setup.option_places.end()) {
    const bool holds_less = kind == StockKind::kZmap && *wish.kind == StockKind::kMmap;
    if (!holds_less) {
      diagnostics.push_back(
          fault_at(model->second,
                   trf("the workpiece comes as {} here; {} cannot take it over", placed->carried.to,
                       stock_model(*wish.kind).name),
                   placed->carried.to == stock_model(StockKind::kOctree).name
                       ? std::string(tr("leave it out"))
                       : trf("{} or octree, or leave it out", placed->carried.to)));
      return false;
    }
  }
  const auto cell = setup.option_places.find("--cell");
  if (cell != setup.option_places.end() && placed->carried.from == placed->carried.to) {
    diagnostics.push_back(fault_at(
        cell->second, tr("the workpiece keeps its cells here; the first setup says them")));
    return false;
  }
  if (const Done saved = placed->stock->save(state_of(next)); !saved) {
    diagnostics.push_back(general_error(saved.error()));
    return false;
  }
  if (past_.size() == next) past_.back().to_next = placement;
  carried_[next] = placed->carried;
  ready_ = next;
  return true;
}

void JobRun::take(std::size_t setup, const Wishes& wishes, const FinishedRun& run,
                  Diagnostics& diagnostics) {
  const Report& report = run.session.report();
  JobResult::Setup& out = result_.setups.back();
  out.report = json_text(report);
  out.machining_s = report.motion.duration_s;
  out.tools = report.tools;
  out.comparison = report.comparison;
  out.files = report.program.files;
  out.errors = report.findings.count(Severity::kError);
  out.warnings = report.findings.count(Severity::kWarning);
  out.notes = report.findings.count(Severity::kNote);
  const bool finished = run.outcome == Outcome::kFinished || run.outcome == Outcome::kLossy;
  if (wishes.keeps_pages)
    out.article =
        article_of(report, run.session.stock(), run.page, title_of(setup), JobPage::anchor(setup));
  if (wishes.keeps_tables) out.table = table_of(setup);
  out.is_whole = finished && report.partial_reason.empty() && run.session.stock() != nullptr;
  if (out.comparison) {
    for (std::size_t n = 0; n < out.comparison->regions.size(); ++n) {
      const DeviationRegion& region = out.comparison->regions[n];
      if (!region.is_gouge || region.worst.by.source.line > 0) continue;
      auto found = made_before(region.worst.at_mm, run.session.stock()->cell_mm());
      if (!found) continue;
      found->region = n;
      out.made_before.push_back(std::move(*found));
    }
  }
  if (!out.is_whole || setup + 1 == count()) return;
  if (run.session.kept_moves()) {
    const std::span<const CutLabel> labels = run.session.cut_labels()->all();
    past_.push_back({*run.session.kept_moves(), {labels.begin(), labels.end()}, out.files, {}});
  }
  result_.stopped_between = !carry_over(setup + 1, *run.session.stock(), diagnostics);
}

/// The last of the setups before one that removed what lies at the point or within a cell of it:
/// the point is on the surface that it left.
std::optional<JobResult::Setup::MadeBefore> JobRun::made_before(Vec3 point_mm,
                                                                double cell_mm) const {
  for (std::size_t n = past_.size(); n-- > 0;) {
    const Past& past = past_[n];
    point_mm = past.to_next.before(point_mm);
    std::optional<std::uint32_t> label = past.moves.cut_by(point_mm);
    for (int axis = 0; axis < 3 && !label; ++axis) {
      for (const double way_mm : {cell_mm, -cell_mm}) {
        Vec3 beside = point_mm;
        beside[axis] += way_mm;
        if (!label) label = past.moves.cut_by(beside);
      }
    }
    if (!label || *label >= past.labels.size()) continue;
    const CutLabel& by = past.labels[*label];
    JobResult::Setup::MadeBefore out;
    out.setup = n + 1;
    out.name = job_.name_of(n);
    out.words = job_.words_of(n);
    out.file = by.source.file < past.files.size() ? past.files[by.source.file] : std::string();
    out.line = by.source.line;
    out.tool = by.tool;
    return out;
  }
  return std::nullopt;
}

void JobRun::run(std::size_t first, std::size_t end, const Wishes& wishes) {
  for (std::size_t setup = first; setup < end; ++setup) {
    if (!asked_.options.has("--quiet"))
      kerf::print(wishes.on_stderr ? stderr : stdout, "{}{}\n", setup == first ? "" : "\n",
                  title_of(setup));
    const Arguments arguments = arguments_of(setup, wishes);
    Diagnostics said;
    RunRequest request = request_of(setup, wishes, arguments, said);
    request.keeps_page = wishes.keeps_pages;
    JobResult::Setup& row = result_.setups.emplace_back();
    row.name = job_.name_of(setup);
    row.words = job_.words_of(setup);
    row.setup_s = job_.setups[setup].time_s;
    row.lies = words_of(job_.setups[setup].turn);
    if (const auto carried = carried_.find(setup); carried != carried_.end())
      row.carried = carried->second;
    if (setup > 0) {
      request.session.stock.kind.reset();  // it is in the model that was asked for, or in more
      request.session.stock.cell_mm = 0;
    }
    RunVerdict verdict = run_one(arguments, std::move(request),
                                 [&](const FinishedRun& run, Diagnostics& diagnostics) {
                                   take(setup, wishes, run, diagnostics);
                                 });
    result_.code = std::max(result_.code, verdict.code);
    result_.listed.push_back(std::move(verdict.listed));
    if (result_.stopped_between) result_.code = std::max<int>(result_.code, kExitUsage);
    if (result_.setups.back().is_whole && !result_.stopped_between) continue;
    for (std::size_t later = setup + 1; later < count(); ++later)
      result_.not_run.push_back(job_.name_of(later));
    return;
  }
}

}  // namespace kerf
