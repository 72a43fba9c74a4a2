// twin/playback/frontier.h - the first cut through a program: finds, records, leaves keyframes.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "twin/findings/finding.h"
#include "twin/job/tools.h"
#include "twin/machine/motion_moves.h"
#include "twin/machine/timeline.h"
#include "twin/playback/cut_record.h"
#include "twin/playback/keyframe_store.h"
#include "twin/playback/load_record.h"
#include "twin/playback/program_track.h"
#include "twin/playback/programmed_steps.h"
#include "twin/playback/recording_stock.h"
#include "twin/process/cut_stage.h"
#include "twin/process/engagement_log.h"

namespace kerf {

/// How much of a program is reported on; as in PlayerProgram.
struct ReportScope {
  std::size_t from = 0;
  bool whole = true;
  BlankKind blank = BlankKind::kUnjudged;
};

/// Cuts a program once, in slices, through the same CutStage as a dry run: the findings are those
/// of the report (`materials`: all that its motions name). Everything before
/// reached() can afterwards be cut again from the record and the keyframes. One thread.
class Frontier {
 public:
  Frontier(const ProgramTrack& track, std::unique_ptr<StockModel> blank, ToolSources tools,
           const TimelineOptions& options, KeyframeStore& store, const ReportScope& scope = {},
           const ProcessPlan& process = *default_process(),
           std::span<const TorchMaterial> materials = {}, const CheckOptions& checks = {});

  /// The findings are to be those of these steps, the track being of their planned path. Before the
  /// first advance().
  void judge(ProgrammedSteps steps) { steps_ = std::move(steps); }
  /// How tools are engaged is measured, and what that takes is in loads(). Before the first
  /// advance(). `track`: the one that is cut.
  void measure_loads(std::shared_ptr<const ProgramTrack> track);
  /// Cuts some motions more, about a millisecond's worth, but not motion `end` nor those behind it
  /// (of planned paths: but for the other pieces of a step that begins before it).
  void advance(std::size_t end);
  /// Motions that have been cut.
  std::size_t reached() const { return reached_; }
  /// The program is cut to its end, with all findings.
  bool complete() const { return complete_; }

  const CutRecord& record() const { return record_; }
  /// How the program's motions are cut.
  const MotionMoves& moves() const { return moves_; }
  const FindingLog& findings() const { return log_; }
  /// Null: they are not measured. Any thread.
  std::shared_ptr<const LoadRecord> loads() const { return loads_; }

 private:
  std::size_t take_one(std::size_t settled);
  const ProgramTrack& track_;
  MotionMoves moves_;
  CutRecord record_;
  RecordingStock stock_;
  ToolResolver resolver_;
  FindingLog log_;
  std::optional<EngagementLog> engagement_;  ///< that outlives the stage
  std::shared_ptr<LoadRecord> loads_;
  CutStage stage_;
  ReportScope scope_;
  ProgrammedSteps steps_;
  std::size_t next_step_ = 0;    ///< of those
  std::vector<PathPiece> path_;  ///< of the present one
  std::size_t reached_ = 0;
  bool complete_ = false;
};

}  // namespace kerf
