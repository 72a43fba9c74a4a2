#include "twin/diff/diff_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "base/translate.h"
#include "twin/findings/finding_json.h"
#include "twin/machine/motion_json.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

std::string file_of(const DiffSide& side, const SourceRef& source) {
  return source.file < side.files.size() ? side.files[source.file] : side.path;
}

/// The lines of steps [begin, end); of none where they would stand.
struct LineSpan {
  std::string file;
  std::uint32_t first = 0, last = 0;
  bool empty = false;
};
LineSpan span_of(const DiffSide& side, std::size_t begin, std::size_t end) {
  LineSpan span;
  span.empty = begin == end;
  if (side.steps.empty()) return span;
  if (span.empty) {
    const SourceRef before = begin > 0 ? side.steps[begin - 1].source : SourceRef{};
    span.file = file_of(side, before);
    span.first = span.last = before.line;
    return span;
  }
  const SourceRef first = side.steps[begin].source;
  span.file = file_of(side, first);
  span.first = span.last = first.line;
  for (std::size_t i = begin; i < end; ++i) {
    const SourceRef& source = side.steps[i].source;
    if (source.file != first.file || source.line == 0) continue;
    span.first = std::min(span.first, source.line);
    span.last = std::max(span.last, source.line);
  }
  return span;
}

std::string words_of(const LineSpan& span) {
  if (span.empty && span.first == 0) return trf("{}: before its first motion", span.file);
  if (span.empty) return trf("{}: behind line {}", span.file, span.first);
  if (span.first == span.last) return fmt::format("{}:{}", span.file, span.first);
  return trf("{}:{} to {}", span.file, span.first, span.last);
}

std::string place_words(const Vec3& p) {
  const auto number = [](double value) {
    const double r = std::round(value * 1000) / 1000;
    return fmt::format("{:.3f}", r == 0 ? 0.0 : r);
  };
  return trf("at X{} Y{} Z{}", number(p.x), number(p.y), number(p.z));
}

const char* words_of(SpindleState state) {
  if (state == SpindleState::kStopped) return tr("off");
  return state == SpindleState::kClockwise ? "M3" : "M4";
}

std::string feed_words(const DiffStep& s) {
  return s.feed_per_rev ? trf("{:g} mm per turn", s.feed) : trf("{:g} mm/min", s.feed);
}

std::string spindle_words(const DiffStep& s) {
  if (s.spindle == SpindleState::kStopped) return words_of(s.spindle);
  if (s.surface_mm_per_min > 0) {
    return trf("{} at {:g} m/min", words_of(s.spindle), s.surface_mm_per_min / 1000);
  }
  return trf("{} at {:g} rpm", words_of(s.spindle), s.rpm);
}

std::string coolant_words(const DiffStep& s) {
  if (!s.flood && !s.mist) return tr("off");
  return s.flood && s.mist ? "M7 M8" : s.flood ? "M8" : "M7";
}

constexpr std::size_t kMostEvents = 8;

double way_mm(std::span<const DiffStep> steps) {
  double sum_mm = 0;
  for (const DiffStep& step : steps) {
    if (has_way(step)) sum_mm += path_length_mm(motion_of(step));
  }
  return sum_mm;
}

/// What there is in one alone: how much of a way, or which events.
std::string alone_words(std::span<const DiffStep> steps) {
  if (std::none_of(steps.begin(), steps.end(), has_way)) {
    std::string kinds;
    for (const DiffStep& step : steps.first(std::min(steps.size(), kMostEvents))) {
      kinds += (kinds.empty() ? "" : ", ") + std::string(to_string(step.kind));
    }
    return kinds + (steps.size() > kMostEvents ? ", .." : "");
  }
  return trf("{} motions, {:.3f} mm of way", steps.size(), way_mm(steps));
}

std::string hunk_text(const DiffReport& report, const MotionHunk& hunk) {
  const auto steps_a = std::span(report.a.steps).subspan(hunk.a_begin, hunk.a_end - hunk.a_begin);
  const auto steps_b = std::span(report.b.steps).subspan(hunk.b_begin, hunk.b_end - hunk.b_begin);
  std::string out =
      fmt::format("  {} | {}\n", words_of(span_of(report.a, hunk.a_begin, hunk.a_end)),
                  words_of(span_of(report.b, hunk.b_begin, hunk.b_end)));
  const auto line = [&out](const std::string& text) { out += "      " + text + "\n"; };
  if (steps_b.empty()) {
    line(trf("only in A: {}", alone_words(steps_a)));
    return out;
  }
  if (steps_a.empty()) {
    line(trf("only in B: {}", alone_words(steps_b)));
    return out;
  }
  const DiffStep& a = steps_a.front();
  const DiffStep& b = steps_b.front();
  if ((hunk.kinds & kDiffPath) != 0 && hunk.apart_mm) {
    line(trf("path: {:.4f} mm apart {}, line {} | {}", *hunk.apart_mm, place_words(hunk.at_mm),
             hunk.a_at.line, hunk.b_at.line));
  } else if ((hunk.kinds & kDiffPath) != 0) {
    line(trf("path: {} | {}", alone_words(steps_a), alone_words(steps_b)));
  }
  if ((hunk.kinds & kDiffRapid) != 0) line(tr("a rapid in one is none in the other"));
  if ((hunk.kinds & kDiffEvents) != 0) line(tr("tool changes, dwells or stops differ"));
  if ((hunk.kinds & kDiffFeed) != 0) {
    line(trf("feed: {} | {}", feed_words(a), feed_words(b)));
  }
  if ((hunk.kinds & kDiffTool) != 0) line(trf("tool: {} | {}", a.tool, b.tool));
  if ((hunk.kinds & kDiffSpindle) != 0) {
    line(trf("spindle: {} | {}", spindle_words(a), spindle_words(b)));
  }
  if ((hunk.kinds & kDiffCoolant) != 0) {
    line(trf("coolant: {} | {}", coolant_words(a), coolant_words(b)));
  }
  if ((hunk.kinds & kDiffOutputs) != 0) line(tr("outputs (M62 to M68) or material differ"));
  return out;
}

std::string motion_text(const DiffReport& report, std::size_t most_hunks) {
  const MotionDiff& motion = *report.motion;
  if (motion.is_same()) {
    return trf("motion    the same: {} motions, {:.4f} mm apart at most\n", motion.a_steps,
               motion.apart_mm);
  }
  std::string out =
      motion.hunk_count == 1
          ? trf("motion    differs in one place, {:.4f} mm apart at most\n", motion.apart_mm)
          : trf("motion    differs in {} places, {:.4f} mm apart at most\n", motion.hunk_count,
                motion.apart_mm);
  std::size_t shown = 0;
  for (const MotionHunk& hunk : motion.hunks) {
    if (shown == most_hunks) break;
    out += hunk_text(report, hunk);
    ++shown;
  }
  if (shown < motion.hunk_count) {
    out += trf("  and {} more; --json FILE lists the first {}\n", motion.hunk_count - shown,
               MotionDiff::kMostHunks);
  }
  return out;
}

std::string cut_words(const DiffSide& side, const std::optional<CutLabel>& cut) {
  if (!cut || cut->source.line == 0) return tr("nothing that is known");
  return trf("{}:{} (tool {})", file_of(side, cut->source), cut->source.line, cut->tool);
}

std::string part_text(const DiffReport& report) {
  const PartDiff& part = *report.part;
  if (part.equal_bits) return tr("part      the same, bit for bit\n");
  if (!part.not_compared.empty()) return trf("part      differs: {}\n", part.not_compared);
  std::string out;
  if (part.same) {
    out = trf("part      the same: {:.4f} mm apart at most\n", part.most_mm);
  } else if (part.by_heights && part.most_mm <= report.tolerance_mm) {
    out = trf("part      differs: {} cells of {:g} mm at walls that have moved by less than that\n",
              part.wall_cells, part.cell_mm);
  } else if (part.by_heights) {
    out = trf("part      differs: heights up to {:.4f} mm apart {}\n", part.most_mm,
              place_words(part.at_mm));
  } else {
    out = trf("part      differs: surfaces up to {:.4f} mm apart {}\n", part.most_mm,
              place_words(part.at_mm));
  }
  if (part.same) return out;
  if (part.a_cut || part.b_cut) {
    out += trf("      cut by {} | {}\n", cut_words(report.a, part.a_cut),
               cut_words(report.b, part.b_cut));
  }
  if (part.by_heights) {
    out += trf("      over {:.2f} mm2; A has {:.3f} mm3 more, B {:.3f} mm3\n", part.area_mm2,
               part.a_more_mm3, part.b_more_mm3);
  }
  out += trf("      left of A {:.3f} mm3, of B {:.3f} mm3\n", part.a_mm3, part.b_mm3);
  return out;
}

/// Number, shape in A, shape in B.
std::map<int, std::pair<std::string, std::string>> tools_apart(const DiffReport& report) {
  std::map<int, std::pair<std::string, std::string>> all;
  for (const auto& [number, shape] : report.a.tools) all[number].first = shape;
  for (const auto& [number, shape] : report.b.tools) all[number].second = shape;
  std::erase_if(all, [](const auto& row) { return row.second.first == row.second.second; });
  return all;
}

std::string tools_text(const DiffReport& report) {
  std::string out;
  for (const auto& [number, shapes] : tools_apart(report)) {
    const auto& [a, b] = shapes;
    out += trf("tool {}    differs: {} | {}\n", number, a.empty() ? tr("not used") : a.c_str(),
               b.empty() ? tr("not used") : b.c_str());
  }
  return out;
}

Json side_json(const DiffSide& side, std::size_t begin, std::size_t end) {
  const LineSpan span = span_of(side, begin, end);
  return {{"file", span.file},
          {"first_line", span.first},
          {"last_line", span.last},
          {"motions", end - begin}};
}

Json hunk_json(const DiffReport& report, const MotionHunk& hunk) {
  Json out;
  out["kinds"] = Json::array();
  for (const DiffKind kind : kDiffKinds) {
    if ((hunk.kinds & kind) != 0) out["kinds"].push_back(name_of(kind));
  }
  out["a"] = side_json(report.a, hunk.a_begin, hunk.a_end);
  out["b"] = side_json(report.b, hunk.b_begin, hunk.b_end);
  out["apart_mm"] = hunk.apart_mm ? Json(rounded(*hunk.apart_mm)) : Json(nullptr);
  out["at_mm"] = hunk.apart_mm ? vector_json(hunk.at_mm) : Json(nullptr);
  out["a_line"] = hunk.a_at.line;
  out["b_line"] = hunk.b_at.line;
  if (hunk.a_begin == hunk.a_end || hunk.b_begin == hunk.b_end) return out;
  const DiffStep& a = report.a.steps[hunk.a_begin];
  const DiffStep& b = report.b.steps[hunk.b_begin];
  out["feed"] = {rounded(a.feed), rounded(b.feed)};
  out["tool"] = {a.tool, b.tool};
  out["rpm"] = {rounded(a.rpm), rounded(b.rpm)};
  return out;
}

Json motion_json(const DiffReport& report) {
  if (!report.motion) return nullptr;
  const MotionDiff& motion = *report.motion;
  Json out;
  out["same"] = motion.is_same();
  out["a_motions"] = motion.a_steps;
  out["b_motions"] = motion.b_steps;
  out["apart_mm"] = rounded(motion.apart_mm);
  out["places"] = motion.hunk_count;
  out["hunks"] = Json::array();
  for (const MotionHunk& hunk : motion.hunks) out["hunks"].push_back(hunk_json(report, hunk));
  return out;
}

Json cut_json(const DiffSide& side, const std::optional<CutLabel>& cut) {
  if (!cut) return nullptr;
  return {{"file", file_of(side, cut->source)}, {"line", cut->source.line}, {"tool", cut->tool}};
}

Json part_json(const DiffReport& report) {
  if (!report.part) return nullptr;
  const PartDiff& part = *report.part;
  Json out;
  out["same"] = part.same;
  out["equal_bits"] = part.equal_bits;
  out["a_mm3"] = rounded(part.a_mm3);
  out["b_mm3"] = rounded(part.b_mm3);
  if (part.equal_bits || !part.not_compared.empty()) return out;
  out["measured"] = part.by_heights ? "heights" : "surfaces";
  out["most_mm"] = rounded(part.most_mm);
  out["at_mm"] = vector_json(part.at_mm);
  out["a_cut"] = cut_json(report.a, part.a_cut);
  out["b_cut"] = cut_json(report.b, part.b_cut);
  if (part.by_heights) {
    out["area_mm2"] = rounded(part.area_mm2);
    out["a_more_mm3"] = rounded(part.a_more_mm3);
    out["b_more_mm3"] = rounded(part.b_more_mm3);
    out["wall_cells"] = part.wall_cells;
  }
  out["cell_mm"] = rounded(part.cell_mm);
  return out;
}

}  // namespace

std::string diff_text(const DiffReport& report, std::size_t most_hunks) {
  std::string out = fmt::format("A         {}\nB         {}\n", report.a.path, report.b.path);
  if (report.motion) out += motion_text(report, most_hunks);
  if (report.part) out += part_text(report);
  if (report.motion) out += tools_text(report);
  return out;
}

std::string diff_json(const DiffReport& report, const std::string& version) {
  Json out;
  out["schema"] = "kerf-diff/1";
  out["version"] = version;
  out["a"] = report.a.path;
  out["b"] = report.b.path;
  out["tolerance_mm"] = rounded(report.tolerance_mm);
  out["same"] = report.is_same();
  out["motion"] = motion_json(report);
  out["part"] = part_json(report);
  out["tools"] = Json::array();
  if (report.motion) {
    for (const auto& [number, shapes] : tools_apart(report)) {
      out["tools"].push_back({{"number", number}, {"a", shapes.first}, {"b", shapes.second}});
    }
  }
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace kerf
