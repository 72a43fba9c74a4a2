#include "stock/zmap/rim_traces.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/portable_math.h"
#include "stock/zmap/cutter_components.h"

namespace kerf {
namespace {

/// So many cells from the side inward the cells around are all of the body (TipTraces::
/// lower_bound_mm).
constexpr double kDeepCells = 2.5;
constexpr double kLeastAngles = 64, kMostAngles = 1 << 16;
constexpr int kLeastLooks = 32, kMostLooks = 2048;
constexpr int kHalvings = 40;

double distance(const Vec2& center, const Vec3& p) {
  return portable::hypot(p.x - center.x, p.y - center.y);
}

}  // namespace

RimTraces::RimTraces(std::span<const BlankBody> bodies, double cell_mm) : cell_mm_(cell_mm) {
  const double deep = kDeepCells * cell_mm;
  for (const BlankBody& body : bodies) {
    if (body.kind == BlankBody::Kind::kBox || body.axis != 'z') continue;
    Rim rim;
    rim.center = Vec2(body.center_mm);
    rim.top = body.bounds_mm.max.z;
    rim.floor = body.bounds_mm.min.z;
    for (const bool bore : {false, true}) {
      if (bore && body.kind != BlankBody::Kind::kTube) continue;
      rim.bore = bore;
      rim.radius = (bore ? body.inner_diameter_mm : body.diameter_mm) / 2;
      rim.inner = bore ? rim.radius : std::max(0.0, rim.radius - deep);
      rim.outer = bore ? rim.radius + deep : rim.radius;
      const double angles = std::ceil(2 * kPi * rim.radius / cell_mm);
      rim.lowest.assign(static_cast<std::size_t>(std::clamp(angles, kLeastAngles, kMostAngles)),
                        static_cast<float>(rim.top));
      rims_.push_back(rim);
    }
  }
}

bool RimTraces::is_near(const Vec3& a, const Vec3& b, double beyond_mm, double radius_mm) const {
  return std::any_of(rims_.begin(), rims_.end(), [&](const Rim& rim) {
    const double far = std::max(distance(rim.center, a) + beyond_mm, distance(rim.center, b));
    return far + radius_mm >= rim.inner;
  });
}

std::size_t RimTraces::Rim::at(double x, double y) const {
  const double turn = portable::atan2(y - center.y, x - center.x) / (2 * kPi);
  const auto count = static_cast<double>(lowest.size());
  const double place = std::floor((turn < 0 ? turn + 1 : turn) * count);
  return static_cast<std::size_t>(std::clamp(place, 0.0, count - 1));
}

void RimTraces::Rim::lower(double angle, double half_angle, double z) {
  const auto level = static_cast<float>(z);
  const auto count = static_cast<std::ptrdiff_t>(lowest.size());
  const double each = 2 * kPi / static_cast<double>(count);
  auto first = static_cast<std::ptrdiff_t>(std::floor((angle - half_angle) / each));
  auto last = static_cast<std::ptrdiff_t>(std::floor((angle + half_angle) / each));
  if (last - first >= count - 1) {
    first = 0;
    last = count - 1;
  }
  for (std::ptrdiff_t i = first; i <= last; ++i) {
    float& one = lowest[static_cast<std::size_t>(((i % count) + count) % count)];
    one = std::min(one, level);
  }
}

/// Pieces of the way as discs that hold all of them.
void RimTraces::add_to(Rim& rim, const Vec3& a, const Vec3& b, double radius_mm, double low_mm,
                       double step_mm) {
  if (std::min(a.z, b.z) + low_mm >= rim.top) return;
  const Vec3 way = b - a;
  const int pieces = static_cast<int>(std::ceil(portable::hypot(way.x, way.y) / step_mm)) + 1;
  const double reach = radius_mm + 0.5 * portable::hypot(way.x, way.y) / pieces;
  for (int i = 0; i < pieces; ++i) {
    const Vec3 middle = a + (i + 0.5) / pieces * way;
    const double off = distance(rim.center, middle);
    if (off - reach > rim.outer || off + reach < rim.inner) continue;
    double half_angle = kPi;
    if (reach < off) {
      const bool whole = off * off - reach * reach <= rim.outer * rim.outer;
      const double seen =
          (off * off + rim.outer * rim.outer - reach * reach) / (2 * off * rim.outer);
      half_angle =
          whole ? portable::asin(reach / off) : portable::acos(std::clamp(seen, -1.0, 1.0));
    }
    const double z = std::min(a.z + way.z * i / pieces, a.z + way.z * (i + 1) / pieces) + low_mm;
    if (z >= rim.top) continue;
    rim.lower(portable::atan2(middle.y - rim.center.y, middle.x - rim.center.x), half_angle, z);
  }
}

void RimTraces::add(const Vec3& a, const Vec3& b, double radius_mm, double low_mm) {
  if (!is_near(a, b, 0, radius_mm)) return;
  const double step_mm = std::max(cell_mm_, radius_mm / 8);
  for (Rim& rim : rims_) add_to(rim, a, b, radius_mm, low_mm, step_mm);
}

double RimTraces::Rim::depth(const ConvexTool& tool, const TipWay& way, double tolerance_mm,
                             double t) const {
  const Vec3 tip = way.from + t * way.step;
  const double off = distance(center, tip);
  // Nearer to the middle of the material the cells tell.
  if (bore ? off > outer : off < inner) return 0;
  const double in = bore ? radius + tolerance_mm - off : off - radius + tolerance_mm;
  if (in > tool.radius) return 0;
  const double material = static_cast<double>(lowest[at(tip.x, tip.y)]);
  const double bottom = tip.z + surface_height(tool, std::max(in, 0.0));
  return bottom < material - tolerance_mm ? material - std::max(bottom, floor) : 0;
}

RimTraces::Touch RimTraces::first_touch(const ConvexTool& tool, const TipWay& way,
                                        double tolerance_mm) const {
  Touch touch;
  const double length = portable::hypot(way.step.x, way.step.y);
  const double lowest = std::min(way.from.z, way.from.z + way.step.z) + surface_height(tool, 0);
  for (const Rim& rim : rims_) {
    if (lowest >= rim.top - tolerance_mm) continue;
    const Vec2 to_center = rim.center - Vec2(way.from);
    const double along =
        length > 0 ? std::clamp(glm::dot(to_center, Vec2(way.step)) / (length * length), 0.0, 1.0)
                   : 0.0;
    if (!rim.bore && distance(rim.center, way.from + along * way.step) > rim.radius + tool.radius) {
      continue;
    }
    const auto depth = [&](double t) { return rim.depth(tool, way, tolerance_mm, t); };
    const int looks = static_cast<int>(
        std::clamp(length / (2 * cell_mm_), double{kLeastLooks}, double{kMostLooks}));
    double clear = 0;
    double first = depth(along) > 0 ? along : Touch{}.t;
    touch.depth_mm = std::max(touch.depth_mm, depth(along));
    for (int i = 0; i <= looks; ++i) {
      const double t = static_cast<double>(i) / looks;
      const double found = depth(t);
      touch.depth_mm = std::max(touch.depth_mm, found);
      if (found > 0) first = std::min(first, t);
      if (found <= 0 && t < first) clear = t;
    }
    if (first > 1) continue;
    for (int n = 0; n < kHalvings && clear < first && first > 0; ++n) {
      const double middle = 0.5 * (clear + first);
      (depth(middle) > 0 ? first : clear) = middle;
    }
    touch.t = std::min(touch.t, first);
  }
  return touch;
}

}  // namespace kerf
