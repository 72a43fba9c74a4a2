// twin/scene/program_curves.h - what a program does over its time, for the curves of the window.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "twin/playback/cut_query.h"
#include "twin/playback/load_record.h"
#include "twin/playback/program_track.h"
#include "twin/process/cutting_wish.h"
#include "twin/process/run_curve.h"
#include "twin/scene/cut_colors.h"
#include "viewer/scene.h"

namespace kerf {

/// Adds up a program's motions as it is cut for the first time. What motions remove may be told a
/// little later than they are checked: when all have been, they are added up once more. About 1 us
/// a motion. One thread.
class CurveMaker {
 public:
  using Clock = std::chrono::steady_clock;
  /// Curves come no more often, but for the last.
  static constexpr std::chrono::milliseconds kPeriod{500};

  /// `cuts`: knows cutters by motion; null: no feeds per tooth.
  CurveMaker(std::shared_ptr<const ProgramTrack> track, const std::vector<NamedTool>& tools,
             std::shared_ptr<const CutQuery> cuts);

  /// There is more to be added up than was, and it is time for it.
  bool wants(std::size_t motions_checked, Clock::time_point now) const;
  /// The curves have what cuts were like, from now on. `wish`: what is held against them.
  void show_loads(std::shared_ptr<const LoadRecord> loads, const CuttingWish& wish) {
    loads_ = std::move(loads);
    wish_ = wish;
  }
  /// Goes on until `deadline`, or all that has been checked is in it; null: not yet. `removed_mm3`:
  /// by motion.
  std::shared_ptr<const ProgramCurves> make(std::size_t motions_checked,
                                            const std::vector<float>& removed_mm3,
                                            Clock::time_point deadline);
  /// All is being added up once more: make() is to be called soon.
  bool is_in_hand() const { return is_last_ && !is_complete(); }
  /// The program is in it as a whole.
  bool is_complete() const { return is_last_ && next_ == track_->size(); }

 private:
  void add(std::size_t motion, double removed_mm3);
  std::uint32_t color_at(double time_s);
  std::shared_ptr<const ProgramCurves> curves();
  void add_loads(ProgramCurves& curves) const;

  std::shared_ptr<const ProgramTrack> track_;
  std::shared_ptr<const CutQuery> cuts_;
  std::shared_ptr<const LoadRecord> loads_;  ///< null: none
  CuttingWish wish_;
  std::vector<NamedTool> tools_;
  /// All motions; and of feed moves that removed something by a tool of known teeth, the turns of
  /// each tooth.
  RunCurve all_, teeth_;
  std::size_t next_ = 0;
  bool is_last_ = false;
  Clock::time_point made_at_{};
};

}  // namespace kerf
