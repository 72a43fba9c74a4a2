// twin/scene/sheet_query.h - which motion of a program made a wall of a sheet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "twin/machine/punch_moves.h"
#include "twin/machine/torch_moves.h"
#include "twin/playback/player.h"
#include "twin/playback/program_track.h"

namespace kerf {

/// A sheet keeps no names of its cuts; where its walls come from follows from the program. Of a
/// torch a wall lies half a kerf beside the way of a motion that burns, or around the hole of a
/// pierce; of a punch it lies on the outline of a stroke. Immutable once made: any number of
/// threads may ask.
class SheetQuery {
 public:
  /// A point farther than this from every wall that the program has made, seen from above, belongs
  /// to none. So much an edge may be missed by that is clicked on the upper face.
  static constexpr double kReach_mm = 0.5;

  /// Reads the whole track, about 0.5 us a motion. Null: the program neither burns nor punches.
  static std::shared_ptr<const SheetQuery> of(const PlayerProgram& program);

  struct Wall {
    std::size_t motion = 0;
    std::string cutter;  ///< "kerf 1.4 (material 2 mild steel)", "square:10"
  };
  /// The nearest wall, of the motions before `until` and the part of `until.motion` up to its
  /// fraction; of several that are as near (the same contour twice) the first, which made it. Looks
  /// at every motion that cuts: about 0.3 us each.
  std::optional<Wall> wall_at(const Vec3& point_mm, const TrackPosition& until) const;

 private:
  /// A motion that burns.
  struct Burn {
    std::size_t motion = 0;
    float half_kerf_mm = 0;
    float half_hole_mm = 0;  ///< of the pierce at its start; 0: none
    std::uint32_t name = 0;
  };
  struct Nearest {
    double off_mm = kReach_mm;
    std::optional<Wall> wall;
    bool accepts(double candidate_mm) const;
  };

  explicit SheetQuery(std::shared_ptr<const ProgramTrack> track) : track_(std::move(track)) {}
  void find_burns(const PlayerProgram& program);
  void look_at_burns(const Vec2& point_mm, const TrackPosition& until, Nearest* nearest) const;
  void look_at_strokes(const Vec2& point_mm, const TrackPosition& until, Nearest* nearest) const;

  std::shared_ptr<const ProgramTrack> track_;
  std::vector<Burn> burns_;
  std::vector<std::string> names_;
  std::optional<PunchMoves> punch_;
};

}  // namespace kerf
