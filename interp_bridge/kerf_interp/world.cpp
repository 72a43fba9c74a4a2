#include "interp_bridge/kerf_interp/world.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "base/portable_math.h"

namespace kerf::interp {
namespace {

/// G43, G43.1, G43.2 and G49 among the words of a block.
std::vector<double> length_codes(const std::string& block) {
  std::vector<double> codes;
  int depth = 0;
  for (std::size_t i = 0; i < block.size(); ++i) {
    if (block[i] == ';' && depth == 0) break;
    depth += block[i] == '(' ? 1 : block[i] == ')' ? -1 : 0;
    if (depth != 0 || (block[i] != 'g' && block[i] != 'G')) continue;
    std::string digits;
    for (std::size_t at = i + 1; at < block.size(); ++at) {
      if (block[at] == ' ' || block[at] == '\t') continue;
      if (std::string_view("0123456789.").find(block[at]) == std::string_view::npos) break;
      digits += block[at];
    }
    const double code = std::round(std::strtod(digits.c_str(), nullptr) * 10) / 10;
    if (code == 43 || code == 43.1 || code == 43.2 || code == 49) codes.push_back(code);
  }
  return codes;
}

}  // namespace

CANON_TOOL_TABLE empty_tool() {
  CANON_TOOL_TABLE tool{};
  tool.toolno = -1;
  tool.pocketno = -1;
  return tool;
}

World::World() : rows_(1, empty_tool()) {
  rows_[0].toolno = 0;
  rows_[0].pocketno = 0;
  spindle_direction.fill(CANON_STOPPED);
  speed_override.fill(true);
}

/// The user's own values come first, then those of the material in force.
bool World::hal_value(const std::string& name, double& value) const {
  bool is_length = false;
  const auto given = hal_values.find(name);
  if (given != hal_values.end()) {
    value = given->second;
  } else if (qtplasmac && material_pin(materials.current(), name, value, is_length)) {
    if (is_length) value *= units_per_mm;
  } else if (qtplasmac && name == "qtplasmac.material_change_number") {
    value = materials.current().number;
  } else if (name == "motion.switchkins-type") {
    value = analog_outputs.back();
  } else {
    return false;
  }
  const bool converted = name == "plasmac.cut-feed-rate" || name == "plasmac.kerf-width" ||
                         name == "qtplasmac.kerf_width-f";
  if (convert_material && converted) value /= units_per_mm * unit_mm();
  return true;
}

Pose World::scaled(const Pose& program_units) const {
  Pose out = program_units;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (is_length(i)) out[i] *= unit_mm();
  }
  return out;
}

void World::set_rotation(double degrees) {
  rotation_deg = degrees;
  const double radians = degrees * 3.14159265358979323846 / 180.0;
  cos_ = portable::cos(radians);
  sin_ = portable::sin(radians);
}

double World::tool_offset(std::size_t axis) const {
  return is_length(axis) ? tool_offset_[axis] / unit_mm() : tool_offset_[axis];
}

/// R * (p * unit + g92) + g5x + tool offset.
Pose World::machine_from_program(const Pose& p) const {
  Pose m = scaled(p);
  for (std::size_t i = 0; i < m.size(); ++i) m[i] += g92_[i];
  const double x = m[0];
  m[0] = x * cos_ - m[1] * sin_;
  m[1] = x * sin_ + m[1] * cos_;
  for (std::size_t i = 0; i < m.size(); ++i) m[i] += g5x_[i] + tool_offset_[i];
  return m;
}

Pose World::program_from_machine(const Pose& m) const {
  Pose p = m;
  for (std::size_t i = 0; i < p.size(); ++i) p[i] -= g5x_[i] + tool_offset_[i];
  const double x = p[0];
  p[0] = x * cos_ + p[1] * sin_;
  p[1] = p[1] * cos_ - x * sin_;
  for (std::size_t i = 0; i < p.size(); ++i) {
    p[i] -= g92_[i];
    if (is_length(i)) p[i] /= unit_mm();
  }
  return p;
}

Pose World::tool_change_position() const {
  Pose machine = machine_;
  std::copy_n(tool_change_place.begin(), tool_change_axes, machine.begin());
  return program_from_machine(machine);
}

void World::move_to(const Pose& program) { machine_ = machine_from_program(program); }

void World::probe_to(const Pose& program, bool found) {
  move_to(program);
  probe_found_ = found;
  probed_ = machine_;
}

void World::add_tool(const CANON_TOOL_TABLE& tool) {
  if (rows_.size() < CANON_POCKETS_MAX) rows_.push_back(tool);
}

void World::mount_pocket_0() {
  const auto mounted = std::find_if(rows_.begin() + 1, rows_.end(),
                                    [](const CANON_TOOL_TABLE& t) { return t.pocketno == 0; });
  if (mounted == rows_.end()) return;
  rows_[0] = *mounted;
  rows_.erase(mounted);
}

int World::row_of_tool(int number) { return looked_up_ = find_row(number); }

int World::find_row(int number) {
  if (number == 0 && !random_toolchanger) return 0;
  const auto found = std::find_if(rows_.begin() + 1, rows_.end(),
                                  [&](const CANON_TOOL_TABLE& t) { return t.toolno == number; });
  if (found != rows_.end()) return static_cast<int>(found - rows_.begin());
  if (rows_[0].toolno == number) return 0;
  if (number <= 0 || rows_.size() >= CANON_POCKETS_MAX) return -1;
  CANON_TOOL_TABLE tool = empty_tool();
  tool.toolno = number;
  tool.pocketno = static_cast<int>(rows_.size());
  rows_.push_back(tool);
  return tool.pocketno;
}

bool World::is_offset(const Pose& offset_mm, int index) const {
  constexpr double kRounding_mm = 1e-9;
  const EmcPose& o = row(index).offset;
  const Pose p = {o.tran.x, o.tran.y, o.tran.z, o.a, o.b, o.c, o.u, o.v, o.w};
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double mm = is_length(i) ? p[i] / units_per_mm : p[i];
    if (std::abs(mm - offset_mm[i]) > kRounding_mm) return false;
  }
  return true;
}

/// The interpreter does not say it with the call. The block does, unless it writes its G codes as
/// expressions; then the numbers do.
World::OffsetSource World::offset_source(const Pose& program_units,
                                         const std::string& block) const {
  const Pose offset_mm = scaled(program_units);
  const int named = looked_up_ >= 0 ? looked_up_ : 0;
  const int tool = row(named).toolno;
  for (const double code : length_codes(block)) {
    if (code == 49) return {};
    if (code == 43) return {OffsetSource::kRow, tool};
    if (code == 43.2 && looked_up_ >= 0) return {OffsetSource::kAddedRow, tool};
    return {OffsetSource::kStated, -1};
  }
  if (looked_up_ < 0 && offset_mm == Pose{}) return {};
  if (is_offset(offset_mm, named)) return {OffsetSource::kRow, tool};
  Pose added = offset_mm;
  for (std::size_t i = 0; i < added.size(); ++i) added[i] -= tool_offset_[i];
  if (looked_up_ >= 0 && is_offset(added, named)) return {OffsetSource::kAddedRow, tool};
  return {OffsetSource::kStated, -1};
}

CANON_TOOL_TABLE World::row(int index) const {
  const auto i = static_cast<std::size_t>(index);
  return index >= 0 && i < rows_.size() ? rows_[i] : empty_tool();
}

void World::set_row(int index, const CANON_TOOL_TABLE& tool) {
  if (index < 0 || index >= CANON_POCKETS_MAX) return;
  const auto i = static_cast<std::size_t>(index);
  if (i >= rows_.size()) rows_.resize(i + 1, empty_tool());
  rows_[i] = tool;
}

int World::load(int index) {
  if (random_toolchanger && index > 0) {
    // The tool that was in the spindle takes the new one's place.
    CANON_TOOL_TABLE taken = row(index);
    CANON_TOOL_TABLE returned = rows_[0];
    std::swap(taken.pocketno, returned.pocketno);
    rows_[0] = taken;
    set_row(index, returned);
    loaded_ = 0;
  } else if (index > 0) {
    rows_[0] = row(index);
    loaded_ = index;
  } else if (!random_toolchanger) {
    rows_[0] = empty_tool();
    rows_[0].toolno = 0;
    loaded_ = 0;
  }
  return rows_[0].toolno;
}

}  // namespace kerf::interp
