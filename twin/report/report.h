// twin/report/report.h - everything a dry run has to tell, as values; written as JSON
// (kerf-report/1) or as a page of text.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cutting/material.h"
#include "interp_bridge/program.h"
#include "twin/compare/comparison.h"
#include "twin/compare/rest.h"
#include "twin/findings/finding.h"
#include "twin/job/placed_stock.h"
#include "twin/machine/timeline.h"
#include "twin/process/cut_stage.h"
#include "twin/process/engagement.h"
#include "twin/report/entry_report.h"
#include "twin/report/guess_row.h"
#include "twin/report/line_window.h"
#include "twin/report/live_report.h"
#include "twin/report/sheet_report.h"
#include "twin/report/turning_report.h"

namespace kerf {

/// The workpiece after the run.
struct StockReport {
  std::string model;         ///< "zmap"
  std::string model_reason;  ///< why a model was chosen that holds more than the Z-map; else empty
  std::string description;   ///< "box 100 x 60 x 20 mm, X0..100 Y0..60 Z-20..0"
  std::string origin;        ///< "--stock", "comment in line 3 (workpiece)", "guessed"
  double cell_mm = 0;
  double blank_mm3 = 0;
  double remaining_mm3 = 0;
  Box bounds_mm;
  std::size_t cells = 0;
  std::string digest;
  std::optional<CarriedOver> carried;  ///< it was saved by another model
};

/// Where the time of the run went. Interpreting and cutting overlap: they do not add up to the
/// total.
struct TimingReport {
  double interpret_s = 0;  ///< wall, until the interpreter was done
  double cut_s = 0;        ///< wall, spent in the cutting stage
  double cut_cpu_s = 0;    ///< CPU of the thread that cuts (its checks included)
  double mesh_s = 0;       ///< wall, surface for mesh files; a picture makes its own as it is drawn
  double total_s = 0;      ///< wall, from the start of the run to the report
};

struct Report {
  std::string version;
  std::string program_path;
  ProgramSummary program;
  LineRange lines;  ///< what was asked for; motion, tools and findings are of these lines alone
  MotionTotals motion;
  std::string time_model;
  std::optional<StockReport> stock;      ///< absent if the run ended before there was one
  std::optional<SheetReport> sheet;      ///< of a workpiece that is one
  std::optional<TurningReport> turning;  ///< of one that turns
  std::optional<Comparison> comparison;  ///< with the design part, where one was given
  std::optional<Rest> rest;              ///< above it, where that was asked for
  std::optional<Material> material;      ///< of the workpiece, where that was said
  std::optional<EntryReport> entry;      ///< of a start in the middle (--enter)
  std::optional<Engagement> engagement;  ///< of milling tools, where that was asked for
  std::vector<ToolUse> tools;
  std::vector<CollisionPair>
      collisions;  ///< what was held against each other, and how near it came
  std::vector<LoosePiece>
      pieces;                     ///< into which milling has parted the workpiece; empty: it is one
  std::vector<GuessRow> guesses;  ///< taken for want of better
  bool lengths_all_zero = false;  ///< of the tool table: they are not checked
  std::optional<LiveReport> live;  ///< of shadow and replay
  FindingLog findings;
  std::string partial_reason;  ///< not empty: the program was not run to its end, and why
  TimingReport timing;
  double peak_rss_mb = 0;
};

/// kerf-report/1, indented by two blanks, with a newline at the end. Lengths, times and volumes are
/// rounded to 1e-6. Additions to the published schema: partial, partial_reason, stock.origin,
/// program.from_line, program.until_line (where asked for), tools[].origin,
/// tools[].offset_mm (of the tool table), guessed (what, option,
/// value, reason), findings_total, timing_s.cut_cpu, motion.moves_without_feed, motion.held_s (of
/// sheets: strokes, turret, regrip, pierces, pauses; part of duration_s), live (shadow and replay),
/// sheet (SheetReport; for a workpiece that is one), turning (TurningReport; the same), compare
/// (compare_json(); where a design was given), rest and engagement (rest_json(),
/// engagement_json(); where they were asked for), pieces (LoosePiece; where some have come free).
std::string json_text(const Report& report);

struct SummaryOptions {
  bool verbose = false;  ///< all that is known of how the run was made
  /// With what was guessed, in `units`; empty: it is not shown.
  std::string command;
  LengthUnit units = LengthUnit::kMm;
};

/// The page of text that `kerf run` prints: verdict, findings by severity (only counted; they are
/// printed as diagnostics), time, volume, tools, blank, and last what was guessed, with the command
/// that says so.
std::string summary_text(const Report& report, const SummaryOptions& options = {});

}  // namespace kerf
