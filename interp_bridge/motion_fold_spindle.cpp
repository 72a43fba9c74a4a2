// Spindles, and the surface speed of G96.
#include <algorithm>
#include <iterator>

#include "base/units.h"
#include "interp_bridge/motion_fold.h"

namespace kerf {

/// G96 turns about X0 of the program.
SurfaceSpeed MotionFold::surface_speed() const {
  const Spindle& spindle = spindles_[spindle_];
  if (spindle.surface_max_rpm <= 0) return {};
  return {spindle.speed * spindle.surface_unit_mm, spindle.surface_max_rpm,
          work_from_program(Vec3{0}).x};
}

void MotionFold::update_rpm() {
  const SurfaceSpeed surface = surface_speed();
  rpm_ = surface.on() ? surface.rpm_at(position_mm_.x) : spindles_[spindle_].speed;
}

/// The first that turns.
void MotionFold::choose_spindle() {
  const auto turning = std::find_if(spindles_.begin(), spindles_.end(), [](const Spindle& one) {
    return one.state != SpindleState::kStopped;
  });
  spindle_ = turning == spindles_.end()
                 ? 0
                 : static_cast<std::size_t>(std::distance(spindles_.begin(), turning));
  update_rpm();
  note_spindles();
}

/// M2 stops all spindles before it ends the program, which is seen by the mode that it sets with
/// each: those that it found turning are told with the end, so that it can be seen whether the
/// program has stopped them itself.
void MotionFold::append_program_end(SourceRef source, std::vector<Motion>& out) {
  const auto stopped = spindles_;
  for (Spindle& spindle : spindles_) {
    if (spindle.ended_from != SpindleState::kStopped) spindle.state = spindle.ended_from;
  }
  choose_spindle();
  append(MotionKind::kProgramEnd, source, out);
  spindles_ = stopped;
  choose_spindle();
}

bool MotionFold::fold_spindle(const CanonicalCommand& command) {
  const auto for_each = [&](auto change) {
    // -1 is all of them (M5 $-1); numbers beyond the last spindle are not on any machine.
    const int number = command.integer(0);
    for (std::size_t i = 0; i < kMaxSpindles; ++i) {
      if (number == -1 || number == static_cast<int>(i)) change(spindles_[i]);
    }
    choose_spindle();
    return true;
  };
  switch (command.name) {
    case CanonicalName::kStartSpindleClockwise:
      return for_each([](Spindle& spindle) { spindle.start(SpindleState::kClockwise); });
    case CanonicalName::kStartSpindleCounterclockwise:
      return for_each([](Spindle& spindle) { spindle.start(SpindleState::kCounterclockwise); });
    case CanonicalName::kStopSpindleTurning:
      return for_each([](Spindle& spindle) { spindle.stop(); });
    case CanonicalName::kSetSpindleSpeed:
      speed_said_ = true;
      return for_each([&](Spindle& spindle) { spindle.speed = command.number(1); });
    case CanonicalName::kSetSpindleMode:
      // Surface speed is m/min in G21 and ft/min in G20.
      return for_each([&](Spindle& spindle) {
        if (stop_before_) spindle.ended_from = spindle.stopped_from;
        spindle.surface_max_rpm = command.number(1);
        spindle.surface_unit_mm = unit_mm_ == kMmPerInch ? 304.8 : 1000.0;
      });
    default:
      return false;
  }
}

}  // namespace kerf
