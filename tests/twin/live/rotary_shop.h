// tests/twin/live/rotary_shop.h - a machine that turns, its dry run, and samples of its joints.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/octree/octree.h"
#include "tests/twin/live/live_shop.h"
#include "tests/twin/live/surface_deviation.h"
#include "twin/live/live_cutter.h"
#include "twin/process/cut_stage.h"

namespace kerf {

/// A program of places X Y Z A B C, every motion on a line of its own.
class TurningProgram {
 public:
  explicit TurningProgram(double tool_mm = 0) {
    state_.tool = 1;
    state_.spindle = SpindleState::kClockwise;
    state_.spindle_rpm = 10000;
    state_.tool_offset_mm = {0, 0, tool_mm};
  }
  TurningProgram& at(Vec3 mm, std::array<double, 3> abc_deg = {}) {
    state_.to_mm = mm;
    state_.to_abc_deg = abc_deg;
    return *this;
  }
  TurningProgram& rapid(Vec3 mm, std::array<double, 3> abc_deg) {
    return go(MotionKind::kTraverse, mm, abc_deg);
  }
  TurningProgram& feed(Vec3 mm, std::array<double, 3> abc_deg) {
    return go(MotionKind::kFeed, mm, abc_deg);
  }
  TurningProgram& arc(Vec3 mm, std::array<double, 3> abc_deg, const ArcGeometry& arc) {
    go(MotionKind::kArc, mm, abc_deg);
    list_.back().arc = arc;
    return *this;
  }
  /// M68 E3 Q..: other kinematics; `mm` is what X Y Z are under these.
  TurningProgram& switched(int type, Vec3 mm) {
    state_.torch.analog[3] = static_cast<float>(type);
    state_.to_mm = mm;
    return *this;
  }
  const std::vector<Motion>& list() const { return list_; }

 private:
  TurningProgram& go(MotionKind kind, Vec3 mm, std::array<double, 3> abc_deg) {
    state_.from_mm = state_.to_mm;
    state_.from_abc_deg = state_.to_abc_deg;
    state_.to_mm = mm;
    state_.to_abc_deg = abc_deg;
    Motion m = state_;
    m.kind = kind;
    m.feed_mm_per_min = kind == MotionKind::kTraverse ? 0 : 3000;
    m.source.line = static_cast<std::uint32_t>(list_.size() + 1);
    list_.push_back(m);
    return *this;
  }
  Motion state_;
  std::vector<Motion> list_;
};

inline std::shared_ptr<const MachineKinematics> turning_machine(
    const std::string& kinematics, const std::string& letters = "",
    const KinematicsGeometry& geometry = {}, const RotaryPlacement& placement = {}) {
  return std::make_shared<const MachineKinematics>(
      known_machine(kinematics, letters, geometry, placement).value());
}

/// A workpiece, a machine with one cutter, and what became of it.
class RotaryShop {
 public:
  static constexpr double kCell_mm = 1;

  RotaryShop(std::shared_ptr<const MachineKinematics> machine, const WorkpieceFrame& frame,
             const char* blank = "box:-15,-15,-20:15,15,0", const char* tool = "1=ball:6:flute=20")
      : machine_(std::move(machine)), frame_(frame), blank_(blank), tool_(tool) {}

  std::unique_ptr<Octree> block() const {
    OctreeOptions options;
    options.blank = parse_blank(blank_).value();
    options.cell_mm = kCell_mm;
    options.memory_limit_bytes = std::size_t{1} << 30U;
    return std::move(Octree::create(options).value());
  }
  ToolSources tools() const {
    ToolSources sources;
    sources.arguments.push_back(std::move(parse_tool_argument(tool_).value()));
    return sources;
  }
  TimelineOptions timeline() const {
    TimelineOptions options;
    options.kinematics = machine_;
    options.kinematics_known = true;
    return options;
  }
  std::unique_ptr<Octree> dry_run(const std::vector<Motion>& program) const {
    auto stock = block();
    ToolResolver resolver(tools(), Octree::can_cut);
    FindingLog log;
    CutStage stage(*stock, resolver, log, timeline());
    stage.set_frame(frame_);
    stage.take(program);
    stage.finish();
    return stock;
  }

  enum class Positions { kJoints, kAxes, kSlides };
  struct Watched {
    std::unique_ptr<Octree> stock;
    FindingLog log;
    LiveFacts facts;
    ToolState place;
  };
  /// The machine runs the program, and is asked `rate_hz` times a second. `followed`: the program
  /// is known (`other_program`: is taken to be that one). `lines`: the source names the program's
  /// line.
  Watched watch(const std::vector<Motion>& program, double rate_hz, Positions positions,
                bool followed, bool lines = false,
                const std::vector<Motion>* other_program = nullptr) const {
    Watched seen;
    seen.stock = block();
    LiveCutOptions options;
    options.timeline = timeline();
    options.frame.work = frame_;
    options.work_known = true;
    if (positions == Positions::kJoints) options.frame.kinematics = machine_;
    options.wait_for_program = true;
    options.guard_s = 0;
    std::unique_ptr<Program> listed;
    if (followed)
      listed = std::make_unique<ListedProgram>(other_program ? *other_program : program);
    LiveCutter cutter(*seen.stock, tools(), seen.log, options, std::move(listed));
    const RunningMachine machine(program);
    const auto path = ToolPath::create(*machine_, frame_, {});
    const int count = static_cast<int>(machine.duration_s() * rate_hz) + 1;
    for (int i = 0; i <= count; ++i) {
      const double t = std::min(machine.duration_s(), i / rate_hz);
      AxisSample sample = sample_of(machine, *path, t, positions);
      if (lines) sample.line = static_cast<std::int32_t>(machine.at(t).motion.source.line);
      cutter.take(sample, i / rate_hz, false);
      if (i % 50 == 0) cutter.look();
    }
    cutter.look();
    cutter.finish();
    seen.facts = cutter.facts();
    seen.place = cutter.place();
    return seen;
  }

 private:
  AxisSample sample_of(const RunningMachine& machine, const ToolPath& path, double t,
                       Positions positions) const {
    const TimedMotion& now = machine.at(t);
    // Evenly: where a corner is rounded the planner's tip is beside the way that is turned here.
    const double done = now.step.duration_s > 0
                            ? std::clamp((t - now.step.start_s) / now.step.duration_s, 0.0, 1.0)
                            : 1.0;
    AxisSample sample;
    sample.tool = 1;
    sample.tool_offset_z_mm = now.motion.tool_offset_mm.z;
    const AxisValues values = positions == Positions::kJoints
                                  ? path.machine_at(now.motion, done)->joints
                                  : path.axes_at(now.motion, done);
    const std::size_t count = positions == Positions::kJoints   ? machine_->joint_letters.size()
                              : positions == Positions::kSlides ? 3
                                                                : 6;
    for (std::size_t i = 0; i < count; ++i) sample.set(i, values[i]);
    return sample;
  }

  std::shared_ptr<const MachineKinematics> machine_;
  WorkpieceFrame frame_;
  const char* blank_;
  const char* tool_;
};

}  // namespace kerf
