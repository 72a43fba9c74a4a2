#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/findings/finding_json.h"
#include "twin/report/compare_report.h"
#include "twin/report/engagement_report.h"
#include "twin/report/load_report.h"
#include "twin/report/report.h"
#include "twin/report/rest_report.h"
#include "twin/report/run_json.h"

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

Json program_json(const Report& report) {
  Json out;
  out["path"] = report.program_path;
  out["lines"] = report.program.program_lines;
  if (report.lines.from > 0) out["from_line"] = report.lines.from;
  if (report.lines.until > 0) out["until_line"] = report.lines.until;
  out["interpreter"] = report.program.interpreter;
  Json commands = Json::object();
  for (const auto& [name, count] : report.program.canonical_commands) commands[name] = count;
  out["canonical_commands"] = std::move(commands);
  return out;
}

Json motion_json(const Report& report) {
  const MotionTotals& m = report.motion;
  Json out;
  out["moves"] = m.moves;
  out["feed_moves"] = m.feed_moves;
  out["traverse_moves"] = m.traverse_moves;
  out["arcs"] = m.arcs;
  out["moves_without_feed"] = m.moves_without_feed;
  out["feed_mm"] = rounded(m.feed_mm);
  out["traverse_mm"] = rounded(m.traverse_mm);
  out["duration_s"] = rounded(m.duration_s);
  if (m.held) {
    out["held_s"] = {{"strokes", rounded(m.held->strokes_s)},
                     {"turret", rounded(m.held->turret_s)},
                     {"regrip", rounded(m.held->regrip_s)},
                     {"pierces", rounded(m.held->pierces_s)},
                     {"pauses", rounded(m.held->pauses_s)}};
  }
  out["time_model"] = report.time_model;
  return out;
}

Json carried_json(const CarriedOver& carried) {
  Json out;
  out["from"] = carried.from;
  out["to"] = carried.to;
  out["bound_mm"] = rounded(carried.bound_mm);
  if (!carried.note.empty()) out["note"] = carried.note;
  return out;
}

Json stock_json(const Report& report) {
  if (!report.stock) return nullptr;
  const StockReport& s = *report.stock;
  Json out;
  out["model"] = s.model;
  if (!s.model_reason.empty()) out["model_reason"] = s.model_reason;
  out["origin"] = s.origin;
  out["cell_mm"] = rounded(s.cell_mm);
  out["blank_mm3"] = rounded(s.blank_mm3);
  out["removed_mm3"] = rounded(s.blank_mm3 - s.remaining_mm3);
  out["remaining_mm3"] = rounded(s.remaining_mm3);
  out["bounds_mm"] = Json::array({vector_json(s.bounds_mm.min), vector_json(s.bounds_mm.max)});
  out["cells"] = s.cells;
  out["digest"] = s.digest;
  if (s.carried) out["carried"] = carried_json(*s.carried);
  return out;
}

Json tools_json(const Report& report) {
  Json out = Json::array();
  for (const ToolUse& use : report.tools) {
    Json tool;
    tool["number"] = use.number;
    tool["shape"] = use.shape.empty() ? Json(nullptr) : Json(use.shape);
    tool["origin"] = use.origin;
    tool["guessed"] = use.guessed;
    if (use.teeth) tool["teeth"] = *use.teeth;
    if (use.offset_mm) {
      const auto& [x, y, z] = *use.offset_mm;
      tool["offset_mm"] = {rounded(x), rounded(y), rounded(z)};
    }
    tool["shank_checked"] = use.shank_checked;
    tool["holder_checked"] = use.holder_checked;
    tool["cut_s"] = rounded(use.cut_s);
    tool["feed_mm"] = rounded(use.feed_mm);
    tool["removed_mm3"] = rounded(use.removed_mm3);
    tool["max_depth_mm"] = rounded(use.max_depth_mm);
    tool["peak_mm3_per_s"] = rounded(use.peak_mm3_per_s);
    if (use.chip.is_known()) {
      tool["engagement"] = {{"feed_per_tooth_mm", rounded(use.chip.most_mm)},
                            {"feed_per_tooth_mean_mm", rounded(use.chip.mean_mm())},
                            {"line", use.chip.most_at.line},
                            {"cutting_speed_m_min", rounded(use.chip.speed_m_per_min)},
                            {"rate_max_mm3_s", rounded(use.peak_mm3_per_s)}};
    }
    if (use.loads) add_loads(tool["engagement"], *use.loads);
    out.push_back(std::move(tool));
  }
  return out;
}

Json collisions_json(const Report& report) {
  Json pairs = Json::array();
  for (const CollisionPair& row : report.collisions) {
    Json pair;
    pair["a"] = row.first.empty() ? to_string(row.part) : row.first;
    pair["b"] = row.other.empty() ? kWorkpieceBody : row.other;
    if (row.first.empty()) pair["tool"] = row.tool;
    pair["contacts"] = row.contacts;
    pair["least_clearance_mm"] =
        row.least_clearance_mm ? Json(rounded(*row.least_clearance_mm)) : Json(nullptr);
    if (!row.least_clearance_mm)
      pair["clearance_above_mm"] =
          row.clearance_above_mm ? Json(rounded(*row.clearance_above_mm)) : Json(nullptr);
    pair["line"] = row.source.line;
    pairs.push_back(std::move(pair));
  }
  return {{"pairs", std::move(pairs)}};
}

Json body_json(const PieceBody& body) {
  Json out;
  out["volume_mm3"] = rounded(body.volume_mm3);
  out["box_mm"] = Json::array({vector_json(body.box_mm.min), vector_json(body.box_mm.max)});
  return out;
}

Json pieces_json(const Report& report) {
  Json out = Json::array();
  for (const LoosePiece& piece : report.pieces) {
    Json row = body_json(piece.body);
    row["held"] = piece.held;
    if (!piece.held) {
      const std::vector<std::string>& files = report.program.files;
      row["file"] =
          piece.source.file < files.size() ? Json(files[piece.source.file]) : Json(nullptr);
      row["line"] = piece.source.line;
      row["time_s"] = rounded(piece.time_s);
      row["tool"] = piece.tool;
      row["cut_by_line"] = piece.cut_by ? Json(piece.cut_by->line) : Json(nullptr);
      row["left"] = Json::array();
      for (const PieceBody& body : piece.left) row["left"].push_back(body_json(body));
    }
    out.push_back(std::move(row));
  }
  return out;
}

Json guesses_json(const std::vector<GuessRow>& rows) {
  Json out = Json::array();
  for (const GuessRow& row : rows) {
    Json json;
    json["what"] = row.what;
    json["option"] = row.option.empty() ? Json(nullptr) : Json(row.option);
    json["value"] = row.value;
    json["reason"] = row.reason;
    out.push_back(std::move(json));
  }
  return out;
}

Json findings_json(const Report& report) {
  Json out = Json::array();
  for (const Finding& finding : report.findings.kept()) {
    out.push_back(finding_json(finding, report.program.files));
  }
  return out;
}

Json load_json(const LoadReport& load) {
  Json out;
  out["unit"] = word_of(load.unit);
  out["samples"] = load.samples;
  out["least"] = rounded(load.least);
  out["most"] = rounded(load.most);
  out["idle"] = Json::array();
  for (const LoadReport::Idle& idle : load.idle)
    out["idle"].push_back({{"rpm", rounded(idle.rpm)}, {"load", rounded(idle.load)}});
  out["tools"] = Json::array();
  for (const LoadReport::Tool& tool : load.tools) {
    out["tools"].push_back({{"number", tool.number},
                            {"judged_s", rounded(tool.judged_s)},
                            {"differs_s", rounded(tool.differs_s)},
                            {"measured", rounded(tool.measured)},
                            {"low", rounded(tool.low)},
                            {"high", rounded(tool.high)}});
  }
  out["unjudged"] = Json::array();
  for (const LoadReport::Unjudged& tool : load.unjudged)
    out["unjudged"].push_back({{"number", tool.number}, {"cut_s", rounded(tool.seconds)}});
  return out;
}

Json live_json(const LiveReport& live) {
  const LiveFacts& f = live.facts;
  Json out;
  out["source"] = live.source;
  out["samples"] = f.samples;
  out["incomplete"] = f.incomplete;
  out["wild"] = f.wild;
  out["duration_s"] = rounded(live.duration_s);
  out["rate_hz"] = rounded(live.rate_hz);
  out["errors"] = live.status.errors;
  out["reconnects"] = live.status.reconnects;
  out["lost"] = live.status.lost;
  out["incomplete_cycles"] = live.status.incomplete;
  out["damaged"] = live.status.damaged;
  out["clock_stood"] = live.status.standing;
  out["duplicates"] = live.status.duplicates;
  out["disordered"] = live.status.disordered;
  out["dropped"] = live.dropped;
  out["trouble"] = live.status.trouble;
  out["gaps"] = f.gaps;
  out["jumps"] = f.jumps;
  out["gap_s"] = rounded(f.gap_s);
  out["gap_max_mm"] = rounded(f.gap_max_mm);
  out["path_mm"] = rounded(f.path_mm);
  out["chord_mm"] = rounded(f.chord_mm);
  out["on_path"] = f.on_path;
  out["off_path"] = f.off_path;
  out["off_path_max_mm"] = rounded(f.off_path_max_mm);
  out["following_max_mm"] = rounded(f.following_max_mm);
  out["following_mean_mm"] =
      rounded(f.on_path > 0 ? f.following_sum_mm / static_cast<double>(f.on_path) : 0);
  out["tool_changes"] = f.tool_changes;
  out["age_ms"] = {{"median", rounded(live.age_median_ms)},
                   {"p99", rounded(live.age_p99_ms)},
                   {"max", rounded(live.age_max_ms)}};
  out["clock"] = {{"offset_s", rounded(live.clock_offset_s)},
                  {"jitter_ms", rounded(live.jitter_ms)},
                  {"steps", live.clock_steps}};
  out["warnings_ahead"] = live.warnings_ahead;
  out["load"] = live.load ? load_json(*live.load) : Json(nullptr);
  out["runs"] = Json::array();
  for (const LiveRun& run : live.runs) out["runs"].push_back(run_json(run));
  return out;
}

Json timing_json(const TimingReport& t) {
  Json out;
  out["interpret"] = rounded(t.interpret_s);
  out["cut"] = rounded(t.cut_s);
  out["cut_cpu"] = rounded(t.cut_cpu_s);
  out["mesh"] = rounded(t.mesh_s);
  out["total"] = rounded(t.total_s);
  return out;
}

}  // namespace

std::string json_text(const Report& report) {
  Json out;
  out["schema"] = "kerf-report/1";
  out["version"] = report.version;
  out["partial"] = !report.partial_reason.empty();
  if (!report.partial_reason.empty()) out["partial_reason"] = report.partial_reason;
  out["program"] = program_json(report);
  out["motion"] = motion_json(report);
  out["stock"] = stock_json(report);
  if (report.sheet) out["sheet"] = sheet_json(*report.sheet, report.program.files);
  if (report.turning) out["turning"] = turning_json(*report.turning, report.program.files);
  if (report.material) out["material"] = material_json(*report.material);
  out["tools"] = tools_json(report);
  out["collisions"] = collisions_json(report);
  if (!report.pieces.empty()) out["pieces"] = pieces_json(report);
  if (report.comparison) {
    out["compare"] = compare_json(*report.comparison, report.program.files);
  }
  if (report.rest) out["rest"] = rest_json(*report.rest);
  if (report.entry) out["entry"] = entry_json(*report.entry, report.program.files);
  if (report.engagement)
    out["engagement"] = engagement_json(*report.engagement, report.program.files);
  if (!report.guesses.empty()) out["guessed"] = guesses_json(report.guesses);
  if (report.live) out["live"] = live_json(*report.live);
  out["findings"] = findings_json(report);
  out["findings_total"] = report.findings.total();
  out["timing_s"] = timing_json(report.timing);
  out["peak_rss_mb"] = std::round(report.peak_rss_mb * 10) / 10;
  // Paths and comments may hold bytes that are not UTF-8: they become U+FFFD instead of an
  // exception.
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace kerf
