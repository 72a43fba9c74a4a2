#include "twin/cli/view_load.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>

#include "base/exit_code.h"
#include "base/small_file.h"
#include "base/translate.h"
#include "twin/cli/command_line.h"
#include "twin/cli/console.h"
#include "twin/cli/cutting_options.h"
#include "twin/report/guess_row.h"

namespace kerf {
namespace {

/// Where the comparison will not say what its user expects.
Diagnostics comparison_doubts(const ViewRequest& request, const StockModel& stock) {
  Diagnostics doubts;
  const auto doubt = [&](std::string message, std::string hint) {
    Diagnostic d = fault_of(std::move(message), std::move(hint));
    d.severity = Severity::kWarning;
    d.file = request.compare.path;
    doubts.push_back(std::move(d));
  };
  doubt_place(*request.design, request.compare.path, stock.bounds_mm(),
              request.compare.tolerance_mm, doubts);
  if (stock.cell_mm() > request.compare.tolerance_mm) {
    doubt(trf("cells of {:g} mm are coarser than the tolerance of {:g} mm: walls may seem "
              "off by up to a cell",
              stock.cell_mm(), request.compare.tolerance_mm),
          trf("--cell {:g} or --tolerance {:g}", request.compare.tolerance_mm, stock.cell_mm()));
  }
  return doubts;
}

}  // namespace

Diagnostic fault_of(std::string message, std::string hint) {
  Diagnostic d;
  d.message = std::move(message);
  d.hint = std::move(hint);
  return d;
}

/// What the file is, by its first bytes; by its name where they do not tell.
ViewKind view_kind_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string head = read_up_to(file, 64);
  const std::string_view begin = head;
  if (begin.starts_with("kerf-state/")) return ViewKind::kState;
  if (begin.find("kerf-recording/") != std::string_view::npos) return ViewKind::kLog;
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".csv" || extension == ".log" || extension == ".sam" ? ViewKind::kLog
                                                                           : ViewKind::kProgram;
}

/// Program, blank, tools; null on error.
std::unique_ptr<LoadedProgram> load_viewed(const ViewRequest& request, ViewKind kind,
                                           const LoadControl& control, Diagnostics& diagnostics,
                                           Outcome& outcome) {
  if (kind == ViewKind::kProgram) {
    auto loaded = load_program(request.run.session, control, diagnostics, outcome);
    // Who cut where is what colours and the difference between cut and uncut are made of.
    if (!loaded || !loaded->player.blank) return loaded;
    loaded->player.blank->keep_cut_ids(true);
    loaded->player.measures_loads = request.run.engagement && !loaded->player.blank->sheet();
    if (request.run.engagement) doubt_engagement(*loaded->player.blank, diagnostics);
    return loaded;
  }
  const std::string& path = request.run.session.program.path;
  Result<Blank> blank = parse_blank("state:" + path);
  if (!blank) {
    diagnostics.push_back(fault_of(blank.error()));
    outcome = Outcome::kFailed;
    return nullptr;
  }
  StockSetup setup =
      make_stock(*blank, StockChoice{}, request.run.session.stock, path, diagnostics, outcome);
  if (!setup.stock) return nullptr;
  auto loaded = std::make_unique<LoadedProgram>();
  loaded->player.track = ProgramTrackBuilder().build({}, {});
  loaded->player.blank = std::move(setup.stock);
  loaded->blank = setup.facts;
  return loaded;
}

/// The block that the interpreter refused, if there is one, and why the program is not whole.
void print_faults(const LoadedProgram& loaded) {
  for (const Finding& remark : loaded.player.remarks) {
    if (remark.severity != Severity::kError) continue;
    print_diagnostic(stderr, diagnostic_of(remark, loaded.player.track->files()));
  }
  if (!loaded.partial_reason.empty()) kerf::print(stderr, "kerf: {}\n", loaded.partial_reason);
}

void print_guesses(const ViewRequest& request, const LoadedProgram& loaded) {
  if (request.run.quiet || loaded.guesses.empty()) return;
  const std::vector<GuessRow> rows = rows_in(loaded.guesses, request.run.units);
  const Arguments said = with_guesses(request.written, rows);
  kerf::print(stderr, "{}", guess_text(rows, command_line(said)));
}

int view_exit_code(Outcome outcome, const Diagnostics& diagnostics) {
  if (outcome == Outcome::kUsageError) return kExitUsage;
  return has_error(diagnostics) || outcome == Outcome::kFailed ? kExitFailure : kExitGood;
}

/// With the machine around it. What is wrong with that one is said; the program is shown without.
ViewedProgram viewed(const ViewRequest& request, const LoadedProgram& loaded) {
  ViewedProgram shown = viewed_program(
      loaded, std::filesystem::path(request.run.session.program.path).filename().string());
  if (request.design && loaded.player.blank) {
    shown.design = request.design;
    shown.tolerance_mm = request.compare.tolerance_mm;
    print_diagnostics(comparison_doubts(request, *loaded.player.blank), request.run.quiet);
  }
  const RunRequest& run = request.run;
  Diagnostics diagnostics;
  shown.machine = machine_around(loaded, run.machine, run.ini, diagnostics);
  print_diagnostics(diagnostics, request.run.quiet);
  return shown;
}

}  // namespace kerf
