// twin/app/work_options.h - the options about tools and workpiece, which run, shadow and replay
// share.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "stock/blank.h"
#include "stock/cutter/shape_spec.h"
#include "twin/app/option_reader.h"
#include "twin/session_parts.h"

namespace kerf {

/// The arguments as written. Empty = not given.
struct WorkArguments {
  std::vector<std::string> tools;
  std::string stock;
  bool additive = false;
  std::string model;
  std::string cell;
  std::string threads;
  std::string kernel;
  std::string margin;
  std::string below;
  std::string path;
};

/// The same, understood.
struct WorkRequest {
  std::vector<ToolShapeArgument> tools;
  std::optional<Blank> blank;
  StockSettings stock;
  double margin_mm = 5;              ///< around a guessed blank
  double below_mm = 0;               ///< the blank's floor
  std::optional<bool> planned_path;  ///< what is cut; nothing: the command's default
};

/// Faults go to the reader.
WorkRequest understand_work(const WorkArguments& arguments, OptionReader& reader);

}  // namespace kerf
