#include "twin/report/entry_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

namespace kerf {
namespace {

using Value = double ActiveMode::*;

double value(const ActiveModes& modes, ModeGroup group, Value of) {
  return modes[static_cast<std::size_t>(group)].*of;
}

std::string g_word(double code) { return code < 0 ? "" : fmt::format("G{:g}", code / 10); }
std::string m_word(double code) { return code < 0 ? "" : fmt::format("M{:g}", code); }

/// Of exact stop no tolerance counts.
std::string path_words(const ActiveModes& modes, Value of) {
  std::string words = g_word(value(modes, ModeGroup::kPath, of));
  if (words != "G64") return words;
  const double tolerance = value(modes, ModeGroup::kPathTolerance, of);
  const double merging = value(modes, ModeGroup::kMergeTolerance, of);
  if (tolerance > 0) words += fmt::format(" P{:g}", tolerance);
  if (merging > 0 && merging != tolerance) words += fmt::format(" Q{:g}", merging);
  return words;
}

std::string length_words(const ActiveModes& modes, Value of) {
  std::string words = g_word(value(modes, ModeGroup::kLengthOffset, of));
  const double tool = value(modes, ModeGroup::kLengthTool, of);
  if (words == "G43" && tool > 0) words += fmt::format(" H{:g}", tool);
  return words;
}

std::string spindle_words(const ActiveModes& modes, Value of) {
  const std::string word = m_word(value(modes, ModeGroup::kSpindle, of));
  const double speed = value(modes, ModeGroup::kSpeed, of);
  return word.empty() || word == "M5" ? word : fmt::format("{} S{:g}", word, speed);
}

std::string tool_words(const ActiveModes& modes, Value of) {
  const double tool = value(modes, ModeGroup::kTool, of);
  return tool > 0 ? fmt::format("T{:g} M6", tool) : "";
}

std::string feed_words(const ActiveModes& modes, Value of) {
  const double feed = value(modes, ModeGroup::kFeed, of);
  return feed > 0 ? fmt::format("F{:g}", feed) : "";
}

std::string speed_words(const ActiveModes& modes, Value of) {
  const double speed = value(modes, ModeGroup::kSpeed, of);
  return speed > 0 ? fmt::format("S{:g}", speed) : "";
}

std::string rotation_words(const ActiveModes& modes, Value of) {
  const double turned = value(modes, ModeGroup::kRotation, of);
  return turned == 0 ? "" : fmt::format("G10 L2 R{:g}", turned);
}

std::string coolant_word(const ActiveModes& modes, ModeGroup group, Value of) {
  // M9 is in neither list, and in both where there is none.
  const std::string word = m_word(value(modes, group, of));
  return word == "M9" ? "" : word;
}

std::string override_word(const ActiveModes& modes, ModeGroup group, Value of) {
  const std::string word = m_word(value(modes, group, of));
  if (group == ModeGroup::kAdaptiveFeed) return word.empty() ? "M52 P0" : "M52 P1";
  return word == "M50" || word == "M51" ? word + " P0" : word;
}

std::uint32_t latest(const ActiveModes& modes, std::initializer_list<ModeGroup> groups) {
  std::uint32_t line = 0;
  for (const ModeGroup group : groups) {
    line = std::max(line, modes[static_cast<std::size_t>(group)].line);
  }
  return line;
}

class Rows {
 public:
  explicit Rows(const ActiveModes& modes) : modes_(modes) {}

  using Words = std::function<std::string(const ActiveModes&, Value)>;
  EntryMode& add(const char* name, const Words& words, std::initializer_list<ModeGroup> groups,
                 bool is_kept = true) {
    rows_.push_back({name, words(modes_, &ActiveMode::now), words(modes_, &ActiveMode::begun),
                     latest(modes_, groups), is_kept});
    return rows_.back();
  }
  void add_code(const char* name, ModeGroup group) {
    add(name,
        [group](const ActiveModes& modes, Value of) { return g_word(value(modes, group, of)); },
        {group});
  }
  std::vector<EntryMode> take() { return std::move(rows_); }

 private:
  const ActiveModes& modes_;
  std::vector<EntryMode> rows_;
};

bool turns_as(const ActiveModes& modes, const Motion& first) {
  const double word = value(modes, ModeGroup::kSpindle, &ActiveMode::now);
  return first.spindle == SpindleState::kClockwise          ? word == 3
         : first.spindle == SpindleState::kCounterclockwise ? word == 4
                                                            : word != 3 && word != 4;
}

/// What motion, tool changer, spindle and coolant would have been told.
void add_deeds(const ActiveModes& modes, const Motion& first, Rows& rows) {
  using G = ModeGroup;
  rows.add("tool", tool_words, {G::kTool},
           value(modes, G::kTool, &ActiveMode::now) != static_cast<double>(first.tool));
  rows.add("spindle", spindle_words, {G::kSpindle, G::kSpeed}, !turns_as(modes, first));
  const auto coolant = [](G group) {
    return [group](const ActiveModes& all, Value of) { return coolant_word(all, group, of); };
  };
  rows.add("mist", coolant(G::kMist), {G::kMist}, !first.mist);
  rows.add("flood", coolant(G::kFlood), {G::kFlood}, !first.flood);
  const auto word = [](G group) {
    return [group](const ActiveModes& all, Value of) { return override_word(all, group, of); };
  };
  rows.add("overrides", word(G::kOverrides), {G::kOverrides}, false);
  rows.add("adaptive_feed", word(G::kAdaptiveFeed), {G::kAdaptiveFeed}, false);
  rows.add("feed_hold", word(G::kFeedHold), {G::kFeedHold}, false);
}

}  // namespace

std::vector<EntryMode> entry_modes(const ActiveModes& modes, const Motion& first) {
  if (modes.size() < kModeGroups) return {};
  using G = ModeGroup;
  Rows rows(modes);
  rows.add_code("plane", G::kPlane);
  rows.add_code("units", G::kUnits);
  rows.add_code("distance", G::kDistance);
  rows.add_code("arc_distance", G::kArcDistance);
  rows.add_code("diameter", G::kDiameter);
  rows.add_code("feed_mode", G::kFeedMode);
  // Feed by the turn goes to motion with its F, which it then does not hear.
  const bool by_turn = value(modes, G::kFeedMode, &ActiveMode::now) == 950 && first.feed_per_rev;
  rows.add("feed", feed_words, {G::kFeed}, !by_turn);
  rows.add("path", path_words, {G::kPath, G::kPathTolerance, G::kMergeTolerance}, false);
  rows.add_code("compensation", G::kCompensation);
  rows.add_code("return", G::kReturn);
  rows.add_code("work_offset", G::kWorkOffset);
  rows.add_code("shift", G::kShift);
  rows.add("rotation", rotation_words, {G::kRotation});
  rows.add("length", length_words, {G::kLengthOffset, G::kLengthTool});
  rows.add_code("spindle_mode", G::kSpindleMode);
  rows.add("speed", speed_words, {G::kSpeed});
  add_deeds(modes, first, rows);
  return rows.take();
}

}  // namespace kerf
