#include "stock/turning/wound_surface.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "base/portable_math.h"
#include "stock/turning/around.h"
#include "stock/turning/revolve.h"

namespace kerf::turning {
namespace {

/// Edges that turn by more are seen as such.
constexpr double kEdgeCosine = 0.866;
/// A turn is divided at least so often: so that a groove moves along by little in a step.
constexpr int kFewestSections = 72;

Vec2 direction_at(int i, int segments) {
  const double angle = 2 * kPi * (i == segments ? 0 : i) / segments;
  return {portable::cos(angle), portable::sin(angle)};
}

BandChain closed_chain_of(const Contour& contour) {
  BandChain chain;
  for (const Point& p : contour.ring()) chain.points.push_back(to_mm(p));
  chain.marks.resize(chain.points.size());
  chain.points.push_back(chain.points.front());
  return chain;
}

/// A closed one, at the corner of lowest z, of these the lowest.
void begin_at_lowest(BandChain& chain) {
  std::vector<Vec2>& points = chain.points;
  if (points.front() != points.back()) return;
  points.pop_back();
  const auto first = std::min_element(
      points.begin(), points.end(),
      [](const Vec2& a, const Vec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::rotate(chain.marks.begin(), chain.marks.begin() + (first - points.begin()),
              chain.marks.end());
  std::rotate(points.begin(), first, points.end());
  points.push_back(points.front());
}

double squared(const Vec2& v) { return glm::dot(v, v); }

/// Joins two chains from end to end. `step(i, j, along_first)`: the triangle of corner i of the
/// first, j of the second, and the next one of the first or of the second.
template <class Place, class Step>
void zip(std::size_t first_count, std::size_t second_count, Place&& place, Step&& step) {
  std::size_t i = 0, j = 0;
  while (i + 1 < first_count || j + 1 < second_count) {
    bool along_first = j + 1 == second_count;
    if (!along_first && i + 1 < first_count) {
      along_first =
          squared(place(0, i + 1) - place(1, j)) <= squared(place(1, j + 1) - place(0, i));
    }
    step(i, j, along_first);
    ++(along_first ? i : j);
  }
}

/// Contours in an order that is the same at all angles.
void put_in_order(std::vector<Contour>& contours) {
  const auto key = [](const Contour& c) {
    return std::tuple(!c.is_outer(), c.box().min_x, c.box().min_y);
  };
  std::sort(contours.begin(), contours.end(),
            [&](const Contour& a, const Contour& b) { return key(a) < key(b); });
}

bool have_as_many_rings(const WoundSections& sections) {
  return std::all_of(sections.begin(), sections.end(),
                     [&](const std::vector<Contour>& s) { return s.size() == sections[0].size(); });
}

/// One vertex a corner and angle; those on the axis are one for all angles.
class WoundMesh {
 public:
  WoundMesh(TriangleMesh& mesh, int segments) : mesh_(mesh), segments_(segments) {}

  void add(const WoundSections& sections, std::size_t contour, double tolerance_mm) {
    on_axis_.clear();
    std::vector<std::vector<Vec2>> chains;
    std::vector<std::vector<std::uint32_t>> corners;
    for (int k = 0; k < segments_; ++k) {
      BandChain chain = closed_chain_of(sections[static_cast<std::size_t>(k)][contour]);
      begin_at_lowest(chain);
      chains.push_back(simplified(chain.points, tolerance_mm));
      std::vector<std::uint32_t>& row = corners.emplace_back();
      for (std::size_t i = 0; i + 1 < chains.back().size(); ++i)
        row.push_back(vertex(chains.back()[i], k));
      row.push_back(row.front());
    }
    for (std::size_t k = 0; k < chains.size(); ++k) {
      const std::size_t next = k + 1 == chains.size() ? 0 : k + 1;
      zip(
          chains[k].size(), chains[next].size(),
          [&](int side, std::size_t i) { return side != 0 ? chains[next][i] : chains[k][i]; },
          [&](std::size_t i, std::size_t j, bool along_first) {
            const std::uint32_t a = corners[k][i], b = corners[next][j],
                                c = along_first ? corners[k][i + 1] : corners[next][j + 1];
            if (a != b && b != c && c != a) mesh_.triangles.push_back({a, c, b});
          });
    }
  }

 private:
  std::uint32_t vertex(const Vec2& p, int k) {
    const auto next = static_cast<std::uint32_t>(mesh_.positions_mm.size());
    if (p.y == 0) {
      const auto [at, is_new] = on_axis_.try_emplace(p.x, next);
      if (!is_new) return at->second;
    }
    mesh_.positions_mm.push_back(place(p, direction_at(k, segments_)));
    return next;
  }

  TriangleMesh& mesh_;
  int segments_;
  std::map<double, std::uint32_t> on_axis_;
};

void append(const TriangleMesh& other, TriangleMesh& mesh) {
  const auto base = static_cast<std::uint32_t>(mesh.positions_mm.size());
  mesh.positions_mm.insert(mesh.positions_mm.end(), other.positions_mm.begin(),
                           other.positions_mm.end());
  for (const auto& t : other.triangles)
    mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

/// A chain with its normals: corners at which it turns are there twice.
struct ShownChain {
  std::vector<Vec2> at, normal;
  std::vector<std::uint32_t> marks;
};

ShownChain shown(const BandChain& marked) {
  ShownChain made;
  const std::vector<Vec2>& chain = marked.points;
  const std::size_t edges = chain.size() - 1;
  const bool closed = chain.front() == chain.back();
  const auto normal = [&](std::size_t i) {
    const Vec2 way = glm::normalize(chain[i + 1] - chain[i]);
    return Vec2(way.y, -way.x);
  };
  const auto joint = [&](std::size_t edge, std::size_t other) {
    const Vec2 own = normal(edge), beside = normal(other);
    return glm::dot(own, beside) < kEdgeCosine ? own : glm::normalize(own + beside);
  };
  const auto add = [&](const Vec2& at, const Vec2& n, std::uint32_t mark) {
    if (!made.at.empty() && made.at.back() == at && made.normal.back() == n &&
        made.marks.back() == mark)
      return;
    made.at.push_back(at);
    made.normal.push_back(n);
    made.marks.push_back(mark);
  };
  for (std::size_t i = 0; i < edges; ++i) {
    const bool has_before = i > 0 || closed, has_after = i + 1 < edges || closed;
    add(chain[i], has_before ? joint(i, i > 0 ? i - 1 : edges - 1) : normal(i), marked.marks[i]);
    add(chain[i + 1], has_after ? joint(i, i + 1 < edges ? i + 1 : 0) : normal(i), marked.marks[i]);
  }
  return made;
}

double highest(const std::vector<Vec2>& chain) {
  double most = 0;
  for (const Vec2& p : chain) most = std::max(most, p.y);
  return most;
}

}  // namespace

void cut_flat(const BarFlats& flats, double angle_rad, ConvexCut& cut,
              std::vector<Contour>& region) {
  Rect box;
  for (const Contour& contour : region) box.extend(contour.box());
  const Unit reach = to_units(flats.reach_mm(angle_rad)), beyond = to_units(1);
  if (region.empty() || box.max_y <= reach) return;
  std::vector<Point> corners{{box.min_x - beyond, reach},
                             {box.max_x + beyond, reach},
                             {box.max_x + beyond, box.max_y + beyond},
                             {box.min_x - beyond, box.max_y + beyond}};
  ConvexRegion above;
  above.assign(corners);
  if (!cut.look(region, above)) return;
  if (region[0].runs()[0]->marks.empty()) {
    cut.apply(region);
  } else {
    cut.apply(region, MeshPatch::kNotCut);
  }
}

WoundSections wound_sections(std::span<const Contour> region, const ThreadSet& threads,
                             int segments, const std::optional<BarFlats>& flats) {
  WoundSections sections;
  ConvexCut cut;
  const Rect box = threads.box();
  for (int k = 0; k < segments; ++k) {
    std::vector<Contour>& section = sections.emplace_back(region.begin(), region.end());
    threads.carve(static_cast<double>(k) / segments, to_mm(box.min_x), to_mm(box.max_x), cut,
                  section);
    if (flats) cut_flat(*flats, 2 * kPi * k / segments, cut, section);
    put_in_order(section);
  }
  return sections;
}

TriangleMesh wind(std::span<const Contour> region, const ThreadSet& threads, double tolerance_mm,
                  const std::optional<BarFlats>& flats) {
  std::vector<Contour> plain, wound;
  Unit radius = 0;
  for (const Contour& contour : region) {
    (contour.box().meets(threads.box()) ? wound : plain).push_back(contour);
    radius = std::max(radius, contour.box().max_y);
  }
  TriangleMesh mesh = revolve(plain, tolerance_mm, flats);
  const double half = tolerance_mm > 0 ? tolerance_mm / 2 : 0;
  const int segments = segments_with(
      std::max(segments_for(to_mm(radius), half > 0 ? half : kFinest_mm / 2), kFewestSections),
      flats);
  const WoundSections sections = wound_sections(wound, threads, segments, flats);
  if (!have_as_many_rings(sections)) {
    append(revolve(wound, tolerance_mm, flats), mesh);
    return mesh;
  }
  WoundMesh builder(mesh, segments);
  for (std::size_t i = 0; i < sections[0].size(); ++i) builder.add(sections, i, half);
  return mesh;
}

MeshPatch wind_band(const WoundSections& sections, std::span<const Contour> region, Unit low_z,
                    Unit high_z, bool has_high_face, double tolerance_mm,
                    const std::optional<BarFlats>& flats) {
  const std::size_t segments = sections.size();
  std::vector<std::vector<ShownChain>> shown_at;
  for (const std::vector<Contour>& section : sections) {
    std::vector<ShownChain>& all = shown_at.emplace_back();
    for (const Contour& contour : section) {
      if (contour.box().max_x < low_z || contour.box().min_x > high_z) continue;
      for (BandChain& chain : band_chains(contour, low_z, high_z, has_high_face)) {
        begin_at_lowest(chain);
        all.push_back(shown(simplified_by_marks(chain, tolerance_mm)));
      }
    }
    // Contours begin anywhere; from the axis outward.
    std::stable_sort(all.begin(), all.end(), [](const ShownChain& a, const ShownChain& b) {
      return highest(a.at) < highest(b.at);
    });
    if (all.size() != shown_at[0].size())
      return revolve_band(region, low_z, high_z, has_high_face, tolerance_mm, flats);
  }
  MeshPatch patch;
  const bool is_marked = !region.empty() && !region[0].runs()[0]->marks.empty();
  for (std::size_t c = 0; c < shown_at[0].size(); ++c) {
    std::vector<std::uint32_t> first;  // of each angle, and once more of the first
    for (std::size_t k = 0; k <= segments; ++k) {
      const ShownChain& chain = shown_at[k == segments ? 0 : k][c];
      const Vec2 direction = direction_at(static_cast<int>(k), static_cast<int>(segments));
      first.push_back(static_cast<std::uint32_t>(patch.vertices.size()));
      for (std::size_t i = 0; i < chain.at.size(); ++i) {
        patch.vertices.push_back(
            {place(chain.at[i], direction), pack_normal(place(chain.normal[i], direction))});
        if (is_marked) patch.cut_by.push_back(chain.marks[i]);
      }
    }
    for (std::size_t k = 0; k < segments; ++k) {
      const ShownChain &chain = shown_at[k][c], &next = shown_at[k + 1 == segments ? 0 : k + 1][c];
      zip(
          chain.at.size(), next.at.size(),
          [&](int side, std::size_t i) { return side != 0 ? next.at[i] : chain.at[i]; },
          [&](std::size_t i, std::size_t j, bool along_first) {
            const auto a = static_cast<std::uint32_t>(first[k] + i),
                       b = static_cast<std::uint32_t>(first[k + 1] + j),
                       third = along_first ? a + 1 : b + 1;
            const glm::vec3 &p = patch.vertices[a].position_mm, &q = patch.vertices[b].position_mm,
                            &r = patch.vertices[third].position_mm;
            if (p == q || q == r || r == p) return;
            patch.indices.insert(patch.indices.end(), {a, third, b});
          });
    }
  }
  patch.skirt_begin = static_cast<std::uint32_t>(patch.indices.size());
  return patch;
}

}  // namespace kerf::turning
