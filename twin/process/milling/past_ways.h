// twin/process/milling/past_ways.h - the moves that have been cut: where exactly they have left a
// wall, which heights know to a cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "base/growing_list.h"
#include "stock/stock_model.h"
#include "twin/process/milling/tool_side.h"
#include "twin/process/milling/upright_arc.h"

namespace kerf {

/// Moves of upright tools by their numbers, which a workpiece keeps for each of its cells
/// (StockModel::keep_cut_ids). Several moves may have one number: of these the last kMostOfOne are
/// asked. 36 bytes a move, 76 an arc, some hundreds one that stands upright. One thread.
class PastWays {
 public:
  static constexpr int kMostOfOne = 64;
  /// Numbers from there on are not kept.
  static constexpr std::uint64_t kMostNumbers = std::uint64_t{1} << 27;

  void clear();
  /// What is added from now on is cut by this one, which the program calls by this number.
  void mount(const Cutter& cutter, int number = 0);
  /// Lines, and arcs about Z or in a plane that stands upright. Others are left out, and cover
  /// nothing.
  void add(const CutMove& move);
  /// How many there are, and of each of them.
  std::size_t tools() const { return tools_.size(); }
  /// How wide the tool in the spindle is, so far above its tip.
  double reach_mm(double above_tip_mm) const { return tools_[tool_].reach_mm(above_tip_mm); }
  double radius_mm(int tool) const { return tools_[static_cast<std::size_t>(tool)].radius_mm; }
  int number_of(int tool) const { return tools_[static_cast<std::size_t>(tool)].number; }
  const std::string& shape_of(int tool) const {
    return tools_[static_cast<std::size_t>(tool)].spec;
  }
  /// Of the last move of that number; -1: it is not known, or its tool is flat.
  int round_tool_of(std::uint32_t number) const {
    if (!knows(number)) return -1;
    const std::size_t tool = tool_of(last_[number]);
    return tools_[tool].is_flat ? -1 : static_cast<int>(tool);
  }
  bool knows(std::uint32_t number) const { return number < last_.size() && last_[number] != kNone; }
  /// A move of that number comes over the point with its tool as low as `z_mm`; or beside it by no
  /// more than `margin_mm`. 10 ns; of a slope that is of no flat tool, ball nor cone 200.
  bool covers(std::uint32_t number, const Vec2& point, double z_mm, double margin_mm) const;
  /// How low the moves of that number come over the point; infinite where they do not. 15 ns; of a
  /// slope that is of neither a flat tool nor a ball 200. As if the tool were wider by `margin_mm`.
  double height_mm(std::uint32_t number, const Vec2& point, double margin_mm = 0) const;

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0}, kUpright = std::uint32_t{1} << 31;
  /// A cutter's surface: how wide it is where it is so much above its tip.
  struct Tool {
    std::string spec;
    int number = 0;
    double radius_mm = 0;
    bool is_flat = false;
    double high_mm = 0;          ///< where it is as wide as it gets
    std::vector<double> radius;  ///< over the height, 0 .. high_mm
    double reach_mm(double above_tip_mm) const;
    std::vector<double> lift;  ///< over the root of 1 - distance / radius
    double lift_mm(double distance_mm) const;
    ToolSide side;
  };
  struct Arc {
    Vec2 center{0};
    double radius = 0, start = 0, sweep = 0;  ///< sweep > 0 counter-clockwise
  };
  /// Floats tell places of a metre to 0.00006 mm.
  struct Way {
    float from[3], to[3];
    std::uint32_t before = kNone;  ///< of the same number
    std::uint32_t arc = kNone;     ///< from kUpright on one of uprights_
  };
  /// From a way on, this tool was in the spindle.
  struct Mount {
    std::size_t first_way = 0, tool = 0;
  };
  std::size_t tool_of(std::size_t way) const {
    std::size_t k = mounts_.size() - 1;
    if (way < mounts_[k].first_way) k = mount_before(way);
    return mounts_[k].tool;
  }
  std::size_t mount_before(std::size_t way) const;
  bool covers(const Way& way, const Tool& tool, const Vec2& point, double z_mm,
              double margin_mm) const;
  bool line_covers(const Way& way, const Tool& tool, const Vec2& point, double z_mm,
                   double margin_mm) const;
  bool arc_covers(const Way& way, const Tool& tool, const Vec2& point, double z_mm,
                  double margin_mm) const;
  double line_height(std::uint32_t way, const Tool& tool, const Vec2& point,
                     double margin_mm) const;
  double arc_height(const Way& way, const Tool& tool, const Vec2& point, double margin_mm) const;
  double upright_height(const Way& way, const Tool& tool, const Vec2& point,
                        double margin_mm) const;
  double height_of(std::uint32_t number, const Tool& tool, const Vec2& point,
                   double margin_mm) const;

  /// A straight way, and what about it is the same at all points: the last ones that were asked.
  struct Line {
    std::uint32_t way = kNone;
    Vec2 from{0}, along{0};
    double z = 0, rise = 0, length2 = 0, length = 0;
    double slope = 0;  ///< rise for each mm
  };
  static constexpr std::size_t kLines = 128;
  const Line& line_of(std::uint32_t way) const;

  GrowingList<Way> ways_;
  mutable std::vector<Line> lines_;
  std::vector<Mount> mounts_;
  std::vector<Arc> arcs_;
  std::vector<UprightArc> uprights_;
  std::vector<Tool> tools_;
  std::size_t tool_ = 0;
  std::vector<std::uint32_t> last_;  ///< by number
};

}  // namespace kerf
