#include "stock/octree/profile_slices.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/portable_math.h"

namespace kerf::octree {
namespace {

/// Rounding must not decide whether a brick is looked at.
constexpr double kSightSlack_mm = 1e-6;

}  // namespace

ProfileSlices::ProfileSlices(const RevolvedBody& body, const Lattice& lattice, int first_layer,
                             int last_layer)
    : lattice_(lattice),
      first_(first_layer),
      last_(last_layer),
      inner_radius_mm_(body.inner_radius_mm) {
  const std::size_t layers = static_cast<std::size_t>(last_ - first_ + 1);
  hits_.resize(layers);
  sides_.resize(layers);
  spans_.resize(layers);
  for (int flat = 0; flat < body.flats; ++flat) {
    const double angle = 2 * kPi * flat / body.flats;
    flats_.push_back({portable::cos(angle), portable::sin(angle)});
  }
  for (const std::vector<Vec2>& chain : body.chains_mm)
    for (std::size_t i = 0, before = chain.size() - 1; i < chain.size(); before = i++)
      add_edge(chain[before], chain[i]);
  for (std::vector<Hit>& layer : hits_)
    std::sort(layer.begin(), layer.end(), [](const Hit& a, const Hit& b) { return a.r < b.r; });
  for (std::vector<Span>& layer : spans_) {
    std::sort(layer.begin(), layer.end(),
              [](const Span& a, const Span& b) { return a.low < b.low; });
    std::size_t kept = 0;
    for (const Span& span : layer) {
      if (kept > 0 && span.low <= layer[kept - 1].high)
        layer[kept - 1].high = std::max(layer[kept - 1].high, span.high);
      else
        layer[kept++] = span;
    }
    layer.resize(kept);
  }
}

/// Of an edge that runs from one end to the other the end of lower z belongs to it, that of higher
/// z does not, so that corners on a layer count once.
void ProfileSlices::add_edge(const Vec2& a, const Vec2& b) {
  const Vec2 low = a.x <= b.x ? a : b, high = a.x <= b.x ? b : a;
  const double length = glm::length(high - low);
  if (length == 0) return;
  Vec2 normal = Vec2(low.y - high.y, high.x - low.x) / length;  // (nz, nr), nr >= 0
  const double cell = lattice_.cell_mm.z, origin = lattice_.origin_mm.z;
  const int from = std::max(first_, static_cast<int>(std::floor((low.x - origin) / cell)) - 1);
  const int to = std::min(last_, static_cast<int>(std::floor((high.x - origin) / cell)) + 1);
  for (int layer = from; layer <= to; ++layer) {
    const double z = lattice_.place_mm(2, layer), above = lattice_.place_mm(2, layer + 1);
    const std::size_t n = static_cast<std::size_t>(layer - first_);
    const auto radius_at = [&](double at) {
      return low.y + (at - low.x) / (high.x - low.x) * (high.y - low.y);
    };
    if (low.x <= z && z < high.x) hits_[n].push_back({radius_at(z), normal.y, normal.x});
    if (high.x < z || low.x > above) continue;
    const double r0 = low.x < z ? radius_at(z) : low.y;
    const double r1 = high.x > above ? radius_at(above) : high.y;
    spans_[n].push_back({std::min(r0, r1), std::max(r0, r1)});
    if (low.y == high.y) continue;
    const double up = normal.x < 0 ? -1 : 1;
    sides_[n].push_back({low, high, up * normal.x, up * normal.y});
  }
}

bool ProfileSlices::is_within_flats(const Vec2& at) const {
  return std::all_of(flats_.begin(), flats_.end(),
                     [&](const Vec2& normal) { return glm::dot(normal, at) < inner_radius_mm_; });
}

std::size_t ProfileSlices::hits_below(int layer, double r) const {
  if (layer < first_ || layer > last_) return 0;
  const std::vector<Hit>& all = hits(layer);
  const auto above =
      std::upper_bound(all.begin(), all.end(), r, [](double at, const Hit& h) { return at < h.r; });
  return static_cast<std::size_t>(above - all.begin());
}

std::optional<BodyExit> ProfileSlices::exit_level(int layer, const Vec2& at, int axis, double sign,
                                                  double length_mm) const {
  const std::vector<Hit>& all = hits(layer);
  const std::size_t beyond = hits_below(layer, portable::hypot(at.x, at.y));
  const double x = at[axis], y = at[1 - axis];
  std::optional<BodyExit> nearest;
  const auto meet = [&](double way, const Vec3& normal) {
    if (!(way <= length_mm) || (nearest && nearest->way_mm <= way)) return;
    nearest = BodyExit{std::max(0.0, way), normal};
  };
  // Cones: outward from the one that lies farther out, inward from the bore.
  const auto meet_cone = [&](const Hit& hit, double outward) {
    const double square = hit.r * hit.r - y * y;
    if (hit.r <= 0 || square < 0) return;
    const double root = std::sqrt(square);
    for (const double place : {root, -root}) {
      const double way = sign * (place - x);
      // Where it comes from lies behind; at the very node rounding may have it so.
      if (way < -kSightSlack_mm || sign * place * outward < 0) continue;
      Vec3 normal(0);
      normal[axis] = outward * hit.nr * place / hit.r;
      normal[1 - axis] = outward * hit.nr * y / hit.r;
      normal.z = outward * hit.nz;
      meet(way, normal);
    }
  };
  if (beyond < all.size()) meet_cone(all[beyond], 1);
  if (beyond > 0) meet_cone(all[beyond - 1], -1);
  for (const Vec2& flat : flats_) {
    const double rate = sign * flat[axis];
    if (rate <= 0) continue;
    meet((inner_radius_mm_ - glm::dot(flat, at)) / rate, Vec3(flat, 0));
  }
  return nearest;
}

std::optional<BodyExit> ProfileSlices::exit_upright(int layer, const Vec2& at, double sign) const {
  const int lower = sign > 0 ? layer : layer - 1;
  if (lower < first_ || lower > last_) return std::nullopt;
  const double r = portable::hypot(at.x, at.y);
  const double start = lattice_.place_mm(2, layer);
  std::optional<BodyExit> nearest;
  for (const Side& side : sides_[static_cast<std::size_t>(lower - first_)]) {
    if ((side.from.y <= r) == (side.to.y <= r)) continue;
    const double z =
        side.from.x + (r - side.from.y) / (side.to.y - side.from.y) * (side.to.x - side.from.x);
    const double way = sign * (z - start);
    if (way < -kSightSlack_mm || way > lattice_.cell_mm.z + kSightSlack_mm) continue;
    if (nearest && nearest->way_mm <= way) continue;
    const Vec2 out = r > 0 ? at / r : Vec2(0);
    nearest = BodyExit{std::clamp(way, 0.0, lattice_.cell_mm.z),
                       Vec3(sign * side.nr * out, sign * side.nz)};
  }
  return nearest;
}

ProfileSlices::Sight ProfileSlices::sight_of(int first_layer, int layers, const Vec2& low,
                                             const Vec2& high) const {
  const Vec2 nearest(std::clamp(0.0, low.x, high.x), std::clamp(0.0, low.y, high.y));
  const Vec2 farthest(std::max(-low.x, high.x), std::max(-low.y, high.y));
  const double r0 = glm::length(nearest) - kSightSlack_mm;
  const double r1 = glm::length(farthest) + kSightSlack_mm;
  bool beyond_flat = false;
  for (const Vec2& flat : flats_) {
    double least = 0, most = 0;
    for (int axis = 0; axis < 2; ++axis) {
      least += std::min(flat[axis] * low[axis], flat[axis] * high[axis]);
      most += std::max(flat[axis] * low[axis], flat[axis] * high[axis]);
    }
    if (least > inner_radius_mm_ + kSightSlack_mm)
      beyond_flat = true;
    else if (most > inner_radius_mm_ - kSightSlack_mm)
      return Sight::kMixed;
  }
  if (beyond_flat) return Sight::kOutside;
  for (int layer = first_layer; layer < first_layer + layers; ++layer) {
    if (layer < first_ || layer > last_) continue;
    const std::vector<Span>& spans = spans_[static_cast<std::size_t>(layer - first_)];
    const auto above = std::upper_bound(spans.begin(), spans.end(), r1,
                                        [](double at, const Span& s) { return at < s.low; });
    if (above != spans.begin() && std::prev(above)->high >= r0) return Sight::kMixed;
  }
  return is_inside(first_layer, glm::length(nearest)) ? Sight::kInside : Sight::kOutside;
}

}  // namespace kerf::octree
