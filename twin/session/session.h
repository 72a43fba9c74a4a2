// twin/session/session.h - one dry run: a program, a blank, tools; in the end a workpiece and a
// report.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "interp_bridge/program.h"
#include "stock/stock_model.h"
#include "twin/findings/outcome.h"
#include "twin/guess/program_survey.h"
#include "twin/machine/kinematics/switched_motions.h"
#include "twin/process/cut_labels.h"
#include "twin/process/cut_stage.h"
#include "twin/process/engagement_log.h"
#include "twin/process/kept_moves.h"
#include "twin/process/load_listener.h"
#include "twin/program/material_handover.h"
#include "twin/program/program_front.h"
#include "twin/report/line_window.h"
#include "twin/report/report.h"

namespace kerf {

/// What a session tells while it runs, for windows and tests. Every call comes from the thread in
/// Session::run(), in program order; the workpiece may be looked at during the call only (after a
/// `snapshot()` at any time).
class SessionObserver {
 public:
  virtual ~SessionObserver() = default;
  /// The blank is there, nothing is cut yet. Comes a second time if the program turns out to need
  /// another model, and everything begins again.
  virtual void on_start(const StockModel& stock) = 0;
  /// These motions have been taken; `end_s` is the program time up to which the workpiece is cut
  /// (the times of the last motions, and so their cuts, wait for what follows). The last call
  /// brings no motions: everything is cut.
  virtual void on_cut(const StockModel& stock, std::span<const Motion> motions, double end_s) = 0;
  /// The files that sources of motions name by their numbers, before the first motion that does;
  /// whenever there are more.
  virtual void on_files(std::span<const std::string> files) { static_cast<void>(files); }
  /// Asked before each on_cut(): of so many motions it is to be told at most, at least 1. Few cost
  /// time.
  virtual std::size_t most_motions() const { return std::numeric_limits<std::size_t>::max(); }
};

/// Runs a program through a Z-map. Two threads: one reads the interpreter, the caller's cuts;
/// between them is a bounded queue, so that memory does not grow with the program and the slower
/// side sets the pace. Without a blank (and where a tool turns up that is not known) the program is
/// looked at beforehand for what fits it (twin/guess/), and the motions are needed twice. The first
/// kMaxKeptMotions are kept (100 MB); a longer file is interpreted a second time, a longer stdin is
/// an error that asks for --stock.
class Session {
 public:
  static constexpr std::size_t kMaxKeptMotions = 500'000;

  /// Checks everything that can be checked before the program is interpreted: files, comments, tool
  /// table, blank, cell size, memory. Null on error, with diagnostics, and `outcome` says of which
  /// kind.
  static std::unique_ptr<Session> open(SessionOptions options, Diagnostics& diagnostics,
                                       Outcome& outcome);
  ~Session();

  void set_observer(SessionObserver* observer) { observer_ = observer; }
  /// Hears of each motion that is reported on. Before run(); outlives the session.
  void record_by(MotionRecorder& recorder) { recorders_.add(recorder); }
  /// Before run(): the workpiece remembers which move made its surface (StockModel::cut_id_at()),
  /// by numbers of cut_labels(). Costs memory and time. Of sheets there are none.
  void keep_cut_labels() { labels_.emplace(); }
  const CutLabels* cut_labels() const { return labels_ ? &*labels_ : nullptr; }
  /// Before run(): the moves that cut are kept, about 100 bytes each, with the labels.
  void keep_moves() {
    keep_cut_labels();
    kept_moves_.emplace();
  }
  /// Before run(): how the tools are engaged is measured, for Report::engagement.
  void log_engagement(bool with_map) { engagement_.emplace(with_map); }
  /// The same, and each part of the feed moves is told to one who outlives the session.
  /// With log_engagement(), before run(): it is told what the cuts of milling tools are like.
  void hear_loads(LoadListener& listener) { load_listener_ = &listener; }
  void log_engagement(EngagementListener& listener) {
    engagement_.emplace(false);
    engagement_->tell(listener);
  }
  const KeptMoves* kept_moves() const { return kept_moves_ ? &*kept_moves_ : nullptr; }

  /// What would be found if these moves, all rapid, were made over the workpiece as it is now:
  /// errors and warnings. Nothing is cut. There is a blank.
  std::vector<Finding> try_moves(std::span<const Motion> moves) const;

  /// Call once. Errors about the program are findings of the report; `diagnostics` gets those that
  /// leave nothing to report on (the guessed blank does not fit the memory, a stdin too long to
  /// keep).
  Outcome run(std::stop_token stop, Diagnostics& diagnostics);

  /// 0..1, or < 0 if not known; any thread.
  double progress() const;
  /// True while an interpreter process may be alive; any thread.
  bool interpreting() const { return interpreting_; }

  /// After run(). The caller may add to it what it measures itself.
  Report& report() { return report_; }
  const Report& report() const { return report_; }
  /// Null if the run ended before there was one.
  const StockModel* stock() const { return front_.stock.stock.get(); }
  /// As findings were judged by, with what holds the blank there is.
  CollisionWishes collisions() const { return checks_of(options_, front_).collisions; }

 private:
  Session(SessionOptions options, ProgramFront front, std::chrono::steady_clock::time_point start);

  bool survey_program(std::stop_token stop, Diagnostics& diagnostics, Outcome& outcome);
  bool gather(std::span<const Motion> motions, ProgramSurvey& survey);
  bool take_guesses(const ProgramSurvey& survey, Diagnostics& diagnostics, Outcome& outcome);
  bool take_sheet(const ProgramSurvey::SheetGuess& guess, const ProgramSurvey& survey,
                  Diagnostics& diagnostics, Outcome& outcome);
  /// How a pass through the program ended. kUnfit: another model is needed, or a tool that is not
  /// known.
  enum class Pass { kWhole, kStopped, kUnfit };
  ProgramSummary interpret(Program& program, const MotionSink& sink, std::stop_token stop);
  Pass cut_program(CutStage& stage, std::stop_token stop, Diagnostics& diagnostics);
  Pass stream(CutStage& stage, std::stop_token stop);
  bool must_begin_again() const { return is_tilted() || lacks_tool_; }
  bool is_tilted() const;
  void watch_tools(std::span<const Motion> motions);
  bool begin_again(std::stop_token stop, Diagnostics& diagnostics, Outcome& outcome);
  bool cut_batch(CutStage& stage, std::span<const Motion> motions);
  bool cut_some(CutStage& stage, std::span<const Motion> motions);
  std::optional<Outcome> cut_and_report(std::stop_token stop, Diagnostics& diagnostics);
  Outcome conclude(bool stopped);
  void complete_report(const CutStage& stage);
  void complete_timing();

  SessionOptions options_;
  ProgramFront front_;
  std::unique_ptr<Program>
      second_pass_;  ///< a guessed blank and a long file: interpreted once more
  std::atomic<const Program*> shown_program_{nullptr};  ///< the one that runs now, for progress()
  MaterialHandover materials_;  ///< from the thread that reads to the one that cuts
  std::vector<TorchMaterial> taken_materials_;
  FileHandover files_;  ///< the same of the names of files
  std::vector<std::string> taken_files_;
  LineWindow window_;
  TiltWatch tilt_;
  std::atomic<double> work_read_{0};  ///< CutStage::work_of() of what has come to be cut
  std::atomic<double> work_done_{0};
  SwitchedMotions switched_;
  std::optional<OpenTools> open_tools_;  ///< while such may be guessed that are met later
  std::optional<int> known_tool_;  ///< has fed, and is none to be guessed; until a tool change
  bool lacks_tool_ = false;
  std::vector<Motion> kept_;  ///< motions of the first pass, complete if kept_whole_
  bool kept_whole_ = false;
  Diagnostics interpreter_;  ///< what the interpreter said in the last pass
  SessionObserver* observer_ = nullptr;
  MotionRecorders recorders_;
  std::optional<CutLabels> labels_;
  std::optional<KeptMoves> kept_moves_;
  std::optional<EngagementLog> engagement_;
  LoadListener* load_listener_ = nullptr;
  Report report_;
  std::atomic<bool> interpreting_{false};
  std::chrono::steady_clock::time_point start_;
};

}  // namespace kerf
