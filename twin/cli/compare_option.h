// twin/cli/compare_option.h - the options that name a design part, and what is done by them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "stock/cutter/shape_spec.h"
#include "stock/stock_model.h"
#include "twin/cli/option_reader.h"
#include "twin/compare/compare_stock.h"
#include "twin/compare/design_file.h"
#include "twin/compare/rest.h"
#include "twin/report/report.h"

namespace kerf {

/// --compare and what goes with it.
struct CompareRequest {
  std::string path;  ///< empty: nothing is compared
  double tolerance_mm = 0.05;
  double mm_per_unit = 1;
  DesignPlacement placement;
  bool is_fitted = false;
  double rest_mm = 0;  ///< --rest; 0: nobody asks for it
  /// Of --tool: held against what is left, also those that the program does not use.
  std::vector<RestTool> described;
  bool is_wanted() const { return !path.empty(); }
};

/// Options of it without --compare are faults. `described`: the tools of --tool.
CompareRequest understand_compare(OptionReader& reader,
                                  const std::vector<ToolShapeArgument>& described = {});

/// The file, before anything is cut; null without --compare, and with an error in `diagnostics`.
std::shared_ptr<const DesignFile> open_design(const CompareRequest& request,
                                              Diagnostics& diagnostics);

/// The same where it lies, for a window.
std::shared_ptr<const DesignPart> placed_design(const CompareRequest& request,
                                                Diagnostics& diagnostics);

/// What was compared with what.
struct Compared {
  std::shared_ptr<const DesignPart> design;  ///< as it was placed; null: nothing was compared
  /// The piece of a workpiece that turns, where it lay, if it was that, with its number among those
  /// that came off; null and 0: it was the workpiece itself.
  std::shared_ptr<const StockModel> piece{};
  std::size_t piece_number = 0;

  /// For what shows the workpiece itself: null where it was a piece.
  std::shared_ptr<const DesignPart> of_workpiece() const { return piece ? nullptr : design; }
};

/// Compares the finished workpiece, and puts what comes of it into the report: the section and
/// findings. Of what is parted off, that which lies most where the design does, or with a fit is
/// most as long as it, is what was made. `stock` null: there is none, which is told.
Compared compare_finished(const CompareRequest& request, const DesignFile& file,
                          const StockModel* stock, const CutHistory& history, Report& report,
                          Diagnostics& diagnostics);

}  // namespace kerf
