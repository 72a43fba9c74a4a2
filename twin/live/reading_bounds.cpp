#include "twin/live/reading_bounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/translate.h"
#include "interp_bridge/wild_motion.h"

namespace kerf {

ReadingBounds::ReadingBounds(const LiveFrameOptions& frame, const TimelineOptions& timeline) {
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    Bound& bound = bounds_[i];
    int axis = frame.axis[i];
    bound.name = trf("position {}", i);
    if (const MachineKinematics* const machine = frame.kinematics.get()) {
      const std::string& letters = machine->joint_letters;
      const auto letter = std::find(kAxisLetters.begin(), kAxisLetters.end(),
                                    i < letters.size() ? letters[i] : '?');
      axis = letter == kAxisLetters.end() ? -1 : static_cast<int>(letter - kAxisLetters.begin());
      bound.name = trf("joint {}", i);
    } else if (axis >= 0) {
      bound.name = std::string(1, kAxisLetters[static_cast<std::size_t>(axis)]);
    }
    // The joints of a robot turn; what they are called says little.
    const bool arm = frame.kinematics && frame.kinematics->is_arm();
    const bool turns = arm || (axis >= 0 && is_rotary_axis(static_cast<std::size_t>(axis)));
    bound.high = turns ? kFarthest_deg : kFarthest_mm;
    bound.low = -bound.high;
    bound.unit = turns ? tr("degrees") : "mm";
    if (axis < 0 || frame.kinematics || frame.workpiece_frame) continue;
    const AxisLimits& limits = timeline.limits.axes[static_cast<std::size_t>(axis)];
    const double travel = limits.max - limits.min;
    if (!limits.present || turns || !std::isfinite(travel) || travel <= 0) continue;
    bound.low = std::max(bound.low, limits.min - travel);
    bound.high = std::min(bound.high, limits.max + travel);
  }
}

std::optional<std::string> ReadingBounds::fault_of(const AxisSample& sample) const {
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    const Bound& bound = bounds_[i];
    const double value = sample.position[i];
    if (!sample.has(i) || (value >= bound.low && value <= bound.high)) continue;
    return trf("{} reads {:g} {}; no machine is beyond {:g} .. {:g} {}", bound.name, value,
               bound.unit, bound.low, bound.high, bound.unit);
  }
  const double offset_mm = sample.tool_offset_z_mm;
  if (std::isnan(offset_mm) || std::abs(offset_mm) <= kFarthest_mm) return std::nullopt;
  return trf("the tool's length reads {:g} mm; none is beyond {:g} mm", offset_mm, kFarthest_mm);
}

}  // namespace kerf
