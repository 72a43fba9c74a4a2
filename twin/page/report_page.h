// twin/page/report_page.h - a report, or several, as one HTML file that needs no network: the part
// in 3D, findings that lead to their places and lines, tools, times; printed, a set-up sheet.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/length_unit.h"
#include "stock/stock_model.h"
#include "twin/page/page_mesh.h"
#include "twin/page/page_spots.h"
#include "twin/process/load_listener.h"
#include "twin/report/report.h"

namespace kerf {

/// Rates over the time of the program, in columns of `step_s`.
struct PageCurves {
  double step_s = 0;
  std::vector<double> removed_mm3_per_s;
  std::vector<double> feed_mm_per_min;
  std::vector<double> spindle_rpm;
  /// Of a kind of load: in columns of its own step, no more than there are of the others.
  struct Load {
    LoadKind kind = LoadKind::kAngle;
    double step_s = 0;
    std::vector<double> nominal;
    std::vector<double> high;  ///< ends of its range; empty: it has none
    double limit = 0;          ///< 0: none is known
  };
  std::vector<Load> loads;
  /// Of each column, where a click leads; empty: nowhere.
  std::vector<PageSpot> spots;
};

/// What triangles are coloured by: who cut them.
struct PageGroup {
  std::string name;
  std::string color;  ///< "#56a0d2"
};

/// The design that the part is coloured by.
struct PageDesign {
  const DesignPart* part = nullptr;  ///< null: it is not
  double tolerance_mm = 0.05;
  std::array<std::string, kDeviationClasses> colors{};  ///< by DeviationClass
};

struct PageOptions {
  LengthUnit units = LengthUnit::kMm;
  std::string heading;  ///< the program's name is told beneath it; empty: that is the heading
  std::string anchor;   ///< by which links find the article; may be empty
  std::string command;  ///< that makes this report again; may be empty
  std::size_t most_triangles = 120'000;
  std::vector<PageGroup> groups;
  /// Which of `groups` the move with this number (CutMove::id) belongs to; empty: nobody asks.
  std::function<std::uint8_t(std::uint32_t move)> group_of;
  PageDesign design;
  PageCurves curves;
};

/// The whole file, UTF-8, in the language of the process: page_of() one article.
std::string report_page(const Report& report, const StockModel* stock,
                        const PageOptions& options = {});

/// An article about one run, with a 3D view of its own. `stock`: null if the run ended before there
/// was one. Files of the program are read for the lines that findings name; one that is not there
/// any more is left out. Findings beyond kMostOnPage are counted. The 3D view takes about 18 bytes
/// a triangle.
std::string page_article(const Report& report, const StockModel* stock,
                         const PageOptions& options = {});
/// A page of articles, each on paper of its own when it is printed. Browsers draw some 16 of them
/// in 3D; of more the first ones go still.
std::string page_of(const std::string& title, const std::string& version, const std::string& body);

inline constexpr std::size_t kMostOnPage = 500;

}  // namespace kerf
