#include "stock/sheet/polygon.h"

#include <cmath>

namespace kerf::sheet {

Unit to_units(double mm) { return std::llround(mm * kUnitsPerMm); }
Point to_units(const Vec2& mm) { return {to_units(mm.x), to_units(mm.y)}; }

Rings to_rings(const std::vector<std::vector<Vec2>>& chains_mm) {
  Rings rings;
  for (const std::vector<Vec2>& chain : chains_mm) {
    Ring& ring = rings.emplace_back();
    for (const Vec2& p : chain) {
      const Point point = to_units(p);
      if (ring.empty() || ring.back() != point) ring.push_back(point);
    }
    while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  }
  return rings;
}

double twice_area_to_mm2(std::int64_t twice_area) {
  return static_cast<double>(twice_area) / (2 * kUnitsPerMm * kUnitsPerMm);
}

}  // namespace kerf::sheet
