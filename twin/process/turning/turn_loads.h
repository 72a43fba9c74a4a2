// twin/process/turning/turn_loads.h - what the cuts of turning tools take: chips, speeds and, of a
// known material, force, torque, power; and what of it is too much.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "cutting/turning_force.h"
#include "interp_bridge/motion.h"
#include "stock/cutter/cutter.h"
#include "twin/findings/finding.h"
#include "twin/job/tool_loads.h"
#include "twin/process/cutting_wish.h"
#include "twin/process/engagement.h"
#include "twin/process/load_listener.h"

namespace kerf {

/// Is told of each part of a feed move how deep the tool cuts and what it feeds. Of drills and
/// other tools on the axis it works out what drilling takes, if they say their teeth. What is too
/// much is told once a tool, where it is worst, when the program is over: a warning where the low
/// end of a range is beyond the limit, a note where the high end alone is. One thread.
class TurnLoads {
 public:
  explicit TurnLoads(FindingLog& log) : log_(log) {}
  /// Before the first tool.
  void set_wish(const CuttingWish& wish) { wish_ = wish; }

  void mount(const Cutter& cutter, int tool);
  struct Part {
    TurnedWay way;
    double sine = 1;  ///< of the lead angle: TurningCut
    /// Of the workpiece where it is cut at most, and how fast it turns there.
    double radius_mm = 0, rpm = 0;
    SourceRef source;
    double start_s = 0;
    Vec3 from_mm{0};
  };
  /// `listener`: is told what it was like; null: nobody is.
  void take(const Part& part, LoadListener* listener = nullptr);
  /// Of a feed move of that tool, which may be one that is not mounted here (driven), that nobody
  /// has measured, and that has cut.
  static void tell_unmeasured(int tool, SourceRef source, double start_s, double seconds,
                              LoadListener* listener);
  /// The program is over: what is too much.
  void finish();
  void forget();

  /// Of the tool of that number with that shape (Cutter::spec()). Null: it has not cut while the
  /// workpiece turned.
  std::shared_ptr<const ToolLoads> loads_of(int tool, const std::string& shape) const;

 private:
  enum Trouble : std::uint8_t { kFeed, kSpeed, kPower, kTorque, kTroubles };
  struct Worst {
    bool is_there = false;
    ValueRange range;
    double seconds = 0;  ///< in all
    SourceRef source;
    double time_s = 0;
    Vec3 at_mm{0};
  };
  struct Tool {
    int number = 0;
    std::string shape;
    std::optional<double> most_feed_mm;  ///< a turn; of drills and the like per tooth
    bool is_insert = true;
    double radius_mm = 0, point_deg = 180;  ///< of drills and the like
    int teeth = 0;                          ///< 0: not known
    std::optional<double> rake_deg;
    std::shared_ptr<ToolLoads> loads = std::make_shared<ToolLoads>();
    std::array<Worst, kTroubles> worst{};
  };
  void add(const Part& part, CutLoad& told);
  void add_drilling(const Part& part, double seconds, CutLoad& told);
  struct Forces {
    ValueRange force_n, torque_nm, power_kw;
  };
  void add_chip(const Part& part, double seconds, double chip_mm, double speed_m_per_min,
                CutLoad& told);
  void add_forces(const Part& part, double seconds, const Forces& forces, CutLoad& told);
  void tell(const Part& part, CutLoad& load, LoadListener& listener) const;
  void note(Trouble trouble, const Part& part, double seconds, const ValueRange& range);
  void tell(const Tool& tool);
  void tell(const Tool& tool, Trouble trouble, FindingId id, double limit, const std::string& text);

  FindingLog& log_;
  CuttingWish wish_;
  std::vector<Tool> tools_;
  std::size_t tool_ = 0;
};

}  // namespace kerf
