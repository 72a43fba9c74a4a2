#include "stock/octree/part_bodies.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace kerf::octree {
namespace {

/// A rim as an arc of no radius: the flat and the wall that meet in it are its tangents.
ToolElement rim(double radius_mm, double z_mm, bool is_lower) {
  ToolElement e;
  e.arc = true;
  e.center_r = radius_mm;
  e.center_z = z_mm;
  e.n0r = is_lower ? 0 : 1;
  e.n0z = is_lower ? -1 : 0;
  e.n1r = is_lower ? 1 : 0;
  e.n1z = is_lower ? 0 : 1;
  return e;
}

}  // namespace

ToolBody part_body(const CarriedPart& part, double raised_mm) {
  ToolBody body;
  body.radius_mm = part.radius_mm;
  body.low_mm = part.from_z_mm + raised_mm;
  body.elements[body.count++] = rim(part.radius_mm, body.low_mm, true);
  if (!std::isfinite(part.to_z_mm)) return body;
  body.endless = false;
  body.top_mm = std::max(body.low_mm, part.to_z_mm);
  body.elements[body.count++] = rim(part.radius_mm, body.top_mm, false);
  return body;
}

std::vector<ToolBody> flute_bodies(const Cutter& cutter, std::span<const ToolBody> bodies) {
  std::vector<ToolBody> out(bodies.begin(), bodies.end());
  if (!cutter.flute_length_mm() || cutter.is_flute_length_assumed()) return out;
  const double flutes_mm = *cutter.flute_length_mm();
  std::erase_if(out, [&](const ToolBody& body) { return body.low_mm >= flutes_mm; });
  for (ToolBody& body : out) {
    if (!body.endless) continue;
    assert(body.count < ToolBody::kMaxElements);
    body.elements[body.count].nz = 1;
    body.elements[body.count++].offset = flutes_mm;
    body.shape = ToolBody::Shape::kGeneral;
    body.endless = false;
    body.top_mm = flutes_mm;
  }
  return out;
}

}  // namespace kerf::octree
