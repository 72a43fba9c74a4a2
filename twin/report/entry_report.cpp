#include "twin/report/entry_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "base/translate.h"
#include "twin/findings/finding_json.h"
#include "twin/report/report_words.h"

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kEarlierShown = 3;

std::string place_words(const Vec3& p) {
  return fmt::format("X{:.2f} Y{:.2f} Z{:.2f} mm", p.x, p.y, p.z);
}

std::string said_in(std::uint32_t line) { return line > 0 ? trf(" (line {})", line) : ""; }
std::string said_before(std::uint32_t line) {
  return line > 0 ? trf(" (before line {})", line) : "";
}

/// What a start at the line does not do, though lines before it say so: as words of a program.
std::string missed_words(const EntryReport& entry) {
  const Motion& m = entry.first;
  std::vector<std::string> words;
  if (m.tool > 0) words.push_back(fmt::format("T{} M6{}", m.tool, said_in(entry.tool_line)));
  if (m.spindle != SpindleState::kStopped) {
    words.push_back(fmt::format("{} S{:.0f}{}", m.spindle == SpindleState::kClockwise ? "M3" : "M4",
                                m.spindle_rpm, said_before(entry.spindle_line)));
  }
  if (m.mist) words.push_back("M7" + said_before(entry.coolant_line));
  if (m.flood) words.push_back("M8" + said_before(entry.coolant_line));
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string way_words(const EntryWay& way) {
  if (way.clear()) return tr("clear");
  const Finding& worst = way.findings.front();
  return trf("NOT clear: {}", message_of(worst));
}

std::string steps_words(const EntryWay& way) {
  std::vector<std::string> steps;
  for (std::size_t i = 1; i < way.points_mm.size(); ++i) {
    const Vec3& from = way.points_mm[i - 1];
    const Vec3& to = way.points_mm[i];
    if (from.x == to.x && from.y == to.y) {
      steps.push_back(fmt::format("Z{:.2f} mm", to.z));
    } else {
      steps.push_back(fmt::format("X{:.2f} Y{:.2f} mm", to.x, to.y));
    }
  }
  return fmt::format("{}", fmt::join(steps, ", "));
}

Json way_json(const EntryWay& way, const std::vector<std::string>& files) {
  Json points = Json::array();
  for (const Vec3& point : way.points_mm) points.push_back(vector_json(point));
  Json found = Json::array();
  for (const Finding& finding : way.findings) found.push_back(finding_json(finding, files));
  return Json{
      {"clear", way.clear()}, {"points_mm", std::move(points)}, {"findings", std::move(found)}};
}

}  // namespace

std::string entry_text(const EntryReport& entry) {
  std::string out =
      trf("start     at line {}, {} into the program; the tool is then at {}\n", entry.line,
          duration_text(entry.before_s), place_words(entry.first.from_mm));
  if (const std::string missed = missed_words(entry); !missed.empty()) {
    out += trf("          not done by a start there, so by hand before: {}\n", missed);
  }
  if (entry.first.compensated) {
    out +=
        tr("          G41 or G42 is in force there: LinuxCNC cannot begin in the middle of it\n");
  }
  if (entry.drive) {
    out += trf("          as LinuxCNC goes, straight from {} to {}: {}\n",
               place_words(entry.drive->points_mm.front()),
               place_words(entry.drive->points_mm.back()), way_words(*entry.drive));
  } else if (entry.at_mm) {
    out += tr("          the machine stands where the program has it\n");
  }
  if (entry.safe.points_mm.size() > 1) {
    out += trf("          by hand before it, G0 {}: {}\n", steps_words(entry.safe),
               way_words(entry.safe));
  }
  for (std::size_t i = 0; i < std::min(entry.earlier.size(), kEarlierShown); ++i) {
    const EarlierStart& start = entry.earlier[i];
    out += start.changes_tool ? trf("          or at line {}, the tool change: {} more\n",
                                    start.line, duration_text(start.costs_s))
                              : trf("          or at line {}, above the workpiece: {} more\n",
                                    start.line, duration_text(start.costs_s));
  }
  return out;
}

Json entry_json(const EntryReport& entry, const std::vector<std::string>& files) {
  const Motion& m = entry.first;
  Json out{{"line", entry.line},
           {"before_s", rounded(entry.before_s)},
           {"place_mm", vector_json(m.from_mm)},
           {"tool", m.tool},
           {"tool_line", entry.tool_line},
           {"spindle", m.spindle == SpindleState::kStopped     ? "stopped"
                       : m.spindle == SpindleState::kClockwise ? "clockwise"
                                                               : "counterclockwise"},
           {"spindle_rpm", rounded(m.spindle_rpm)},
           {"spindle_line", entry.spindle_line},
           {"flood", m.flood},
           {"mist", m.mist},
           {"coolant_line", entry.coolant_line},
           {"feed_mm_per_min", rounded(m.feed_mm_per_min)},
           {"compensated", m.compensated}};
  if (entry.at_mm) out["at_mm"] = vector_json(*entry.at_mm);
  if (entry.drive) {
    out["drive"] = way_json(*entry.drive, files);
    out["drive"]["feed"] = entry.drive_is_feed;
  }
  out["safe"] = way_json(entry.safe, files);
  Json earlier = Json::array();
  for (const EarlierStart& start : entry.earlier) {
    earlier.push_back(Json{{"line", start.line},
                           {"costs_s", rounded(start.costs_s)},
                           {"changes_tool", start.changes_tool}});
  }
  out["earlier"] = std::move(earlier);
  return out;
}

}  // namespace kerf
