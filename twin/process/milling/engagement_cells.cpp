// EngagementScan at one place of the way, in brief: what stands over the cutter, cell by cell.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "twin/process/milling/engagement_scan.h"

namespace kerf {
namespace {

/// Of more cells across its radius not all are asked, but so many as if each were larger.
constexpr double kManyCells = 31;
/// A tip that rises more steeply than this, so near to its middle, is a point: a cone, and a ball
/// of five cells or less.
constexpr double kNearTip_cells = 2, kPointed = 0.2;
/// Looking for where material ends, so many cells beyond the last in it.
constexpr double kBeyond_cells = 1.5;
/// So near to the rim, at least, is the cell before it.
constexpr double kAtRim_cells = 2;
/// From the deepest cell to the next one, so many places.
constexpr int kDeepSteps = 4;

}  // namespace

bool EngagementScan::is_pointed(const Cutter& cutter, double cell_mm) {
  const double near_tip = std::min(kNearTip_cells * cell_mm, cutter.radius_mm());
  return cutter.height_mm(near_tip) > kPointed * near_tip;
}

bool EngagementScan::asks_cells(const Cutter& cutter, double cell_mm) {
  const double radius = cutter.radius_mm();
  const bool is_flat = cutter.height_mm(radius * (1 - 1e-9)) <= 0;
  return !is_flat && radius >= kFineCells * cell_mm && !is_pointed(cutter, cell_mm);
}

/// Of cells of that size, by their distance from the cutter's middle.
void EngagementScan::weigh_cells(double cell_mm) {
  if (cell_mm == weighed_mm_) return;
  weighed_mm_ = cell_mm;
  for (std::vector<double>* each :
       {&weights_.height_rad, &weights_.thick_per_mm, &weights_.upright, &weights_.steps})
    each->resize(kLifts + 1);
  for (std::size_t k = 0; k <= kLifts; ++k) {
    const double r = std::max(static_cast<double>(k) / lift_scale_, 0.25 * cell_mm);
    const double outer = std::min(r + 0.5 * cell_mm, radius_);
    const double inner = std::max(0.0, r - 0.5 * cell_mm), width = outer - inner;
    const double rise = lift_of(outer) - lift_of(inner);
    const double normal = width / std::hypot(width, rise);
    weights_.height_rad[k] = rise * cell_mm / r;
    weights_.thick_per_mm[k] = normal / kThinChip_mm;
    weights_.upright[k] = std::sqrt(std::max(0.0, 1 - normal * normal));
    weights_.steps[k] = std::min(cell_mm / r, kPi) / CellFront::kStep;
  }
}

/// A cell with material over the cutter's surface. Its share of the height is what the profile
/// rises over its width, times what of its circle it covers.
void EngagementScan::take_cell(const CellBatch& cells, int n, CellFront& front) {
  front.add(cells.first_end, n), front.add(cells.last_end, n);
  if (cells.ahead[n] < 0) return;
  CellFront::Extent& extent = front.extent[static_cast<std::size_t>(cells.step[n] + 0.5)];
  extent.inner_mm = std::min(extent.inner_mm, cells.radius[n]);
  extent.outer_mm = std::max(extent.outer_mm, cells.radius[n]);
  extent.deep_mm = std::max(extent.deep_mm, cells.deep[n]);
}

/// Of what is ahead, the first of those that are farther, or deeper, than all before.
void EngagementScan::take_outermost(const CellBatch& cells, CellFront& front) {
  const auto first_of = [&](const CellBatch::Each& each, double value) {
    int n = 0;
    while (each[n] != value || cells.ahead[n] < 0) ++n;
    return Vec2(cells.x[n], cells.y[n]);
  };
  if (cells.most_deep > front.deep_mm)
    front.deep_mm = cells.most_deep, front.deepest = first_of(cells.deep, cells.most_deep);
  if (cells.most_radius > front.farthest_mm)
    front.farthest_mm = cells.most_radius,
    front.farthest = first_of(cells.radius, cells.most_radius);
  if (cells.most_beside > front.left_mm)
    front.left_mm = cells.most_beside, front.leftmost = first_of(cells.beside, cells.most_beside);
  if (cells.least_beside < front.right_mm)
    front.right_mm = cells.least_beside,
    front.rightmost = first_of(cells.beside, cells.least_beside);
}

CellGround EngagementScan::ground_of(const Station& station, const CellRow& row) const {
  CellGround ground;
  ground.center_x = station.center.x, ground.center_y = station.center.y;
  ground.ahead_x = station.ahead.x, ground.ahead_y = station.ahead.y;
  ground.tip = row.tip, ground.film = kThinnestFilm_mm;
  ground.radius = radius_, ground.wall_slope = kWallSlope;
  ground.slope = row.slope;
  return ground;
}

/// Leaves those cells that are in material, in the way and on no slope that it has cut.
void EngagementScan::keep_over(const Station& station, const CellRow& row, CellBatch& cells) const {
  HeldWay held;
  const bool has_closed_form = held_.slope == 0 || side_.is_ball;
  if (held_.length > 0 && has_closed_form) {
    held = {held_.start.x, held_.start.y, held_.direction.x, held_.direction.y, held_.length,
            held_.z,       held_.slope,   held_.lean,        held_.lowest};
  }
  const CellGround ground = ground_of(station, row);
  kernel_->take_cells(ground, way_end(station), held, lift_table(), cells);
  const bool asks_each =
      (held_.length > 0 && !has_closed_form) || own_until_ > 0 || (arc_ && station.is_near_end);
  for (int n = 0; asks_each && n < cells.count; ++n) {
    if (cells.depth[n] <= 0) continue;
    const Vec2 middle = station.center + Vec2(cells.x[n], cells.y[n]);
    double height = cells.height[n];
    if (!has_closed_form) height = behind_held(middle, height);
    if (own_until_ > 0) height = behind_itself(middle, height);
    const bool is_on = is_on_way(station, middle);
    cells.depth[n] = is_on ? height - (row.tip + cells.lift[n] + kThinnestFilm_mm) : -1;
  }
  for (int n = 0; own_ != nullptr && n < cells.count; ++n) {
    const Vec2 middle = station.center + Vec2(cells.x[n], cells.y[n]);
    const double surface = row.tip + cells.lift[n] + kThinnestFilm_mm;
    if (cells.depth[n] > 0 && is_cut_by_own(middle, surface)) cells.depth[n] = -1;
  }
  int kept = 0;
  while (kept < cells.count && cells.depth[kept] > 0) ++kept;
  for (int n = kept; n < cells.count; ++n) {
    cells.move(n, kept);
    kept += cells.depth[n] > 0 ? 1 : 0;
  }
  cells.count = kept;
}

/// All that has been collected, in its order.
void EngagementScan::take_batch(const Station& station, const CellRow& row, CellBatch& cells,
                                CellFront& front) const {
  keep_over(station, row, cells);
  const CellWeights weights{weights_.height_rad.data(), weights_.thick_per_mm.data(),
                            weights_.upright.data(), weights_.steps.data(),
                            double{CellFront::kSteps}};
  // At the blank's edge heights are taken no further than they go.
  CellGround ground = ground_of(station, row);
  ground.most_above_tip = front.most_above_tip_mm;
  ground.fresh = fresh_mm_, ground.thin = kThinChip_mm, ground.thinnest = kThinnestChip_mm;
  kernel_->place_cells(ground, lift_table(), weights, 0.25 * front.across * cell_,
                       1 / CellFront::kStep, cells);
  for (int n = 0; n < cells.count; ++n) take_cell(cells, n, front);
  take_outermost(cells, front);
  cells.count = 0;
}

/// The cells of a row that are before the cutter; first > last: none.
EngagementScan::CellRow EngagementScan::row_at(const Station& station, const CellFront& front,
                                               int j) const {
  const double cell_x = heights_->cell_x_mm(), cell_y = heights_->cell_y_mm();
  const double reach = engaged_ < radius_ ? engaged_ : radius_;
  const Box& box = heights_->bounds_mm();
  const Vec2 center = station.center - Vec2(box.min), ahead = station.ahead;
  CellRow row;
  row.tip = std::max(station.tip_z, box.min.z);
  row.slope = rise_ > 0 ? rise_ / length_ : 0;
  row.center_x = center.x;
  row.j = j, row.y = (j + 0.5) * cell_y - center.y;
  row.first = 1, row.last = 0;
  const double half2 = reach * reach - row.y * row.y;
  if (half2 <= 0 || j >= heights_->ny()) return row;
  double from = -std::sqrt(half2), to = -from;
  // Ahead of its middle, or so near to its sides that a part of the cell is.
  const double behind = -0.5 * front.across * cell_, limit = behind - ahead.y * row.y;
  if (ahead.x > 1e-9) from = std::max(from, limit / ahead.x);
  if (ahead.x < -1e-9) to = std::min(to, limit / ahead.x);
  if (std::abs(ahead.x) <= 1e-9 && limit > 0) return row;
  row.first = std::max(0, static_cast<int>(std::ceil((center.x + from) / cell_x - 0.5)));
  row.last =
      std::min(static_cast<int>(std::floor((center.x + to) / cell_x - 0.5)), heights_->nx() - 1);
  return row;
}

/// Some cells of a row that are higher than what the cutter leaves anywhere near them.
void EngagementScan::collect_row(const CellRow& row, int each, CellBatch& cells) const {
  const HeightGrid::Row heights(*heights_, row.j);
  const double y2 = row.y * row.y, to_part = kLifts / (radius_ * radius_);
  const double cell_x = heights_->cell_x_mm();
  for (int i = row.first; i <= row.last; i += each) {
    const double x = (i + 0.5) * cell_x - row.center_x;
    const auto height = static_cast<double>(heights.kept(i));
    const auto k = static_cast<std::size_t>((x * x + y2) * to_part);
    // No higher than the profile somewhat farther in.
    cells.x[cells.count] = x, cells.y[cells.count] = row.y, cells.height[cells.count] = height;
    cells.count += height > row.tip + static_cast<double>(low_lift_[k]) ? 1 : 0;
  }
}

/// All cells of as many rows as blocks are high that are higher than that, block by block.
void EngagementScan::collect_blocks(const Station& station, std::span<const CellRow> rows,
                                    CellFront& front) const {
  constexpr int kSide = HeightGrid::kTileCells, kX = CellBlocks::kX;
  CellBlocks blocks;
  blocks.cell_x = heights_->cell_x_mm(), blocks.cell_y = heights_->cell_y_mm();
  blocks.y = rows[0].y, blocks.tip = rows[0].tip;
  blocks.low_lift = low_lift_.data();
  blocks.to_part = kLifts / (radius_ * radius_), blocks.last_part = kLifts + 1;
  int first = std::numeric_limits<int>::max(), last = -1;
  for (std::size_t n = 0; n < rows.size(); ++n) {
    blocks.first[n] = rows[n].first, blocks.last[n] = rows[n].last;
    if (rows[n].first > rows[n].last) continue;
    first = std::min(first, rows[n].first), last = std::max(last, rows[n].last);
  }
  CellBatch& cells = cells_;
  for (int i = first - first % kX; i <= last;) {
    const int end = std::min((i / kSide + 1) * kSide, last + 1);
    blocks.i = i, blocks.count = (end - i + kX - 1) / kX;
    blocks.x = (i + 0.5) * blocks.cell_x - rows[0].center_x;
    blocks.heights =
        heights_->tile(i / kSide, rows[0].j / kSide) + HeightGrid::offset(i, rows[0].j);
    const int taken = kernel_->collect(blocks, cells);
    if (taken < blocks.count) take_batch(station, rows[0], cells, front);
    i += taken * kX;
  }
}

/// All cells before it, row by row.
void EngagementScan::take_cells(const Station& station, CellFront& front) const {
  constexpr int kY = CellBlocks::kY;
  const double cell_y = heights_->cell_y_mm();
  const double reach = engaged_ < radius_ ? engaged_ : radius_;
  const double center_y = station.center.y - heights_->bounds_mm().min.y;
  const auto row_of = [&](double y) { return static_cast<int>(std::floor(y / cell_y)); };
  const int first_j = std::max(0, row_of(center_y - reach));
  const int last_j = std::min(row_of(center_y + reach), heights_->ny() - 1);
  const int each = front.each, step = front.rows;
  CellBatch& cells = cells_;
  cells.count = 0;
  if (each == 1 && step == 1) {
    for (int j = first_j - first_j % kY; j <= last_j; j += kY) {
      std::array<CellRow, kY> rows;
      for (int n = 0; n < kY; ++n)
        rows[static_cast<std::size_t>(n)] = row_at(station, front, j + n);
      collect_blocks(station, rows, front);
    }
  } else {
    for (int j = first_j; j <= last_j; j += step) {
      CellRow row = row_at(station, front, j);
      if (row.first > row.last) continue;
      if (each > 1) row.first += (each - row.first % each + j / step % each) % each;
      const int most = std::max(0, row.last - row.first) / each + 2;
      if (cells.count + most > CellBatch::kMost) take_batch(station, row, cells, front);
      collect_row(row, each, cells);
    }
  }
  take_batch(station, row_at(station, front, first_j), cells, front);
}

/// How far beyond a place in material it ends, in that direction.
double EngagementScan::beyond(const Station& station, const Vec2& arm, const Vec2& out,
                              double cells) const {
  const auto depth_at = [&](double mm) {
    const Vec2 at = arm + mm * out;
    if (glm::dot(at, at) >= radius_ * radius_) return -1.0;
    return over_surface(station, station.center + at) - kThinnestFilm_mm;
  };
  double in = 0, free = kBeyond_cells * cells * cell_;
  if (depth_at(free) > 0) return free;
  for (int n = 0; n < 2 + static_cast<int>(cells); ++n) {
    const double middle = 0.5 * (in + free);
    (depth_at(middle) > 0 ? in : free) = middle;
  }
  return 0.5 * (in + free);
}

/// What stands highest over what the cutter leaves: as heights end somewhere between two cells,
/// nearer to the middle of its way than the cell is.
double EngagementScan::deepest(const Station& station, const CellFront& front) const {
  const Vec2 left(-station.ahead.y, station.ahead.x);
  const double beside = glm::dot(front.deepest, left), across = front.across * cell_;
  double deep = front.deep_mm;
  for (int n = 1; n <= kDeepSteps; ++n) {
    const double at = std::abs(beside) - across * n / kDeepSteps;
    const Vec2 arm = front.deepest + (beside < 0 ? 1.0 : -1.0) * (std::abs(beside) - at) * left;
    const double r = glm::length(arm), over = over_surface(station, station.center + arm);
    if (at < 0 || r >= radius_ || over <= kThinnestFilm_mm) break;
    // Between two cells a surface may seem to go on higher than the blank does.
    const double above_tip =
        std::min(over - kThinnestFilm_mm + lift_of(r), front.most_above_tip_mm);
    deep = std::max(deep, above_tip - lift_of(at));
  }
  return deep;
}

/// Heights at its cells are exact, so that what they add up to is exact to a part of a cell,
/// without a question about what lies between them; walls at the rim are where the moves have left
/// them.
EngagementLook EngagementScan::look_by_cells(const Station& station, bool anticlockwise) {
  CellFront front;
  const double finer = radius_ / (kManyCells * cell_);
  const int cells = std::max(1, static_cast<int>(finer * finer));
  front.rows = static_cast<int>(std::sqrt(cells));
  front.each = cells / front.rows;
  front.across = std::sqrt(front.rows * front.each);
  front.most_above_tip_mm = heights_->bounds_mm().max.z - station.tip_z;
  weigh_cells(front.across * cell_);
  take_cells(station, front);
  front.settle();
  for (std::size_t k = 0; k < front.at.size(); ++k) {
    const CellFront::Extent& extent = front.extent[k];
    if (extent.outer_mm <= 0) continue;
    front.at[k].inner_mm = extent.inner_mm, front.at[k].radius_mm = extent.outer_mm;
    front.at[k].deep_mm = extent.deep_mm;
  }
  FrontRays rays(kRays, radius_, false);
  double left_mm = front.left_mm, right_mm = front.right_mm;
  if (front.farthest_mm > 0) {
    const Vec2 left(-station.ahead.y, station.ahead.x);
    left_mm = std::min(left_mm + beyond(station, front.leftmost, left, front.across), radius_);
    right_mm = std::max(right_mm - beyond(station, front.rightmost, -left, front.across), -radius_);
    const Vec2 out = front.farthest / front.farthest_mm;
    const double farthest =
        std::min(front.farthest_mm + beyond(station, front.farthest, out, front.across), radius_);
    const double deep = deepest(station, front);
    for (FrontContact& contact : front.at) {
      if (contact.radius_mm >= front.farthest_mm) contact.radius_mm = farthest;
      if (contact.deep_mm >= front.deep_mm) contact.deep_mm = deep;
    }
  }
  for (std::size_t k = 0; k <= CellFront::kSteps; ++k) {
    FrontContact& contact = front.at[k];
    // Half of the outermost two's directions are beyond the sides.
    const bool is_side = k == 0 || k == CellFront::kSteps;
    contact.high_mm = front.share[k] / (is_side ? 0.5 * CellFront::kStep : CellFront::kStep);
    if (contact.radius_mm <= 0) continue;
    if (contact.inner_mm <= flat_radius_ + 0.5 * front.across * cell_) contact.inner_mm = 0;
    contact.edge_mm = profile_mm(contact.radius_mm) - profile_mm(contact.inner_mm);
  }
  // What stands at the rim stands over the cells before it, too.
  const bool meets_rim = engaged_ >= radius_ * (1 - kSameRadius);
  const double before_rim_mm = radius_ - kAtRim_cells * front.across * cell_;
  const auto about = static_cast<std::size_t>(front.across * cell_ / (radius_ * CellFront::kStep));
  std::array<bool, CellFront::kSteps + 2> may_have_wall{};
  for (std::size_t k = 0; meets_rim && k <= CellFront::kSteps; ++k) {
    if (front.at[k].radius_mm < before_rim_mm || front.at[k].radius_mm <= 0) continue;
    const std::size_t first = k - std::min(k, about + 1);
    const std::size_t last = std::min<std::size_t>(k + about + 1, CellFront::kSteps);
    std::fill(may_have_wall.begin() + first, may_have_wall.begin() + last + 1, true);
  }
  const auto wall_at = [&](const FrontWay& way) {
    FrontContact wall;
    const auto k = static_cast<std::size_t>((way.rad + kPi / 2) * (1 / CellFront::kStep));
    wall.edge_mm = may_have_wall[k] || may_have_wall[k + 1] ? rim_height(station, way) : 0;
    if (wall.edge_mm <= 0) return wall;
    const double beside = radius_ * (1 - kSameRadius) * std::abs(way.left);
    wall.deep_mm = wall.edge_mm + lift_[kLifts] - lift_of(beside);
    return wall;
  };
  rays.take(front.at, wall_at, right_mm, left_mm);
  return rays.look(anticlockwise);
}

}  // namespace kerf
