// twin/scene/draw_feeder.h - what the window needs to draw the workpiece by rays or by CSG.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "stock/stock_model.h"
#include "twin/playback/cut_query.h"
#include "twin/playback/program_track.h"
#include "twin/scene/frame_moves.h"
#include "viewer/csg/cut_moves.h"
#include "viewer/scene.h"

namespace kerf {

/// Heights of the workpiece for rays, moves of the program for CSG, and the words for what cannot
/// be: whoever asks for a draw mode gets an answer with the next update, and a new one when it
/// changes. One thread.
///
/// CSG has no stock model to begin with in the middle of a program. It begins with the blank, so
/// all moves up to a place are subtracted as long as they are no more than kMostMoves, chords of
/// arcs counted one by one; beyond that the newest of them are, and the answer says from which line
/// on. The older half goes when they have become too many.
class DrawFeeder {
 public:
  /// What one picture of the window can have, for an eye that moves: see CsgView.
  static constexpr std::size_t kMostMoves = 1000;

  /// For the player of a program.
  struct Program {
    std::shared_ptr<const ProgramTrack> track;
    std::shared_ptr<const CutQuery> cuts;     ///< null: it cuts nothing
    std::shared_ptr<const StockModel> blank;  ///< a snapshot; null: there is none
    bool is_tilted = false;    ///< tools are not upright in the workpiece, or it turns
    bool is_compared = false;  ///< with a design part
  };
  /// For a machine that is watched: rays alone.
  DrawFeeder() = default;
  explicit DrawFeeder(Program program) : program_(std::move(program)) {}

  void choose(DrawMode draw_mode);
  /// The draw mode that is drawn with what update() hands out is this one.
  DrawMode drawn() const { return answer_.is_drawn() ? answer_.draw_mode : DrawMode::kMesh; }

  /// News of the chosen draw mode, if there are any. `stock`: a snapshot of the workpiece as it is
  /// at that place, or null. The first one after CSG was chosen reads the whole track, about 0.5 us
  /// a motion.
  void update(const std::shared_ptr<const StockModel>& stock, const TrackPosition& place,
              SceneUpdate* update);

 private:
  DrawAnswer find_heights(const std::shared_ptr<const StockModel>& stock, SceneUpdate* update);
  DrawAnswer find_moves(const TrackPosition& place, SceneUpdate* update);
  DrawAnswer begin_csg();
  std::vector<SweptMove> moves_of(std::size_t motion) const;
  void collect(std::size_t motion, std::size_t most);
  void go_to(const TrackPosition& place);

  std::optional<Program> program_;
  DrawAnswer answer_;
  bool is_answer_due_ = false;
  std::shared_ptr<const StockModel> heights_of_;  ///< handed out last

  std::optional<DrawAnswer> csg_answer_;  ///< whether it can be; found out once
  std::unique_ptr<FrameMoves> frame_moves_;
  CutMoves shown_;
  std::size_t whole_ = 0;               ///< moves in it of motions before place_.motion
  std::size_t first_motion_ = 0;        ///< in it; those before it that cut are left out
  std::optional<TrackPosition> place_;  ///< it goes up to here
};

}  // namespace kerf
