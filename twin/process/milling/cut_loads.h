// twin/process/milling/cut_loads.h - what the cuts of milling tools are like: chips, speeds and,
// of a known material, forces, torque, power, bending; and what is wrong with them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "cutting/milling_force.h"
#include "stock/cutter/cutter.h"
#include "twin/findings/finding.h"
#include "twin/job/tool_loads.h"
#include "twin/process/cutting_wish.h"
#include "twin/process/engagement.h"
#include "twin/process/load_listener.h"

namespace kerf {

/// Is told of each part of a feed move how the tool is engaged on it (EngagementLog::heard_by).
/// What is wrong is told once a tool, where it is worst, when the program is over: a warning where
/// the low end of a range is beyond the limit, a note where the high end alone is. One thread.
class CutLoads {
 public:
  explicit CutLoads(FindingLog& log) : log_(log) {}
  /// Before the first tool.
  void set_wish(const CuttingWish& wish) { wish_ = wish; }

  void mount(const Cutter& cutter, int tool);
  struct Part {
    EngagementLook look;
    EngagedWay way;
    SourceRef source;
    double start_s = 0;
    Vec3 from_mm{0};
    double rpm = 0;              ///< 0: the spindle stands
    double most_mm_per_min = 0;  ///< the speed that its motion reaches
  };
  /// `listener`: is told what it was like; null: nobody is.
  void take(const Part& part, LoadListener* listener = nullptr);
  /// Of a part that was seen in the air and is not: how the tool is engaged there nobody knows.
  void take_unmeasured(const Part& part, LoadListener* listener);
  /// Of a part that nobody has measured.
  void tell_unmeasured(double start_s, double seconds, LoadListener* listener) const;
  /// The program is over: what is wrong.
  void finish();
  void forget();

  /// Of the tool of that number with that shape (Cutter::spec()). Null: nothing is known of its
  /// teeth, or it has not cut.
  std::shared_ptr<const ToolLoads> loads_of(int tool, const std::string& shape) const;

 private:
  /// Where something is worst.
  struct Worst {
    bool is_there = false;
    double value = 0;  ///< by which it is the worst
    ValueRange range;
    double seconds = 0;  ///< in all
    SourceRef source;
    double time_s = 0;
    Vec3 at_mm{0};
    double extra = 0;
  };
  enum Trouble : std::uint8_t {
    kChip,
    kThin,
    kThinest,
    kSlot,
    kDown,
    kRamp,
    kSpeed,
    kPower,
    kTorque,
    kBend,
    kUp,
    kTroubles
  };
  struct Tool {
    int number = 0;
    std::string shape;
    double radius_mm = 0;
    int teeth = 0;
    EdgeTraits traits;
    std::optional<double> flute_mm, stickout_mm;
    double shank_mm = 0, point_deg = 180;
    std::optional<MillingModel> model;
    std::optional<EdgeProfile> profile;
    std::shared_ptr<ToolLoads> loads = std::make_shared<ToolLoads>();
    double cut_s = 0;
    std::array<Worst, kTroubles> worst{};
  };
  struct AirWay {
    double seconds = 0, start_s = 0;
    SourceRef source;
    Vec3 at_mm{0};
    int tool = 0;
  };

  void take_engaged(const Part& part);
  void note(Trouble trouble, const Part& part, double value, const ValueRange& range,
            double extra = 0);
  void take_air(const Part& part);
  void close_air();
  void judge_way(const Part& part);
  void take_plunge(const Part& part, double feed_per_tooth_mm);
  void take_cut(const Part& part, double feed_per_tooth_mm);
  void add_forces(const Part& part, const ValueRange& force_n, const ValueRange& torque_nm,
                  const ValueRange& torque_mean_nm, const ValueRange& power_w);
  void add_bend(const Part& part, const ValueRange& force_n, const ValueRange& wall_n);
  void tell(const Tool& tool);
  void tell(const Tool& tool, Trouble trouble, FindingId id, Severity severity, std::string text);
  void tell_air();

  FindingLog& log_;
  CuttingWish wish_;
  std::vector<Tool> tools_;
  Tool* tool_ = nullptr;
  CutLoad load_;  ///< of the present part
  double feed_s_ = 0, air_s_ = 0;
  AirWay air_;
  std::vector<AirWay> longest_air_;  ///< five at most, the longest first
};

}  // namespace kerf
