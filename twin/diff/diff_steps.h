// twin/diff/diff_steps.h - the motions of a program as they are held against those of another one.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "interp_bridge/motion.h"
#include "twin/process/motion_recorder.h"

namespace kerf {

/// One motion, or one event between motions; what is not compared is left out. About 300 bytes.
struct DiffStep {
  MotionKind kind = MotionKind::kTraverse;
  bool rapid = false;
  bool start_known = true;
  std::uint8_t unknown_to = 0;
  SourceRef source;
  Vec3 from_mm{0}, to_mm{0};
  std::array<double, 3> from_abc_deg{}, to_abc_deg{};
  Vec3 from_uvw_mm{0}, to_uvw_mm{0};
  ArcGeometry arc;  ///< kArc only
  double dwell_s = 0;

  // How it is run.
  int tool = 0;
  double feed = 0;  ///< mm/min, or mm a turn
  bool feed_per_rev = false;
  SpindleState spindle = SpindleState::kStopped;
  double rpm = 0;
  double surface_mm_per_min = 0;  ///< G96
  bool flood = false, mist = false;
  TorchState torch;
};

/// Goes somewhere, along a way that is known.
bool has_way(const DiffStep& step);
/// As the geometry of motions takes it.
Motion motion_of(const DiffStep& step);

/// All that a session tells, in order, but for motions that go nowhere (G1 F100).
class StepCollector final : public MotionRecorder {
 public:
  void restart() override { steps.clear(); }
  void name_files(const std::vector<std::string>& /*files*/) override {}
  void on_step(std::uint64_t number, const Motion& motion, const TimedStep& step) override;
  void on_cut(std::uint64_t, double, double) override {}

  std::vector<DiffStep> steps;
};

}  // namespace kerf
