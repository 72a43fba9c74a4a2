// twin/process/milling/engaged_parts.h - holds what looks say of the parts of feed moves against
// what these moves have removed, before it counts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "twin/process/engagement_log.h"
#include "twin/process/load_listener.h"
#include "twin/process/milling/cut_loads.h"
#include "twin/process/motion_recorder.h"

namespace kerf {

/// One look may stand for several moves, and ahead of a tool there may be a wall that it does not
/// reach. What a move has removed, which is known later, is the least doubtful:
///  - parts that were seen in the air and have removed more than a skin are not measured;
///  - parts that were seen in material and have removed nothing are in the air; but where removal
///    begins, as far before it as the tool's front reaches, they are not: where moves are cut
///    together, it counts for that one under whose middle it lies.
/// Passes what then holds on to CutLoads and to the recorder, in order, and corrects the log, which
/// knows the looks alone. One thread.
class EngagedParts {
 public:
  explicit EngagedParts(CutLoads& loads) : loads_(loads) {}
  /// Each may be null, and outlives this.
  void set(EngagementLog* log, LoadListener* listener, MotionRecorder* recorder = nullptr) {
    log_ = log, listener_ = listener, recorder_ = recorder;
  }

  /// A part as it was seen.
  void hear(const CutLoads::Part& part);
  std::size_t heard() const { return heard_; }
  /// For how far before the next removal it begins (Done::front_mm).
  bool is_waiting() const { return doubtful_ > 0; }

  /// A move, in the order of their parts.
  struct Done {
    std::size_t parts = 0;  ///< of those that were heard; none: nobody has looked at it
    bool is_whole = false;  ///< all that its motion removes, it has removed
    /// False: what is told of it is told now, beside a machine; long parts alone are judged.
    bool may_wait = true;
    std::uint64_t motion = 0;  ///< ProcessSite::motion; they do not fall
    std::uint32_t pass = EngagementLog::kNoPass;
    double removed_mm3 = 0, depth_mm = 0;
    double front_mm = 0;  ///< how far before its middle the tool meets what it has removed
    double reach_mm = 0;  ///< .. and at most
    double cell_mm = 0;
  };
  void judge(const Done& move);
  /// The tool goes elsewhere, or the program is over.
  void end_way() { settle(0); }
  void forget();

 private:
  struct Heard {
    CutLoads::Part part;
    std::uint32_t pass = EngagementLog::kNoPass;
    std::uint64_t motion = 0;
  };
  void judge_parts(const Done& move);
  void tell(const Heard& heard) const;
  void tell_until(std::uint64_t motion) const;
  void settle(double within_mm);
  void settle_first(bool cuts);
  void take_as_air(Heard& heard);
  void take_out();

  CutLoads& loads_;
  EngagementLog* log_ = nullptr;
  LoadListener* listener_ = nullptr;
  MotionRecorder* recorder_ = nullptr;
  /// Not judged yet, from begin_ on. The first of them, doubtful_, wait for what comes after them.
  std::vector<Heard> queue_;
  std::size_t begin_ = 0, doubtful_ = 0, heard_ = 0;
  double doubtful_mm_ = 0;  ///< their way
};

}  // namespace kerf
