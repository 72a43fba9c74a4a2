// twin/live/load_watch.h - whether the spindle of a watched machine takes what its cuts should.
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "machine_io/position_source.h"
#include "twin/findings/finding.h"
#include "twin/live/idle_loads.h"
#include "twin/live/load_bins.h"
#include "twin/process/cutting_wish.h"
#include "twin/process/load_listener.h"
#include "twin/report/live_load.h"

namespace kerf {

/// Holds the mean load of the last kWindow bins against the idle load, measured with the same speed
/// of the spindle in the air, and the band of what was cut meanwhile:
///
///     measured    idle + low .. idle + high / kLeastEfficiency
///
/// low and high are those of the material; or, where a tool has cut for kLearn_s what should take
/// as much (within a factor of two), kLeastOfUsual and kMostOfUsual of what it took then, if that
/// is narrower. The load may be late by up to kShifts bins: the band is the widest of these.
///
/// Not judged, and not taken for idle: until a spindle has kept its speed for kSettle_s, without a
/// load, while its number stands still for longer than it ever did, cuts that nobody knows, windows
/// of two tools, and cuts that should take less than the idle load is uncertain. What differs for
/// kLasting_s of the time that is judged, in one direction, is a finding, once a tool and
/// direction. One thread; deterministic.
///
/// A speed is kept while it changes by less than a tenth in kSlowly_bins, as facing at constant
/// surface speed has it: what the spindle's own mass takes of that is little beside the cut. Once
/// it has come to speeds whose idle load was not measured, that is IdleLoads::near(). Not of
/// currents: of a torque they are another share there.
class LoadWatch final : public LoadListener {
 public:
  static constexpr int kWindow = 16, kShifts = 4, kSlowly_bins = 4;
  static constexpr double kSettle_s = 3, kLasting_s = 5, kLearn_s = 20;
  static constexpr double kLeastEfficiency = 0.75;
  static constexpr double kLeastOfUsual = 0.5, kMostOfUsual = 1.4;
  /// Cuts that nobody knows the load of are told from so long on.
  static constexpr double kLeastUnjudged_s = 1;
  /// Bins are judged so much later: a number that stands still is known as that by then.
  static constexpr double kDelay_s = 4;

  /// `log` outlives the watch.
  LoadWatch(const CuttingWish& wish, FindingLog& log) : wish_(wish), log_(log) {}

  void take(const AxisSample& sample, double t_s);
  void on_load(const CutLoad& load) override;
  /// All parts before `until_s` have been heard.
  void judge(double until_s);
  /// What the other one has learnt of spindle and tools, and told of them.
  void go_on_from(const LoadWatch& other) { known_ = other.known_; }

  /// None: the source tells no load.
  std::optional<LoadNow> now() const;
  std::optional<LoadReport> report() const;

 private:
  enum class Side : std::uint8_t { kWithin, kLower, kHigher };
  struct Usual {
    double seconds = 0, measured = 0, nominal = 0;
    double ratio() const { return measured / nominal; }
  };
  /// The mean of a window, as late as may be.
  struct Expected {
    double low = 0, high = 0;                  ///< of the material
    double nominal_low = 0, nominal_high = 0;  ///< nominal, at the least and the most
  };
  /// A difference that lasts.
  struct Stretch {
    Side side = Side::kWithin;
    double seconds = 0, begin_s = 0;
    SourceRef source;
    double measured_s = 0, low_s = 0, high_s = 0;
    bool by_usual = false;
  };
  struct Tool {
    double judged_s = 0, differs_s = 0;
    double measured_s = 0, low_s = 0, high_s = 0;
    std::map<int, Usual> usual;  ///< by the power of two of what the cuts should take
    bool lower_told = false, higher_told = false;
  };
  struct Known {
    std::uint64_t samples = 0;
    LoadUnit unit = LoadUnit::kPercentOfPower;
    double least = std::numeric_limits<double>::infinity();
    double most = -std::numeric_limits<double>::infinity();
    double longest_still_s = 0;  ///< that was over again
    IdleLoads idle;
    std::map<int, Tool> tools;
    std::map<int, double> unjudged_s;  ///< by the tool
    bool still_told = false;
  };

  double per_power_w() const;
  double per_torque_nm() const;
  double least_margin() const;
  void watch_tool(const AxisSample& sample, double t_s);
  void watch_speed(std::int64_t number, LoadBin& bin);
  void watch_stillness(double load, double t_s, double elapsed_s);
  void tell_stillness(double t_s);
  bool is_usable(const LoadBin& bin) const;
  bool is_air(std::int64_t number) const;
  std::optional<IdleLoads::Idle> idle_of(double rpm, bool is_drifting) const;
  std::optional<IdleLoads::Idle> window_idle(std::int64_t last) const;
  void judge_bin(std::int64_t number);
  bool window_tool(std::int64_t last, int& tool) const;
  double window_load(std::int64_t last) const;
  Expected window_expected(std::int64_t last) const;
  void judge_window(std::int64_t last, int number, const IdleLoads::Idle& idle);
  void note(Tool& tool, int number, const Stretch& now);
  void tell(int number, const Stretch& stretch, double idle);

  CuttingWish wish_;
  FindingLog& log_;
  Known known_;
  LoadBins bins_;
  std::int64_t next_ = 0;  ///< bin to be judged
  double t_s_ = -1, last_load_ = std::numeric_limits<double>::quiet_NaN();
  double rpm_ = std::numeric_limits<double>::quiet_NaN();
  double part_rpm_ = 0;  ///< where the source tells none
  int tool_ = -1;
  double tool_from_s_ = 0;   ///< the tool is steady
  double speed_from_s_ = 0;  ///< .. and the speed, of the bins that have been judged
  double settled_rpm_ = 0;   ///< the speed when it was another one last
  bool is_drifting_ = false;
  std::deque<double> last_rpm_;  ///< of the last bins, kSlowly_bins at most
  double still_load_ = 0, still_from_s_ = 0, still_s_ = 0, frozen_to_s_ = 0, still_cut_s_ = 0;
  double heard_s_ = 0;
  Stretch stretch_;
  int stretch_tool_ = 0;
  double idle_ = 0;  ///< of the last window
};

}  // namespace kerf
