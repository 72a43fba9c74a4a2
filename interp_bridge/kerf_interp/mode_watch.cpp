#include "interp_bridge/kerf_interp/mode_watch.h"

#include <array>
#include <cmath>
#include <utility>

#include "base/units.h"

namespace kerf::interp {
namespace {

using Values = std::array<double, kModeGroups>;

/// Where the interpreter's lists have a group: write_g_codes(), write_m_codes() and
/// write_settings() of its interp_write.cc.
constexpr std::pair<ModeGroup, std::size_t> kGCodes[] = {
    {ModeGroup::kPlane, 3},        {ModeGroup::kCompensation, 4}, {ModeGroup::kUnits, 5},
    {ModeGroup::kDistance, 6},     {ModeGroup::kFeedMode, 7},     {ModeGroup::kWorkOffset, 8},
    {ModeGroup::kLengthOffset, 9}, {ModeGroup::kReturn, 10},      {ModeGroup::kPath, 11},
    {ModeGroup::kSpindleMode, 13}, {ModeGroup::kArcDistance, 14}, {ModeGroup::kDiameter, 15},
    {ModeGroup::kShift, 16}};
constexpr std::pair<ModeGroup, std::size_t> kMCodes[] = {{ModeGroup::kSpindle, 2},
                                                         {ModeGroup::kMist, 4},
                                                         {ModeGroup::kFlood, 5},
                                                         {ModeGroup::kAdaptiveFeed, 7},
                                                         {ModeGroup::kFeedHold, 8}};
constexpr std::pair<ModeGroup, std::size_t> kSettings[] = {{ModeGroup::kFeed, 1},
                                                           {ModeGroup::kSpeed, 2},
                                                           {ModeGroup::kPathTolerance, 3},
                                                           {ModeGroup::kMergeTolerance, 4}};

/// Of Recording::length_offset, behind the nine lengths.
constexpr std::size_t kOffsetTool = 10;

Values values_of(InterpBase& interpreter) {
  std::array<int, ACTIVE_G_CODES> g{};
  std::array<int, ACTIVE_M_CODES> m{};
  std::array<double, ACTIVE_SETTINGS> settings{};
  interpreter.active_g_codes(g.data());
  interpreter.active_m_codes(m.data());
  interpreter.active_settings(settings.data());
  Values values;
  values.fill(-1);
  const auto at = [&values](ModeGroup group) -> double& {
    return values[static_cast<std::size_t>(group)];
  };
  for (const auto& [group, index] : kGCodes) at(group) = g[index];
  for (const auto& [group, index] : kMCodes) at(group) = m[index];
  for (const auto& [group, index] : kSettings) at(group) = settings[index];
  const World& world = recording().world;
  // Its own list says M51 after M49.
  const bool feed = world.feed_override, speed = world.speed_override[0];
  at(ModeGroup::kOverrides) = feed && speed ? 48 : feed ? 51 : speed ? 50 : 49;
  at(ModeGroup::kRotation) = world.rotation_deg;
  at(ModeGroup::kTool) = world.row(world.loaded_row()).toolno;
  const std::vector<double>& offset = recording().length_offset;
  if (at(ModeGroup::kLengthOffset) == 430 && offset.size() > kOffsetTool) {
    at(ModeGroup::kLengthTool) = offset[kOffsetTool];
  }
  return values;
}

/// G20 and G21 turn F and the tolerances into other numbers, and change nothing.
bool is_same(double a, double b, bool units_change) {
  constexpr double kRounding = 1e-9;
  const auto meets = [&](double scale) {
    return std::abs(a - b * scale) <= kRounding * std::abs(a);
  };
  return a == b || (units_change && (meets(kMmPerInch) || meets(1 / kMmPerInch)));
}

}  // namespace

void ModeWatch::begin(InterpBase& interpreter) {
  modes_.clear();
  for (const double value : values_of(interpreter)) modes_.push_back({value, value, 0});
}

void ModeWatch::follow(InterpBase& interpreter, int line) {
  const Values values = values_of(interpreter);
  const auto units = static_cast<std::size_t>(ModeGroup::kUnits);
  const bool units_change = values[units] != modes_[units].now;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool same = is_same(values[i], modes_[i].now, units_change);
    modes_[i].now = values[i];
    if (same) continue;
    modes_[i].line = static_cast<std::uint32_t>(line > 0 ? line : 0);
  }
}

void ModeWatch::write(RecordWriter& records) const {
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    const ActiveMode& mode = modes_[i];
    records.numbers(records::kMode, static_cast<int>(mode.line),
                    {static_cast<double>(i), mode.begun, mode.now});
  }
}

}  // namespace kerf::interp
