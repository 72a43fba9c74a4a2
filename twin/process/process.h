// twin/process/process.h - what a process (milling, torch, punch) makes of motions: the only seam
// between a process and who cuts, watches, looks ahead, plays and reports.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "interp_bridge/motion.h"
#include "interp_bridge/program.h"
#include "interp_bridge/torch_materials.h"
#include "stock/stock_model.h"
#include "twin/findings/finding.h"
#include "twin/job/tool_use.h"
#include "twin/job/tools.h"
#include "twin/machine/beam_settings.h"
#include "twin/machine/motion_moves.h"
#include "twin/machine/program_holds.h"
#include "twin/machine/punch_moves.h"
#include "twin/machine/timeline.h"
#include "twin/machine/turret.h"
#include "twin/process/check_options.h"
#include "twin/process/collision_table.h"
#include "twin/process/cut_labels.h"
#include "twin/process/cut_progress.h"
#include "twin/process/fallen_piece.h"
#include "twin/process/feed_check.h"
#include "twin/process/loose_piece.h"
#include "twin/process/motion_recorder.h"
#include "twin/process/sheet_checks.h"

namespace kerf {

class EngagementLog;
class KeptMoves;
class LoadListener;

/// What CutStage holds for its process, and keeps up to date. It outlives the process.
struct ProcessSite {
  StockModel& stock;
  ToolResolver& tools;
  FindingLog& log;
  FeedCheck feeds;
  CutProgress progress;
  MotionMoves moves;                    ///< as the model cuts
  bool limits_known = false;            ///< TimelineOptions
  CutLabels* labels = nullptr;          ///< CutStage::label_by()
  KeptMoves* kept = nullptr;            ///< CutStage::keep_moves()
  EngagementLog* engagement = nullptr;  ///< CutStage::log_engagement()
  LoadListener* loads = nullptr;        ///< CutStage::hear_loads()
  BlankKind blank = BlankKind::kUnjudged;
  bool timed = false;      ///< motions come with their times: CutStage::take_timed()
  bool watched = false;    ///< CutStage::watch_machine()
  bool holding = false;    ///< nothing is reported on yet
  bool cut_short = false;  ///< CutStage::cut_short()
  /// How the machine turns tool and workpiece, whatever the model takes; null: nobody has said.
  std::shared_ptr<const MachineKinematics> kinematics{};
  WorkpieceFrame frame{};                   ///< where the workpiece lies in the machine
  MotionRecorder* recorder = nullptr;       ///< CutStage::record_by()
  std::uint64_t motion = 0;                 ///< its number of the motion that is taken now
  std::optional<std::uint64_t> first_id{};  ///< CutStage::number_from()

  /// Of a motion, one of its moves has been cut.
  void note_cut(std::uint64_t number, double removed_mm3, double depth_mm) const {
    if (recorder) recorder->on_cut(number, removed_mm3, depth_mm);
  }
};

/// What a process has done, as its section of the report. Immutable.
class ProcessSums {
 public:
  virtual ~ProcessSums() = default;
  /// Keys that stand before those of the workpiece.
  virtual void add_json(nlohmann::ordered_json& out) const = 0;
  /// Lines for the page of text.
  virtual std::string text() const = 0;
  /// The same in a few words, for one of several runs.
  virtual std::string run_text() const = 0;
};

/// Of a process that strikes: what it takes of a machine that is watched, beyond whole motions.
class StrokeTaker {
 public:
  virtual ~StrokeTaker() = default;
  /// A motion that a machine is still on: what comes up to `share` of its way. Again with a greater
  /// share, or Process::take(), is the same motion. `seen` = false: nobody has seen the machine
  /// come so far; what holds the sheet goes along, nothing is struck.
  virtual void take_part(const Motion& motion, const TimedStep& step, double share, bool seen) = 0;
  /// Strokes that have been seen, and are no program's: `motion` says which tool, line and time.
  virtual void take_seen(const Motion& motion, const TimedStep& step,
                         std::span<const PunchHit> hits) = 0;
  /// The workpiece moves while the tool is down, of a machine without a program.
  virtual void note_dragging(const Motion& motion, const TimedStep& step) = 0;
};

/// Cuts the motions of one program out of one workpiece, looks for what can go wrong on the way,
/// and adds up. CutStage calls it. One thread.
class Process {
 public:
  virtual ~Process() = default;

  /// In program order, all motions. `path`: what the machine makes of it where it is planned, else
  /// empty.
  virtual void take(const Motion& motion, const TimedStep& step,
                    std::span<const PathPiece> path) = 0;
  /// The program is over, or stopped before its end (`whole` = false).
  virtual void finish(bool whole) = 0;
  /// Findings, tool uses and sums begin anew with the motion that is taken next.
  virtual void begin_reporting() = 0;
  /// What was taken has been given to the model, which may hold some back.
  virtual void hand_over() {}
  /// It is in the workpiece.
  virtual void complete() {}

  /// Goes on where another one of the same kind is, whose workpiece is the same.
  virtual void go_on_from(const Process& /*other*/) {}
  /// Of a torch program, all that the motions name from here on.
  virtual void set_materials(std::span<const TorchMaterial> /*materials*/) {}
  /// What its checks judge by. Before the first motion.
  virtual void check_by(const CheckOptions& /*options*/) {}
  /// Its searches end once that is requested. Before the first motion.
  virtual void stop_by(const std::stop_token& /*stop*/) {}

  virtual const std::vector<ToolUse>& tools() const = 0;
  /// How near bodies came to each other, as far as that was looked for.
  virtual std::vector<CollisionPair> collisions() const { return {}; }
  /// In the spindle, as far as it has been needed; null: none that is known. Until the next call.
  virtual const Cutter* cutter() const { return nullptr; }
  /// What comes of a probing move behind all that was taken.
  virtual ProbeAnswer answer(const ProbeQuestion& /*question*/) { return {}; }
  /// Pieces that have come free, by number; those that were cut up afterwards are in it still.
  virtual std::span<const FreedPiece> freed() const { return {}; }
  /// The same of a workpiece that turns, in the order in which they came off.
  virtual std::span<const FallenPiece> fallen() const { return {}; }
  /// The same of a workpiece that is milled, with what is held; empty: nothing has come free. After
  /// finish().
  virtual std::vector<LoosePiece> loose() const { return {}; }
  /// Null: it has no section of the report.
  virtual std::shared_ptr<const ProcessSums> sums() const { return nullptr; }
  /// Null: it cuts along ways.
  virtual StrokeTaker* strokes() { return nullptr; }
};

/// How a process goes about motions.
struct ProcessTraits {
  /// A, B and C turn tool or workpiece, and moves may lead where nobody knows; false: the process
  /// sees to both.
  bool turns = true;
  bool slides = true;  ///< U, V and W slide what the kinematics say
  /// Tips are where tools end; false: it goes through whatever the tool's length is, and motions
  /// are taken as programmed.
  bool by_length = true;
  bool follows_path = true;  ///< the path that the machine runs; false: what the program says
  /// A beam: through the workpiece at whatever height. Beside a machine it is on while the spindle
  /// turns as the source tells it; where nothing tells it, it is off.
  bool is_beam = false;
};

/// The tools of a program, for lists: asked motion by motion, without cutting. One thread.
class MotionTools {
 public:
  virtual ~MotionTools() = default;
  struct Tool {
    const ResolvedTool* tool = nullptr;      ///< null: none. Until the next call
    std::optional<std::string_view> name{};  ///< nothing: what the tool table says of it
  };
  /// In program order. `materials`: at least those that motions have named so far.
  virtual Tool of(const Motion& motion, std::span<const TorchMaterial> materials) = 0;
  /// Tools of one number and different shapes are different ones.
  virtual bool by_shape() const { return false; }
};

/// A process with its settings, for one job: chosen once (choose_process()), and handed to whoever
/// cuts, watches, plays. Immutable; any number of threads.
class ProcessPlan {
 public:
  virtual ~ProcessPlan() = default;
  virtual std::unique_ptr<Process> make(ProcessSite& site) const = 0;
  virtual std::unique_ptr<MotionTools> tools(const ToolSources& sources,
                                             ToolResolver::CutterCheck can_cut) const = 0;
  virtual ProcessTraits traits() const { return {}; }
  /// Where its machine stands; empty: nowhere beyond its program's words.
  virtual MakeHolds holds() const { return {}; }
  /// What motions are cut as, where those before count; null: MotionMoves knows.
  virtual std::shared_ptr<const OrderedMoves> moves() const { return nullptr; }
  /// What the user is told before it begins; may be empty.
  virtual std::string warning() const { return {}; }

  /// For views: null, there is none.
  virtual const BeamSettings* beam() const { return nullptr; }
  virtual TurretPointer turret() const { return nullptr; }
};
using ProcessPointer = std::shared_ptr<const ProcessPlan>;

/// What a process is chosen by.
struct ProcessWish {
  bool is_sheet = false;   ///< the workpiece
  bool is_turned = false;  ///< the workpiece: it turns, tools stand still
  bool guessed = false;    ///< the workpiece is a guess
  BeamOptions beam;
  TurretPointer turret;
  bool is_qtplasmac = false;
  bool has_program = true;  ///< false: a machine is watched without one
};

/// That of a workpiece of which nothing else is known: milling.
ProcessPointer default_process();

}  // namespace kerf
