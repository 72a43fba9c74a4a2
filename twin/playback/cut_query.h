// twin/playback/cut_query.h - which motion of a program made a point of the workpiece's surface.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "base/geometry.h"
#include "stock/cutter/cutter.h"
#include "twin/job/tools.h"
#include "twin/playback/program_track.h"

namespace kerf {

/// Looks for the last motion that touched a point, backwards from a place of the program. Immutable
/// once made: any number of threads may ask. Making it reads the whole track, about 0.3 us a
/// motion; it keeps a box for every kChunk motions, about 0.3 bytes a motion.
class CutQuery {
 public:
  static constexpr std::size_t kChunk = 256;

  /// `can_cut`: as the ToolResolver of the session that cuts it.
  CutQuery(std::shared_ptr<const ProgramTrack> track, ToolSources tools,
           ToolResolver::CutterCheck can_cut = nullptr);

  /// The motion that touched the point last, of those before `until` and the part of `until.motion`
  /// up to its fraction. Nothing: none did, the point is of the blank.
  ///
  /// A motion touches a point if a point at most `tolerance_mm` beside it and, by as much, above or
  /// below lies in what the cutter (and all above it: the Z-map is cleared upward) sweeps on the
  /// motion:
  ///
  ///     min over t of  tip(t).z + h(max(0, |point.xy - tip(t).xy| - tolerance)) <= point.z +
  ///     tolerance
  ///
  /// with h the height of the cutter's surface above its tip (Cutter::height_mm). To within 1 nm
  /// for straight moves of cutters with a convex profile, 1 um for all level moves; arcs that are
  /// not level, and sloping moves of other cutters, are searched at steps of a 50th of the cutter's
  /// radius and refined around the lowest.
  /// For the motion that gave a cell of a Z-map its height ask at the middle of the cell, with a
  /// tolerance of 1 um; a point picked on a drawn surface is off by a cell, and wants that
  /// tolerance. A later pass over the same path touches, too, though it removes nothing.
  ///
  /// Chunks whose boxes lie apart from the point cost nanoseconds.
  std::optional<std::size_t> last_cut_at(const Vec3& point_mm, double tolerance_mm,
                                         const TrackPosition& until) const;

  /// The cutter that makes a motion; null: it does not cut.
  const Cutter* cutter_at(std::size_t motion) const;

 private:
  /// From this motion on, until the next entry.
  struct Mount {
    std::size_t motion = 0;
    std::shared_ptr<const Cutter> cutter;  ///< null: nothing that is known
    double radius_mm = 0;
    bool convex = false;
  };
  /// Where the tip goes in kChunk motions that cut, and with how thick a cutter.
  struct Chunk {
    Box tip_mm;
    double radius_mm = 0;
  };
  /// What is asked for.
  struct Probe {
    Vec3 point_mm{0};
    double tolerance_mm = 0;
  };

  void add_mount(std::size_t motion, const ResolvedTool* tool);
  std::size_t mount_index(std::size_t motion) const;
  static bool may_touch(const Box& tip_mm, double radius_mm, const Probe& probe);
  static bool touches(const Motion& motion, const Mount& mount, const Probe& probe);

  std::shared_ptr<const ProgramTrack> track_;
  std::vector<Mount> mounts_;  ///< in order; the first one is of nothing, at motion 0
  std::vector<Chunk> chunks_;
};

}  // namespace kerf
