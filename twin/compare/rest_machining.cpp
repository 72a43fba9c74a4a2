#include "twin/compare/rest_machining.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "base/translate.h"
#include "mesh/column_lines.h"
#include "stock/column_runs.h"
#include "stock/cutter/shape_spec.h"
#include "twin/compare/design_walls.h"
#include "twin/compare/tool_reach.h"

namespace kerf {
namespace {

/// Of the thickness, as near as a tool is followed to the design.
constexpr double kNearEnough = 0.01;
/// A tool that leaves so little more than the thickness, by rounding, leaves the thickness.
constexpr double kRounding_mm = 1e-4;

/// The workpiece seen from above.
struct FromAbove {
  ColumnGrid grid;
  std::vector<float> top_mm;  ///< the floor where nothing is left
};

FromAbove from_above(const StockModel& stock, const ColumnSource& source) {
  const ColumnLayout layout = source.column_layout();
  FromAbove out;
  const Box box = stock.bounds_mm();
  const auto cells = [](double length, double cell) {
    return std::max(1, static_cast<int>(std::lround(length / cell)));
  };
  out.grid.nx = cells(box.max.x - layout.low_mm.x, layout.cell_mm.x);
  out.grid.ny = cells(box.max.y - layout.low_mm.y, layout.cell_mm.y);
  out.grid.bounds_mm = {
      {layout.low_mm, box.min.z},
      {layout.low_mm + Vec2(out.grid.nx, out.grid.ny) * layout.cell_mm, box.max.z}};
  out.top_mm.assign(out.grid.size(), static_cast<float>(box.min.z));
  ColumnRuns runs;
  const auto [tiles_x, tiles_y, tiles_z] = layout.tiles;
  std::uint32_t tile = 0;
  for (int z = 0; z < tiles_z; ++z) {
    for (int y = 0; y < tiles_y; ++y) {
      for (int x = 0; x < tiles_x; ++x, ++tile) {
        source.read_columns(tile, runs);
        const int first_i = x * layout.columns[0], first_j = y * layout.columns[1];
        for (int j = 0; j < runs.ny && first_j + j < out.grid.ny; ++j) {
          for (int i = 0; i < runs.nx && first_i + i < out.grid.nx; ++i) {
            const std::size_t column = runs.column(i, j);
            const std::uint32_t end = runs.first[column + 1];
            if (end == runs.first[column]) continue;
            float& top = out.top_mm[static_cast<std::size_t>(first_j + j) *
                                        static_cast<std::size_t>(out.grid.nx) +
                                    static_cast<std::size_t>(first_i + i)];
            top = std::max(top, runs.runs[end - 1].high_mm);
          }
        }
      }
    }
  }
  return out;
}

class RestFinder {
 public:
  RestFinder(const StockModel& stock, const ColumnSource& source, const DesignPart& design,
             double thickness_mm)
      : above_(from_above(stock, source)),
        grid_(above_.grid),
        floor_mm_(static_cast<float>(grid_.bounds_mm.min.z)),
        cell_mm2_(grid_.cell_mm().x * grid_.cell_mm().y),
        thickness_mm_(thickness_mm),
        probe_(design) {
    DesignFromAbove below = design_from_above(design, grid_);
    walls_ = std::move(below.walls);
    free_mm_ = std::move(below.top_mm);
    design_mm_ = std::move(below.whole_mm);
  }

  Rest run(std::vector<RestTool> tools) {
    Rest out;
    out.thickness_mm = thickness_mm_;
    out.cell_mm = std::max(grid_.cell_mm().x, grid_.cell_mm().y);
    out.tools = std::move(tools);
    find_cells(out);
    find_regions();
    add_tools(out);
    tell(out);
    return out;
  }

 private:
  struct Region {
    RestRegion told;
    std::vector<std::uint32_t> cells;
  };

  float bottom(std::size_t cell) const { return std::max(design_mm_[cell], floor_mm_); }
  Vec3 place(std::size_t cell, float z) const {
    const auto nx = static_cast<std::size_t>(grid_.nx);
    return {grid_.center(static_cast<int>(cell % nx), static_cast<int>(cell / nx)),
            static_cast<double>(z)};
  }
  /// Of what stands in a cell up to `z`; exact up to `reach_mm`.
  double thickness(std::size_t cell, float z, double reach_mm) {
    const double above = static_cast<double>(z) - static_cast<double>(bottom(cell));
    if (above <= 0) return 0;
    return std::min(above, std::max(0.0, probe_.distance_mm(place(cell, z), reach_mm)));
  }
  bool is_thicker(std::size_t cell, float z) {
    const double most = thickness_mm_ + kRounding_mm;
    if (static_cast<double>(z) - static_cast<double>(bottom(cell)) <= most) return false;
    return thickness(cell, z, 2 * most) > most;
  }

  /// By a tool that leaves that. A rim, which is thin as it is, by who takes most of it.
  bool is_cleared(std::size_t cell, float z) {
    if (rest_[cell] == kThick) return !is_thicker(cell, z);
    return above_.top_mm[cell] - z >= 0.5f * (above_.top_mm[cell] - bottom(cell));
  }

  void find_cells(Rest& out) {
    out.map.bounds_mm = grid_.bounds_mm;
    out.map.nx = grid_.nx, out.map.ny = grid_.ny;
    out.map.cells.assign(grid_.size(), RestMap::kNothing);
    rest_.assign(grid_.size(), 0);
    for (std::size_t cell = 0; cell < rest_.size(); ++cell) {
      const float top = above_.top_mm[cell];
      if (top > floor_mm_ || design_mm_[cell] > floor_mm_) out.map.cells[cell] = RestMap::kDone;
      if (is_thicker(cell, top)) rest_[cell] = kThick, out.map.cells[cell] = RestMap::kByNone;
    }
    add_rims();
  }

  /// What is thick is so in its middle; at walls it is near the design, and belongs to it as far as
  /// the thickness. By steps of a cell that go to four and eight neighbours in turn: octagons.
  void add_rims() {
    const double cell_mm = std::min(grid_.cell_mm().x, grid_.cell_mm().y);
    const double most_steps = std::max(grid_.nx, grid_.ny);
    const int steps = static_cast<int>(std::min(std::ceil(thickness_mm_ / cell_mm), most_steps));
    std::vector<std::uint32_t> front, next;
    for (std::size_t cell = 0; cell < rest_.size(); ++cell)
      if (rest_[cell] != 0) front.push_back(static_cast<std::uint32_t>(cell));
    for (int step = 0; step < steps && !front.empty(); ++step) {
      next.clear();
      for (const std::uint32_t cell : front) {
        each_neighbour(cell, step % 2 == 1, [&](std::size_t other) {
          const double above =
              static_cast<double>(above_.top_mm[other]) - static_cast<double>(bottom(other));
          if (rest_[other] != 0 || above <= kRounding_mm) return;
          rest_[other] = kRim;
          next.push_back(static_cast<std::uint32_t>(other));
        });
      }
      front.swap(next);
    }
  }

  template <class Visit>
  void each_neighbour(std::uint32_t cell, bool at_corners, const Visit& visit) const {
    const int i = static_cast<int>(cell) % grid_.nx, j = static_cast<int>(cell) / grid_.nx;
    for (int y = std::max(0, j - 1); y <= std::min(grid_.ny - 1, j + 1); ++y) {
      for (int x = std::max(0, i - 1); x <= std::min(grid_.nx - 1, i + 1); ++x) {
        if (!at_corners && x != i && y != j) continue;
        visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(grid_.nx) +
              static_cast<std::size_t>(x));
      }
    }
  }

  void find_regions() {
    std::vector<std::uint8_t> open = rest_;
    for (std::size_t seed = 0; seed < open.size(); ++seed) {
      if (open[seed] == 0) continue;
      Region region;
      open[seed] = 0;
      region.cells.push_back(static_cast<std::uint32_t>(seed));
      for (std::size_t k = 0; k < region.cells.size(); ++k) {
        each_neighbour(region.cells[k], true, [&](std::size_t next) {
          if (open[next] == 0) return;
          open[next] = 0;
          region.cells.push_back(static_cast<std::uint32_t>(next));
        });
      }
      std::sort(region.cells.begin(), region.cells.end());
      measure(region);
      regions_.push_back(std::move(region));
    }
    std::stable_sort(regions_.begin(), regions_.end(), [](const Region& a, const Region& b) {
      return a.told.volume_mm3 > b.told.volume_mm3;
    });
  }

  void measure(Region& region) {
    RestRegion& told = region.told;
    const Vec2 half = 0.5 * grid_.cell_mm();
    for (const std::size_t cell : region.cells) {
      const float top = above_.top_mm[cell], low = bottom(cell);
      told.area_mm2 += cell_mm2_;
      told.volume_mm3 += cell_mm2_ * static_cast<double>(top - low);
      told.box_mm.extend(place(cell, low) - Vec3(half, 0));
      told.box_mm.extend(place(cell, top) + Vec3(half, 0));
      // No cell is thicker than it is high.
      if (static_cast<double>(top - low) <= told.thickness_mm) continue;
      const double thick = thickness(cell, top, std::numeric_limits<double>::infinity());
      if (thick <= told.thickness_mm) continue;
      told.thickness_mm = thick;
      told.at_mm = place(cell, top);
    }
  }

  void add_tools(Rest& out) {
    const ToolReach reach(grid_.nx, grid_.ny, grid_.cell_mm(), free_mm_, walls_);
    std::vector<float> left = above_.top_mm;  // by all tools together
    std::vector<double> widths(grid_.size(), 0);
    for (std::size_t n = 0; n < out.tools.size(); ++n) {
      RestTool& tool = out.tools[n];
      if (!mills_surfaces(tool.shape)) {
        tool.left_out = tr("it mills no surfaces");
        continue;
      }
      const Result<Cutter> cutter = parse_shape(tool.shape);
      if (!cutter) {
        tool.left_out = cutter.error();
        continue;
      }
      if (!reach.takes(*cutter)) {
        tool.left_out = trf("it is wider than {} cells", ToolReach::kMostCellsAcross);
        continue;
      }
      const std::vector<float> lowest =
          reach.lowest_mm(*cutter, rest_, static_cast<float>(kNearEnough * thickness_mm_));
      for (Region& region : regions_) {
        RestReach by;
        by.tool = n;
        for (const std::size_t cell : region.cells) {
          const float z = std::min(above_.top_mm[cell], std::max(lowest[cell], bottom(cell)));
          by.takes_mm3 += cell_mm2_ * static_cast<double>(above_.top_mm[cell] - z);
          left[cell] = std::min(left[cell], z);
          if (static_cast<double>(z - bottom(cell)) > by.leaves_mm)
            by.leaves_mm =
                std::max(by.leaves_mm, thickness(cell, z, std::numeric_limits<double>::infinity()));
          const double width = cutter->radius_mm();
          if (width <= widths[cell] || !is_cleared(cell, z)) continue;
          widths[cell] = width;
          out.map.cells[cell] = static_cast<std::uint8_t>(std::min<std::size_t>(
              RestMap::kByTool + n, std::numeric_limits<std::uint8_t>::max()));
        }
        tool.takes_mm3 += by.takes_mm3;
        if (by.leaves_mm <= thickness_mm_ + kRounding_mm) ++tool.clears;
        region.told.by_tool.push_back(by);
      }
    }
    for (const Region& region : regions_)
      for (const std::size_t cell : region.cells)
        out.by_none_mm3 += cell_mm2_ * static_cast<double>(left[cell] - bottom(cell));
  }

  void tell(Rest& out) {
    out.regions_in_all = regions_.size();
    for (Region& region : regions_) {
      out.volume_mm3 += region.told.volume_mm3;
      out.area_mm2 += region.told.area_mm2;
      if (out.regions.size() < Rest::kMostRegions) out.regions.push_back(std::move(region.told));
    }
  }

  FromAbove above_;
  ColumnGrid grid_;
  float floor_mm_;
  double cell_mm2_, thickness_mm_;
  DesignProbe probe_;
  std::vector<float> design_mm_, free_mm_;
  std::vector<WallPoint> walls_;
  static constexpr std::uint8_t kThick = 1, kRim = 2;
  std::vector<std::uint8_t> rest_;  ///< 0: neither
  std::vector<Region> regions_;
};

}  // namespace

bool mills_surfaces(const std::string& shape) {
  const std::string kind = shape.substr(0, shape.find(':'));
  constexpr std::array<std::string_view, 9> kMills{
      "flat", "ball", "bull", "vee", "taper", "lollipop", "tslot", "dovetail", "profile"};
  return std::find(kMills.begin(), kMills.end(), kind) != kMills.end() &&
         shape.find(":live=") == std::string::npos;
}

const char* why_no_rest(const StockModel& stock) {
  if (stock.sheet() != nullptr) return tr_noop("a sheet is cut through, not milled from above");
  if (stock.turned() != nullptr) return tr_noop("a workpiece that turns is not milled from above");
  const auto* const source = dynamic_cast<const ColumnSource*>(&stock.bare());
  if (source == nullptr || source->column_layout().tiles[0] == 0)
    return tr_noop("its model has no heights");
  return nullptr;
}

Rest find_rest(const StockModel& stock, const DesignPart& design, double thickness_mm,
               std::vector<RestTool> tools) {
  const auto begin = std::chrono::steady_clock::now();
  const auto& source = dynamic_cast<const ColumnSource&>(stock.bare());
  Rest out = RestFinder(stock, source, design, thickness_mm).run(std::move(tools));
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

}  // namespace kerf
