// EngagementScan at one place of the way: what the cutter's side has in it there.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "twin/process/milling/engagement_scan.h"

namespace kerf {
namespace {

/// What is thinner is not there: what a pass leaves of the one before, by rounding.
constexpr double kThinnestFront_mm = 0.002;
/// Radii along a ray, of cutters that are not flat; fewer, in some directions, to learn how far out
/// they are in material at all; and steps to where they are.
constexpr int kRadii = 30, kBriefRadii = 10, kPointedRadii = 20, kFirstRadii = 8, kFirstRays = 6,
              kRadiusSteps = 2;
constexpr double kLeastStep = 0.1;
/// What is no farther above material, of the radius, may be in some between two radii.
constexpr double kNearMaterial = 0.06;
/// Four cells whose heights differ by more cells than that have a wall between them.
constexpr double kWallCells = 3;
/// So much of a cell is no even surface between four of them: there is an edge.
constexpr double kTwistCells = 0.05;
/// So far ahead of the rim, as part of the radius, is what is asked about: what the move before has
/// left is right at it. A hundredth of that is beside a wall, and in none.
constexpr double kAhead = 1.0 / 200, kMargin = kAhead / 100, kLeastMargin_mm = 4e-5;
/// Of what is not flat, so many cells.
constexpr double kAheadCells = 0.1;
/// What an arc that stands upright has cut before is lower than where it is now by more.
constexpr double kLowerBefore_mm = 1e-3;
constexpr double kNeverEnds = std::numeric_limits<double>::infinity();
/// A move of fewer cells is one of many.
constexpr double kShort_cells = 8;

/// Places of `count` parts from 0 to 1: closer together towards 1, or even ones.
template <int count>
struct Parts {
  std::array<double, count + 1> sines{}, even{};
};
template <int count>
const double* parts(bool is_even) {
  static const Parts<count> of = [] {
    Parts<count> made;
    for (int k = 0; k <= count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      made.sines[at] = std::sin(kPi / 2 * k / count);
      made.even[at] = static_cast<double>(k) / count;
    }
    return made;
  }();
  return is_even ? of.even.data() : of.sines.data();
}

/// Places across the disc of one that goes straight down, each way.
constexpr int kDiscPlaces = 24;

}  // namespace

double EngagementScan::on_way_radius() const {
  return radius_ + (length_ < kShort_cells * cell_ ? 0.5 * cell_ : 0);
}

/// As is_on_way() has it, of what is no arc.
FrontEnd EngagementScan::way_end(const Station& station) const {
  FrontEnd end;
  end.is_near = station.is_near_end && !arc_;
  end.x = station.end.x, end.y = station.end.y;
  end.radius2 = on_way_radius() * on_way_radius();
  end.along_x = direction_.x, end.along_y = direction_.y;
  return end;
}

FrontGrid EngagementScan::front_grid() const {
  const Box& box = heights_->bounds_mm();
  return {box.min.x,
          box.min.y,
          heights_->cell_x_mm(),
          heights_->cell_y_mm(),
          static_cast<double>(heights_->nx()),
          static_cast<double>(heights_->ny())};
}

/// It is going to be cut by the rest of the move; of one that is short, as others will follow, by
/// about a cell more.
bool EngagementScan::is_on_way(const Station& station, const Vec2& point) const {
  if (!station.is_near_end) return true;
  const double most = on_way_radius();
  const Vec2 arm = point - station.end;
  if (glm::dot(arm, arm) < most * most) return true;
  return arc_ ? place_of(point).along <= sweep_ : glm::dot(arm, direction_) <= 0;
}

/// The material of the cell in which `point` is, above the lowest the cutter comes there with its
/// middle beside it; 0: there is none, or the cutter passes the cell's middle by.
double EngagementScan::material_at(const Station& station, const Vec2& point, double least_radius,
                                   bool at_rim) const {
  const Box& box = heights_->bounds_mm();
  const double cell_x = heights_->cell_x_mm(), cell_y = heights_->cell_y_mm();
  const double i = std::floor((point.x - box.min.x) / cell_x);
  const double j = std::floor((point.y - box.min.y) / cell_y);
  if (i < 0 || j < 0 || i >= heights_->nx() || j >= heights_->ny()) return 0;
  const Vec2 middle(box.min.x + (i + 0.5) * cell_x, box.min.y + (j + 0.5) * cell_y);
  const Vec2 arm = middle - station.center;
  const double ahead = glm::dot(arm, station.ahead);
  const double beside = arc_ ? glm::length(middle - center_) - arc_radius_
                             : station.ahead.x * arm.y - station.ahead.y * arm.x;
  if (std::abs(beside) >= radius_ || !is_on_way(station, middle)) return 0;
  const auto lift = [&](double radius) {
    return lift_[static_cast<std::size_t>(std::min(radius * lift_scale_, double{kLifts}))];
  };
  double height = static_cast<double>(heights_->height(static_cast<int>(i), static_cast<int>(j)));
  const double tip = std::max(station.tip_z, box.min.z);
  const double lowest = tip + lift(std::abs(beside));
  const double meets =
      kThinnestFront_mm + tip +
      lift(at_rim ? least_radius * (1 - 1e-9) : std::min(glm::length(arm), radius_));
  if (height <= meets || ahead < -cell_) return 0;
  height = behind_itself(middle, behind_held(middle, height));
  return height > meets && !is_cut_by_own(middle, meets) ? height - lowest : 0;
}

/// What stands right before the rim. Near the sides the rim is steep: as far ahead, and as far
/// within the way, as it takes for the middle of the cell to be outside of the rim and within the
/// way, however it lies.
Vec2 EngagementScan::before_rim(const Station& station, double angle) const {
  const Vec2 left(-station.ahead.y, station.ahead.x);
  const double half = 0.5 * cell_ * (std::abs(left.x) + std::abs(left.y)) * (1 + 1e-6);
  if (!arc_) {
    const double most = std::max(0.0, radius_ - half);
    const double lane = std::clamp(radius_ * std::sin(angle), -most, most);
    const double inner = std::max(0.0, std::abs(lane) - half);
    return station.center + lane * left +
           (std::sqrt(radius_ * radius_ - inner * inner) + half) * station.ahead;
  }
  // Lanes of an arc go round with it.
  const double r = arc_radius_;
  const Vec2 rim =
      station.center + radius_ * (std::sin(angle) * left + std::cos(angle) * station.ahead);
  const double least = std::min(std::max(r - radius_ + half, half), r);
  const double arm =
      std::clamp(glm::length(rim - center_), least, std::max(r + radius_ - half, least));
  double turn = 0;
  for (const double beside : {arm - half, arm, arm + half}) {
    const double p = std::max(beside, half);
    const double cosine = (r * r + p * p - radius_ * radius_) / (2 * r * p);
    turn = std::max(turn, std::acos(std::clamp(cosine, -1.0, 1.0)));
  }
  turn = std::min(turn + half / arm, kPi);
  const Vec2 out = (station.center - center_) / r;
  return center_ + arm * (std::cos(turn) * out + std::sin(turn) * station.ahead);
}

/// How high the material is there when what the arc itself has cut at its beginning is gone, too.
double EngagementScan::behind_own(const Vec2& point, double height) const {
  const Place place = place_of(point);
  const auto left_by = [&](double angle) {
    const double r = arc_radius_, p = place.beside;
    const double distance =
        std::sqrt(std::max(0.0, r * r + p * p - 2 * r * p * std::cos(place.along - angle)));
    if (distance > radius_) return kNeverEnds;
    return z_ + rise_ * angle / sweep_ +
           lift_[static_cast<std::size_t>(std::min(distance * lift_scale_, double{kLifts}))];
  };
  if (place.along <= own_until_) return std::min(height, left_by(place.along));
  return std::min({height, left_by(0), left_by(own_until_)});
}

/// The arc has come over the point lower than that.
bool EngagementScan::is_cut_by_own(const Vec2& point, double height) const {
  if (own_ == nullptr) return false;
  const auto lift = [this](double mm) { return lift_of(mm); };
  return own_->lowest_over(point, 0, own_part_, radius_, lift) < height - kLowerBefore_mm;
}

/// A move that has made one of the low cells about there has cut the point, too; or the one that is
/// held back. Cells that no known move has made are as
/// they are.
bool EngagementScan::is_cut_there(const Vec2& point, double z, int i, int j,
                                  const std::array<float, 9>& kept) const {
  const double margin = std::max(kMargin * radius_, kLeastMargin_mm);
  if (behind_itself(point, behind_held(point, kNeverEnds)) <= z + margin) return true;
  if (is_cut_by_own(point, z)) return true;
  const float floor = heights_->floor_mm();
  const auto is_low = [&](float height) {
    return static_cast<double>(std::max(floor, height)) <= z + kThinnestFront_mm;
  };
  const int last_x = heights_->nx() - 1, last_y = heights_->ny() - 1;
  std::uint32_t asked = MeshPatch::kNotCut;
  for (int n = 0; n < 9; ++n) {
    if (!is_low(kept[static_cast<std::size_t>(n)])) continue;
    const int x = std::clamp(i + n % 3 - 1, 0, last_x), y = std::clamp(j + n / 3 - 1, 0, last_y);
    const std::uint32_t number = owners_->present_cut_id(x, y);
    if (number == asked || !ways_->knows(number)) continue;
    asked = number;
    if (ways_->covers(number, point, z, margin)) return true;
  }
  return asked == MeshPatch::kNotCut && is_low(kept[4]);
}

/// How high material stands over the end of the profile at the cutter's rim; 0: there is none.
double EngagementScan::rim_height(const Station& station, const FrontWay& way) const {
  const Box& box = heights_->bounds_mm();
  const double z = std::max(station.tip_z, box.min.z) + lift_[kLifts];
  if (owners_ == nullptr) {
    const double deep = material_at(station, before_rim(station, way.rad), radius_, true);
    const double beside = radius_ * std::abs(way.left) * lift_scale_;
    return deep > 0 ? std::max(0.0, deep + lift_[static_cast<std::size_t>(beside)] - lift_[kLifts])
                    : 0;
  }
  const Vec2 left(-station.ahead.y, station.ahead.x);
  const Vec2 point =
      station.center + radius_ * (1 - kSameRadius) * (way.ahead * station.ahead + way.left * left);
  const auto i = static_cast<int>(std::floor((point.x - box.min.x) / heights_->cell_x_mm()));
  const auto j = static_cast<int>(std::floor((point.y - box.min.y) / heights_->cell_y_mm()));
  if (i < 0 || j < 0 || i >= heights_->nx() || j >= heights_->ny()) return 0;
  if (!is_on_way(station, point)) return 0;
  const std::array<float, 9> kept = heights_->kept_about(i, j);
  float highest_kept = kept[0], lowest_kept = kept[0];
  for (const float each : kept)
    highest_kept = std::max(highest_kept, each), lowest_kept = std::min(lowest_kept, each);
  const auto highest = static_cast<double>(std::max(heights_->floor_mm(), highest_kept));
  const auto lowest = static_cast<double>(std::max(heights_->floor_mm(), lowest_kept));
  const double least = z + kThinnestFront_mm;
  if (highest <= least) return 0;
  const bool differs = lowest <= least || held_.length > 0 || own_until_ > 0 || own_ != nullptr;
  if (differs && is_cut_there(point, z, i, j, kept)) return 0;
  const auto own = static_cast<double>(heights_->height(i, j));
  const double stands = own > least ? own : highest;
  if (highest - lowest <= kThinnestFront_mm) return stands - z;
  return std::max(least, left_at_wall(point, i, j, stands)) - z;
}

/// How high the moves that made the cells about a place beside a wall have left it. A cell that the
/// wall goes through is as high as it is on one side of the wall; what those moves have left
/// between their wall and the place counts where it is thicker than kThinnestFront_mm.
double EngagementScan::left_at_wall(const Vec2& point, int i, int j, double height) const {
  const float floor = heights_->floor_mm();
  const int last_x = std::min(heights_->nx() - 1, i + 1);
  std::uint32_t asked = MeshPatch::kNotCut;
  for (int y = std::max(0, j - 1); y <= std::min(heights_->ny() - 1, j + 1); ++y) {
    const HeightGrid::Row row(*heights_, y);
    for (int x = std::max(0, i - 1); x <= last_x; ++x) {
      if (static_cast<double>(std::max(floor, row.kept(x))) >= height) continue;
      const std::uint32_t number = owners_->present_cut_id(x, y);
      if (number == asked || !ways_->knows(number)) continue;
      asked = number;
      height = std::min(height, ways_->height_mm(number, point, kThinnestFront_mm));
    }
  }
  return behind_itself(point, behind_held(point, height));
}

/// How high the moves that made the four cells about a place have left it; where one of them is of
/// no move, as high as that at most. `kept`: the heights of the four.
double EngagementScan::left_by_owners(const Vec2& point, int i, int j,
                                      const std::array<float, 4>& kept) const {
  double height = kNeverEnds, highest = -kNeverEnds;
  std::uint32_t asked = MeshPatch::kNotCut;
  const float floor = heights_->floor_mm();
  const std::array<std::uint32_t, 4> numbers = owners_->present_cut_ids_of_four(i, j);
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    const auto own = static_cast<double>(std::max(floor, kept[n]));
    highest = std::max(highest, own);
    const std::uint32_t number = numbers[n];
    if (!ways_->knows(number)) {
      height = std::min(height, own);
    } else if (number != asked) {
      height = std::min(height, ways_->height_mm(number, point, kThinnestFront_mm));
      asked = number;
    }
  }
  height = std::min(height, highest);
  return behind_itself(point, behind_held(point, height));
}

/// Material over the cutter's surface, which between four cells is what it is at these: what this
/// cutter has cut itself has nothing, however coarse they are. At walls and edges the moves that
/// made them are asked, or (where nobody knows them) the nearest cell counts.
double EngagementScan::over_surface(const Station& station, const Vec2& point) const {
  const HeightGrid& grid = *heights_;
  const Box& box = grid.bounds_mm();
  const double cell_x = grid.cell_x_mm(), cell_y = grid.cell_y_mm();
  const double x = (point.x - box.min.x) / cell_x, y = (point.y - box.min.y) / cell_y;
  if (!(x >= 0 && y >= 0 && x < grid.nx() && y < grid.ny())) return -kNeverEnds;
  if (station.is_near_end && !is_on_way(station, point)) return -kNeverEnds;
  const double tip = std::max(station.tip_z, box.min.z);
  const auto middle_of = [&](int i, int j) {
    return Vec2(box.min.x + (i + 0.5) * cell_x, box.min.y + (j + 0.5) * cell_y);
  };
  const auto own_height = [&](int i, int j, float height) {
    const auto high = static_cast<double>(height);
    return own_until_ > 0 ? behind_itself(middle_of(i, j), high) : high;
  };
  // What is held back is asked about once, and only where there would be material without it.
  const auto less_held = [&](double depth) {
    if (depth <= kThinnestFilm_mm || held_.length <= 0) return depth;
    const double surface = tip + lift_at(point, station);
    return behind_held(point, depth + surface) - surface;
  };
  const double from_x = x - 0.5, from_y = y - 0.5;
  const int i = static_cast<int>(from_x), j = static_cast<int>(from_y);
  if (from_x < 0 || from_y < 0 || i + 1 >= grid.nx() || j + 1 >= grid.ny()) {
    const int own_i = static_cast<int>(x), own_j = static_cast<int>(y);
    const double height = own_height(own_i, own_j, grid.height(own_i, own_j));
    return less_held(height - tip - lift_at(middle_of(own_i, own_j), station));
  }
  const std::array<float, 4> kept = grid.heights_of_four(i, j);
  double height[4];
  for (int n = 0; n < 4; ++n) height[n] = own_height(i + n % 2, j + n / 2, kept[n]);
  const double highest = std::max(std::max(height[0], height[1]), std::max(height[2], height[3]));
  const double lowest = std::min(std::min(height[0], height[1]), std::min(height[2], height[3]));
  // Over what is level the cutter's own curve counts.
  if (highest - lowest < kThinnestFilm_mm)
    return less_held(highest - tip - lift_at(point, station));
  const double right = x - 0.5 - i, up = y - 0.5 - j;
  const bool is_wall = highest - lowest > kWallCells * cell_;
  const Vec2 low = middle_of(i, j) - station.center,
             high = middle_of(i + 1, j + 1) - station.center;
  const auto depth_of = [&](int n) {
    const double arm_x = n % 2 == 0 ? low.x : high.x, arm_y = n / 2 == 0 ? low.y : high.y;
    return height[n] - tip - lift_of(std::sqrt(arm_x * arm_x + arm_y * arm_y));
  };
  if (is_wall) {
    if (owners_ == nullptr) return depth_of((right < 0.5 ? 0 : 1) + (up < 0.5 ? 0 : 2));
    return left_by_owners(point, i, j, kept) - tip - lift_at(point, station);
  }
  const double depth[] = {depth_of(0), depth_of(1), depth_of(2), depth_of(3)};
  const double twist = std::abs(depth[0] + depth[3] - depth[1] - depth[2]);
  if (owners_ != nullptr && twist > kTwistCells * cell_)
    return left_by_owners(point, i, j, kept) - tip - lift_at(point, station);
  return (1 - up) * ((1 - right) * depth[0] + right * depth[1]) +
         up * ((1 - right) * depth[2] + right * depth[3]);
}

/// Along one direction, the angle from straight ahead: where the cutter ends in material.
FrontContact EngagementScan::contact_at(const Station& station, double angle) {
  FrontContact found;
  double wall = 0;
  if (engaged_ >= radius_ * (1 - kSameRadius)) {
    const FrontWay way = FrontWay::of(angle);
    wall = rim_height(station, way);
    const double beside = radius_ * (1 - kSameRadius) * std::abs(way.left);
    if (wall > 0) {
      const double under = lift_[kLifts] - cutter_->height_mm(beside);
      found.radius_mm = radius_, found.deep_mm = wall + under;
    }
  }
  if (!is_flat()) round_contact(station, angle, found);
  found.high_mm += wall;
  found.edge_mm = wall + profile_mm(found.radius_mm) - profile_mm(found.inner_mm);
  return found;
}

/// How deep the cutter's surface is in material along one direction.
double EngagementScan::over_ray(const Ray& ray, double radius) const {
  // Up a slope what it leaves beside it, and nearer to its tip, it has cut from farther back.
  if (ray.slope > 0 && slope_of(radius) * ray.ahead <= ray.slope) return -kThinnestFilm_mm;
  const Vec2 point = ray.station->center + radius * ray.out;
  const double depth = over_surface(*ray.station, point) - kThinnestFilm_mm;
  if (own_ == nullptr || depth <= 0) return depth;
  return is_cut_by_own(point, ray.station->tip_z + lift_of(radius)) ? -kThinnestFilm_mm : depth;
}

/// As they are kept. Where all four are in one tile only the first is looked for.
static void read_fours(const HeightGrid& heights, int count, RayPlaces& at) {
  static_assert(RayPlaces::kTileCells == HeightGrid::kTileCells);
  static_assert(RayPlaces::kBlockX == HeightGrid::kBlockX);
  static_assert(RayPlaces::kBlockY == HeightGrid::kBlockY);
  constexpr int kSide = HeightGrid::kTileCells;
  for (int k = 0; k < count; ++k) {
    if (at.offset[k] < 0) {
      const std::array<float, 4> four = heights.heights_of_four(at.i[k], at.j[k]);
      for (std::size_t n = 0; n < four.size(); ++n) at.height[n][k] = four[n];
      continue;
    }
    const float* const first = heights.tile(at.i[k] / kSide, at.j[k] / kSide) + at.offset[k];
    const int right = at.next_x[k], up = at.next_y[k];
    at.height[0][k] = first[0], at.height[1][k] = first[right];
    at.height[2][k] = first[up], at.height[3][k] = first[up + right];
  }
}

/// The same of many radii at once.
void EngagementScan::over_places(const Ray& ray, RayPlaces& at, int count) const {
  const Station& station = *ray.station;
  if (own_until_ > 0 || own_ != nullptr || (arc_ && station.is_near_end)) {
    for (int k = 0; k < count; ++k) at.depth[k] = over_ray(ray, at.radius[k]);
    return;
  }
  const FrontGrid grid = front_grid();
  const RayLine line{station.center.x, station.center.y, ray.out.x, ray.out.y};
  kernel_->lay_ray(grid, line, way_end(station), count, at);
  read_fours(*heights_, count, at);
  RayGround ground;
  ground.tip = std::max(station.tip_z, heights_->bounds_mm().min.z);
  ground.film = kThinnestFilm_mm;
  ground.floor = static_cast<double>(heights_->floor_mm());
  ground.wall = kWallCells * cell_, ground.twist = kTwistCells * cell_;
  ground.knows_owners = owners_ != nullptr, ground.has_held = held_.length > 0;
  kernel_->look_along(grid, line, lift_table(), ground, count, at);
  for (int k = 0; k < count; ++k) {
    if (at.state[k] != RayPlaces::kDone) at.depth[k] = over_place(ray, at, k);
    at.depth[k] -= kThinnestFilm_mm;
  }
  for (int k = 0; k < count && ray.slope > 0; ++k) {
    if (slope_of(at.radius[k]) * ray.ahead <= ray.slope) at.depth[k] = -kThinnestFilm_mm;
  }
}

/// What is still to be asked of one of them.
double EngagementScan::over_place(const Ray& ray, const RayPlaces& at, int k) const {
  const Vec2 point(at.x[k], at.y[k]);
  const double tip = std::max(ray.station->tip_z, heights_->bounds_mm().min.z);
  if (at.state[k] == RayPlaces::kHeld) {
    const double surface = tip + at.lift[k];
    return behind_held(point, at.depth[k] + surface) - surface;
  }
  if (at.state[k] == RayPlaces::kOwners) {
    const std::array<float, 4> kept = {at.height[0][k], at.height[1][k], at.height[2][k],
                                       at.height[3][k]};
    return left_by_owners(point, at.i[k], at.j[k], kept) - tip - at.lift[k];
  }
  return over_surface(*ray.station, point);
}

EngagementScan::Ray EngagementScan::ray_at(const Station& station, double angle) const {
  const Vec2 left(-station.ahead.y, station.ahead.x);
  Ray ray;
  ray.station = &station;
  ray.ahead = std::cos(angle), ray.left = std::sin(angle);
  ray.out = ray.ahead * station.ahead + ray.left * left;
  ray.slope = rise_ > 0 ? rise_ / length_ : 0;
  return ray;
}

/// Of so many radii: closer together farther out, where the profile is steep, but of what is
/// pointed.
double EngagementScan::radius_of(double part) const {
  return flat_radius_ + (reach_ - flat_radius_) * part;
}

/// What is the same along all directions of a look, and of others that reach as far.
void EngagementScan::lay_radii(int count) {
  if (laid_reach_ == reach_ && radii_.size() == static_cast<std::size_t>(count) + 1) return;
  laid_reach_ = reach_;
  radii_.resize(static_cast<std::size_t>(count) + 1);
  const double* const places = count == kRadii        ? parts<kRadii>(is_pointed_)
                               : count == kBriefRadii ? parts<kBriefRadii>(is_pointed_)
                                                      : parts<kPointedRadii>(is_pointed_);
  for (int k = 0; k <= count; ++k) {
    RayRadius& at = radii_[static_cast<std::size_t>(k)];
    at.mm = radius_of(places[k]) * (1 - kSameRadius);
    at.height_mm = cutter_->height_mm(at.mm);
    if (k > 0) at.step = step_between(radii_[static_cast<std::size_t>(k - 1)].mm, at.mm);
  }
  static_assert(kRadii + 1 <= RayPlaces::kMost && kFirstRadii + 1 <= RayPlaces::kMost);
  for (int k = 0; k < RayPlaces::kMost; ++k)
    places_.radius[k] = radii_[static_cast<std::size_t>(std::min(k, count))].mm;
}

/// How much the profile rises between two radii, and how much of a depth is normal to it.
EngagementScan::RayStep EngagementScan::step_between(double from_mm, double to_mm) const {
  const double width = std::abs(to_mm - from_mm);
  const double rise = std::abs(lift_of(to_mm) - lift_of(from_mm));
  return {width, rise, width > 0 ? width / std::hypot(width, rise) : 0};
}

/// Out to where anything of what is not flat is in material: in that, radii are laid.
double EngagementScan::reach_of(const Station& station) {
  reach_ = engaged_;
  if (is_flat()) return engaged_;
  const double near_mm = kNearMaterial * radius_;
  int farthest = -1;
  const double* const places = parts<kFirstRadii>(is_pointed_);
  for (int k = 0; k < RayPlaces::kMost; ++k)
    first_places_.radius[k] = radius_of(places[std::min(k, kFirstRadii)]) * (1 - kSameRadius);
  for (int n = 0; n <= kFirstRays && farthest < kFirstRadii; ++n) {
    const Ray ray = ray_at(station, kPi * (static_cast<double>(n) / kFirstRays - 0.5) * 0.99);
    over_places(ray, first_places_, kFirstRadii + 1);
    for (int k = kFirstRadii; k > farthest; --k) {
      if (first_places_.depth[k] > -near_mm) farthest = k;
    }
  }
  const bool is_all = farthest < 0 || farthest + 1 >= kFirstRadii;
  return is_all ? engaged_ : radius_of(places[farthest + 1]);
}

/// The mean over a stretch, on which a thickness goes evenly from one to the other, of what of it
/// counts.
double EngagementScan::counted(double from_mm, double to_mm) {
  const auto sum = [](double thick) {
    if (thick <= 0) return 0.0;
    return thick < kThinChip_mm ? thick * thick / (2 * kThinChip_mm) : thick - kThinChip_mm / 2;
  };
  if (std::abs(to_mm - from_mm) < kSameRadius)
    return std::clamp(0.5 * (from_mm + to_mm) / kThinChip_mm, 0.0, 1.0);
  return (sum(to_mm) - sum(from_mm)) / (to_mm - from_mm);
}

/// What a chip's thickness there is multiplied by, to count as kThinChip_mm where it counts in
/// full.
double EngagementScan::of_thin_chips(double normal, double ahead) const {
  if (fresh_mm_ <= 0) return 1;
  const double whole_mm = fresh_mm_ * std::sqrt(std::max(0.0, 1 - normal * normal)) * ahead;
  return kThinChip_mm / std::clamp(0.5 * whole_mm, kThinnestChip_mm, kThinChip_mm);
}

/// Where, between a radius in material and one in none, it ends.
EngagementScan::RayEdge EngagementScan::edge_on(const Ray& ray, RayPlace in, RayPlace free) const {
  const auto between = [&] {
    const double part = in.depth / std::max(in.depth - free.depth, kThinnestFilm_mm);
    return in.radius + std::clamp(part, kLeastStep, 1 - kLeastStep) * (free.radius - in.radius);
  };
  for (int n = 0; n < kRadiusSteps; ++n) {
    const double middle = between(), depth = over_ray(ray, middle);
    (depth > 0 ? in : free) = {middle, depth, nullptr};
  }
  return {between(), in};
}

/// Places along one direction, from the inside out. What is thinner than radii are apart lies about
/// the place that is nearest to material.
void EngagementScan::look_along(const Ray& ray) {
  over_places(ray, places_, static_cast<int>(radii_.size()));
  along_.resize(radii_.size());
  std::size_t nearest = 0;
  double depth = places_.depth[0];
  for (std::size_t k = 0; k < radii_.size(); ++k) {
    along_[k] = {radii_[k].mm, places_.depth[k], &radii_[k]};
    if (places_.depth[k] > depth) depth = places_.depth[k], nearest = k;
  }
  if (depth > 0 || depth < -kNearMaterial * radius_) return;
  for (std::size_t k = std::min(nearest + 1, along_.size() - 1); k >= nearest && k > 0; --k) {
    const double radius = 0.5 * (along_[k - 1].radius + along_[k].radius);
    along_.insert(along_.begin() + static_cast<std::ptrdiff_t>(k),
                  {radius, over_ray(ray, radius), nullptr});
  }
}

/// How high it is in material, out to where, and from where.
void EngagementScan::round_contact(const Station& station, double angle, FrontContact& found) {
  const Ray ray = ray_at(station, angle);
  look_along(ray);
  const double sine = std::abs(ray.left);
  const double most_above_tip = heights_->bounds_mm().max.z - station.tip_z;
  const auto take = [&](const RayPlace& from, const RayPlace& to) {
    const bool is_laid = from.at != nullptr && to.at == from.at + 1;
    const RayStep step = is_laid ? to.at->step : step_between(from.radius, to.radius);
    if (step.width_mm <= 0) return;
    // What is thick without that is thick with it: of_thin_chips() is 1 at least.
    const bool is_thick = step.normal * std::min(from.depth, to.depth) >= kThinChip_mm;
    if (is_thick) return void(found.high_mm += step.rise_mm);
    const double thick = step.normal * of_thin_chips(step.normal, ray.ahead);
    found.high_mm += step.rise_mm * counted(thick * from.depth, thick * to.depth);
  };
  double inner = -1, outer = -1;
  for (std::size_t k = 0; k < along_.size(); ++k) {
    const RayPlace& at = along_[k];
    if (at.depth > 0) {
      const double surface = at.at != nullptr ? at.at->height_mm : cutter_->height_mm(at.radius);
      // At the blank's edge heights are taken further than they go.
      const double above_tip = std::min(at.depth + surface, most_above_tip);
      if (above_tip > found.deep_mm)
        found.deep_mm = std::max(found.deep_mm, above_tip - cutter_->height_mm(at.radius * sine));
      if (k == 0) inner = at.radius;
      outer = at.radius;
    }
    if (k == 0) continue;
    const RayPlace& before = along_[k - 1];
    if (at.depth > 0 && before.depth > 0) {
      take(before, at);
    } else if (at.depth > 0 || before.depth > 0) {
      const bool begins = at.depth > 0;
      const RayEdge edge = begins ? edge_on(ray, at, before) : edge_on(ray, before, at);
      take({edge.radius, 0, nullptr}, edge.in);
      take(edge.in, begins ? at : before);
      if (begins && inner < 0) inner = edge.radius;
      if (!begins) outer = edge.radius;
    }
  }
  if (inner < 0) return;
  if (found.radius_mm <= 0) found.radius_mm = outer;
  found.inner_mm = inner > flat_radius_ ? inner : 0;
}

EngagementLook EngagementScan::plunge_at(const Station& station) const {
  EngagementLook look;
  look.is_plunge = true;
  if (rise_ >= 0) return look;
  double widest = 0;
  for (int y = 0; y < kDiscPlaces; ++y) {
    for (int x = 0; x < kDiscPlaces; ++x) {
      const Vec2 at = engaged_ * (2.0 * (Vec2(x, y) + 0.5) / double{kDiscPlaces} - 1.0);
      const double radius = glm::length(at);
      if (radius >= engaged_) continue;
      const double deep = material_at(station, station.center + at, radius, false);
      look.deep_mm = std::max(look.deep_mm, deep);
      if (deep > 0) widest = std::max(widest, radius);
    }
  }
  if (look.deep_mm <= 0) return look;
  look.angle_rad = look.exit_rad = 2 * kPi;
  look.wide_mm = look.effective_mm = 2 * widest;
  look.contact_mm = profile_mm(widest);
  look.cuts_centre = cuts_centre(station);
  return look;
}

/// The tip's middle goes down into what is below it.
bool EngagementScan::cuts_centre(const Station& station) const {
  if (rise_ >= 0) return false;
  const double tip = std::max(station.tip_z, heights_->bounds_mm().min.z);
  const std::optional<double> height = height_at(station.center);
  return height && *height > tip + kThinnestFront_mm;
}

/// Of the profile, up to that radius.
double EngagementScan::profile_mm(double radius) const {
  const double scaled = std::clamp(radius * lift_scale_, 0.0, double{kLifts});
  const auto k = static_cast<std::size_t>(scaled);
  return profile_[k] + (scaled - static_cast<double>(k)) * (profile_[k + 1] - profile_[k]);
}

EngagementScan::Station EngagementScan::station_at(double part) const {
  const auto place = [this](double at) {
    return point_of(arc_ ? Place{at * sweep_, arc_radius_} : Place{at * length_, 0});
  };
  Station station;
  station.tip_z = z_ + rise_ * part;
  station.center = place(part);
  station.end = place(1);
  station.is_near_end = length_ > 0 && (1 - part) * length_ < 2 * radius_ + kShort_cells * cell_;
  station.ahead = direction_;
  if (arc_) {
    const Vec2 out = (station.center - center_) / arc_radius_;
    station.ahead = turn_ * Vec2(-out.y, out.x);
  }
  return station;
}

EngagementLook EngagementScan::look_ahead(const HeightGrid& heights, const Cutter& cutter,
                                          const CutMove& move, const Look& asked) {
  set(heights, cutter, move);
  cutter_ = &cutter;
  set_held(asked.held);
  const bool knows_walls = asked.owners != nullptr && asked.ways != nullptr;
  own_until_ = 0;
  own_ = asked.own, own_part_ = asked.own_part;
  owners_ = knows_walls ? asked.owners : nullptr, ways_ = asked.ways;
  engaged_ = engaged_radius();
  if (engaged_ <= 0) return {};
  if (length_ == 0) return plunge_at(station_at(asked.at));
  // What an arc leaves behind it comes up before it again when it has gone round.
  own_until_ = arc_ ? asked.at * sweep_ - std::min(kPi, 2 * radius_ / arc_radius_) : 0;
  // What stands right before it is removed next.
  const double ahead_mm = !is_flat() ? kAheadCells * cell_ : knows_walls ? kAhead * radius_ : 0;
  fresh_mm_ = asked.behind_mm > 0 ? asked.behind_mm + ahead_mm : 0;
  const Station station = station_at(asked.at + ahead_mm / length_);
  const bool pointed = is_pointed(cutter, cell_);
  if (pointed != is_pointed_) is_pointed_ = pointed, laid_reach_ = -1;
  if (asked.is_brief && asks_cells(cutter, cell_)) {
    EngagementLook look = look_by_cells(station, asked.anticlockwise);
    if (look.is_engaged()) look.cuts_centre = cuts_centre(station_at(asked.at));
    return look;
  }
  reach_ = reach_of(station);
  const int brief_radii = is_pointed_ ? kPointedRadii : kBriefRadii;
  if (!is_flat()) lay_radii(asked.is_brief ? brief_radii : kRadii);
  FrontRays rays(kRays, radius_, is_flat());
  rays.sweep([&](double angle) { return contact_at(station, angle); });
  EngagementLook look = rays.look(asked.anticlockwise);
  if (look.is_engaged()) look.cuts_centre = cuts_centre(station_at(asked.at));
  return look;
}

}  // namespace kerf
