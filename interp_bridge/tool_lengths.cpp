#include "interp_bridge/tool_lengths.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kerf {
namespace {

constexpr std::size_t kOffsetNumbers = 9;
/// A program that adds up more rows than these (G43.2 in a loop) has no length that can be named.
constexpr std::size_t kMostRows = 8;

double greatest(const Vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

Vec3 xyz_of(const CanonicalCommand& command, std::size_t first, double unit_mm) {
  return Vec3{command.number(first), command.number(first + 1), command.number(first + 2)} *
         unit_mm;
}

}  // namespace

std::map<int, Vec3> known_lengths(const std::vector<ToolTableRow>& rows) {
  std::map<int, Vec3> lengths;
  bool any = false;
  for (const ToolTableRow& row : rows) {
    if (row.added) continue;
    lengths.emplace(row.tool, row.offset_mm);
    any |= row.offset_mm != Vec3{0};
  }
  if (!any) lengths.clear();
  return lengths;
}

void ToolLengths::set_up(ToolLengthSetup setup) { setup_ = std::move(setup); }

void ToolLengths::mount(int tool, bool by_hand) {
  tool_ = tool;
  if (!by_hand) row_of_spindle_ = tool;
  of_this_tool_ = false;
  judge();
}

/// U and W stay as they were under G43.1, in the unit that was in force when they were set.
ToolLengths::Call ToolLengths::decode_coded(const Vec3& offset_mm, double u, double w,
                                            double unit_mm) {
  const double before_u = std::exchange(call_u_, u);
  const double before_w = std::exchange(call_w_, w);
  const auto whole = [unit_mm](double value) {
    return static_cast<int>(std::lround(value * unit_mm));
  };
  const auto row_mm = [this](int tool) {
    const auto row = hidden_mm_.find(tool);
    return row == hidden_mm_.end() ? Vec3{0} : row->second;
  };
  Call call{OffsetOrigin::kStated, -1, offset_mm};
  const int count = whole(w);
  const int tools = whole(u);
  if (count == 1 && greatest(offset_mm - row_mm(tools)) <= kSameLength_mm) {
    // M61 has not changed what rs274 takes for the tool in the spindle.
    const bool spindle = tools == row_of_spindle_ && tool_ != row_of_spindle_;
    return {OffsetOrigin::kRow, spindle ? tool_ : tools, offset_mm};
  }
  if (count == 0 && tools == row_of_spindle_ && tool_ != 0 && offset_mm == Vec3{0}) {
    // Nothing was in it before M61: G43 and G49 look alike, and nothing is claimed.
    return {OffsetOrigin::kRow, tool_, offset_mm};
  }
  if (u == before_u && w == before_w) {
    if (w == 0 && offset_mm == Vec3{0}) call.origin = OffsetOrigin::kNone;
  } else if (w == 0) {
    call.origin = offset_mm == Vec3{0} ? OffsetOrigin::kNone : OffsetOrigin::kStated;
  } else if (count == whole(before_w) + 1) {
    call = {OffsetOrigin::kAddedRow, tools - whole(before_u), offset_mm};
  }
  return call;
}

ToolLengths::Call ToolLengths::decode(const CanonicalCommand& command, double unit_mm) {
  const Vec3 offset_mm = xyz_of(command, 0, unit_mm);
  if (setup_.calls == ToolLengthSetup::Calls::kCoded) {
    return decode_coded(offset_mm, command.number(6), command.number(8), unit_mm);
  }
  if (command.argument_count < kOffsetNumbers + 2) {
    const bool none = offset_mm == Vec3{0};
    return {none ? OffsetOrigin::kNone : OffsetOrigin::kStated, -1, offset_mm};
  }
  const int origin = std::clamp(command.integer(kOffsetNumbers), 0, 3);
  return {static_cast<OffsetOrigin>(origin), command.integer(kOffsetNumbers + 1), offset_mm};
}

/// The interpreter knows no lengths: what it says in numbers is what the program has said.
void ToolLengths::apply_hidden(const Call& call) {
  const auto row = setup_.length_mm.find(call.tool);
  switch (call.origin) {
    case OffsetOrigin::kNone:
      applied_mm_ = Vec3{0};
      break;
    case OffsetOrigin::kRow:
    case OffsetOrigin::kAddedRow:
      if (call.origin == OffsetOrigin::kRow) applied_mm_ = Vec3{0};
      if (row != setup_.length_mm.end()) applied_mm_ += row->second;
      break;
    case OffsetOrigin::kStated:
      for (int axis = 0; axis < 3; ++axis) {
        if (call.offset_mm[axis] != call_mm_[axis]) applied_mm_[axis] = call.offset_mm[axis];
      }
      break;
  }
}

void ToolLengths::use(const CanonicalCommand& command, double unit_mm, SourceRef source) {
  if (!checks()) return;
  const Call call = decode(command, unit_mm);
  const bool is_row = call.origin == OffsetOrigin::kRow || call.origin == OffsetOrigin::kAddedRow;
  if (call.origin != OffsetOrigin::kAddedRow && call.origin != OffsetOrigin::kStated) {
    applied_known_ = true;
    stated_ = false;
    rows_.clear();
  }
  if (is_row) {
    if (!setup_.length_mm.contains(call.tool) || rows_.size() >= kMostRows)
      applied_known_ = false;
    else
      rows_.push_back(call.tool);
  }
  if (call.origin == OffsetOrigin::kStated) {
    stated_ = true;
    if (stated_is_measured_) applied_known_ = false;
  }
  if (setup_.calls == ToolLengthSetup::Calls::kTrue) {
    applied_mm_ = call.offset_mm;
  } else {
    apply_hidden(call);
  }
  call_mm_ = call.offset_mm;
  of_this_tool_ = call.origin != OffsetOrigin::kNone;
  set_at_ = source;
  judge();
}

void ToolLengths::set_row(const CanonicalCommand& command) {
  if (!checks()) return;
  const int tool = command.integer(1);
  const Vec3 said_mm = xyz_of(command, 2, setup_.table_unit_mm);
  Vec3& row_mm = setup_.length_mm[tool];
  if (setup_.calls == ToolLengthSetup::Calls::kTrue) {
    row_mm = said_mm;
  } else {
    Vec3& before_mm = hidden_mm_[tool];
    for (int axis = 0; axis < 3; ++axis) {
      if (said_mm[axis] != before_mm[axis]) row_mm[axis] = said_mm[axis];
    }
    before_mm = said_mm;
  }
  judge();
}

void ToolLengths::judge() {
  state_ = {};
  const auto row = setup_.length_mm.find(tool_);
  if (tool_ == 0 || !applied_known_ || row == setup_.length_mm.end()) return;
  const double off_mm = greatest(applied_mm_ - row->second);
  if (off_mm <= kSameLength_mm) return;
  const bool corrected =
      rows_.size() > 1 && std::find(rows_.begin(), rows_.end(), tool_) != rows_.end();
  const bool stated = of_this_tool_ && (stated_ || corrected);
  if (stated && off_mm <= kMostWear_mm) return;
  state_.verdict = stated ? ToolLengthState::Verdict::kStated : ToolLengthState::Verdict::kWrong;
  state_.applied_mm = applied_mm_;
  state_.real_mm = row->second;
  if (!stated_ && rows_.size() == 1) state_.offset_tool = rows_.front();
  if (of_this_tool_) state_.set_at = set_at_;
}

}  // namespace kerf
