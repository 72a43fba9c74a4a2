// twin/process/motion_recorder.h - who wants to know of each motion what came of it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "interp_bridge/motion.h"
#include "twin/machine/timeline.h"
#include "twin/process/engagement.h"

namespace kerf {

/// Every call comes from the thread that cuts.
class MotionRecorder {
 public:
  virtual ~MotionRecorder() = default;
  /// Everything begins again, for a workpiece in another model: what has been told is void.
  virtual void restart() = 0;
  /// What SourceRef::file of the motions means; before those that name a new one. Only grows.
  virtual void name_files(const std::vector<std::string>& files) = 0;
  /// In program order, each motion that is reported on; numbers ascend.
  virtual void on_step(std::uint64_t number, const Motion& motion, const TimedStep& step) = 0;
  /// A move of that motion has been cut, of which there may be several. Numbers do not fall. Also
  /// of motions that are not reported on, which on_step() has not told of.
  virtual void on_cut(std::uint64_t number, double removed_mm3, double depth_mm) = 0;
  /// How the tool was engaged on a part of that motion, as the report counts it; a look at nothing:
  /// it was in the air. Parts in their order, once it is known what their moves have removed, some
  /// of them behind on_cut() of later motions. Only where that is measured, and of what could be.
  virtual void on_engaged(std::uint64_t /*number*/, const EngagementLook& /*look*/,
                          const EngagedWay& /*way*/) {}
  /// Of motions before that one on_engaged() has told all. From the first call on those behind it
  /// are waited for; where nobody calls, nothing is told later than on_cut() of the next motion.
  virtual void on_engaged_until(std::uint64_t /*number*/) {}
  /// The same of a tool that stands still: after it has cut.
  virtual void on_turned(std::uint64_t /*number*/, const TurnedWay& /*way*/) {}
};

/// Several, each told what all are told.
class MotionRecorders final : public MotionRecorder {
 public:
  void add(MotionRecorder& recorder) { all_.push_back(&recorder); }
  bool empty() const { return all_.empty(); }

  void restart() override {
    for (MotionRecorder* const each : all_) each->restart();
  }
  void name_files(const std::vector<std::string>& files) override {
    for (MotionRecorder* const each : all_) each->name_files(files);
  }
  void on_step(std::uint64_t number, const Motion& motion, const TimedStep& step) override {
    for (MotionRecorder* const each : all_) each->on_step(number, motion, step);
  }
  void on_cut(std::uint64_t number, double removed_mm3, double depth_mm) override {
    for (MotionRecorder* const each : all_) each->on_cut(number, removed_mm3, depth_mm);
  }
  void on_engaged(std::uint64_t number, const EngagementLook& look,
                  const EngagedWay& way) override {
    for (MotionRecorder* const each : all_) each->on_engaged(number, look, way);
  }
  void on_engaged_until(std::uint64_t number) override {
    for (MotionRecorder* const each : all_) each->on_engaged_until(number);
  }
  void on_turned(std::uint64_t number, const TurnedWay& way) override {
    for (MotionRecorder* const each : all_) each->on_turned(number, way);
  }

 private:
  std::vector<MotionRecorder*> all_;
};

}  // namespace kerf
