// twin/process/milling/engagement_scan.h - when on its way a move removes what: worked out from the
// heights that it meets, cell by cell, without cutting.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interp_bridge/motion.h"
#include "stock/present_heights.h"
#include "stock/stock_model.h"
#include "surface/height_grid.h"
#include "twin/process/engagement.h"
#include "twin/process/milling/front_kernel.h"
#include "twin/process/milling/front_rays.h"
#include "twin/process/milling/past_ways.h"
#include "twin/process/milling/tool_side.h"
#include "twin/process/milling/upright_arc.h"
#include "twin/process/milling/way_spans.h"

namespace kerf {

/// Looks at the cells that a move comes over, and works out for each of them when the cutter's
/// surface goes down through its height: the instant at which a flat cutter's edge is there, or the
/// time from where a ball touches the top until it is right beside the cell. Reads only. Of long
/// ways with many cells every n-th of a row is looked at, in each row another one, so that each
/// stands for the n around it; along long arcs heights are looked up in rows that run beside them.
///
/// Ends of the cutting are those of the cells' squares, not of their middles: the sides of a blank,
/// which are edges of cells, are met and left where they are; walls that were cut before are known
/// to half a cell. Where a wall is left beside the way the cutter is taken to be at it until its
/// widest is past the wall's end.
///
/// Does not see gaps of less than kLeastGapBins bins; arcs are those about Z with up to one turn;
/// cutters do not undercut, and what is hollow below its top is not. One thread; keeps its memory.
class EngagementScan {
 public:
  static constexpr int kMostPoints = 4096;  ///< looked at by each of its passes
  static constexpr int kMostBins = 256;
  static constexpr int kLeastGapBins = 3;
  /// Fewer cells across a cutter's radius say too little of where on it material is.
  static constexpr double kFineCells = 12;
  /// Looks in brief ask cells alone: of what is not flat, so many cells wide, and not pointed.
  /// Beside its own passes a cone is in few of them, next to its tip.
  static bool asks_cells(const Cutter& cutter, double cell_mm);
  static bool is_pointed(const Cutter& cutter, double cell_mm);

  static bool takes(const Cutter& cutter, const CutMove& move);
  /// One of front_kernels(); without it, the first of them.
  void use(const FrontKernel& kernel) { kernel_ = &kernel; }

  struct Cost {
    double looks = 0;   ///< heights that were looked at
    double places = 0;  ///< of them, those that are above the cutter's tip
  };

  /// The part of the way from `from` to `to`; `bin_mm`: as fine as volumes are to be told (coarser
  /// where kMostBins of them are shorter than that). Looks at a few lanes along the way: spans()
  /// are as exact as above, where what is cut is no narrower than the lanes are apart (about a
  /// fortieth of the cutter in the middle, less at its sides) and no shorter than `step_mm`; air of
  /// less than `gap_mm` is not seen. bins_mm3() are good to some percent.
  /// `held`: null, or a straight move of the same cutter that the heights may not have yet.
  struct Lanes {
    double bin_mm = 0, gap_mm = 0, step_mm = 0;
    int count = 41;
    const CutMove* held = nullptr;
  };
  Cost run_lanes(const HeightGrid& heights, const Cutter& cutter, const CutMove& move, double from,
                 double to, const Lanes& lanes);

  /// After run_lanes(), of the same move: bins_mm3() of a part of the way, by all of its cells (of
  /// many every n-th; of few, where the material is level about them, several places of each). The
  /// first bin has what the cutter stands in there, too.
  Cost run_part(double from, double to, int bins);

  struct Look {
    double at = 0;                  ///< part of the way
    const CutMove* held = nullptr;  ///< as in Lanes
    bool anticlockwise = false;     ///< the spindle, seen from above
    /// Who knows which moves have cut which cells (of the heights that are looked at), and these
    /// moves; or null: walls are known to a cell.
    const PresentHeights* owners = nullptr;
    const PastWays* ways = nullptr;
    /// Of what is not flat, by its cells, or (where these are coarse) by a third of the radii.
    bool is_brief = false;
    /// So far before the place the tool has stood last, and has taken what is behind its surface
    /// there; 0: that is no concern.
    double behind_mm = 0;
    /// An arc that the move touches at that part of its way: the heights have it not yet, and what
    /// it has gone through it has removed.
    const UprightArc* own = nullptr;
    double own_part = 0;
  };
  /// What the cutter's side has in it where it is at that part of its way, by a ring of looks ahead
  /// of it. At its rim walls are where the moves that made them have left them, and the sides of a
  /// box are exact; of what is not flat, surfaces are those between the heights. The depth is to
  /// the heights. Straight down: at the end of the way, whether there is anything. On slopes the
  /// bottom's share does not count. In brief: where asks_cells(), by the heights of its cells
  /// alone, so that walls below its rim are known to half a cell. 1 us; 90 us of what is not flat,
  /// 20 in brief.
  EngagementLook look_ahead(const HeightGrid& heights, const Cutter& cutter, const CutMove& move,
                            const Look& look);

  std::span<const WaySpan> spans() const { return spans_; }
  /// What is removed on each of equal parts of the way from `from` to `to`.
  std::span<const double> bins_mm3() const { return bins_; }

 private:
  /// A place in the frame of the way: along and beside it, or around its centre.
  struct Place {
    double along = 0;   ///< mm; of arcs the angle from the start, 0 .. 2 pi
    double beside = 0;  ///< mm; of arcs the distance from the centre
  };
  /// The cutter is over a place: parts of the way, and where it is nearest.
  struct Pass {
    double first = 0, nearest = 0, last = 0;
    double middle = 0;  ///< where it is nearest, were the way longer
  };

  bool is_flat() const { return flat_radius_ >= radius_; }
  bool is_level() const { return rise_ == 0 && length_ > 0; }
  void set_cutter(const Cutter& cutter);
  void set(const HeightGrid& heights, const Cutter& cutter, const CutMove& move);
  Place place_of(const Vec2& point) const;
  Vec2 point_of(const Place& place) const;
  Place moved(const Place& place, double along_mm, double outward_mm) const;
  double beside_mm(const Place& place) const;
  double distance2(const Place& place, double t) const;
  double surface(const Place& place, double t) const;
  int passes(const Place& place, double from, double to, Pass (&found)[3]) const;
  bool pass_at(double nearest, double half, double from, double to, Pass& pass) const;

  template <class Visit>
  void each_cell(double from, double to, double most_apart_mm, Visit&& visit);
  bool is_level_about(int i, int j) const;
  void take(const Place& place, double height, double area_mm2);
  double take_pass(const Place& place, const Pass& pass, double height, double area_mm2);
  void add(double from, double to, double mm3);
  int bin_of(double t) const;
  double lowest_at(const Place& place, const Pass& pass) const;
  double first_below(const Place& place, const Pass& pass, double height) const;
  double settled(const Place& place, const Pass& pass) const;
  double level_crossing(const Place& place, const Pass& pass, double height) const;
  double left_at(const Place& place, double removed_to_mm);
  bool stands_beside(const Place& place, double tip_mm) const;
  bool is_at_side(const Place& place) const;
  std::optional<double> height_at(const Vec2& point) const;
  double behind_held(const Vec2& point, double height) const {
    return height <= held_.lowest ? height : behind_way(point, height);
  }
  double behind_way(const Vec2& point, double height) const;
  Box path_box(double from, double to) const;

  struct Lane {
    double beside = 0;    ///< mm, from the way
    double width_mm = 0;  ///< for which it stands
    double lowest = 0;    ///< when the cutter is lowest, after it is nearest: part of the way
  };
  /// What a look at a lane has found.
  struct LaneLook {
    bool removed = false;
    Place place{};  ///< the middle of the cell
    double height = 0, depth = 0;
    double when = 0;  ///< it is being removed
  };
  void set_bins(double bin_mm);
  double engaged_radius() const;
  void lay_lanes(int count);
  double lowest_behind(double beside) const;
  bool lane_within(const Lane& lane, double& low, double& high) const;
  double front_at_start(const Lane& lane) const;
  double outside_mm(const Vec2& point) const;
  Vec2 point_on(const Lane& lane, double along) const;
  LaneLook look(const Lane& lane, double along);
  LaneLook look_at(const Lane& lane, const Vec2& point);
  /// A stretch of a lane begins or ends between a place that is removed and one that is free.
  struct Edge {
    Lane lane;
    double removed_at = 0, free_at = 0;
    LaneLook look;    ///< at the former
    double time = 0;  ///< when it is removed at first, or left
    double most = 0;  ///< it cannot be farther than that beyond, as part of the way
    std::size_t span = 0, stretch = 0;
    bool begins = false;
  };
  void walk(const Lane& lane, double phase, double step);
  void note_edge(const Lane& lane, const LaneLook& look, double removed_at, double free_at,
                 bool begins);
  void take_edge(const Lane& lane, const Edge& edge, LaneLook look, WaySpan& stretch);
  void find_edges(bool missed);
  void find_edge(const Lane& lane, double removed, double free, LaneLook& last);
  double begin_of(const Place& place, double height, double from, double to, double best);
  double end_of(const Place& place, double height, double from, double to, double best);

  /// What is thinner has been cut: the model's rounding.
  static constexpr double kThinnestFilm_mm = 2e-4;
  /// A chip that is thinner counts by its thickness: it is next to nothing.
  static constexpr double kThinChip_mm = 0.05;
  /// .. or, where the tool stood so near before that no thicker one can be, than half of what would
  /// be there; but surfaces between heights are no better known than that.
  static constexpr double kThinnestChip_mm = 0.005;
  /// Directions to begin with, from one side to the other.
  static constexpr int kRays = FrontRays::kMost;
  /// What rises by more for each mm is a wall of the cutter, where the lower end counts.
  static constexpr double kWallSlope = 4;
  /// Rounding of the cutter's own radius.
  static constexpr double kSameRadius = 1e-9;
  /// The cutter at one place.
  struct Station {
    Vec2 center{0}, ahead{1, 0};
    Vec2 end{0};  ///< of the move
    bool is_near_end = false;
    double tip_z = 0;
  };
  void set_held(const CutMove* held);
  FrontGrid front_grid() const;
  double on_way_radius() const;
  FrontEnd way_end(const Station& station) const;
  LiftTable lift_table() const { return {lift_.data(), lift_scale_, double{kLifts}}; }
  double material_at(const Station& station, const Vec2& point, double least_radius,
                     bool at_rim) const;
  double rim_height(const Station& station, const FrontWay& way) const;
  /// `kept`: heights about that cell (HeightGrid::kept_about()).
  bool is_cut_there(const Vec2& point, double z, int i, int j,
                    const std::array<float, 9>& kept) const;
  double lift_at(const Vec2& point, const Station& station) const {
    const Vec2 arm = point - station.center;
    return lift_of(std::sqrt(arm.x * arm.x + arm.y * arm.y));
  }
  double over_surface(const Station& station, const Vec2& point) const;
  double behind_itself(const Vec2& point, double height) const {
    return own_until_ <= 0 ? height : behind_own(point, height);
  }
  double behind_own(const Vec2& point, double height) const;
  bool is_cut_by_own(const Vec2& point, double height) const;
  double left_by_owners(const Vec2& point, int i, int j, const std::array<float, 4>& kept) const;
  double left_at_wall(const Vec2& point, int i, int j, double height) const;
  bool is_on_way(const Station& station, const Vec2& point) const;
  Station station_at(double part) const;
  Vec2 before_rim(const Station& station, double angle) const;
  FrontContact contact_at(const Station& station, double angle);
  /// A direction from the tool's middle.
  struct Ray {
    const Station* station = nullptr;
    Vec2 out{1, 0};
    double ahead = 1, left = 0;  ///< its parts along the way and across it
    double slope = 0;            ///< of a way up
  };
  Ray ray_at(const Station& station, double angle) const;
  double over_ray(const Ray& ray, double radius) const;
  double radius_of(double part) const;
  double reach_of(const Station& station);
  double of_thin_chips(double normal, double ahead) const;
  static double counted(double from_mm, double to_mm);
  /// From one radius to another one.
  struct RayStep {
    double width_mm = 0, rise_mm = 0, normal = 0;
  };
  struct RayRadius {
    double mm = 0, height_mm = 0;  ///< the cutter's, over its tip
    RayStep step;                  ///< from the one before
  };
  void lay_radii(int count);
  RayStep step_between(double from_mm, double to_mm) const;
  /// How deep the cutter is in material at a radius of a direction; below 0: so far above it.
  struct RayPlace {
    double radius = 0, depth = 0;
    const RayRadius* at = nullptr;  ///< if it is one of these
  };
  /// Where that begins or ends, and the nearest place in material that was looked at.
  struct RayEdge {
    double radius = 0;
    RayPlace in;
  };
  RayEdge edge_on(const Ray& ray, RayPlace in, RayPlace free) const;
  void over_places(const Ray& ray, RayPlaces& at, int count) const;
  double over_place(const Ray& ray, const RayPlaces& at, int k) const;
  void look_along(const Ray& ray);
  void round_contact(const Station& station, double angle, FrontContact& found);
  double profile_mm(double radius) const;
  /// What its cells say of a place, in directions from one side to the other.
  struct CellFront {
    static constexpr int kSteps = FrontRays::kSteps;
    static constexpr double kStep = kPi / kSteps;
    static constexpr double kRounding = 1e-12;  ///< is left of sums that cancel
    int each = 1, rows = 1;  ///< of so many cells in a row, and of so many rows, one is asked
    double across = 1;       ///< so many cells wide is what it stands for
    std::array<FrontContact, kSteps + 1> at{};
    std::array<double, kSteps + 1> share{};  ///< of the height, times the angle
    /// What share[k] is more than share[k + 1], at k + 1.
    std::array<double, kSteps + 3> rises{};
    /// Of what there is in a direction: the nearest, the farthest, and the deepest.
    struct Extent {
      double inner_mm = std::numeric_limits<double>::infinity(), outer_mm = 0, deep_mm = 0;
    };
    std::array<Extent, kSteps + 1> extent{};
    /// Seen from the cutter's middle.
    double farthest_mm = 0, left_mm = -std::numeric_limits<double>::infinity(),
           right_mm = std::numeric_limits<double>::infinity();
    double deep_mm = 0;
    Vec2 farthest{0}, leftmost{0}, rightmost{0}, deepest{0};
    double most_above_tip_mm = 0;  ///< heights go no further

    void add(const CellBatch::End& end, int n) {
      double* const at_low = rises.data() + end.low[n];
      at_low[0] += end.first[n], at_low[1] += end.second[n], at_low[2] += end.third[n];
    }
    void settle() {
      double sum = rises[kSteps + 2];
      for (std::size_t k = kSteps + 1; k-- > 0;) {
        sum += rises[k + 1];
        share[k] = sum > kRounding ? sum : 0;
      }
    }
  };
  /// Cells of a row, seen from the cutter's middle.
  struct CellRow {
    double tip = 0, slope = 0;  ///< as high as the cutter's tip is, of its way up
    double center_x = 0;        ///< of the cutter, from the grid's side
    double y = 0;
    int j = 0, first = 0, last = 0;
  };
  CellGround ground_of(const Station& station, const CellRow& row) const;
  CellRow row_at(const Station& station, const CellFront& front, int j) const;
  void collect_row(const CellRow& row, int each, CellBatch& cells) const;
  void collect_blocks(const Station& station, std::span<const CellRow> rows,
                      CellFront& front) const;
  void keep_over(const Station& station, const CellRow& row, CellBatch& cells) const;
  static void take_cell(const CellBatch& cells, int n, CellFront& front);
  static void take_outermost(const CellBatch& cells, CellFront& front);
  void take_batch(const Station& station, const CellRow& row, CellBatch& cells,
                  CellFront& front) const;
  void take_cells(const Station& station, CellFront& front) const;
  void weigh_cells(double cell_mm);
  double beyond(const Station& station, const Vec2& arm, const Vec2& out, double cells) const;
  double deepest(const Station& station, const CellFront& front) const;
  EngagementLook look_by_cells(const Station& station, bool anticlockwise);
  /// How high over its tip the cutter's surface is.
  double lift_of(double radius) const {
    const double scaled = std::min(radius * lift_scale_, double{kLifts});
    const int k = static_cast<int>(scaled);
    const double* const lift = lift_.data() + k;
    return lift[0] + (scaled - k) * (lift[1] - lift[0]);
  }
  /// How much it rises there for each mm of the radius.
  double slope_of(double radius) const {
    const auto k = static_cast<std::size_t>(std::min(radius * lift_scale_, double{kLifts - 1}));
    return (lift_[k + 1] - lift_[k]) * lift_scale_;
  }
  EngagementLook plunge_at(const Station& station) const;
  bool cuts_centre(const Station& station) const;

  const HeightGrid* heights_ = nullptr;
  const Cutter* cutter_ = nullptr;  ///< of a look
  std::vector<RayPlace> along_;     ///< one direction of it
  std::vector<RayRadius> radii_;    ///< along it
  double laid_reach_ = -1;          ///< for which they are
  const FrontKernel* kernel_ = &front_kernels().front();
  mutable RayPlaces places_{}, first_places_{};  ///< of radii_, and of the first radii
  mutable CellBatch cells_{};
  Motion motion_;  ///< of arcs
  bool arc_ = false;
  ToolSide side_;
  double radius_ = 0, flat_radius_ = 0;
  bool is_pointed_ = false;
  double engaged_ = 0;   ///< greatest radius that can be in material
  double reach_ = 0;     ///< .. and that is, of what is not flat
  double fresh_mm_ = 0;  ///< from where the tool stood before; 0: no concern
  double z_ = 0, rise_ = 0, low_z_ = 0;
  Vec2 start_{0}, direction_{1, 0};
  double length_ = 0;  ///< seen from above
  Vec2 center_{0};
  double arc_radius_ = 0, start_angle_ = 0, sweep_ = 0, turn_ = 1;
  double cell_ = 0, half_along_ = 0;
  std::string cutter_spec_;  ///< whose lift_ is
  static constexpr int kLifts = 1024;
  std::vector<double> lift_;  ///< of the cutter above its tip, over the radius
  double lift_scale_ = 0;
  /// What a cell in material adds: height times angle; for each mm of its depth, so much of that
  /// counts as is no thin chip, and of a level one so much is normal to the cutter; and over how
  /// many steps of directions it is seen.
  struct Weights {
    std::vector<double> height_rad, thick_per_mm, upright, steps;
  };
  Weights weights_;
  double weighed_mm_ = 0;        ///< for cells of that size
  std::vector<float> low_lift_;  ///< less than lift_, over even steps of the radius' square
  std::vector<double> profile_;  ///< its length from where it begins to rise, over the radius

  double from_ = 0, to_ = 1, bin_ = 1, spread_ = 0, apart_mm_ = 0;
  Cost cost_;
  std::vector<double> bins_;
  std::vector<WaySpan> spans_;
  std::vector<Lane> lanes_;
  std::vector<Edge> edges_;
  const PresentHeights* owners_ = nullptr;
  const PastWays* ways_ = nullptr;
  const UprightArc* own_ = nullptr;
  double own_part_ = 0;
  double own_until_ = 0;  ///< of an arc that may come back to where it began: so far it has cut
  /// The move that is held back; length 0: none.
  struct Held {
    Vec2 start{0}, direction{1, 0};
    double length = 0, z = 0;
    double slope = 0, lean = 0;  ///< of its way: the tangent, and the sine
    double lowest = std::numeric_limits<double>::infinity();  ///< it leaves what is no higher
  } held_;
};

}  // namespace kerf
