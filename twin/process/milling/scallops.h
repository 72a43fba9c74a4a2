// twin/process/milling/scallops.h - the crests that round tools leave between their passes, as they
// stand in the workpiece.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "stock/present_heights.h"
#include "surface/height_grid.h"
#include "twin/job/tool_loads.h"
#include "twin/process/engagement.h"
#include "twin/process/milling/past_ways.h"

namespace kerf {

/// Of one tool.
struct ScallopsOfTool {
  int tool = 0;
  std::string shape;
  Scallops crests;
};

/// Looks along rows and columns of cells, about kLines of each. Where the surface that one tool has
/// left has a crest, and another one farther on, the deepest place between the two lies h below the
/// line through both, square to the surface: R - sqrt(R^2 - (ae / 2)^2) of a ball whose passes are
/// ae apart, in a plane of any slope and in any direction. Where exactly a crest is, is found from
/// the parabolas through the cells on either side of it.
///
/// Crests that are nearer to each other than kLeastCells cells, or farther apart than the tool is
/// wide, are not seen; nor is what a flat tool leaves. O(cells of these lines); one thread.
class ScallopScan {
 public:
  static constexpr int kLines = 100, kLeastCells = 4;
  static constexpr double kRounding_mm = 2e-5;  ///< heights are floats

  ScallopScan(const HeightGrid& heights, const PresentHeights& owners, const PastWays& ways)
      : heights_(heights), owners_(owners), ways_(ways) {}
  std::vector<ScallopsOfTool> run();

 private:
  /// Between two cells, or at one: part of a line, in cells.
  struct Crest {
    double at = 0, height = 0;
    std::size_t last = 0;  ///< cell of it
  };
  struct Found {
    LoadSpread spread;
    std::size_t count = 0;
    Vec3 at_mm{0};
  };
  void read(bool is_row, int line);
  void walk(bool is_row, int line);
  bool is_crest(std::size_t k) const {
    // Few bend down at all.
    const double bend = z_[k - 1] - 2 * z_[k] + z_[k + 1];
    return bend < -kRounding_mm && bends_down(k, -bend);
  }
  bool bends_down(std::size_t k, double bend) const;
  Crest crest_at(std::size_t first, std::size_t last) const;
  void take(bool is_row, int line, const Crest& from, const Crest& to);

  const HeightGrid& heights_;
  const PresentHeights& owners_;
  const PastWays& ways_;
  double edge_mm_ = 0;
  std::vector<double> z_;               ///< of the line
  std::vector<std::uint32_t> numbers_;  ///< of moves, by cell of the line
  std::vector<int> tool_of_;            ///< by cell of the line; -1: none, or a flat one
  std::vector<Found> found_;            ///< by tool
};

}  // namespace kerf
