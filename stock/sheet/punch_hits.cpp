#include "stock/sheet/punch_hits.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/portable_math.h"

namespace kerf {
namespace {

/// For pictures: as long and as wide as tools of such presses are, whatever their shape.
constexpr double kPunchLength_mm = 40, kHolder_mm = 40;
/// Beyond it, units do not fit into 64 bits.
constexpr double kFarthest_mm = 1e13;

/// Whole turns of right angles are exact: square punches keep their corners.
Vec2 direction_of(double turn_rad) {
  const double quarters = turn_rad / (kPi / 2);
  const double nearest = std::round(quarters);
  constexpr double kSameTurn = 1e-12;
  if (std::abs(quarters - nearest) > kSameTurn * std::max(1.0, std::abs(quarters))) {
    return {portable::cos(turn_rad), portable::sin(turn_rad)};
  }
  const double quarter = nearest - 4 * std::floor(nearest / 4);
  return quarter == 0   ? Vec2(1, 0)
         : quarter == 1 ? Vec2(0, 1)
         : quarter == 2 ? Vec2(-1, 0)
                        : Vec2(0, -1);
}

double area_of(const sheet::Rings& rings) {
  std::int64_t twice = 0;
  for (const sheet::Ring& ring : rings) twice += sheet::twice_area(ring);
  return sheet::twice_area_to_mm2(twice);
}

}  // namespace

Result<Cutter> punch_cutter(std::string spec, const PlaneOutline& shape) {
  if (const Done fit = check_outline(shape); !fit) return Error{fit.error()};
  // Outlines counter-clockwise, holes clockwise: turned and moved, they need no more looking at.
  ClipperLib::Clipper clipper;
  clipper.AddPaths(sheet::to_rings(shape.rings), ClipperLib::ptSubject, true);
  sheet::Rings rings;
  clipper.Execute(ClipperLib::ctUnion, rings, ClipperLib::pftEvenOdd, ClipperLib::pftEvenOdd);
  Cutter::Footprint footprint = shape.rings;
  if (footprint.size() > 1) {
    footprint.clear();
    for (const sheet::Ring& ring : rings) {
      std::vector<Vec2>& chain = footprint.emplace_back();
      for (const sheet::Point& p : ring) chain.push_back(sheet::to_mm(p));
    }
  } else if (sheet::twice_area(sheet::to_rings(footprint)[0]) < 0) {
    std::reverse(footprint[0].begin(), footprint[0].end());
  }
  double radius = 0;
  for (const std::vector<Vec2>& chain : footprint) {
    for (const Vec2& p : chain) radius = std::max(radius, glm::length(p));
  }
  ProfilePiece flat;
  flat.r1 = radius;
  Result<Cutter> cutter = Cutter::from_profile(std::move(spec), {flat});
  if (cutter) {
    cutter->set_footprint(std::move(footprint));
    cutter->set_flute_length_mm(kPunchLength_mm);
    cutter->set_shank_diameter_mm(kHolder_mm);
  }
  return cutter;
}

CutMove punch_stroke(const Vec3& place_mm, double turn_rad, std::uint64_t id) {
  CutMove stroke;
  stroke.from_mm = stroke.to_mm = place_mm;
  stroke.arc = CutArc{place_mm, {0, 0, 1}, turn_rad};
  stroke.id = id;
  return stroke;
}

double turn_of(const CutMove& stroke) { return stroke.arc ? stroke.arc->sweep_rad : 0.0; }

PlaneOutline footprint_at(const Cutter& punch, const CutMove& stroke) {
  const Vec2 place(stroke.to_mm);
  const double turn = turn_of(stroke);
  PlaneOutline shape;
  if (!(std::abs(place.x) + std::abs(place.y) + std::abs(turn) < kFarthest_mm)) return shape;
  const Vec2 along = direction_of(turn);
  for (const std::vector<Vec2>& chain : *punch.footprint()) {
    std::vector<Vec2>& ring = shape.rings.emplace_back();
    ring.reserve(chain.size());
    for (const Vec2& p : chain) {
      ring.push_back(place + Vec2(along.x * p.x - along.y * p.y, along.y * p.x + along.x * p.y));
    }
  }
  return shape;
}

double overlap_mm2(const PlaneOutline& a, const PlaneOutline& b) {
  ClipperLib::Clipper clipper;
  clipper.AddPaths(sheet::to_rings(a.rings), ClipperLib::ptSubject, true);
  clipper.AddPaths(sheet::to_rings(b.rings), ClipperLib::ptClip, true);
  sheet::Rings common;
  clipper.Execute(ClipperLib::ctIntersection, common, ClipperLib::pftEvenOdd,
                  ClipperLib::pftEvenOdd);
  return area_of(common);
}

double area_mm2(const PlaneOutline& shape) {
  ClipperLib::Clipper clipper;
  clipper.AddPaths(sheet::to_rings(shape.rings), ClipperLib::ptSubject, true);
  sheet::Rings rings;
  clipper.Execute(ClipperLib::ctUnion, rings, ClipperLib::pftEvenOdd, ClipperLib::pftEvenOdd);
  return area_of(rings);
}

namespace sheet {

Kerf kerf_of_strokes(const Cutter& punch, std::span<const CutMove> strokes) {
  Kerf kerf;
  for (const CutMove& stroke : strokes) {
    for (Ring& ring : to_rings(footprint_at(punch, stroke).rings)) {
      kerf.box.extend(bounds_of(ring));
      kerf.rings.push_back(std::move(ring));
    }
  }
  return kerf;
}

}  // namespace sheet
}  // namespace kerf
