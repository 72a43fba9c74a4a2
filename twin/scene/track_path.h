// twin/scene/track_path.h - the toolpath of a program as vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "twin/machine/motion_moves.h"
#include "twin/playback/packed_column.h"
#include "twin/playback/program_track.h"
#include "viewer/scene.h"

namespace kerf {

/// Made motion by motion, so that a long path can be handed over in parts. Arcs become chords that
/// leave them by 0.02 mm at most, but need not be shorter than a degree. A program with more than
/// kMaxVertices is shown up to there. A vertex says the number of its motion.
class TrackPath {
 public:
  static constexpr std::size_t kMaxVertices = 100'000'000;

  /// `planned`: the track is of the path that the machine runs; its feeds are drawn as that.
  /// `moves`: where the tip goes in the workpiece.
  explicit TrackPath(std::shared_ptr<const ProgramTrack> track, bool planned = false,
                     MotionMoves moves = {});

  /// The chunks of the next motions, about 16 chunks in all; empty at the end.
  std::vector<std::shared_ptr<const PathChunk>> next_chunks();
  bool complete() const { return next_motion_ >= track_->size() || vertices_ >= kMaxVertices; }

  /// Vertices that lie behind the tool at a place, as far as made.
  std::uint64_t past_vertices(const TrackPosition& place) const;

 private:
  void add(std::size_t motion);
  bool add_tilted(std::size_t motion, PathKind kind);
  void push(const Vec3& at, PathKind kind, std::size_t motion);

  std::shared_ptr<const ProgramTrack> track_;
  PathKind feed_kind_;
  MotionMoves moves_;
  std::vector<CutMove> divided_;
  std::size_t next_motion_ = 0;
  std::uint64_t vertices_ = 0;
  PackedColumn first_vertex_{PackedColumn::Of::kIntegers};  ///< by motion: those before are past
  std::shared_ptr<PathChunk> open_;
  std::vector<std::shared_ptr<const PathChunk>> made_;
};

}  // namespace kerf
