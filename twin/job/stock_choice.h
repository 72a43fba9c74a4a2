// twin/job/stock_choice.h - the workpiece models there are, and which one a program needs.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/translate.h"
#include "stock/blank.h"
#include "stock/octree/kernel_choice.h"
#include "stock/stock_model.h"
#include "stock/zmap/zmap_kernel.h"
#include "twin/job/tools.h"
#include "twin/machine/motion_moves.h"

namespace kerf {

enum class StockKind { kZmap, kMmap, kOctree, kSheet, kTurning };

/// How a workpiece is modelled.
struct StockSettings {
  std::optional<StockKind> kind;  ///< of --model; absent: what tools and motions need
  double cell_mm = 0;             ///< 0: what suits the blank (and of heights, the finest tool)
  int threads = 1;                ///< cutting threads
  ZMapKernel kernel = ZMapKernel::kAuto;
  /// StockModel::keep_cut_ids() will be asked for: models of heights make room at once.
  bool keeps_cut_ids = false;
  /// What comes after the program needs an octree: "setup 3 lays it on its side". Counts where
  /// nothing else is asked for and nothing turns; empty: nothing does.
  std::string later_need;
  bool additive = false;  ///< material is added along the path, within the blank's box; octree only
};

/// A row of `kerf models`.
struct StockModelRow {
  StockKind kind;
  std::string_view name;  ///< as --model takes it
  const char* purpose;    ///< one line; tr() shows it
  /// Null, or the message says why it cannot be made: StockModel's create().
  Result<std::unique_ptr<StockModel>> (*create)(const Blank& blank, const StockSettings& settings);
  Done (*can_cut)(const Cutter& cutter);
  bool takes_tilted_tools;
};

/// In the order of what they hold: each holds what those before it do. Two stand apart, at the end:
/// the sheet is for sheets alone, and sheets are for it alone; turning is for what turns.
std::span<const StockModelRow> stock_models();
const StockModelRow& stock_model(StockKind kind);
/// An octree's plain kernel is that for SSE2 and NEON, too; its "auto" may take one more (AVX-512).
octree::KernelChoice octree_kernel(ZMapKernel kernel);
/// Least of the usual cells that gives the surface of a box at most a million of them.
double octree_cell_mm(const Box& box);
/// A workpiece that turns, as the model turning has it: driven tools may mill it. `settings`: its
/// threads. Error: that of `turned`, or why it cannot be milled.
Result<std::unique_ptr<StockModel>> with_milling(Result<std::unique_ptr<TurningStock>> turned,
                                                 const StockSettings& settings);
/// The same of a file: a part that was turned, milled or not (is_milled_part()).
Result<std::unique_ptr<StockModel>> load_turned(const std::string& path,
                                                const StockSettings& settings);
/// Which of them this is, whoever wraps it.
const StockModelRow& row_of(const StockModel& stock);
/// Of that name, or null.
const StockModelRow* find_stock_model(std::string_view name);
/// Whether the model that was asked for (none: any but the sheet) can cut with it, or why not.
Done can_be_cut(std::optional<StockKind> kind, const Cutter& cutter);
/// "zmap, mmap, octree, sheet, auto"
std::string stock_model_names();

/// Why a model that holds less does not do; empty: it does.
struct StockNeeds {
  std::string turning;   ///< what says that the workpiece turns, and tools stand still
  std::string undercut;  ///< "tool 3 (tslot:20:4:8) cuts undercuts"
  std::string tilt;      ///< "line 12 turns the tool or the workpiece: A30"
  std::string blank;     ///< "the blank has a cylinder along x"
  double finest_mm = 0;  ///< cells of heights had better be no larger; 0: any will do
};

/// Looks for the first motion that needs a model for tilted tools.
class TiltWatch {
 public:
  /// `machine` null: nothing tilts.
  explicit TiltWatch(std::shared_ptr<const MachineKinematics> machine)
      : machine_(std::move(machine)) {}

  /// In program order, with the frame in force. Nothing once one has been found.
  void look_at(std::span<const Motion> motions, const WorkpieceFrame& frame);
  /// "line 12 turns A to 30"; empty: none yet.
  const std::string& found() const { return found_; }
  const MotionMoves& moves() const { return moves_; }

 private:
  std::shared_ptr<const MachineKinematics> machine_;
  MotionMoves moves_;
  std::string found_;
};

/// What the tools that are known before the program runs ask for. The finest of them counts only
/// where somebody names it for this program: a table has tools that are not used.
StockNeeds stock_needs(const ToolSources& tools);
/// Of a saved workpiece, by the head of its file; of one that has none, loading says what is wrong.
StockKind saved_kind(const std::string& path);
/// A saved octree that has been turned as well: a lathe can go on with it.
bool is_milled_part(const std::string& path);
/// Of sheet metal, new or saved. Reads the head of a saved one.
bool is_sheet(const Blank& blank);
/// Whether a lathe may hold it: a saved part that turns, or a blank of bodies that stand on the
/// axis. Reads the head of a saved one.
bool may_be_turned(const Blank& blank);
/// Why the model that was asked for is not for this blank; empty: it is, or none was asked for.
std::string misfit(const StockSettings& settings, const Blank& blank);
/// What only the octree holds of a blank; empty: nothing.
std::string need_of_blank(const Blank& blank);

/// The simplest model that holds what is needed, or the one that was asked for.
struct StockChoice {
  StockKind kind = StockKind::kZmap;
  std::string reason;    ///< for the report; empty if it was asked for, or if the simplest will do
  double finest_mm = 0;  ///< StockNeeds::finest_mm
};
StockChoice choose_stock(const StockSettings& settings, const StockNeeds& needs);

}  // namespace kerf
