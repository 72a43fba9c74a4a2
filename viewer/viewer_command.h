// viewer/viewer_command.h - what the user asks for, as values.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/geometry.h"
#include "viewer/scene.h"
#include "viewer/view_detail.h"

namespace kerf {

struct PlayCommand {};
struct PauseCommand {};
struct StopCommand {};  ///< Back to the first block, paused.
struct SpeedCommand {
  double factor = 1.0;  ///< kMinSpeed .. kMaxSpeed
};
struct StepBlockCommand {
  int blocks = 1;  ///< Forward, or back if negative.
};
/// The beginning of the first motion of a line. As fast as possible, exactly as if it had been cut
/// from the start.
struct SeekLineCommand {
  std::string file;  ///< As in ProgramText; empty: the main program.
  int line = 1;
};
/// As fast as it can be cut to the next time that the line comes, showing what is passed.
struct RunToLineCommand {
  std::string file;
  int line = 1;
};
struct SeekTimeCommand {
  double time_s = 0.0;
};
struct SeekEndCommand {};
struct NextToolCommand {
  int step = 1;  ///< -1: the one before
};
struct NextFindingCommand {
  int step = 1;
};
struct SeekFindingCommand {
  int index = 0;  ///< Into FindingList::findings.
};
struct BreakpointCommand {
  std::string file;
  int line = 1;
  bool set = true;
};
/// The camera moved: how much of the workpiece a pixel shows (two pixels, where the processor
/// draws). Sent when it changes by a factor of two somewhere; patches much finer than this need not
/// be made.
struct DetailCommand {
  ViewDetail detail;
  /// Of what changes in a frame, so many are drawn with ease; 0: any number.
  std::size_t easy_triangles = 0;
};
/// Colours other than ColorBy::kPlain and kHeight are made by the owner of the workpiece.
struct ColorCommand {
  ColorBy mode = ColorBy::kPlain;
  int first_line = 0;  ///< Of the main program, for kLineRange.
  int last_line = 0;
};
/// In which draw mode the workpiece is to be drawn: its values are wanted from now on. The answer
/// is SceneUpdate::draw_mode.
struct DrawModeCommand {
  DrawMode draw_mode = DrawMode::kMesh;
};
/// Who cut this point of the surface last.
struct PickCommand {
  Vec3 point_mm{0.0};
};
/// What a start of the machine at that line of the main program would miss and meet. The answer is
/// SceneUpdate::entry.
struct EntryCommand {
  int line = 1;
};
/// Another program instead of this one, or a log to be replayed.
struct OpenCommand {
  std::string path;
};
/// The same program, cut otherwise: ViewedJob's fields as the user left them.
struct JobCommand {
  std::string stock, cell, model;
  std::vector<std::pair<int, std::string>> tools;  ///< number and SHAPE text, those that are given
  std::vector<std::string> fixtures{};             ///< those that are given
};
/// Another setup of the part: ViewedJob::setups. To a later one, what those before it leave is cut
/// first.
struct SetupCommand {
  std::size_t setup = 0;
};
/// The same program once more: its findings are to be told in another language.
struct ReadAgainCommand {};
struct CloseCommand {};  ///< The window was closed; the last command that comes.

using ViewerCommand =
    std::variant<PlayCommand, PauseCommand, StopCommand, SpeedCommand, StepBlockCommand,
                 SeekLineCommand, RunToLineCommand, SeekTimeCommand, SeekEndCommand,
                 NextToolCommand, NextFindingCommand, SeekFindingCommand, BreakpointCommand,
                 DetailCommand, ColorCommand, DrawModeCommand, PickCommand, EntryCommand,
                 OpenCommand, JobCommand, SetupCommand, ReadAgainCommand, CloseCommand>;

inline constexpr double kMinSpeed = 0.1;
inline constexpr double kMaxSpeed = 1000.0;

/// From the window's thread to the owner's. A later SpeedCommand, SeekTimeCommand or DetailCommand
/// replaces one that is last in the queue (a dragged slider makes many); nothing else is dropped.
class CommandQueue {
 public:
  void push(ViewerCommand command);
  /// In order; empty if there is nothing.
  std::vector<ViewerCommand> take();
  /// Waits until there is something or the time is over.
  std::vector<ViewerCommand> wait_for(std::chrono::milliseconds longest);

 private:
  std::mutex mutex_;
  std::condition_variable filled_;
  std::vector<ViewerCommand> commands_;
};

}  // namespace kerf
