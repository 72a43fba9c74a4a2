#include "twin/compare/compare_patches.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <unordered_set>
#include <vector>

#include "mesh/column_lines.h"
#include "twin/compare/patch_deviation.h"

namespace kerf {
namespace {

/// Farther than any workpiece reaches: distances are true ones.
constexpr double kReach_mm = 1e9;
constexpr double kMostColumns = 1e6;
constexpr double kPieceCells = 2;

Vec3 normal_of(const Vec3& a, const Vec3& b, const Vec3& c) { return glm::cross(b - a, c - a); }

/// Where walls stand in a patch of cells, seen from above; and its border, beyond which there may
/// be one.
class WallPlaces {
 public:
  WallPlaces(const MeshPatch& patch, const Box& tile_mm, bool is_asked)
      : patch_(patch), tile_mm_(tile_mm), is_asked_(is_asked) {
    if (!is_asked) return;
    const std::span<const std::uint32_t> indices = patch.surface_indices();
    for (std::size_t n = 0; n + 2 < indices.size(); n += 3) {
      const auto at = [&](std::size_t k) {
        return Vec3(patch.vertices[indices[n + k]].position_mm);
      };
      const Vec3 across = normal_of(at(0), at(1), at(2));
      constexpr double kLevel = 0.95;
      if (std::abs(across.z) > kLevel * glm::length(across)) continue;
      for (std::size_t k = 0; k < 3; ++k) places_.insert(key(at(k)));
    }
  }
  bool has(std::uint32_t vertex) const {
    if (!is_asked_) return false;
    const Vec3 p(patch_.vertices[vertex].position_mm);
    constexpr double kNear_mm = 1e-4;
    for (int axis = 0; axis < 2; ++axis)
      if (p[axis] < tile_mm_.min[axis] + kNear_mm || p[axis] > tile_mm_.max[axis] - kNear_mm)
        return true;
    return places_.contains(key(p));
  }

 private:
  static std::uint64_t key(const Vec3& p) {
    const auto bits = [](double mm) {
      return std::uint64_t{std::bit_cast<std::uint32_t>(static_cast<float>(mm))};
    };
    return bits(p.x) << 32 | bits(p.y);
  }

  const MeshPatch& patch_;
  Box tile_mm_;
  bool is_asked_;
  std::unordered_set<std::uint64_t> places_;
};

/// A triangle whose deviation changes evenly.
struct Facet {
  std::array<Vec3, 3> corners;
  std::array<double, 3> deviations_mm;
};

/// In pieces with edges no longer than that: so what hangs together does in DeviationSums.
void add_pieces(const Facet& facet, const SurfaceSample& like, double longest_mm,
                DeviationSums& sums) {
  std::size_t edge = 0;
  double length = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double l = glm::distance(facet.corners[k], facet.corners[(k + 1) % 3]);
    if (l <= length) continue;
    length = l;
    edge = k;
  }
  SurfaceSample sample = like;
  if (length <= longest_mm) {
    const auto& d = facet.deviations_mm;
    sample.at_mm = (facet.corners[0] + facet.corners[1] + facet.corners[2]) / 3.0;
    sample.deviation_mm = (d[0] + d[1] + d[2]) / 3;
    sums.add(sample);
    return;
  }
  sample.area_mm2 *= 0.5;
  const std::size_t a = edge, b = (edge + 1) % 3;
  const Vec3 middle = 0.5 * (facet.corners[a] + facet.corners[b]);
  const double deviation = 0.5 * (facet.deviations_mm[a] + facet.deviations_mm[b]);
  for (const std::size_t moved : {a, b}) {
    Facet half = facet;
    half.corners[moved] = middle;
    half.deviations_mm[moved] = deviation;
    add_pieces(half, sample, longest_mm, sums);
  }
}

void add_triangles(const MeshPatch& patch, const Box& blank_mm, const Box& tile_mm, double cell_mm,
                   const SurfaceDoubt& doubt, DeviationSums& sums) {
  const WallPlaces walls(patch, tile_mm, doubt.walls_mm > 0);
  const std::span<const std::uint32_t> indices = patch.surface_indices();
  for (std::size_t n = 0; n + 2 < indices.size(); n += 3) {
    const std::array<std::uint32_t, 3> t{indices[n], indices[n + 1], indices[n + 2]};
    const Vec3 a(patch.vertices[t[0]].position_mm), b(patch.vertices[t[1]].position_mm),
        c(patch.vertices[t[2]].position_mm);
    const Vec3 across = normal_of(a, b, c);
    const double size = glm::length(across);
    if (!(size > 0)) continue;
    std::size_t worst = 0;
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double deviation = static_cast<double>(patch.deviation_mm[t[k]]);
      sum += deviation;
      if (std::abs(deviation) > std::abs(static_cast<double>(patch.deviation_mm[t[worst]])))
        worst = k;
    }
    const bool meets_wall = walls.has(t[0]) || walls.has(t[1]) || walls.has(t[2]);
    const double off = meets_wall ? doubt.most_mm() : doubt.anywhere_mm;
    const auto sure = [off](double deviation) {
      return std::copysign(std::max(0.0, std::abs(deviation) - off), deviation);
    };
    SurfaceSample sample{(a + b + c) / 3.0, sure(sum / 3), 0.5 * size};
    const std::uint32_t label = patch.cut_by.empty() ? MeshPatch::kNotCut : patch.cut_by[t[worst]];
    sample.cut_by = label;
    // The blank's own faces: the design goes on beyond it.
    const auto is_on_face = [&](const Vec3& p) {
      constexpr double kNear_mm = 1e-4;
      for (int axis = 0; axis < 3; ++axis)
        if (std::abs(p[axis] - blank_mm.min[axis]) < kNear_mm ||
            std::abs(p[axis] - blank_mm.max[axis]) < kNear_mm)
          return true;
      return false;
    };
    const bool is_face = label == MeshPatch::kNotCut && is_on_face(sample.at_mm);
    if (is_face && sample.deviation_mm < 0) sample.deviation_mm = 0;
    const double worst_mm = sure(static_cast<double>(patch.deviation_mm[t[worst]]));
    if (std::abs(worst_mm) > sums.tolerance_mm() && !(is_face && worst_mm < 0)) {
      Facet facet{{a, b, c}, {}};
      for (std::size_t k = 0; k < 3; ++k)
        facet.deviations_mm[k] = sure(static_cast<double>(patch.deviation_mm[t[k]]));
      add_pieces(facet, sample, kPieceCells * cell_mm, sums);
    } else {
      sums.add(sample);
    }
    SurfaceSample peak = sample;
    peak.at_mm = Vec3(patch.vertices[t[worst]].position_mm);
    peak.deviation_mm = worst_mm;
    peak.is_extra = true;
    if (!is_face || peak.deviation_mm > 0) sums.add(peak);
  }
}

/// A crossing of a vertical line with one of the two surfaces.
struct Crossing {
  std::uint32_t column;
  float z_mm;
  std::int8_t workpiece, design;  ///< 1: into it as one goes down, -1: out of it
};

class VolumeCounter {
 public:
  VolumeCounter(const Box& bounds_mm, double cell_mm, const DesignPart& design,
                const SurfaceDoubt& doubt, DeviationSums& sums)
      : design_(design), sums_(sums), doubt_mm_(doubt.most_mm()) {
    const Vec3 size = bounds_mm.size();
    const double pitch = std::max(cell_mm, std::sqrt(size.x * size.y / kMostColumns));
    grid_ = {bounds_mm, std::max(1, static_cast<int>(std::ceil(size.x / pitch))),
             std::max(1, static_cast<int>(std::ceil(size.y / pitch)))};
    const float outward = design.is_inside_out() ? -1.0f : 1.0f;
    for (std::uint32_t t = 0; t < design.size(); ++t) {
      each_column_line(design.corners(t), grid_, [&](std::size_t at, float z, int up) {
        const int way = outward < 0 ? -up : up;
        crossings_.push_back({static_cast<std::uint32_t>(at), z, 0, static_cast<std::int8_t>(way)});
      });
    }
  }
  void add(const MeshPatch& patch) {
    const std::span<const std::uint32_t> indices = patch.surface_indices();
    for (std::size_t n = 0; n + 2 < indices.size(); n += 3) {
      const std::array<glm::vec3, 3> corners{patch.vertices[indices[n]].position_mm,
                                             patch.vertices[indices[n + 1]].position_mm,
                                             patch.vertices[indices[n + 2]].position_mm};
      each_column_line(corners, grid_, [&](std::size_t at, float z, int up) {
        crossings_.push_back({static_cast<std::uint32_t>(at), z, static_cast<std::int8_t>(up), 0});
      });
    }
  }
  /// What is in one of the two alone, where it is more than the tolerance allows.
  void count() {
    std::ranges::sort(crossings_, [](const Crossing& a, const Crossing& b) {
      return a.column != b.column ? a.column < b.column : a.z_mm > b.z_mm;
    });
    const Vec2 cell = grid_.cell_mm();
    DesignProbe probe(design_);
    for (std::size_t n = 0; n < crossings_.size();) {
      int workpiece = 0, design = 0;
      const std::uint32_t column = crossings_[n].column;
      for (; n < crossings_.size() && crossings_[n].column == column; ++n) {
        workpiece += crossings_[n].workpiece;
        design += crossings_[n].design;
        if (n + 1 == crossings_.size() || crossings_[n + 1].column != column) continue;
        const bool in_workpiece = workpiece > 0, in_design = design > 0;
        if (in_workpiece == in_design) continue;
        const double high =
            std::min(static_cast<double>(crossings_[n].z_mm), grid_.bounds_mm.max.z);
        const double low =
            std::max(static_cast<double>(crossings_[n + 1].z_mm), grid_.bounds_mm.min.z);
        if (!(high - low > sums_.tolerance_mm())) continue;
        // It is counted where the workpiece's surface is, if one of its ends is that.
        std::optional<double> surface_z;
        if (crossings_[n].workpiece != 0) surface_z = high;
        if (crossings_[n + 1].workpiece != 0) surface_z = low;
        add_part(column, low, high, surface_z, in_design, cell.x * cell.y, probe);
      }
    }
  }

 private:
  void add_part(std::uint32_t column, double low, double high, std::optional<double> surface_z,
                bool is_gouge, double area_mm2, DesignProbe& probe) {
    const auto nx = static_cast<std::uint32_t>(grid_.nx);
    const Vec2 xy = grid_.center(static_cast<int>(column % nx), static_cast<int>(column / nx));
    // Its ends and its middle: what is farthest from the design's surface.
    double worst = 0;
    Vec3 place(0);
    for (const double z : {low, 0.5 * (low + high), high}) {
      const Vec3 p(xy, z);
      const double size = std::abs(probe.distance_mm(p, kReach_mm));
      if (size <= worst) continue;
      worst = size;
      place = p;
    }
    // It is not the place that counts, but what there is of it: the surface says how deep it is.
    constexpr double kJust = 1 + 1e-6;
    if (surface_z) place.z = *surface_z;
    if (!(worst > kJust * sums_.tolerance_mm() + doubt_mm_)) {
      sums_.add_beside(place, is_gouge, (high - low) * area_mm2);
      return;
    }
    const double told = kJust * sums_.tolerance_mm();
    SurfaceSample sample{place, is_gouge ? -told : told, 0, (high - low) * area_mm2,
                         MeshPatch::kNotCut};
    sample.is_extra = true;
    sums_.add(sample);
  }

  const DesignPart& design_;
  DeviationSums& sums_;
  double doubt_mm_;
  ColumnGrid grid_;
  std::vector<Crossing> crossings_;
};

}  // namespace

void compare_patches(const StockModel& stock, double cell_mm, const DesignPart& design,
                     const SurfaceDoubt& doubt, DeviationSums& sums) {
  const Box bounds = stock.bounds_mm();
  VolumeCounter volumes(bounds, cell_mm, design, doubt, sums);
  for (std::uint32_t tile = 0; tile < stock.tile_count(); ++tile) {
    MeshPatch patch = stock.patch(tile, 0);
    if (patch.indices.empty()) continue;
    volumes.add(patch);
    add_deviation(design, {cell_mm, sums.tolerance_mm(), kReach_mm}, &patch);
    add_triangles(patch, bounds, stock.tile_box(tile), cell_mm, doubt, sums);
  }
  volumes.count();
}

}  // namespace kerf
