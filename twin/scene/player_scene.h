// twin/scene/player_scene.h - what a player has, as values of the viewer.
#pragma once

#include <chrono>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "twin/compare/design_part.h"
#include "twin/machines/machine_choice.h"
#include "twin/machines/machine_model.h"
#include "twin/playback/cut_query.h"
#include "twin/playback/load_program.h"
#include "twin/playback/player.h"
#include "twin/scene/body_watch.h"
#include "twin/scene/cut_colors.h"
#include "twin/scene/draw_feeder.h"
#include "twin/scene/patch_feeder.h"
#include "twin/scene/program_curves.h"
#include "twin/scene/punch_pose.h"
#include "twin/scene/sheet_query.h"
#include "twin/scene/track_path.h"
#include "twin/scene/turned_look.h"
#include "viewer/scene.h"
#include "viewer/viewer_command.h"

namespace kerf {

/// What is shown besides what is played.
struct ViewedProgram {
  std::string title;
  bool keeps_eye = false;          ///< see SceneSetup
  std::vector<std::string> files;  ///< paths, in the order of SourceRef::file
  std::vector<LineSegment> blank_outline;
  std::shared_ptr<const StockModel> blank;  ///< a snapshot; null: there is none
  std::string work_offset;                  ///< "G54"; empty: not known
  bool turns = false;                       ///< the workpiece is of the model turning
  bool planned = false;                     ///< the track is of the path that the machine runs
  MotionMoves moves;                        ///< where tool and tip are in the workpiece
  std::vector<NamedTool> tools;
  std::shared_ptr<const MachineModel> machine;  ///< null: none is drawn
  std::shared_ptr<const PunchPose> punch;       ///< of a sheet that is punched; null: it is not
  std::shared_ptr<const CutQuery> cuts;         ///< who cut a point; null: not told
  std::shared_ptr<const SheetQuery> walls;      ///< the same of a sheet; null: it is none
  std::shared_ptr<const DesignPart> design;     ///< the surface is compared with; null: with none
  double tolerance_mm = 0.05;                   ///< of that comparison
  CollisionWishes collisions;                   ///< fixtures and spindle, as they are checked
  CuttingWish cutting;                          ///< the material, and what is held against forces
  bool measures_loads = false;                  ///< the player says what cuts are like
};

/// Where the tool is in the workpiece.
ToolPose tool_pose_at(const MotionMoves& moves, const ProgramTrack& track,
                      const PlayerState& state);

/// The machine around it; see drawn_machine(). Null without a workpiece.
std::shared_ptr<const MachineModel> machine_around(const LoadedProgram& loaded,
                                                   const MachineChoice& choice,
                                                   const std::string& ini,
                                                   Diagnostics& diagnostics);

/// Of its machine, for Moment::link_poses. Empty: it cannot stand so. A lathe's turret holds a
/// drill, and whatever else is longer along Z than across it, at its end of greatest Z.
std::vector<glm::mat4> machine_poses_at(const ViewedProgram& shown, const ProgramTrack& track,
                                        const PlayerState& state, double tool_length_mm);

/// With `title` in the title bar.
ViewedProgram viewed_program(const LoadedProgram& loaded, std::string title);

/// Follows the states of one player and says what has changed for the picture. One thread.
class PlayerScene {
 public:
  using Clock = std::chrono::steady_clock;

  PlayerScene(std::shared_ptr<const ProgramTrack> track, ViewedProgram shown);

  /// What stays: setup, text, timeline. Clears what was shown before.
  SceneUpdate start(const PlayerState& state) const;

  /// Of a file and line as the window names them; nothing if there is no such file.
  std::optional<SourceRef> source_of(const std::string& file, int line) const;

  /// The path of a line's file.
  const std::string& file(const SourceRef& line) const { return shown_.files[line.file]; }

  void set_detail(const ViewDetail& detail, std::size_t easy_triangles = 0) {
    feeder_.set_detail(detail, easy_triangles);
  }
  /// Patches are made for the mesh alone; the answer is in the next update.
  void set_draw_mode(DrawMode draw_mode) { draw_modes_.choose(draw_mode); }
  /// What the player does not know: speed asked for, breakpoints of the user.
  void set_controls(double speed, std::vector<SourceRef> breakpoints);
  /// Of the player, where cuts are measured: before the first curves and colours.
  void show_loads(std::shared_ptr<const LoadRecord> loads);
  void set_colors(const ColorCommand& command, const std::vector<float>& removed_mm3);
  /// Curves of what has been checked are due.
  bool wants_curves(const PlayerState& state) const {
    return curves_.wants(state.motions_checked, Clock::now());
  }
  /// Within a few milliseconds; what is new is in the next update, with colours that go by what has
  /// been cut. `removed_mm3`: by motion.
  void add_curves(const PlayerState& state, const std::vector<float>& removed_mm3);
  /// Which motion made this point of the surface; the answer is in the next update.
  void pick(const Vec3& point_mm, const PlayerState& state);

  /// What is new in `state`; patches made until `deadline` at most, the rest with the next call.
  /// Empty (is_empty()) if there is nothing.
  SceneUpdate update(const std::shared_ptr<const PlayerState>& state, Clock::time_point deadline);
  static bool is_empty(const SceneUpdate& update);
  /// There is more to come without a new state.
  bool behind() const {
    return (draws_mesh() && feeder_.behind()) || !path_.complete() || curves_.is_in_hand();
  }

 private:
  bool draws_mesh() const { return draw_modes_.drawn() == DrawMode::kMesh; }
  void find_cut(const Vec3& point_mm, const PlayerState& state, PickedPoint& picked) const;
  ToolPose tool_pose(const PlayerState& state) const;
  std::shared_ptr<const Moment> moment_of(const PlayerState& state);
  void color_again(const std::vector<float>& removed_mm3);
  bool is_removed_due(const PlayerState& state) const;
  double removed_mm3(const PlayerState& state);

  std::shared_ptr<const ProgramTrack> track_;
  ViewedProgram shown_;
  PatchFeeder feeder_;
  DrawFeeder draw_modes_;
  BodyWatch bodies_;
  TrackPath path_;
  CurveMaker curves_;
  DiameterMode diameters_;
  double speed_ = 1;
  std::vector<SourceRef> breakpoints_;
  bool has_rotary_ = false;
  bool has_slides_ = false;  ///< U, V, W have moved
  bool moment_stale_ = true;
  SceneUpdate waiting_;  ///< answers, for the next update
  std::shared_ptr<const PlayerState> state_;
  std::uint64_t shown_stock_ = 0;
  double tool_length_mm_ = 0;
  double removed_mm3_ = 0;
  std::uint64_t removed_stock_ = 0;
  std::shared_ptr<const LoadRecord> loads_;  ///< null: none
  ColorCommand colors_;                      ///< asked for last
  Clock::time_point colored_at_{};
  Clock::time_point removed_due_{};
  /// Kept, so that a new one cannot have the address of one that was shown.
  std::shared_ptr<const std::vector<Finding>> shown_findings_;
};

}  // namespace kerf
