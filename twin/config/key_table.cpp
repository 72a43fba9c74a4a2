#include "twin/config/key_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "base/translate.h"
#include "machine_io/modbus/modbus_settings.h"
#include "twin/machine/kinematics/machine_kinematics.h"

namespace kerf {
namespace {

constexpr std::string_view kSmallItems[] = {"tool",    "line",    "spindle",       "tool_offset_z",
                                            "trigger", "counter", "counter_begun", "load"};

}  // namespace

std::span<const Setting> key_table() {
  static const std::vector<Setting> keys = [] {
    std::vector<Setting> all;
    for (const Setting& setting : setting_table()) {
      if (!setting.key.empty()) all.push_back(setting);
    }
    return all;
  }();
  return keys;
}

int axis_of_item(std::string_view item) {
  for (std::size_t i = 0; i < kAxisKeys.size(); ++i) {
    if (item == kAxisKeys[i]) return static_cast<int>(i);
  }
  return -1;
}

int joint_of_item(std::string_view item) {
  const bool fits = item.size() == 2 && item[0] == 'J' && item[1] >= '0' && item[1] <= '8';
  return fits ? item[1] - '0' : -1;
}

const std::vector<std::string>& item_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all(kAxisKeys.begin(), kAxisKeys.end());
    for (std::size_t i = 0; i < kMaxPositions; ++i) all.push_back(fmt::format("J{}", i));
    all.insert(all.end(), std::begin(kSmallItems), std::end(kSmallItems));
    return all;
  }();
  return names;
}

const std::vector<std::string>& pin_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const std::string& module : known_modules()) {
      for (const GeometryPin& pin : geometry_pins(module)) all.push_back(pin.name);
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }();
  return names;
}

std::string allowed_text(const Setting& spec) {
  const std::string unit = *spec.unit == 0 ? "" : fmt::format(" ({})", tr(spec.unit));
  switch (spec.type) {
    case KeyType::kGroup:
      return tr("a group of keys");
    case KeyType::kText:
      return tr("a text");
    case KeyType::kFile:
    case KeyType::kFolder:
      return tr("a path");
    case KeyType::kYesNo:
      return tr("yes or no");
    case KeyType::kTexts:
      return tr("a list of texts");
    case KeyType::kPairs:
      return tr("a list of pairs, [[a, b], ..]");
    case KeyType::kGroups:
      return tr("a list of groups of keys");
    case KeyType::kWord:
      return trf("one of {}", fmt::join(parts_of(spec.words), ", "));
    case KeyType::kNumber:
    case KeyType::kWhole:
      break;
  }
  const char* const whole = spec.type == KeyType::kWhole ? tr("a whole number, ") : "";
  if (spec.least_excluded) {
    return trf("{}above {} and at most {}{}", whole, spec.least, spec.most, unit);
  }
  return trf("{}{} to {}{}", whole, spec.least, spec.most, unit);
}

}  // namespace kerf
