#include "twin/process/turning/tool_plates.h"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include "stock/turning/turned_part.h"
#include "twin/process/contact_grounds.h"
#include "twin/process/turning/tool_outlines.h"

namespace kerf {
namespace {

/// How deep is worked out to this.
constexpr double kPlateDepth_mm = 0.005;

CarriedPieces plate_pieces(const TurningTool& tool, double half_width_mm) {
  std::vector<std::vector<Vec2>> polygons;
  for (const turning::GridPart& part : tool.parts(false)) {
    if (part.empty()) continue;
    std::vector<Vec2>& polygon = polygons.emplace_back();
    for (const turning::Point& corner : part.corners()) polygon.push_back(turning::to_mm(corner));
  }
  return plates_of(polygons, half_width_mm);
}

/// A plate that can be made thinner.
struct Plate {
  TurningTool tool;
  double half_width_mm = 0;
  double most_mm = 0;  ///< half of its least thickness, or more

  CarriedPieces less(double by_mm) const {
    return plate_pieces(tool.inset(by_mm), std::max(half_width_mm - by_mm, 0.0));
  }
  double depth_mm(const RigidWay& way, const Solid& still, double known_mm) const {
    const auto touches = [&](double depth) {
      Vec3 guess{0};
      const CarriedPieces thin = less(depth);
      return std::ranges::any_of(thin.pieces, [&](const Convex& piece) {
        return first_touch(piece, way, still, guess).has_value();
      });
    };
    double deep = known_mm, clear = most_mm;
    if (deep + kPlateDepth_mm >= clear || !touches(deep + kPlateDepth_mm)) return deep;
    while (clear - deep > kPlateDepth_mm) {
      const double middle = (deep + clear) / 2;
      (touches(middle) ? deep : clear) = middle;
    }
    return deep;
  }
};

CarriedBody body_of(ToolPart part, const InsertOutline& outline, double half_width_mm) {
  Vec2 low{0}, high{0};
  outline_box(outline, low, high);
  const auto plate = std::make_shared<const Plate>(
      Plate{TurningTool(outline), half_width_mm,
            std::min({half_width_mm, (high.x - low.x) / 2, (high.y - low.y) / 2})});
  CarriedBody body;
  body.part = part;
  body.whole = plate_pieces(plate->tool, half_width_mm);
  body.thin = plate->less(kContactTolerance_mm);
  body.bare = plate->less(kContactRounding_mm);
  body.stands = true;
  body.depth_mm = [plate](const RigidWay& way, const Solid& still, double known_mm) {
    return plate->depth_mm(way, still, known_mm);
  };
  return body;
}

}  // namespace

std::vector<CarriedBody> standing_bodies(const Cutter& cutter) {
  if (!cutter.insert()) return carried_bodies(tool_bodies(cutter, {}, 0));
  const ToolOutlines outlines = outlines_of(cutter);
  double half_width_mm = kBarePlate_mm;
  std::vector<CarriedBody> out;
  if (!outlines.holder.parts.empty()) {
    Vec2 low{0}, high{0};
    outline_box(outlines.holder, low, high);
    const Vec2 size = high - low;
    half_width_mm = size.x > size.y ? size.y / 2 : size.x;
  }
  if (!outlines.cutter.parts.empty())
    out.push_back(body_of(ToolPart::kCutter, outlines.cutter, half_width_mm));
  if (!outlines.holder.parts.empty())
    out.push_back(body_of(ToolPart::kHolder, outlines.holder, half_width_mm));
  return out;
}

}  // namespace kerf
