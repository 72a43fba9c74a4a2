// twin/cli/page_output.h - --html: the report of a run as a page.
#pragma once

#include <span>
#include <string>

#include "base/diagnostic.h"
#include "base/length_unit.h"
#include "stock/stock_model.h"
#include "twin/cli/outputs.h"
#include "twin/process/cut_labels.h"
#include "twin/process/cutting_wish.h"
#include "twin/process/load_curve.h"
#include "twin/process/run_curve.h"
#include "twin/report/report.h"

namespace kerf {

/// What a page tells beyond the report.
struct PageFacts {
  std::span<const CutLabel> labels;  ///< of the workpiece's cut ids; empty: not known
  const RunCurve* curve = nullptr;   ///< null: not kept
  std::string command;               ///< that makes the report again; may be empty
  LengthUnit units = LengthUnit::kMm;
  const DesignPart* design = nullptr;  ///< that the report compares with; null: with none
  const LoadCurve* loads = nullptr;    ///< null: not measured
  CuttingWish cutting{};               ///< what loads are held against
};

/// The article of a run that is one of several, under its own heading (report_page.h).
std::string article_of(const Report& report, const StockModel* stock, const PageFacts& facts,
                       const std::string& heading, const std::string& anchor);

/// A page that is made, to `html` and `pdf` of `paths`.
void write_page(const OutputPaths& paths, const std::string& page, Diagnostics& diagnostics);

/// `html` and `pdf` of `paths`, where they are wanted, each under a temporary name that is renamed
/// when it is whole; "-" is standard output. What fails is a diagnostic. `stock`: null if there was
/// none.
void write_pages(const OutputPaths& paths, const Report& report, const StockModel* stock,
                 const PageFacts& facts, Diagnostics& diagnostics);

}  // namespace kerf
