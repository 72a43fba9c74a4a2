#include "twin/report/entry_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/translate.h"
#include "twin/findings/finding_json.h"
#include "twin/report/report_words.h"

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kEarlierShown = 3;
/// Labels of the summary, in any language.
constexpr std::size_t kLabelColumns = 10;

std::string place_words(const Vec3& p) {
  return fmt::format("X{:.2f} Y{:.2f} Z{:.2f} mm", p.x, p.y, p.z);
}

std::string said_in(std::uint32_t line) { return line > 0 ? trf(" (line {})", line) : ""; }

const EntryMode* mode_of(const EntryReport& entry, std::string_view name) {
  const auto found = std::find_if(entry.modes.begin(), entry.modes.end(),
                                  [&](const EntryMode& mode) { return mode.name == name; });
  return found == entry.modes.end() ? nullptr : &*found;
}

std::uint32_t line_of(const EntryReport& entry, std::string_view name) {
  const EntryMode* const mode = mode_of(entry, name);
  return mode == nullptr ? 0 : mode->line;
}

/// What a start at the line does not do, though lines before it say so: as words of a program.
std::string missed_words(const EntryReport& entry) {
  std::vector<std::string> words;
  for (const EntryMode& mode : entry.modes) {
    if (!mode.is_missed()) continue;
    const bool by_turn = std::string_view(mode.name) == "feed";
    words.push_back((by_turn ? "G95 " : "") + mode.now + said_in(mode.line));
  }
  // Deeds first, in the order in which they are entered.
  const auto is_deed = [](const std::string& word) { return word[0] == 'T' || word[0] == 'M'; };
  std::stable_partition(words.begin(), words.end(), is_deed);
  return fmt::format("{}", fmt::join(words, ", "));
}

bool is_compensated(const EntryReport& entry) {
  const EntryMode* const mode = mode_of(entry, "compensation");
  return entry.first.compensated || (mode != nullptr && mode->now != "G40");
}

/// S is told with M3 and M4; that nothing is done about overrides and the like, not at all.
bool is_shown(const EntryReport& entry, const EntryMode& mode) {
  const std::string_view name = mode.name;
  if (name == "speed") {
    const EntryMode* const spindle = mode_of(entry, "spindle");
    return spindle == nullptr || spindle->now == "M5" || !spindle->differs();
  }
  const bool only_if_other = name == "overrides" || name == "adaptive_feed" ||
                             name == "feed_hold" || name == "shift" || name == "diameter" ||
                             name == "spindle" || name == "spindle_mode";
  return !mode.now.empty() && (!only_if_other || mode.differs());
}

/// "G17 G21 G91 ..": all that is in force and told in one word or two.
std::string modes_words(const EntryReport& entry) {
  std::vector<std::string> words;
  for (const EntryMode& mode : entry.modes) {
    if (is_shown(entry, mode)) words.push_back(mode.now);
  }
  return fmt::format("{}", fmt::join(words, " "));
}

/// What the program says anew before it moves: no mode of its own.
bool is_of_tool(const EntryMode& mode) {
  const std::string_view name = mode.name;
  return name == "tool" || name == "spindle" || name == "mist" || name == "flood";
}

/// Modes of which LinuxCNC begins with another. Run from here has them; nobody else does.
std::string other_words(const EntryReport& entry) {
  std::vector<std::string> words;
  for (const EntryMode& mode : entry.modes) {
    if (!mode.is_kept || !mode.differs() || is_of_tool(mode)) continue;
    if (!mode.now.empty() && !is_shown(entry, mode)) continue;
    const std::string begins = mode.begins.empty() ? "" : trf(" instead of {}", mode.begins);
    words.push_back((mode.now.empty() ? trf("no {}", mode.begins) : mode.now + begins) +
                    said_in(mode.line));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string modes_text(const EntryReport& entry) {
  if (entry.modes.empty()) return {};
  std::string out;
  const std::string missed = missed_words(entry);
  out += missed.empty()
             ? tr("          a start there misses nothing\n")
             : trf("          not done by a start there, so by hand before: {}\n", missed);
  out += trf("          in force there: {}\n", modes_words(entry));
  const std::string other = other_words(entry);
  out += other.empty() ? tr("          LinuxCNC begins in these modes, too\n")
                       : trf("          LinuxCNC begins in others, and reads these first, which a "
                             "program cut off there does not: {}\n",
                             other);
  return out;
}

Json modes_json(const EntryReport& entry) {
  Json modes = Json::array();
  for (const EntryMode& mode : entry.modes) {
    modes.push_back(Json{{"name", mode.name},
                         {"now", mode.now},
                         {"begins", mode.begins},
                         {"line", mode.line},
                         {"differs", mode.differs()},
                         {"missed", mode.is_missed()}});
  }
  return modes;
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

std::string before_starts(const EntryReport& entry) {
  std::string out =
      trf("start     at line {}, {} into the program; the tool is then at {}\n", entry.line,
          duration_text(entry.before_s), place_words(entry.first.from_mm));
  if (const SourceRef at = entry.first.source; at.file == 0 && at.line < entry.line) {
    out += trf("          LinuxCNC begins at line {} then: a loop leads back there\n", at.line);
  }
  if (entry.live) {
    out += trf("          the machine stands at {}, by {}, {:.1f} s ago{}\n",
               place_words(entry.live->at_mm), entry.live->source, entry.live->age_s,
               entry.live->tool >= 0 ? trf(", with tool {}", entry.live->tool) : "");
  }
  out += modes_text(entry);
  if (is_compensated(entry)) {
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
  return out;
}

}  // namespace

std::string entry_text(const EntryReport& entry) {
  std::string out = before_starts(entry);
  for (std::size_t i = 0; i < std::min(entry.earlier.size(), kEarlierShown); ++i) {
    const EarlierStart& start = entry.earlier[i];
    out += start.changes_tool ? trf("          or at line {}, the tool change: {} more\n",
                                    start.line, duration_text(start.costs_s))
                              : trf("          or at line {}, above the workpiece: {} more\n",
                                    start.line, duration_text(start.costs_s));
  }
  return out;
}

namespace {

/// As in the page of text, but for the column of labels, and for where to begin instead.
Json text_lines(const EntryReport& entry) {
  Json lines = Json::array();
  const std::string text = before_starts(entry);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::size_t begin = at + kLabelColumns;
    lines.push_back(begin < end ? text.substr(begin, end - begin) : text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

}  // namespace

Json entry_json(const EntryReport& entry, const std::vector<std::string>& files) {
  const Motion& m = entry.first;
  Json out{{"line", entry.line},
           {"before_s", rounded(entry.before_s)},
           {"place_mm", vector_json(m.from_mm)},
           {"tool", m.tool},
           {"tool_line", line_of(entry, "tool")},
           {"spindle", m.spindle == SpindleState::kStopped     ? "stopped"
                       : m.spindle == SpindleState::kClockwise ? "clockwise"
                                                               : "counterclockwise"},
           {"spindle_rpm", rounded(m.spindle_rpm)},
           {"spindle_line", line_of(entry, "spindle")},
           {"flood", m.flood},
           {"mist", m.mist},
           {"coolant_line", std::max(line_of(entry, "flood"), line_of(entry, "mist"))},
           {"feed_mm_per_min", rounded(m.feed_mm_per_min)},
           {"compensated", is_compensated(entry)},
           {"modes", modes_json(entry)}};
  out["first_line"] = m.source.line;
  if (entry.at_mm) out["at_mm"] = vector_json(*entry.at_mm);
  if (entry.live) {
    out["live"] = Json{{"source", entry.live->source}, {"age_s", rounded(entry.live->age_s)}};
    if (entry.live->tool >= 0) out["live"]["tool"] = entry.live->tool;
  }
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
  out["text"] = text_lines(entry);
  return out;
}

}  // namespace kerf
