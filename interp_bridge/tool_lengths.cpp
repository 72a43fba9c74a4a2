#include "interp_bridge/tool_lengths.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kerf {
namespace {

constexpr std::size_t kOffsetNumbers = 9;
/// A program that adds up more rows than these (G43.2 in a loop) has no length that can be named.
constexpr std::size_t kMostRows = 8;

bool is_turn(std::size_t axis) { return axis >= 3 && axis < 6; }
bool has_axis(unsigned axes, std::size_t axis) { return (axes >> axis & 1U) != 0; }

/// mm or degrees: in both what is below kSameLength_mm is nothing.
double greatest(const ToolOffset& v) {
  double most = 0;
  for (const double one : v) most = std::max(most, std::abs(one));
  return most;
}

ToolOffset difference(const ToolOffset& a, const ToolOffset& b) {
  ToolOffset out = a;
  for (std::size_t axis = 0; axis < out.size(); ++axis) out[axis] -= b[axis];
  return out;
}

Vec3 three_of(const ToolOffset& v, std::size_t first) {
  return {v[first], v[first + 1], v[first + 2]};
}

/// X Y Z A B C U V W from number `first` on.
ToolOffset offset_of(const CanonicalCommand& command, std::size_t first, double unit_mm,
                     unsigned axes) {
  ToolOffset out{};
  for (std::size_t axis = 0; axis < out.size(); ++axis) {
    if (!has_axis(axes, axis) || first + axis >= command.argument_count) continue;
    out[axis] = command.number(first + axis) * (is_turn(axis) ? 1 : unit_mm);
  }
  return out;
}

}  // namespace

std::map<int, ToolOffset> known_lengths(const std::vector<ToolTableRow>& rows, unsigned axes) {
  std::map<int, ToolOffset> lengths;
  bool any = false;
  for (const ToolTableRow& row : rows) {
    if (row.added) continue;
    ToolOffset& length = lengths[row.tool];
    for (std::size_t axis = 0; axis < length.size(); ++axis) {
      const Vec3& three = axis < 3        ? row.offset_mm
                          : is_turn(axis) ? row.offset_abc_deg
                                          : row.offset_uvw_mm;
      if (has_axis(axes, axis)) length[axis] = three[static_cast<int>(axis % 3)];
      any |= length[axis] != 0;
    }
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
ToolLengths::Call ToolLengths::decode_coded(const ToolOffset& offset, double u, double w,
                                            double unit_mm) {
  const double before_u = std::exchange(call_u_, u);
  const double before_w = std::exchange(call_w_, w);
  const auto whole = [unit_mm](double value) {
    return static_cast<int>(std::lround(value * unit_mm));
  };
  const auto row_of = [this](int tool) {
    const auto row = hidden_.find(tool);
    return row == hidden_.end() ? ToolOffset{} : row->second;
  };
  const bool is_zero = offset == ToolOffset{};
  Call call{OffsetOrigin::kStated, -1, offset};
  const int count = whole(w);
  const int tools = whole(u);
  if (count == 1 && greatest(difference(offset, row_of(tools))) <= kSameLength_mm) {
    // M61 has not changed what rs274 takes for the tool in the spindle.
    const bool spindle = tools == row_of_spindle_ && tool_ != row_of_spindle_;
    return {OffsetOrigin::kRow, spindle ? tool_ : tools, offset};
  }
  if (count == 0 && tools == row_of_spindle_ && tool_ != 0 && is_zero) {
    // Nothing was in it before M61: G43 and G49 look alike, and nothing is claimed.
    return {OffsetOrigin::kRow, tool_, offset};
  }
  if (u == before_u && w == before_w) {
    if (w == 0 && is_zero) call.origin = OffsetOrigin::kNone;
  } else if (w == 0) {
    call.origin = is_zero ? OffsetOrigin::kNone : OffsetOrigin::kStated;
  } else if (count == whole(before_w) + 1) {
    call = {OffsetOrigin::kAddedRow, tools - whole(before_u), offset};
  }
  return call;
}

ToolLengths::Call ToolLengths::decode(const CanonicalCommand& command, double unit_mm) {
  if (setup_.calls == ToolLengthSetup::Calls::kCoded) {
    constexpr unsigned kNoSlides = 0x3f;
    return decode_coded(offset_of(command, 0, unit_mm, setup_.axes & kNoSlides), command.number(6),
                        command.number(8), unit_mm);
  }
  const ToolOffset offset = offset_of(command, 0, unit_mm, setup_.axes);
  if (command.argument_count < kOffsetNumbers + 2) {
    const bool none = offset == ToolOffset{};
    return {none ? OffsetOrigin::kNone : OffsetOrigin::kStated, -1, offset};
  }
  const int origin = std::clamp(command.integer(kOffsetNumbers), 0, 3);
  return {static_cast<OffsetOrigin>(origin), command.integer(kOffsetNumbers + 1), offset};
}

/// The interpreter has the table's lengths along this axis: its numbers are the offset.
bool ToolLengths::is_told(std::size_t axis) const {
  return setup_.calls == ToolLengthSetup::Calls::kTrue && !is_turn(axis);
}

/// Where the interpreter knows no lengths, what it says in numbers is what the program has said.
void ToolLengths::apply(const Call& call) {
  const auto found = setup_.lengths.find(call.tool);
  const ToolOffset row = found == setup_.lengths.end() ? ToolOffset{} : found->second;
  for (std::size_t axis = 0; axis < applied_.size(); ++axis) {
    double& applied = applied_[axis];
    const double said = call.offset[axis];
    if (is_told(axis)) {
      applied = said;
      continue;
    }
    switch (call.origin) {
      case OffsetOrigin::kNone:
        applied = 0;
        break;
      case OffsetOrigin::kRow:
        applied = row[axis];
        break;
      case OffsetOrigin::kAddedRow:
        applied += row[axis];
        break;
      case OffsetOrigin::kStated:
        if (said != call_[axis]) applied = said;
        break;
    }
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
    if (!setup_.lengths.contains(call.tool) || rows_.size() >= kMostRows)
      applied_known_ = false;
    else
      rows_.push_back(call.tool);
  }
  if (call.origin == OffsetOrigin::kStated) {
    stated_ = true;
    if (stated_is_measured_) applied_known_ = false;
  }
  apply(call);
  call_ = call.offset;
  of_this_tool_ = call.origin != OffsetOrigin::kNone;
  set_at_ = source;
  judge();
}

void ToolLengths::set_row(const CanonicalCommand& command) {
  if (!checks()) return;
  const int tool = command.integer(1);
  const bool coded = setup_.calls == ToolLengthSetup::Calls::kCoded;
  constexpr unsigned kNoSlides = 0x3f;
  const ToolOffset said =
      offset_of(command, 2, setup_.table_unit_mm, coded ? setup_.axes & kNoSlides : setup_.axes);
  ToolOffset& row = setup_.lengths[tool];
  ToolOffset& before = hidden_[tool];
  for (std::size_t axis = 0; axis < row.size(); ++axis) {
    if (is_told(axis) || said[axis] != before[axis]) row[axis] = said[axis];
  }
  before = said;
  judge();
}

void ToolLengths::judge() {
  state_ = {};
  const auto row = setup_.lengths.find(tool_);
  if (tool_ == 0 || !applied_known_ || row == setup_.lengths.end()) return;
  const ToolOffset off = difference(applied_, row->second);
  const double most = greatest(off);
  if (most <= kSameLength_mm) return;
  const bool corrected =
      rows_.size() > 1 && std::find(rows_.begin(), rows_.end(), tool_) != rows_.end();
  const bool stated = of_this_tool_ && (stated_ || corrected);
  if (stated && most <= kMostWear_mm) return;
  state_.verdict = stated ? ToolLengthState::Verdict::kStated : ToolLengthState::Verdict::kWrong;
  state_.applied_mm = applied_mm();
  state_.real_mm = three_of(row->second, 0);
  state_.abc_off_deg = three_of(off, 3);
  state_.uvw_off_mm = three_of(off, 6);
  if (!stated_ && rows_.size() == 1) state_.offset_tool = rows_.front();
  if (of_this_tool_) state_.set_at = set_at_;
}

}  // namespace kerf
