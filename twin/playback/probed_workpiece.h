// twin/playback/probed_workpiece.h - what the probes of a program meet that is read to be played.
#pragma once

#include <memory>
#include <span>
#include <stop_token>

#include "interp_bridge/program.h"
#include "stock/stock_model.h"
#include "twin/findings/finding.h"
#include "twin/job/tools.h"
#include "twin/process/cut_stage.h"
#include "twin/program/program_front.h"

namespace kerf {

/// A copy of the blank that is cut while the program is read, since what a program does behind a
/// probe hangs on what it meets. Of milled blanks. It costs as much as a dry run, and its memory.
/// One thread.
class ProbedWorkpiece {
 public:
  /// `front` has a blank, whose copy shares its tiles. Once `stop` is requested nothing is cut.
  ProbedWorkpiece(const SessionOptions& options, const ProgramFront& front, std::stop_token stop);

  /// In program order.
  void take(std::span<const Motion> motions, const WorkpieceFrame& frame);
  /// Session's answer, behind all that was taken.
  ProbeAnswer answer(const ProbeQuestion& question) { return stage_.answer(question); }
  bool takes_tilted_tools() const { return stock_->takes_tilted_tools(); }

 private:
  std::unique_ptr<StockModel> stock_;
  FindingLog log_;  ///< what is to be said the player says
  ToolResolver resolver_;
  CutStage stage_;
};

}  // namespace kerf
