// twin/serve/shop_state.h - what of a watch the page for the shop shows, as members of a JSON
// object. Texts are in the language of the process.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/geometry.h"
#include "base/length_unit.h"
#include "twin/findings/finding.h"
#include "twin/live/live_session.h"
#include "viewer/scene.h"

namespace kerf {

/// A line of the program, with its number.
struct ShownLine {
  int number = 0;
  std::string text;
};

/// What a page shows beside the part, at one time.
struct ShopMoment {
  std::string state = "waiting";  ///< how the page colours its text: to_string(LiveState)
  std::string state_text;
  std::optional<double> age_s;                            ///< of what is shown; none: it has no age
  std::vector<std::pair<std::string, std::string>> rows;  ///< as they are shown
  std::string notice;
  bool is_alarm = false;
  std::string file;            ///< of the program's line
  int line = 0;                ///< 0: none is known
  std::optional<Vec3> tip_mm;  ///< none: no tool is drawn
  Vec3 axis{0, 0, 1};
};

/// Of a machine that is watched.
ShopMoment moment_of(const LiveStatus& status, const std::string& tool_name, LengthUnit unit);
/// Nothing but a notice, while there is nothing to be shown.
ShopMoment waiting_moment(const std::string& notice);

/// state, state_text, age_s or null, told_ms (when that was: since 1970, UTC), rows (pairs of
/// texts), notice and is_alarm, line, code (pairs of number and text), tip_mm or null, axis.
std::string state_members(const ShopMoment& moment, const std::vector<ShownLine>& code = {});

/// For rows: "X1.000 Y2.000 Z3.000", with as many digits whatever the place.
std::string place_text(const Vec3& mm, LengthUnit unit);
/// For the row of the program: "part.ngc:12".
std::string line_text(const std::string& file, int line);

/// What stays: title, source, box, turns, tool_shape (outlines, radius and height, from below to
/// above; plates).
struct ShopSetup {
  std::string title, source;
  Box blank_mm;
  bool turns = false;
  const ToolShape* tool = nullptr;
};
std::string setup_members(const ShopSetup& setup);

/// severity, text, file, line. `is_ahead`: it has not happened yet.
std::string finding_object(const Finding& finding, const std::vector<std::string>& files,
                           bool is_ahead, LengthUnit unit);

}  // namespace kerf
