// twin/process/milling/length_check.h - tool-length: a tool that works, or comes near the blank,
// under an offset that is not its length.
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <string>

#include "base/geometry.h"
#include "interp_bridge/motion.h"
#include "twin/findings/finding.h"
#include "twin/machine/timeline.h"

namespace kerf {

/// A tip this far above the blank or beside it is near it.
inline constexpr double kNearBlank_mm = 1.0;

/// One finding for each tool that was mounted and offset that was set: programs that repeat
/// themselves are told once.
///
/// A wrong offset is common where nothing comes of it: G49 before the way up at the end, or the way
/// to the next place between M6 and G43. So it is told
///   - of a feed move, an arc or a thread, if its way comes near the blank where the tip is, or
///   where
///     the program has it (a tool that is too short cuts air above the blank)
///   - of a traverse, if the tip touches the workpiece, or comes near the blank without going up
/// and of nothing else.
class LengthCheck {
 public:
  LengthCheck(const Box& blank_mm, FindingLog& log) : blank_mm_(blank_mm), log_(log) {}

  /// `upright`: else the blank may have turned, and every way is near it. `touches`: of a traverse.
  void check(const Motion& motion, const TimedStep& step, double radius_mm, bool upright,
             bool touches);
  void forget() { told_.clear(); }

 private:
  bool comes_near(const Motion& motion, const Vec3& shift_mm, double radius_mm) const;
  bool matters(const Motion& motion, double radius_mm, bool upright, bool touches) const;

  Box blank_mm_;
  FindingLog& log_;
  /// Tool, file, line, whose offset, the differences in um and thousandths of a degree.
  using Event = std::array<std::int64_t, 13>;
  std::set<Event> told_;
};

/// "G43 H1 applies 60 mm, and tool 2 in the spindle is 75 mm long: its tip is 15 mm lower than
/// programmed"
std::string length_text(const Motion& motion);

}  // namespace kerf
