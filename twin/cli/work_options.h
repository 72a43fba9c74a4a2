// twin/cli/work_options.h - the options about tools and workpiece, which run, shadow and replay
// share.
#pragma once

#include <optional>
#include <vector>

#include "stock/blank.h"
#include "stock/cutter/shape_spec.h"
#include "twin/cli/option_reader.h"
#include "twin/config/live_config.h"
#include "twin/program/session_parts.h"
#include "twin/tool_library/tool_library.h"

namespace kerf {

/// The options, understood.
struct WorkRequest {
  std::vector<ToolShapeArgument> tools;
  std::vector<ToolLibrary> libraries;
  bool tools_named = false;  ///< on the command line
  std::optional<Blank> blank;
  StockSettings stock;
  double margin_mm = 0;        ///< around a guessed blank
  double below_mm = 0;         ///< the blank's floor
  double spindle_max_rpm = 0;  ///< of a lathe; 0: not known
  CollisionWishes collisions{};
  bool planned_path = false;                  ///< what is cut
  ValueFrom path_from = ValueFrom::kNowhere;  ///< who says so
};

/// Faults go to the reader. `config`: what its layers have as theirs; null: none.
WorkRequest understand_work(const LiveConfig* config, OptionReader& reader);

}  // namespace kerf
