// twin/playback/load_record.h - the loads of a program's cuts, over its time and by its motions.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "twin/playback/program_track.h"
#include "twin/process/load_curve.h"

namespace kerf {

/// Written by the thread that cuts a program for the first time, read by any, whole at any moment.
/// 4 bytes a motion and kind that there is.
class LoadRecord final : public LoadListener {
 public:
  explicit LoadRecord(std::shared_ptr<const ProgramTrack> track) : track_(std::move(track)) {}

  /// Counts for the motions in whose time it is. 0.2 us.
  void on_load(const CutLoad& load) override;
  void restart() override;

  LoadCurve curve() const;
  /// The greatest nominal value of each motion, 0 where there is none; empty: of none.
  std::vector<float> by_motion(LoadKind kind) const;

 private:
  void find_motions(const CutLoad& load);

  std::shared_ptr<const ProgramTrack> track_;
  std::size_t motion_ = 0;            ///< of the last load, of which the next one is not far
  std::vector<std::size_t> motions_;  ///< of the present load
  mutable std::mutex mutex_;          ///< of what follows
  LoadCurve curve_;
  std::array<std::vector<float>, kLoadKinds> of_motion_;
};

}  // namespace kerf
