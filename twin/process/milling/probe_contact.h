// twin/process/milling/probe_contact.h - where a probing move meets the workpiece, or leaves it.
#pragma once

#include "interp_bridge/program.h"
#include "stock/stock_model.h"

namespace kerf {

/// The probe trips where it lies so deep in the workpiece as the model has it. On a top or a floor
/// that and what a ball rises within a cell are the error of the answer; a wall is where it should
/// be within half a cell.
inline constexpr double kProbeDepth_mm = 0.001;

/// `move` is the question's motion for the model, whose moves are all complete; `tip` the cutter in
/// the spindle, whose shape is the probe's. kUnknown, with the reason, where the move meets nothing
/// and stays clear of the blank's outline: something else stands there (a tool setter). Over the
/// blank that is kMissed.
ProbeAnswer probe_contact(const StockModel& stock, const Cutter& tip, const CutMove& move,
                          bool away);

}  // namespace kerf
