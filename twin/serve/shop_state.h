// twin/serve/shop_state.h - what of a watch the page for the shop shows, as members of a JSON
// object. Texts are in the language of the process.
#pragma once

#include <string>
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

/// state (to_string(LiveState)), state_text, age_s, told_ms (when that was: since 1970, UTC), rows
/// (pairs of texts), notice and is_alarm, line, code (pairs of number and text), tip_mm or null,
/// axis.
std::string state_members(const LiveStatus& status, const std::string& tool_name,
                          const std::vector<ShownLine>& code, LengthUnit unit);
/// The same of nothing but a notice, while there is no session.
std::string waiting_members(const std::string& notice);

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
