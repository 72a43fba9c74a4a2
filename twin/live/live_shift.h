// twin/live/live_shift.h - a machine through a shift: its programs run, end, are aborted and begun
// again, on one blank or on one after the other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "machine_io/position_source.h"
#include "stock/stock_model.h"
#include "twin/findings/finding.h"
#include "twin/job/tools.h"
#include "twin/live/live_cutter.h"
#include "twin/process/cut_labels.h"
#include "twin/report/live_run.h"

namespace kerf {

/// Where the machine stands when it begins a program: InterpreterSetup::start. Nothing: not known.
using ProgramStart = std::optional<std::array<double, 9>>;

/// A program that the machine may run.
struct ShiftProgram {
  std::string path;
  /// Once more, from its beginning; null if that fails. May be empty: it is read but once, and a
  /// second run of it is not recognised (standard input).
  std::function<std::unique_ptr<Program>(const ProgramStart&)> open;
};

struct ShiftOptions {
  LiveCutOptions cutting;
  std::vector<ShiftProgram> programs;  ///< the first one is the one that is followed at once
  OnProgramEnd on_end = OnProgramEnd::kKeep;
  double density_kg_per_m3 = 7850;  ///< of a sheet, for the weight of its parts
};

/// A chain of LiveCutters, one a run.
///
/// Where the source tells whether a program runs (AxisSample::program), each start of one is a new
/// run. Else a machine that has been at the end of its program, or has stood (line 0) or gone back
/// in its lines, and is then not on the path, is in doubt: scouts follow each program from its
/// beginning, each with a copy of the workpiece, beside the run as it was. Whose path the machine
/// is on for kSure_mm, while the others are off theirs, has been right; the others, and what they
/// have cut and found meanwhile, are forgotten. So a run that goes on is never cut short by a dwell
/// or a loop: as long as it is on its path there are no scouts. Where there are several programs
/// their scouts find out in the same way which of them a new run is.
///
/// A program is read from where the machine stood before it began: what is relative (G91), or goes
/// back to where it began (G98), depends on it.
///
/// One thread. Deterministic as LiveCutter is.
class LiveShift {
 public:
  static constexpr double kSure_mm = 2.0;

  /// `first`: options.programs[0], opened; null: no program. `log`: that of the whole watch, to
  /// which each run's findings are added when it is over. The references outlive the shift.
  LiveShift(std::unique_ptr<StockModel> stock, const ToolSources& tools, FindingLog& log,
            ShiftOptions options, std::unique_ptr<Program> first);
  ~LiveShift();

  /// As LiveCutter::label_by().
  void label_by(CutLabels& labels);
  /// As LiveCutter has them.
  void take(const AxisSample& sample, double t_s, bool lost);
  void look() { current().look(); }
  void hand_over() { current().hand_over(); }
  void finish();
  std::vector<AheadWarning> take_warnings() { return current().take_warnings(); }

  /// Of the run that is shown. Another one after a take() that began one.
  const LiveCutter& cutter() const { return *run_.cutter; }
  StockModel& stock() { return *stock_; }
  const StockModel& stock() const { return *stock_; }
  /// Number of the program that it follows, of ShiftOptions::programs.
  std::size_t program() const { return run_.program; }

  /// Findings since the last call, those of a run that may turn out to be none excepted, with the
  /// files of their program.
  struct Told {
    Finding finding;
    std::vector<std::string> files;
  };
  std::vector<Told> take_findings();

  /// The present run, its end and digest left open.
  LiveRun present() const;
  /// Those that are over; all of them after finish().
  const std::vector<LiveRun>& past() const { return past_; }
  /// In all.
  LiveFacts facts() const;
  /// By tool, in the order of their first use, in all.
  std::vector<ToolUse> tools() const;

 private:
  struct Run {
    std::unique_ptr<StockModel> stock;  ///< of a scout: its own
    std::unique_ptr<FindingLog> log;
    std::unique_ptr<LiveCutter> cutter;
    std::size_t program = 0;
    ProgramStart opened;  ///< the start from which its program was read
    std::uint32_t part = 1;
    double begin_s = 0;
    std::optional<double> end_s;
    bool finished = false;
  };
  /// What is left of run_ if a scout is right: all until there were scouts.
  struct Before {
    std::size_t findings = 0;
    LiveFacts facts;
    std::vector<ToolUse> tools;
    std::optional<SheetReport> sheet;
    double program_s = 0;
    std::uint32_t line = 0;
    bool finished = false;
  };
  LiveCutter& current() { return *run_.cutter; }
  Run make_run(std::size_t program, StockModel& stock, std::unique_ptr<Program> opened);
  std::unique_ptr<Program> open(std::size_t program) const;
  bool can_begin() const;
  void see_start(const AxisSample& sample);
  bool stands(const AxisSample& sample) const;
  void read_from_start(Run& run);
  std::function<std::unique_ptr<Program>()> reopen(std::size_t program) const;
  void see_state(const AxisSample& sample, double t_s);
  void see_line(const AxisSample& sample, double t_s);
  void end_run(double t_s);
  void begin_next();
  void begin_scouts();
  void drop_scouts();
  void decide();
  std::optional<std::size_t> best_scout() const;
  void promote(std::size_t scout);
  void close_run();
  LiveRun record() const;
  std::vector<std::string> files() const;
  Before now() const;
  std::optional<SheetReport> sheet_now() const;
  double way_of(const Run& run) const { return run.cutter->facts().path_mm; }

  const ToolSources& tools_;
  FindingLog& log_;
  ShiftOptions options_;
  std::unique_ptr<StockModel> stock_;
  std::unique_ptr<StockModel> blank_;  ///< as it was given, if more than one may be needed
  CutLabels* labels_ = nullptr;
  Run run_;
  std::vector<Run> scouts_;
  std::optional<Before> before_scouts_;
  std::unique_ptr<StockModel> stock_before_;  ///< the workpiece then
  std::optional<double> regained_s_;  ///< program time where run_ was first on its path again
  std::vector<LiveRun> past_;
  std::vector<ToolUse> past_tools_;
  std::vector<Told> told_;                               ///< of runs that are over
  std::size_t told_count_ = 0;                           ///< of the present run's findings
  std::optional<std::pair<AxisSample, double>> before_;  ///< the last sample, and its time
  ProgramStart start_;                                   ///< where the machine stood last
  ProgramStart opened_;  ///< the start of the first run's program, as it was opened
  bool was_idle_ = false;
  ProgramState state_ = ProgramState::kUnknown;
  bool rested_ = false;                ///< the machine has stood since it was on the path
  std::optional<double> off_since_s_;  ///< it is not on the path
  std::uint32_t last_line_ = 0;        ///< of the program, where it was last on the path
  double scouts_from_s_ = 0;           ///< not earlier than this
  bool scouts_wrong_ = false;          ///< they have been, since the machine was last on the path
  double t_s_ = 0;
  bool over_ = false;  ///< finish() has been called
};

}  // namespace kerf
