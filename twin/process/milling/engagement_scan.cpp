#include "twin/process/milling/engagement_scan.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/golden_section.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// What is thinner is not there: heights are floats.
constexpr double kLeast_mm = 1e-4;
/// What one look at the cutter's surface costs, and what a search for a place of it does, in places
/// (Cost).
constexpr double kLook = 0.3;
constexpr double kSearch = 2 * 26 * kLook, kQuickSearch = 4 * kLook;
constexpr int kSearchSteps = 26;
constexpr double kWholeTurn = 2 * kPi * (1 + 1e-9);
constexpr double kSameRadius_mm = 1e-3;
/// Of few cells so many places side by side are looked at, where the material is level.
constexpr int kMostInCell = 8, kInRim = 3;
constexpr double kSameLevel_mm = 1e-5;

double wrapped(double angle) {
  const double turned = std::fmod(angle, 2 * kPi);
  return turned < 0 ? turned + 2 * kPi : turned;
}

/// Greatest radius at which the cutter is as low as its tip.
double flat_radius(const Cutter& cutter) {
  double flat = 0, rises = cutter.radius_mm();
  if (cutter.height_mm(rises * (1 - 1e-9)) <= 0) return rises;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (flat + rises);
    (cutter.height_mm(middle) <= 1e-9 ? flat : rises) = middle;
  }
  return flat;
}

/// Places within cells that fill them evenly, along a row and over all: 0 .. 1 of each edge.
Vec2 spread_in_cell(int i, int j) {
  const double n = i + 1297.0 * j;
  const double x = 0.5 + n * 0.7548776662466927, y = 0.5 + n * 0.5698402909980532;
  return {x - std::floor(x), y - std::floor(y)};
}

struct Range {
  double low = -kNever, high = kNever;
  /// Where low <= offset + x * slope <= high.
  void within(double offset, double slope, double least, double most) {
    if (std::abs(slope) < 1e-12) {
      if (offset < least || offset > most) high = -kNever;
      return;
    }
    const double a = (least - offset) / slope, b = (most - offset) / slope;
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
  }
};

}  // namespace

bool EngagementScan::takes(const Cutter& cutter, const CutMove& move) {
  if (cutter.undercuts() || cutter.footprint() != nullptr || !move.is_vertical()) return false;
  if (!move.arc) return true;
  const CutArc& arc = *move.arc;
  if (std::abs(arc.axis.z) < 1 - 1e-12 || std::abs(arc.sweep_rad) > kWholeTurn) return false;
  const Vec2 from = Vec2(move.from_mm - arc.center_mm), to = Vec2(move.to_mm - arc.center_mm);
  const double radius = glm::length(from);
  return radius > kSameRadius_mm && std::abs(glm::length(to) - radius) < kSameRadius_mm;
}

void EngagementScan::set_cutter(const Cutter& cutter) {
  if (cutter_spec_ == cutter.spec() && !lift_.empty()) return;
  cutter_spec_ = cutter.spec();
  radius_ = cutter.radius_mm();
  flat_radius_ = flat_radius(cutter);
  side_ = ToolSide::of(cutter);
  weighed_mm_ = 0, laid_reach_ = -1;
  lift_.resize(kLifts + 2);
  lift_scale_ = kLifts / radius_;
  for (int k = 0; k <= kLifts; ++k) {
    lift_[static_cast<std::size_t>(k)] = cutter.height_mm(std::min(radius_ * k / kLifts, radius_));
  }
  lift_[kLifts + 1] = lift_[kLifts];
  low_lift_.resize(kLifts + 2);
  for (int k = 0; k <= kLifts + 1; ++k) {
    const double inner = std::max(0.0, std::sqrt(static_cast<double>(k) / kLifts) - 1.0 / kLifts);
    const double lift = cutter.height_mm(std::min(inner, 1.0) * radius_);
    low_lift_[static_cast<std::size_t>(k)] = static_cast<float>(lift - kThinnestFilm_mm / 2);
  }
  profile_.assign(kLifts + 2, 0.0);
  for (std::size_t k = 1; k <= kLifts; ++k) {
    const bool rises = static_cast<double>(k) > flat_radius_ * lift_scale_;
    profile_[k] =
        profile_[k - 1] + (rises ? std::hypot(1 / lift_scale_, lift_[k] - lift_[k - 1]) : 0);
  }
  profile_[kLifts + 1] = profile_[kLifts];
}

void EngagementScan::set(const HeightGrid& heights, const Cutter& cutter, const CutMove& move) {
  heights_ = &heights;
  set_cutter(cutter);
  z_ = move.from_mm.z;
  rise_ = move.to_mm.z - z_;
  low_z_ = std::max(std::min(z_, z_ + rise_), heights.bounds_mm().min.z);
  start_ = Vec2(move.from_mm);
  cell_ = std::max(heights.cell_x_mm(), heights.cell_y_mm());
  half_along_ = cell_ / 2;
  arc_ = move.arc.has_value();
  if (arc_) {
    center_ = Vec2(move.arc->center_mm);
    const Vec2 arm = start_ - center_;
    arc_radius_ = glm::length(arm);
    start_angle_ = std::atan2(arm.y, arm.x);
    turn_ = move.arc->sweep_rad * move.arc->axis.z < 0 ? -1 : 1;
    sweep_ = std::abs(move.arc->sweep_rad);
    length_ = sweep_ * arc_radius_;
    motion_ = {};
    motion_.kind = MotionKind::kArc;
    motion_.from_mm = move.from_mm;
    motion_.to_mm = move.to_mm;
    motion_.arc = {move.arc->center_mm, move.arc->axis, move.arc->sweep_rad};
  } else {
    const Vec2 way = Vec2(move.to_mm) - start_;
    length_ = glm::length(way);
    if (length_ < 1e-9) length_ = 0;
    direction_ = length_ > 0 ? way / length_ : Vec2(1, 0);
    half_along_ *= std::abs(direction_.x) + std::abs(direction_.y);
  }
}

EngagementScan::Place EngagementScan::place_of(const Vec2& point) const {
  if (!arc_) {
    const Vec2 arm = point - start_;
    return {glm::dot(arm, direction_), direction_.x * arm.y - direction_.y * arm.x};
  }
  const Vec2 arm = point - center_;
  return {wrapped(turn_ * (std::atan2(arm.y, arm.x) - start_angle_)), glm::length(arm)};
}

Vec2 EngagementScan::point_of(const Place& place) const {
  if (!arc_) {
    return start_ + place.along * direction_ + place.beside * Vec2(-direction_.y, direction_.x);
  }
  const double angle = start_angle_ + turn_ * place.along;
  return center_ + place.beside * Vec2(std::cos(angle), std::sin(angle));
}

double EngagementScan::beside_mm(const Place& place) const {
  return std::abs(arc_ ? place.beside - arc_radius_ : place.beside);
}

/// `outward_mm`: away from the way, or (below 0) nearer to it, but not beyond it.
EngagementScan::Place EngagementScan::moved(const Place& place, double along_mm,
                                            double outward_mm) const {
  const double middle = arc_ ? arc_radius_ : 0, side = place.beside < middle ? -1 : 1;
  const double away = std::max(0.0, beside_mm(place) + outward_mm);
  return {place.along + (arc_ ? along_mm / std::max(place.beside, cell_) : along_mm),
          std::max(arc_ ? 0.0 : -kNever, middle + side * away)};
}

double EngagementScan::distance2(const Place& place, double t) const {
  if (!arc_) {
    const double along = place.along - t * length_;
    return along * along + place.beside * place.beside;
  }
  const double r = arc_radius_, p = place.beside;
  return r * r + p * p - 2 * r * p * std::cos(place.along - t * sweep_);
}

double EngagementScan::surface(const Place& place, double t) const {
  const double distance = std::sqrt(std::max(0.0, distance2(place, t)));
  const double scaled = std::min(distance * lift_scale_, double{kLifts});
  const auto k = static_cast<std::size_t>(scaled);
  const double part = scaled - static_cast<double>(k);
  return z_ + rise_ * t + lift_[k] + part * (lift_[k + 1] - lift_[k]);
}

bool EngagementScan::pass_at(double nearest, double half, double from, double to,
                             Pass& pass) const {
  pass.first = std::max(from, nearest - half);
  pass.last = std::min(to, nearest + half);
  pass.middle = nearest;
  pass.nearest = std::clamp(nearest, pass.first, std::max(pass.first, pass.last));
  return pass.first < pass.last;
}

int EngagementScan::passes(const Place& place, double from, double to, Pass (&found)[3]) const {
  const double beside = beside_mm(place);
  if (!arc_) {
    const double rest = radius_ * radius_ - place.beside * place.beside;
    if (rest <= 0) return 0;
    if (length_ == 0) {
      if (distance2(place, 0) >= radius_ * radius_) return 0;
      found[0] = {from, to, to, to};
      return 1;
    }
    return pass_at(place.along / length_, std::sqrt(rest) / length_, from, to, found[0]) ? 1 : 0;
  }
  if (beside >= radius_) return 0;
  const double p = std::max(place.beside, 1e-9);
  const double cosine =
      (arc_radius_ * arc_radius_ + p * p - radius_ * radius_) / (2 * arc_radius_ * p);
  if (cosine >= 1) return 0;
  if (cosine <= -1) return pass_at(place.along / sweep_, kNever, from, to, found[0]) ? 1 : 0;
  const double half = std::acos(cosine) / sweep_;
  int count = 0;
  for (int turn = -1; turn <= 1; ++turn) {
    const double nearest = (place.along + turn * 2 * kPi) / sweep_;
    if (pass_at(nearest, half, from, to, found[count])) ++count;
  }
  return count;
}

Box EngagementScan::path_box(double from, double to) const {
  Box box;
  if (!arc_) {
    for (const double t : {from, to}) box.extend(Vec3(start_ + t * length_ * direction_, 0));
    return box;
  }
  Motion part = motion_;
  part.from_mm = point_at(motion_, from);
  part.to_mm = point_at(motion_, to);
  part.arc.sweep_rad *= to - from;
  return bounds_of(part);
}

/// So are all cells beside it, or there are none.
bool EngagementScan::is_level_about(int i, int j) const {
  const float height = heights_->height(i, j);
  for (int row = std::max(0, j - 1); row <= std::min(heights_->ny() - 1, j + 1); ++row) {
    for (int column = std::max(0, i - 1); column <= std::min(heights_->nx() - 1, i + 1); ++column) {
      const auto step = static_cast<double>(heights_->height(column, row) - height);
      if (std::abs(step) > kSameLevel_mm) return false;
    }
  }
  return true;
}

/// Visits cells that the cutter comes over on that part of the way, every n-th of a row: no more
/// than about kMostPoints of them, where they are not to be farther apart than that.
template <class Visit>
void EngagementScan::each_cell(double from, double to, double most_apart_mm, Visit&& visit) {
  const Box& box = heights_->bounds_mm();
  const double cell_x = heights_->cell_x_mm(), cell_y = heights_->cell_y_mm();
  const Box path = path_box(from, to);
  const Vec2 low = Vec2(path.min) - radius_, high = Vec2(path.max) + radius_;
  const auto index = [](double at, double cell, int count) {
    return static_cast<int>(std::clamp(std::floor(at / cell), -1.0, static_cast<double>(count)));
  };
  const int i0 = std::max(0, index(low.x - box.min.x, cell_x, heights_->nx()));
  const int i1 = std::min(heights_->nx() - 1, index(high.x - box.min.x, cell_x, heights_->nx()));
  const int j0 = std::max(0, index(low.y - box.min.y, cell_y, heights_->ny()));
  const int j1 = std::min(heights_->ny() - 1, index(high.y - box.min.y, cell_y, heights_->ny()));
  if (i0 > i1 || j0 > j1) return;
  const double reach = arc_ ? radius_ : engaged_, way = (to - from) * length_ + 2 * reach;
  const double cells = std::min(way * 2 * reach / (cell_x * cell_y),
                                static_cast<double>(i1 - i0 + 1) * (j1 - j0 + 1));
  const int most = std::max(1, static_cast<int>(std::min(most_apart_mm / cell_, 1e6)));
  const int n = std::clamp(static_cast<int>(std::ceil(cells / kMostPoints)), 1, most);
  const int skew = std::max(1, static_cast<int>(std::lround(0.618 * n)));
  // Cells of level material are no grain of it: where an edge of the cutter is can be told there.
  // Not of flat ones that go sideways: beside a wall, which is where cells end, it has to be
  // rounded as that was.
  const bool told = !is_flat() || length_ == 0;
  const int finer =
      told ? std::clamp(static_cast<int>(std::sqrt(kMostPoints / cells)), 1, kMostInCell) : 1;
  // Along a row, or (arcs go along none) in any direction.
  apart_mm_ = cell_ * (arc_ ? std::sqrt(double{1} * n) : n);
  const double behind = cell_ + (rise_ < 0 || from <= from_ ? reach : 0);
  const bool by_columns = !arc_ && std::abs(direction_.y) > std::abs(direction_.x);
  const int row0 = by_columns ? i0 : j0, row1 = by_columns ? i1 : j1;
  const int inner0 = by_columns ? j0 : i0, inner1 = by_columns ? j1 : i1;
  const double row_mm = by_columns ? cell_x : cell_y, inner_mm = by_columns ? cell_y : cell_x;
  const double row_min = by_columns ? box.min.x : box.min.y;
  const double inner_min = by_columns ? box.min.y : box.min.x;
  for (int row = row0; row <= row1; ++row) {
    const double across = row_min + (row + 0.5) * row_mm;
    int first = inner0, last = inner1;
    if (!arc_) {
      const Place at_zero = place_of(by_columns ? Vec2(across, 0) : Vec2(0, across));
      Range range;
      range.within(at_zero.along, by_columns ? direction_.y : direction_.x, from * length_ - behind,
                   to * length_ + reach + cell_);
      range.within(at_zero.beside, by_columns ? direction_.x : -direction_.y, -reach - cell_,
                   reach + cell_);
      if (range.low > range.high) continue;
      first = std::max(first, index(range.low - inner_min, inner_mm, inner1 + 1));
      last = std::min(last, index(range.high - inner_min, inner_mm, inner1 + 1));
    }
    const int phase = static_cast<int>((static_cast<long long>(row) * skew) % n);
    for (int k = first + (phase - first % n + n) % n; k <= last; k += n) {
      cost_.looks += 1;
      const int i = by_columns ? row : k, j = by_columns ? k : row;
      const auto height = static_cast<double>(heights_->height(i, j));
      if (height <= low_z_ + kLeast_mm) continue;
      const Vec2 cell(cell_x, cell_y), corner = Vec2(box.min) + Vec2(i, j) * cell;
      const bool rim = told && beside_mm(place_of(corner + 0.5 * cell)) > engaged_ - cell_;
      const bool level = (finer > 1 || rim) && is_level_about(i, j);
      const int each = level ? std::max(finer, rim ? kInRim : 1) : 1;
      cost_.places += each * each;
      for (int part = 0; part < each * each; ++part) {
        const Vec2 shift = level ? spread_in_cell(i, j) : Vec2(0.5);
        const Vec2 in = (Vec2(part % each, part / each) + shift) / static_cast<double>(each);
        visit(place_of(corner + in * cell), height, cell_x * cell_y * n / (each * each));
      }
    }
  }
}

int EngagementScan::bin_of(double t) const {
  const auto last = static_cast<int>(bins_.size()) - 1;
  return std::clamp(static_cast<int>((t - from_) / bin_), 0, last);
}

/// Spread evenly.
void EngagementScan::add(double from, double to, double mm3) {
  from = std::max(from, from_), to = std::min(to, to_);
  const int first = bin_of(from), last = bin_of(to);
  if (first == last || to <= from) {
    bins_[static_cast<std::size_t>(first)] += mm3;
    return;
  }
  for (int b = first; b <= last; ++b) {
    const double begin = std::max(from, from_ + b * bin_);
    const double end = b == last ? to : from_ + (b + 1) * bin_;
    bins_[static_cast<std::size_t>(b)] += mm3 * std::max(0.0, end - begin) / (to - from);
  }
}

void EngagementScan::take(const Place& place, double height, double area_mm2) {
  Pass found[3];
  const int count = passes(place, from_, to_, found);
  for (int k = 0; k < count; ++k) height = take_pass(place, found[k], height, area_mm2);
}

/// Returns how high the material is behind it.
double EngagementScan::take_pass(const Place& place, const Pass& pass, double height,
                                 double area_mm2) {
  const double floor = heights_->bounds_mm().min.z;
  double rest = height;
  const double at_once = std::max(floor, surface(place, pass.first));
  if (at_once < height - kLeast_mm) {
    const double half = pass.first > from_ ? spread_ : 0;
    add(pass.first - half, pass.first + half, (height - at_once) * area_mm2);
    rest = at_once;
  }
  const bool level = rise_ == 0;
  if (level && beside_mm(place) < flat_radius_ && is_flat()) return rest;
  const double end = rise_ < 0 ? pass.last : pass.nearest;
  double begin = pass.first;
  if (length_ == 0 && rise_ < 0) {
    begin = std::max(begin, (height - surface(place, 0)) / rise_);
    if (begin >= end) return rest;
  }
  cost_.places += (rise_ < 0 ? 4 : 1) * kLook * (bin_of(end) - bin_of(begin) + 2);
  for (int b = bin_of(begin); b <= bin_of(end); ++b) {
    const double from = from_ + b * bin_, to = std::min(end, from + bin_);
    double level_mm = surface(place, to);
    if (pass.nearest > from && pass.nearest < to) {
      level_mm = std::min(level_mm, surface(place, pass.nearest));
    }
    // On the way down it is lowest somewhere behind that.
    if (rise_ < 0 && length_ > 0 && pass.nearest < to) {
      for (const double part : {0.25, 0.5, 0.75}) {
        level_mm = std::min(level_mm, surface(place, from + part * (to - from)));
      }
    }
    level_mm = std::max(level_mm, floor);
    if (level_mm >= rest) continue;
    bins_[static_cast<std::size_t>(b)] += (rest - level_mm) * area_mm2;
    rest = level_mm;
  }
  return rest;
}

/// Where the cutter's surface is lowest over the place; it falls before that and rises behind it.
double EngagementScan::lowest_at(const Place& place, const Pass& pass) const {
  if (rise_ == 0) return pass.nearest;
  if (is_flat()) return rise_ < 0 ? pass.last : pass.first;
  const auto low_at = [&](double t) { return surface(place, t); };
  return golden_section(low_at, pass.first, pass.last, kSearchSteps).middle();
}

/// On a level way: when the surface goes down through that height.
double EngagementScan::level_crossing(const Place& place, const Pass& pass, double height) const {
  const auto higher = std::upper_bound(lift_.begin(), lift_.end() - 1, height - z_);
  const double k = static_cast<double>(higher - lift_.begin());
  double radius = std::min(k, double{kLifts}) / lift_scale_;
  if (higher != lift_.begin() && higher != lift_.end() - 1 && std::isfinite(*higher)) {
    const double low = *(higher - 1), part = (height - z_ - low) / (*higher - low);
    radius = (k - 1 + part) / lift_scale_;
  }
  const double beside = place.beside;
  double half = 0;
  if (!arc_) {
    half = std::sqrt(std::max(0.0, radius * radius - beside * beside)) / length_;
  } else {
    const double cosine = (arc_radius_ * arc_radius_ + beside * beside - radius * radius) /
                          std::max(2 * arc_radius_ * beside, 1e-9);
    half = std::acos(std::clamp(cosine, -1.0, 1.0)) / sweep_;
  }
  return std::clamp(pass.middle - half, pass.first, pass.nearest);
}

double EngagementScan::first_below(const Place& place, const Pass& pass, double height) const {
  if (surface(place, pass.first) < height - kLeast_mm) return pass.first;
  double above = pass.first, below = lowest_at(place, pass);
  if (surface(place, below) >= height - kLeast_mm) return kNever;
  if (is_level()) return level_crossing(place, pass, height);
  if (is_flat()) return std::clamp((height - z_) / rise_, above, below);
  for (int i = 0; i < kSearchSteps; ++i) {
    const double middle = 0.5 * (above + below);
    (surface(place, middle) < height ? below : above) = middle;
  }
  return below;
}

/// When the surface has gone as far down as it goes.
double EngagementScan::settled(const Place& place, const Pass& pass) const {
  const double lowest = lowest_at(place, pass), level = surface(place, lowest) + 1e-7;
  if (surface(place, pass.first) <= level) return pass.first;
  if (is_level()) return level_crossing(place, pass, level);
  if (is_flat()) return lowest;
  double above = pass.first, below = lowest;
  for (int i = 0; i < kSearchSteps; ++i) {
    const double middle = 0.5 * (above + below);
    (surface(place, middle) <= level ? below : above) = middle;
  }
  return below;
}

/// When what stands there begins to be removed, if that is before `best`; else kNever.
double EngagementScan::begin_of(const Place& place, double height, double from, double to,
                                double best) {
  Pass found[3], square[3];
  const double half = length_ > 0 ? half_along_ : 0;
  const int count = passes(place, from_, to_, found);
  if (count == 0 || found[0].first - half / std::max(length_, cell_) > best) return kNever;
  double removed = kNever;
  for (int k = 0; k < count && removed == kNever; ++k) {
    if (found[k].last >= from) removed = first_below(place, found[k], height);
  }
  cost_.places += is_level() || is_flat() ? kQuickSearch : 2 * kSearch;
  if (removed < from || removed > to) return kNever;
  // Sides of the blank are where cells end; other walls are somewhere about their middles.
  const Place edge = moved(place, -half, is_at_side(place) ? -half : 0);
  const int edges = passes(edge, from_, to_, square);
  double begin = removed;
  for (int k = 0; k < edges; ++k) {
    const double met = first_below(edge, square[k], height);
    if (met >= from) begin = std::min(begin, met);
  }
  return begin;
}

std::optional<double> EngagementScan::height_at(const Vec2& point) const {
  const Vec2 at = point - Vec2(heights_->bounds_mm().min);
  const double i = std::floor(at.x / heights_->cell_x_mm());
  const double j = std::floor(at.y / heights_->cell_y_mm());
  if (i < 0 || j < 0 || i >= heights_->nx() || j >= heights_->ny()) return std::nullopt;
  return behind_held(
      point, static_cast<double>(heights_->height(static_cast<int>(i), static_cast<int>(j))));
}

/// Beyond the edge of what is swept there, a cell away, is material.
bool EngagementScan::stands_beside(const Place& place, double tip_mm) const {
  const Vec2 point = point_of(moved(place, 0, radius_ + cell_ - beside_mm(place)));
  return height_at(point).value_or(tip_mm) > tip_mm + kLeast_mm;
}

/// Nearer to the way is no blank any more.
bool EngagementScan::is_at_side(const Place& place) const {
  return !height_at(point_of(moved(place, 0, -cell_)));
}

/// When the cutter leaves the square about a cell of which it removes the middle then.
double EngagementScan::left_at(const Place& place, double removed_to) {
  const double half = half_along_, beside = beside_mm(place);
  double outward = std::min(half, radius_ - beside - 1e-9);
  const bool at_wall =
      beside + half > radius_ - cell_ && stands_beside(place, z_ + rise_ * removed_to);
  if (at_wall) outward = radius_ - beside - 1e-9;
  Pass square[3];
  const Place edge = moved(place, half, outward);
  const int edges = passes(edge, from_, to_, square);
  double left = removed_to;
  for (int k = 0; k < edges; ++k) left = std::max(left, settled(edge, square[k]));
  // The way ends before the widest comes to the end of the wall.
  if (edges == 0 && at_wall && !arc_ && edge.along > to_ * length_) left = to_;
  return left;
}

/// When what stands there is removed and left, if that is behind `best`.
double EngagementScan::end_of(const Place& place, double height, double from, double to,
                              double best) {
  Pass found[3];
  const int count = passes(place, from_, to_, found);
  for (int k = count - 1; k >= 0; --k) {
    const Pass& pass = found[k];
    if (pass.first > to || pass.last < best) continue;
    cost_.places += is_level() || is_flat() ? kQuickSearch : 2 * kSearch;
    const double lowest = surface(place, lowest_at(place, pass));
    if (lowest >= height - kLeast_mm) continue;
    const double removed_to = settled(place, pass);
    if (removed_to < from || removed_to > to) continue;
    best = std::max(best, length_ > 0 ? left_at(place, removed_to) : removed_to);
  }
  return best;
}

void EngagementScan::set_bins(double bin_mm) {
  const double way_mm = (to_ - from_) * std::hypot(length_, rise_);
  const int bins = std::clamp(static_cast<int>(std::ceil(way_mm / bin_mm)), 1, kMostBins);
  bin_ = (to_ - from_) / bins;
  bins_.assign(static_cast<std::size_t>(bins), 0.0);
}

EngagementScan::Cost EngagementScan::run_part(double from, double to, int bins) {
  cost_ = {};
  from_ = from, to_ = to;
  bin_ = (to - from) / bins;
  bins_.assign(static_cast<std::size_t>(bins), 0.0);
  each_cell(from, to, length_ > 0 ? 2 * bin_ * length_ : 16 * cell_,
            [&](const Place& place, double height, double area_mm2) {
              spread_ = length_ > 0 ? apart_mm_ / 2 / length_ : 0;
              const double rest = held_.length > 0 ? behind_held(point_of(place), height) : height;
              if (rest > low_z_ + kLeast_mm) take(place, rest, area_mm2);
            });
  return cost_;
}

}  // namespace kerf
