#include "stock/turning/revolve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/portable_math.h"
#include "stock/turning/around.h"

namespace kerf::turning {
namespace {

constexpr int kFewestSegments = 12;

std::vector<Vec2> divided_at_flats(const std::vector<Vec2>& chain, const BarFlats& flats,
                                   double tolerance_mm) {
  std::vector<Vec2> result{chain[0]};
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    const int parts = parts_at_flats(chain[i], chain[i + 1], flats, tolerance_mm);
    for (int k = 1; k < parts; ++k)
      result.push_back(chain[i] + static_cast<double>(k) / parts * (chain[i + 1] - chain[i]));
    result.push_back(chain[i + 1]);
  }
  return result;
}

std::vector<Vec2> closed_chain(const Contour& contour) {
  std::vector<Vec2> chain;
  for (const Point& p : contour.ring()) chain.push_back(to_mm(p));
  chain.push_back(chain.front());
  return chain;
}

void keep_corners(std::span<const Vec2> chain, double tolerance_mm, std::size_t first,
                  std::size_t last, std::vector<char>& kept) {
  std::vector<std::pair<std::size_t, std::size_t>> open{{first, last}};
  kept[first] = kept[last] = 1;
  while (!open.empty()) {
    const auto [begin, end] = open.back();
    open.pop_back();
    double farthest = tolerance_mm;
    std::size_t at = begin;
    for (std::size_t i = begin + 1; i < end; ++i) {
      const double distance = distance_to_edge_mm(chain[i], chain[begin], chain[end]);
      if (distance > farthest) {
        farthest = distance;
        at = i;
      }
    }
    if (at == begin) continue;
    kept[at] = 1;
    open.push_back({begin, at});
    open.push_back({at, end});
  }
}

}  // namespace

int segments_for(double radius_mm, double tolerance_mm) {
  if (!(radius_mm > tolerance_mm)) return kFewestSegments;
  const double half = portable::acos(1 - tolerance_mm / radius_mm);
  return std::max(kFewestSegments, static_cast<int>(std::ceil(kPi / half)));
}

int segments_with(int segments, const std::optional<BarFlats>& flats) {
  const int step = flats ? 2 * flats->count : 1;
  return (segments + step - 1) / step * step;
}

std::vector<Vec2> simplified(std::span<const Vec2> chain, double tolerance_mm) {
  if (!(tolerance_mm > 0) || chain.size() < 4) return {chain.begin(), chain.end()};
  std::vector<char> kept(chain.size(), 0);
  const std::size_t last = chain.size() - 1;
  if (chain.front() == chain.back()) {
    // Two corners that are sure to stay, and of a ring three.
    std::size_t far = 1;
    for (std::size_t i = 1; i < last; ++i) {
      if (glm::distance(chain[i], chain[0]) > glm::distance(chain[far], chain[0])) far = i;
    }
    std::size_t third = far == 1 ? 2 : 1;
    for (std::size_t i = 1; i < last; ++i) {
      if (i != far && distance_to_edge_mm(chain[i], chain[0], chain[far]) >
                          distance_to_edge_mm(chain[third], chain[0], chain[far]))
        third = i;
    }
    const std::array<std::size_t, 4> corners{0, std::min(far, third), std::max(far, third), last};
    for (std::size_t i = 0; i < 3; ++i)
      keep_corners(chain, tolerance_mm, corners[i], corners[i + 1], kept);
  } else {
    keep_corners(chain, tolerance_mm, 0, last, kept);
  }
  std::vector<Vec2> result;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    if (kept[i] != 0) result.push_back(chain[i]);
  }
  return result;
}

TriangleMesh revolve(std::span<const Contour> contours, double tolerance_mm,
                     const std::optional<BarFlats>& flats) {
  Unit radius = 0;
  for (const Contour& contour : contours) radius = std::max(radius, contour.box().max_y);
  const double half = tolerance_mm > 0 ? tolerance_mm / 2 : 0;
  const double finest = half > 0 ? half : kFinest_mm / 2;
  const int segments = segments_with(segments_for(to_mm(radius), finest), flats);
  const std::vector<Vec2> around = directions(segments);
  const std::vector<double> reach = flats ? reaches(segments, *flats) : std::vector<double>();
  TriangleMesh mesh;
  for (const Contour& contour : contours) {
    std::vector<Vec2> chain = simplified(closed_chain(contour), half);
    if (flats) chain = divided_at_flats(chain, *flats, finest);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> rings;  // first vertex and step
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      const bool on_axis = chain[i].y == 0;
      rings.emplace_back(static_cast<std::uint32_t>(mesh.positions_mm.size()), on_axis ? 0 : 1);
      for (std::size_t k = 0; k < (on_axis ? 1 : static_cast<std::size_t>(segments)); ++k) {
        const double r = flats ? std::min(chain[i].y, reach[k]) : chain[i].y;
        mesh.positions_mm.push_back(place({chain[i].x, r}, around[k]));
      }
    }
    for (std::size_t i = 0; i < rings.size(); ++i) {
      const auto [from, from_step] = rings[i];
      const auto [to, to_step] = rings[(i + 1) % rings.size()];
      add_strip(segments, from, from_step, to, to_step, true,
                [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
                  mesh.triangles.push_back({a, b, c});
                });
    }
  }
  return mesh;
}

}  // namespace kerf::turning
