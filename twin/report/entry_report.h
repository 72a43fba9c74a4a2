// twin/report/entry_report.h - what an operator asks before a program is begun in its middle.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "interp_bridge/motion.h"
#include "twin/findings/finding.h"
#include "twin/report/entry_modes.h"

namespace kerf {

/// A way of the tool, judged as if it were rapid: it must not touch anything.
struct EntryWay {
  std::vector<Vec3> points_mm;    ///< of the tip, workpiece frame; the first is where it begins
  std::vector<Finding> findings;  ///< errors and warnings; none: it is clear
  bool clear() const { return findings.empty(); }
};

/// A line before, at which the program may be begun instead.
struct EarlierStart {
  std::uint32_t line = 0;
  double costs_s = 0;         ///< how much of the program is run a second time
  bool changes_tool = false;  ///< M6 and what follows it is done there; else the tool is above all
};

/// Where the machine itself says that it stands.
struct EntryLive {
  std::string source;
  Vec3 at_mm{0};  ///< of the program's tool, workpiece frame
  double age_s = 0;
  int tool = -1;  ///< in the spindle; -1: it does not say
};

struct EntryReport {
  std::uint32_t line = 0;
  Motion first;                   ///< the program's own first motion from that line on
  double before_s = 0;            ///< so much of the program comes before it
  std::vector<EntryMode> modes;   ///< what is in force when it begins
  std::optional<Vec3> at_mm;      ///< --at: where the machine stands
  std::optional<EntryLive> live;  ///< who says so
  std::optional<EntryWay>
      drive;                   ///< as LinuxCNC goes from there; nothing: it stands where it should
  bool drive_is_feed = false;  ///< and cuts what is in the way
  EntryWay safe;               ///< up, over and down to where the program has the tool
  std::vector<EarlierStart> earlier;  ///< the nearest first
};

/// For `kerf run`'s page of text; each line ends with a newline.
std::string entry_text(const EntryReport& entry);
nlohmann::ordered_json entry_json(const EntryReport& entry, const std::vector<std::string>& files);

}  // namespace kerf
