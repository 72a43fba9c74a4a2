#include "twin/process/carried_bodies.h"

#include <array>
#include <utility>

#include "twin/collision/solid_sweep.h"
#include "twin/process/contact_grounds.h"

namespace kerf {
namespace {

CarriedPieces pieces_of(SolidPointer solid) {
  CarriedPieces out;
  out.pieces.assign(solid->pieces().begin(), solid->pieces().end());
  out.box_mm = solid->box_mm();
  out.owner = std::move(solid);
  return out;
}

SolidPointer thinner(const Solid& solid, double by_mm) {
  std::vector<std::vector<RoundedDisc>> hulls;
  std::array<Vec3, 2> corners{};
  for (const Convex& piece : solid.pieces()) {
    hulls.emplace_back();
    eroded(piece, by_mm, hulls.back(), corners);
  }
  return Solid::of_hulls(hulls);
}

}  // namespace

std::vector<CarriedBody> carried_bodies(std::span<const ToolBody> bodies) {
  std::vector<CarriedBody> out;
  for (const ToolBody& body : bodies) {
    CarriedBody carried;
    carried.part = body.part;
    carried.whole = pieces_of(body.solid);
    carried.thin = pieces_of(thinner(*body.solid, kContactTolerance_mm));
    carried.bare = pieces_of(thinner(*body.solid, kContactRounding_mm));
    carried.width_mm = body.width_mm;
    carried.from_z_mm = body.from_z_mm;
    carried.depth_mm = [solid = body.solid](const RigidWay& way, const Solid& still,
                                            double known_mm) {
      return touch_depth_mm(*solid, way, still, known_mm);
    };
    out.push_back(std::move(carried));
  }
  return out;
}

CarriedPieces plates_of(std::span<const std::vector<Vec2>> polygons, double half_width_mm) {
  auto corners = std::make_shared<std::vector<std::vector<Vec3>>>();
  for (const std::vector<Vec2>& polygon : polygons) {
    std::vector<Vec3>& plate = corners->emplace_back();
    for (const Vec2& p : polygon) {
      plate.emplace_back(p.y, -half_width_mm, p.x);
      plate.emplace_back(p.y, half_width_mm, p.x);
    }
  }
  CarriedPieces out;
  for (const std::vector<Vec3>& plate : *corners) {
    Convex piece;
    piece.corners = plate;
    out.pieces.push_back(piece);
    out.box_mm.extend(piece.box_mm());
  }
  out.owner = std::move(corners);
  return out;
}

}  // namespace kerf
