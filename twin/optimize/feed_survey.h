// twin/optimize/feed_survey.h - of each feed move of a program how fast it may be: what a dry run
// tells while it cuts.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "twin/optimize/cut_limits.h"
#include "twin/process/engagement_log.h"
#include "twin/process/motion_recorder.h"

namespace kerf {

/// A motion at the rate of a feed.
struct SurveyedMotion {
  std::uint64_t number = 0;
  SourceRef source;
  Vec3 from_mm{0}, to_mm{0};
  double feed_mm_per_min = 0;  ///< programmed; 0: none is in force
  /// What the aims allow in the slowest of its places; infinity: nothing is limited.
  double limit_mm_per_min = std::numeric_limits<double>::infinity();
  double allowed_mm_per_min = std::numeric_limits<double>::infinity();  ///< by the axes
  double removed_mm3 = 0;
  double speed_mm_per_min = 0;  ///< that the machine reaches, no faster than its own feed
  std::size_t first_part = 0, parts = 0;
  MotionKind kind = MotionKind::kFeed;
  bool is_per_turn = false;  ///< G95
  bool is_measured = false;  ///< how its tool is engaged is known
  bool is_engaged = false;   ///< somewhere
  bool goes_down = false;    ///< steeply
};

/// A part of a motion on which the tool is engaged in one way.
struct SurveyedPart {
  double length_mm = 0;
  double limit_mm_per_min = std::numeric_limits<double>::infinity();
  /// Where the tool enters and where it leaves: from its beginning, and up to its end.
  double soft_front_mm = 0, soft_back_mm = 0;
  double soft_mm() const { return std::min(length_mm, soft_front_mm + soft_back_mm); }
  double section_mm2 = 0;  ///< across the way, at most
  float diameter_mm = 0;
  bool is_rounded = false;  ///< its tool: the section may be less
  bool is_engaged = false;
  bool is_fresh = false;  ///< the tool comes from a traverse, or is another one
};

/// The greatest of a load, at the speed that the machine reaches, and where.
struct PeakLoad {
  double most = 0;
  SourceRef at;
};

/// Listens to one run. About 150 bytes a feed move. One thread.
class FeedSurvey final : public MotionRecorder, public EngagementListener {
 public:
  /// Where a tool comes into material, and where it leaves it, for so much of its diameter of the
  /// way, it is given this part of what it may. A block that is not divided has it where it lies in
  /// there with half of its way in material.
  static constexpr double kSoftWay = 0.5, kSoftShare = 0.7, kSoftBlock = 0.5;
  /// What a rounded tool removes is added up over so much of its diameter of the way.
  static constexpr double kRateWay = 0.5;
  /// What goes down more steeply than this drills.
  static constexpr double kSteep_rad = 10 * kPi / 180;

  explicit FeedSurvey(const FeedAims& aims) : aims_(aims) {}

  void restart() override;
  void name_files(const std::vector<std::string>&) override {}
  void on_step(std::uint64_t number, const Motion& motion, const TimedStep& step) override;
  void on_cut(std::uint64_t number, double removed_mm3, double depth_mm) override;
  void on_mount(int tool, const Cutter& cutter) override;
  void on_part(const EngagementLook& look, double length_mm) override;
  void on_unmeasured(double length_mm) override;

  /// After the run, once: limits of motions, with entries and exits softened.
  void settle();

  const std::vector<SurveyedMotion>& motions() const { return motions_; }
  const std::vector<SurveyedPart>& parts() const { return parts_; }
  const PerLimit<PeakLoad>& peaks() const { return peaks_; }
  /// Of all motions, by tool.
  const std::map<int, double>& seconds_by_tool() const { return seconds_; }
  /// Tools that have cut whose teeth nobody has told, with their shapes.
  const std::map<int, std::string>& toothless() const { return toothless_; }
  /// The same of tools of which it is not known how far they stick out.
  const std::map<int, std::string>& unheld() const { return unheld_; }

 private:
  void soften();
  void limit_rates();
  void limit_rates(std::size_t from, std::size_t to, double share);

  FeedAims aims_;
  std::vector<SurveyedMotion> motions_;
  std::vector<SurveyedPart> parts_;
  PerLimit<PeakLoad> peaks_;
  std::map<int, double> seconds_;
  std::map<int, std::string> toothless_, unheld_;
  std::size_t cut_ = 0;  ///< motions before it have no more cuts to come
  // The tool and the present motion.
  std::optional<CutLimits> limits_;
  int tool_ = 0;
  std::string shape_;
  double diameter_mm_ = 0;
  double rpm_ = 0, speed_mm_per_min_ = 0;
  bool is_fresh_ = true, in_feed_ = false;
};

}  // namespace kerf
