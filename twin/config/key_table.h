// twin/config/key_table.h - the keys of configurations: the part of the setting table that has
// some, and what their places may be called.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "twin/config/setting_table.h"

namespace kerf {

/// The axes in the order of positions.
inline constexpr std::string_view kAllAxes = "XYZABCUVW";

/// The rows of the setting table that have a key, in its order.
std::span<const Setting> key_table();

/// "X", .. "W": axis 0 to 8; "J0" .. "J8": joint 0 to 8. -1: neither.
int axis_of_item(std::string_view item);
int joint_of_item(std::string_view item);
/// All that PIN stands for: numbers of any of the kinematics.
const std::vector<std::string>& pin_names();
/// All that ITEM stands for.
const std::vector<std::string>& item_names();

/// "above 0 and at most 1000 (mm)", "0 to 255", "one of mark, cut, ignore".
std::string allowed_text(const Setting& spec);

}  // namespace kerf
