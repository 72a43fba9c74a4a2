#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/translate.h"
#include "stock/cutter/turning_shape.h"
#include "twin/job/load_text.h"
#include "twin/report/compare_report.h"
#include "twin/report/engagement_report.h"
#include "twin/report/load_report.h"
#include "twin/report/report.h"
#include "twin/report/report_words.h"
#include "twin/report/rest_report.h"
#include "twin/report/shown_lengths.h"

namespace kerf {
namespace {

/// "errors    2 rapid-contact, 1 below-stock", a line for each severity that there is. Of more
/// findings than are kept the kinds of the kept ones are told.
std::string findings_text(const FindingLog& log) {
  constexpr std::pair<Severity, const char*> kSeverities[] = {
      {Severity::kError, tr_noop("errors")},
      {Severity::kWarning, tr_noop("warnings")},
      {Severity::kNote, tr_noop("notes")}};
  std::string out;
  for (const auto& [severity, word] : kSeverities) {
    if (log.count(severity) == 0) continue;
    std::vector<std::pair<FindingId, std::uint64_t>> kinds;
    for (const Finding& finding : log.kept()) {
      if (finding.severity != severity) continue;
      const auto known = std::find_if(kinds.begin(), kinds.end(),
                                      [&](const auto& kind) { return kind.first == finding.id; });
      if (known != kinds.end()) {
        ++known->second;
      } else {
        kinds.emplace_back(finding.id, 1);
      }
    }
    std::uint64_t told = 0;
    std::string line;
    for (const auto& [id, count] : kinds) {
      told += count;
      line += fmt::format("{}{} {}", line.empty() ? "" : ", ", count, to_string(id));
    }
    if (told < log.count(severity)) {
      line += trf("{}{} more", line.empty() ? "" : ", ", log.count(severity) - told);
    }
    out += fmt::format("{:<9} {}\n", tr(word), line);
  }
  return out;
}

/// Its first words: what the time was reckoned by.
std::string short_model(const std::string& time_model) {
  return time_model.substr(0, time_model.find(": "));
}

/// Says what the rest of the page is about, where that is not the whole program.
std::string lines_text(const LineRange& lines) {
  if (lines == LineRange{}) return {};
  std::string out = tr("lines     ");
  if (lines.from > 0) out += trf("reported from line {} (all before it is cut)", lines.from);
  if (lines.from > 0 && lines.until > 0) out += ", ";
  if (lines.until > 0) out += trf("run until line {}", lines.until);
  return out + "\n";
}

/// What is finer is the step of a profile's corners: it has no cells until it is milled.
constexpr double kFinestCell_mm = 1e-3;

void add_stock(std::string& out, const StockReport& s) {
  out += trf("stock     {} ({})\n", s.description, s.origin);
  if (s.model == "sheet") {
    out += trf("          {}, {} corners of polygons\n", s.model, s.cells);
  } else if (s.model == "turning" && s.cell_mm < kFinestCell_mm) {
    out += trf("          {}, {} corners of its profile\n", s.model, s.cells);
  } else {
    out += trf("          {}, cells of {:.4g} mm, {:.2f} million\n", s.model, s.cell_mm,
               static_cast<double>(s.cells) / 1e6);
  }
  if (!s.model_reason.empty()) {
    out += trf("          {} because {}\n", s.model, s.model_reason);
  }
  constexpr double kNothing_mm = 5e-5;  // four places are shown
  if (s.carried && s.carried->bound_mm >= kNothing_mm) {
    out += trf("          was {}; sure but within {:.4f} mm of its surface\n", s.carried->from,
               s.carried->bound_mm);
  }
}

void add_removed(std::string& out, const StockReport& s) {
  const double removed = s.blank_mm3 - s.remaining_mm3;
  const double percent = s.blank_mm3 > 0 ? 100 * removed / s.blank_mm3 : 0;
  out += trf("removed   {} of {} ({:.1f} %)\n", volume_text(removed), volume_text(s.blank_mm3),
             percent);
}

/// "T1, T3": of the tools that have cut.
std::string without_teeth(const std::vector<ToolUse>& tools) {
  std::string out;
  for (const ToolUse& use : tools) {
    if (use.teeth || use.removed_mm3 <= 0 || is_turning_shape(use.shape)) continue;
    out += fmt::format("{}T{}", out.empty() ? "" : ", ", use.number);
  }
  return out;
}

void add_tools(std::string& out, const std::vector<ToolUse>& tools) {
  const char* head = tr("tools     ");
  for (const ToolUse& use : tools) {
    const std::string shape = use.shape.empty() ? tr("undefined, did not cut") : use.shape;
    out += fmt::format("{}{:<3} {}", head, use.number, shape);
    if (!use.shape.empty()) {
      out += fmt::format(" ({}{})", use.guessed ? tr("guessed from ") : "", use.origin);
      out += trf("\n              removed {}, cutting {}, deepest cut {:.2f} mm, peak {:.1f} mm3/s",
                 volume_text(use.removed_mm3), duration_text(use.cut_s), use.max_depth_mm,
                 use.peak_mm3_per_s);
      if (use.chip.is_known()) {
        out +=
            trf("\n              {} teeth: feed per tooth {:.3g} mm, {:.3g} mm at most (line {}), "
                "cutting speed {} m/min",
                *use.teeth, use.chip.mean_mm(), use.chip.most_mm, use.chip.most_at.line,
                load_text(use.chip.speed_m_per_min));
      }
      if (use.loads) out += loads_text(*use.loads, use.chip.is_known());
    }
    out += "\n";
    head = "          ";
  }
}

/// Of each fixture and link what came nearest to it.
void add_clearances(std::string& out, const Report& report) {
  std::vector<const CollisionPair*> nearest;
  for (const CollisionPair& row : report.collisions) {
    if (row.other.empty() || !row.least_clearance_mm) continue;
    const auto known = std::ranges::find_if(
        nearest, [&](const CollisionPair* other) { return other->other == row.other; });
    if (known == nearest.end()) {
      nearest.push_back(&row);
    } else if (*row.least_clearance_mm < *(*known)->least_clearance_mm) {
      *known = &row;
    }
  }
  const char* head = tr("clearance ");
  for (const CollisionPair* row : nearest) {
    const std::string what = row->first.empty()
                                 ? trf("{} of tool {}", name_of(row->part), row->tool)
                             : row->first == "workpiece" ? std::string(tr("the workpiece"))
                                                         : row->first;
    if (row->contacts > 0) {
      out += trf("{}{}: touched by {}, line {}\n", head, row->other, what, row->source.line);
    } else {
      out += trf("{}{}: {:.2f} mm from {}, line {}\n", head, row->other, *row->least_clearance_mm,
                 what, row->source.line);
    }
    head = "          ";
  }
}

/// "T1, T3": the tools of which `is_known` is not so.
std::string unknown_of(const Report& report, bool ToolUse::*is_known) {
  std::string out;
  for (const ToolUse& use : report.tools) {
    if (use.*is_known || use.shape.empty()) continue;
    out += fmt::format("{}T{}", out.empty() ? "" : ", ", use.number);
  }
  return out;
}

/// What nobody looked for: one line a run, whatever the number of tools.
void add_unchecked(std::string& out, const Report& report) {
  if (!report.stock || report.sheet || report.turning) return;
  const std::string holders = unknown_of(report, &ToolUse::holder_checked);
  const std::string shanks = unknown_of(report, &ToolUse::shank_checked);
  if (holders.empty() && shanks.empty()) return;
  const bool is_described = std::ranges::any_of(report.tools, [](const ToolUse& use) {
    return !use.holder_checked && use.shape.find("holder=") != std::string::npos;
  });
  if (is_described) {
    out += tr("unchecked shank and holder: not where material is added\n");
    return;
  }
  const std::string first = (holders.empty() ? shanks : holders).substr(1);
  std::string number = first.substr(0, first.find(','));
  // --tool has no 0: a program that changes no tool cuts with what --tool 1 says.
  if (number == "0") number = "1";
  if (shanks.empty()) {
    out += trf("unchecked {}: no holder known (--tool {}=SHAPE:holder=er20:stickout=L)\n", holders,
               number);
  } else if (holders.empty()) {
    out +=
        trf("unchecked {}: no length of flutes known (--tool {}=SHAPE:flute=L)\n", shanks, number);
  } else if (holders == shanks) {
    out +=
        trf("unchecked {}: no holder and no length of flutes known "
            "(--tool {}=SHAPE:flute=L:holder=er20:stickout=L)\n",
            holders, number);
  } else {
    out +=
        trf("unchecked {}: no holder known; {}: no length of flutes "
            "(--tool {}=SHAPE:flute=L:holder=er20:stickout=L)\n",
            holders, shanks, number);
  }
}

void add_spindle_load(std::string& out, const LoadReport& load) {
  const std::string_view sign = sign_of(load.unit);
  out += trf("load      {} to {} {}", load_text(load.least), load_text(load.most), sign);
  for (const LoadReport::Idle& idle : load.idle) {
    out += idle.rpm > 0
               ? trf(", {} {} in the air at {:.0f} rpm", load_text(idle.load), sign, idle.rpm)
               : trf(", {} {} in the air", load_text(idle.load), sign);
  }
  out += '\n';
  for (const LoadReport::Tool& tool : load.tools) {
    out += trf("          T{} {} {}, {} to {} should be; over {}", tool.number,
               load_text(tool.measured), sign, load_text(tool.low), load_text(tool.high),
               duration_text(tool.judged_s));
    if (tool.differs_s > 0) out += trf(", {} of it beyond", duration_text(tool.differs_s));
    out += '\n';
  }
  for (const LoadReport::Unjudged& tool : load.unjudged)
    out +=
        trf("          T{} cuts for {} that are not judged: threads, driven tools, or no teeth=N\n",
            tool.number, duration_text(tool.seconds));
}

void add_live(std::string& out, const LiveReport& live) {
  const LiveFacts& f = live.facts;
  out += trf("source    {}: {} samples in {}, {:.0f} a second\n", live.source, f.samples,
             duration_text(live.duration_s), live.rate_hz);
  std::string faults;
  const auto add = [&](std::uint64_t n, const char* what) {
    if (n == 0) return;
    if (!faults.empty()) faults += ", ";
    faults += fmt::format("{} {}", n, what);
  };
  add(live.status.errors, tr("errors"));
  add(live.status.reconnects, tr("reconnections"));
  add(live.status.lost, tr("lost"));
  add(live.status.incomplete, tr("cycles of the bus incomplete"));
  add(live.status.damaged, tr("damaged"));
  add(live.status.standing, tr("while the device's clock stood"));
  add(live.status.duplicates, tr("duplicates"));
  add(live.status.disordered, tr("out of order"));
  add(live.dropped, tr("dropped"));
  add(f.incomplete, tr("incomplete"));
  add(f.wild, tr("where no machine is"));
  add(f.gaps, tr("gaps"));
  if (!faults.empty()) out += fmt::format("          {}\n", faults);
  if (!live.status.trouble.empty()) {
    out += trf("          last trouble: {}\n", live.status.trouble);
  }
  out += trf("cut       {} along the program, {} from sample to sample\n", distance_text(f.path_mm),
             distance_text(f.chord_mm));
  if (f.on_path > 0) {
    out +=
        trf("followed  {} samples on the path, {:.3f} mm from it on average, {:.3f} mm at "
            "most; {} beside it, {:.2f} mm at most\n",
            f.on_path, f.following_sum_mm / static_cast<double>(f.on_path), f.following_max_mm,
            f.off_path, f.off_path_max_mm);
  }
  if (live.load) add_spindle_load(out, *live.load);
  if (live.jitter_ms > 0 || live.clock_steps > 0) {
    out +=
        trf("clocks    the device's and this computer's keep together within {:.1f} ms{}\n",
            live.jitter_ms, live.clock_steps > 0 ? tr("; this computer's was set meanwhile") : "");
  }
  if (live.age_max_ms > 0) {
    out += trf("age       {:.1f} ms in the middle, {:.1f} at 99 %, {:.1f} at most\n",
               live.age_median_ms, live.age_p99_ms, live.age_max_ms);
  }
}

/// One line a run, where there is more than the whole watch.
void add_runs(std::string& out, const std::vector<LiveRun>& runs) {
  if (runs.size() < 2) return;
  const char* head = tr("runs      ");
  for (const LiveRun& run : runs) {
    const std::string file = run.program.substr(run.program.rfind('/') + 1);
    std::string lines;
    if (run.from_line > 0) lines = trf(", lines {} to {}", run.from_line, run.to_line);
    out += trf("{}{:<3} part {}: {} {}{}, {} from {} on\n", head, run.number, run.part,
               file.empty() ? tr("no program") : file, tr(to_string(run.end)), lines,
               duration_text(run.end_s - run.begin_s), duration_text(run.begin_s));
    out +=
        trf("              removed {}, {} along the program, {} beside it; {} errors, "
            "{} warnings\n",
            volume_text(run.removed_mm3), distance_text(run.facts.path_mm),
            distance_text(run.facts.chord_mm), run.errors, run.warnings);
    if (run.sheet) out += "              " + sheet_run_text(*run.sheet);
    head = "          ";
  }
}

/// ", of that strokes 3.6 s, turret 4.1 s"; empty where nothing was held.
std::string held_text(const HeldTime& held) {
  const std::pair<const char*, double> causes[] = {
      {tr("strokes"), held.strokes_s},
      {tr("turret"), held.turret_s},
      {tr("re-gripping"), held.regrip_s},
      {tr("piercing"), held.pierces_s},
      {tr("pauses at the ends of cuts"), held.pauses_s}};
  std::string out;
  for (const auto& [cause, seconds] : causes) {
    if (seconds <= 0) continue;
    out += fmt::format("{} {} {:.1f} s", out.empty() ? tr(", of that") : ",", cause, seconds);
  }
  return out;
}

/// What comes first on every page.
void add_verdict(std::string& out, const Report& report) {
  const std::string name = report.program_path.empty() ? "" : report.program_path + ": ";
  out += trf("verdict   {}{}\n", name, verdict_text(report.findings));
  if (!report.partial_reason.empty()) {
    out +=
        trf("PARTIAL   {}: everything here is of the part that was run\n", report.partial_reason);
  }
  out += findings_text(report.findings);
}

std::string summary_text(const Report& report, const LiveReport& live) {
  std::string out;
  add_verdict(out, report);
  add_live(out, live);
  add_runs(out, live.runs);
  if (report.stock) add_removed(out, *report.stock);
  if (report.sheet) out += sheet_text(*report.sheet);
  if (report.turning) out += turning_text(*report.turning);
  if (report.comparison) out += compare_text(*report.comparison);
  if (report.rest) out += rest_text(*report.rest);
  add_tools(out, report.tools);
  add_clearances(out, report);
  add_unchecked(out, report);
  if (report.stock) add_stock(out, *report.stock);
  out += trf("run       {:.2f} s (cutting {:.2f}), {:.0f} MB\n", report.timing.total_s,
             report.timing.cut_cpu_s, report.peak_rss_mb);
  return out;
}

/// --verbose.
void add_details(std::string& out, const Report& report) {
  const MotionTotals& m = report.motion;
  out += trf("program   {} lines, {} moves ({} arcs)\n", report.program.program_lines, m.moves,
             m.arcs);
  out += trf("distance  feed {}, traverse {}\n", distance_text(m.feed_mm),
             distance_text(m.traverse_mm));
  out += trf("model     {}\n", report.time_model);
  out +=
      trf("run       {:.2f} s (interpreting {:.2f}, cutting {:.2f}, surface {:.2f}), {:.0f} MB\n",
          report.timing.total_s, report.timing.interpret_s, report.timing.cut_s,
          report.timing.mesh_s, report.peak_rss_mb);
}

}  // namespace

std::string summary_text(const Report& report, const SummaryOptions& options) {
  if (report.live) return summary_text(report, *report.live);
  std::string out;
  const MotionTotals& m = report.motion;
  add_verdict(out, report);
  out += lines_text(report.lines);
  if (report.entry) out += entry_text(*report.entry);
  out += trf("time      {}{} ({})\n", duration_text(m.duration_s), m.held ? held_text(*m.held) : "",
             short_model(report.time_model));
  if (report.stock) add_removed(out, *report.stock);
  if (report.sheet) out += sheet_text(*report.sheet);
  if (report.turning) out += turning_text(*report.turning);
  if (report.comparison) out += compare_text(*report.comparison);
  if (report.rest) out += rest_text(*report.rest);
  if (report.material) {
    out += trf("material  {}{}\n", report.material->name,
               without_teeth(report.tools).empty()
                   ? ""
                   : trf("; forces of tools without teeth=N are not known: {}",
                         without_teeth(report.tools)));
  }
  add_tools(out, report.tools);
  if (report.engagement) out += engagement_text(*report.engagement);
  add_clearances(out, report);
  add_unchecked(out, report);
  if (report.lengths_all_zero) {
    out += tr("lengths   all 0 in the tool table, and so they are not checked\n");
  }
  if (report.stock) add_stock(out, *report.stock);
  if (options.verbose) add_details(out, report);
  return in_unit(out, options.units) +
         guess_text(rows_in(report.guesses, options.units), options.command);
}

}  // namespace kerf
