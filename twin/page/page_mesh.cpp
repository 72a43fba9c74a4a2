#include "twin/page/page_mesh.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <memory>
#include <thread>
#include <unordered_map>
#include <utility>

#include "base/mesh_patch.h"
#include "base/triangle_mesh.h"
#include "stock/sparse_surface.h"
#include "stock/turning/turned_surface.h"
#include "twin/compare/patch_deviation.h"
#include "twin/compare/triangle_tree.h"
#include "twin/page/surface_simplifier.h"

namespace kerf {
namespace {

/// Corners of the full surface that the simplified one is measured by.
constexpr std::size_t kMeasured = 20'000;

struct PlaceHash {
  std::size_t operator()(const glm::vec3& p) const {
    std::uint64_t h = 0x9e3779b97f4a7c15u;
    for (int i = 0; i < 3; ++i) {
      std::uint32_t bits;
      const float value = p[i] == 0 ? 0.0f : p[i];  // -0 is 0
      std::memcpy(&bits, &value, sizeof(bits));
      h = (h ^ bits) * 0xff51afd7ed558ccdu;
      h ^= h >> 29;
    }
    return static_cast<std::size_t>(h);
  }
};

/// Corners at one place become one: patches part them where their normals differ.
class Joiner {
 public:
  explicit Joiner(PageSurface& into) : into_(into) {}

  void add(const PageSurface& part) {
    numbers_.resize(part.corners.size());
    std::fill(numbers_.begin(), numbers_.end(), kNone);
    for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
      std::uint32_t triangle[3];
      for (std::size_t k = 0; k < 3; ++k) triangle[k] = number_of(part, part.indices[i + k]);
      if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0])
        continue;
      into_.indices.insert(into_.indices.end(), triangle, triangle + 3);
    }
  }

 private:
  static constexpr std::uint32_t kNone = 0xffff'ffff;

  std::uint32_t number_of(const PageSurface& part, std::uint32_t corner) {
    if (numbers_[corner] != kNone) return numbers_[corner];
    const auto next = static_cast<std::uint32_t>(into_.corners.size());
    const auto [at, is_new] = known_.try_emplace(part.corners[corner], next);
    if (is_new) {
      into_.corners.push_back(part.corners[corner]);
      if (!part.groups.empty()) into_.groups.push_back(part.groups[corner]);
    }
    return numbers_[corner] = at->second;
  }

  PageSurface& into_;
  std::unordered_map<glm::vec3, std::uint32_t, PlaceHash> known_;
  std::vector<std::uint32_t> numbers_;  ///< of the part's corners in the whole
};

/// Of a corner: who cut it, and above that how far it is from the design.
constexpr std::uint16_t group_number(std::uint8_t who, DeviationClass deviation) {
  return static_cast<std::uint16_t>(static_cast<unsigned>(deviation) << 8 | who);
}

PageSurface surface_of(MeshPatch patch, double cell_mm, const PageMeshOptions& options) {
  if (options.design) {
    DeviationDetail detail;
    detail.cell_mm = cell_mm;
    detail.tolerance_mm = options.tolerance_mm;
    add_deviation(*options.design, detail, &patch);
  }
  PageSurface part;
  part.corners.reserve(patch.vertices.size());
  for (const MeshVertex& vertex : patch.vertices) part.corners.push_back(vertex.position_mm);
  const auto seen = patch.surface_indices();
  part.indices.assign(seen.begin(), seen.end());
  if (!options.group_of && !options.design) return part;
  part.groups.reserve(part.corners.size());
  for (std::size_t i = 0; i < part.corners.size(); ++i) {
    const bool is_cut =
        options.group_of && i < patch.cut_by.size() && patch.cut_by[i] != MeshPatch::kNotCut;
    const std::uint8_t who = is_cut ? options.group_of(patch.cut_by[i]) : kNoGroup;
    part.groups.push_back(group_number(
        who, options.design
                 ? deviation_class(static_cast<double>(patch.deviation_mm[i]), options.tolerance_mm)
                 : DeviationClass::kWithin));
  }
  return part;
}

/// Some corners of a surface, evenly spread over their order.
class Sample {
 public:
  explicit Sample(std::size_t tiles)
      : each_(std::max<std::size_t>(1, kMeasured / std::max<std::size_t>(1, tiles))) {}

  void take(const MeshPatch& patch, std::vector<glm::vec3>& into) const {
    const auto seen = patch.surface_indices();
    const std::size_t step = std::max<std::size_t>(1, seen.size() / each_);
    for (std::size_t i = 0; i < seen.size(); i += step)
      into.push_back(patch.vertices[seen[i]].position_mm);
  }

 private:
  std::size_t each_;
};

/// The surfaces of all tiles in their order, each simplified within its border; on all processors.
struct Tiles {
  PageSurface whole;
  std::vector<glm::vec3> sample;
  std::size_t full_triangles = 0;
};

unsigned processors() { return std::clamp(std::thread::hardware_concurrency(), 1u, 16u); }

/// Null: the model has none.
std::unique_ptr<SparseSurface> sparse_surface_of(const StockModel& stock,
                                                 const PageMeshOptions& options) {
  const auto* const source = dynamic_cast<const SparseSource*>(&stock.bare());
  if (source == nullptr) return nullptr;
  SparseOptions wanted;
  wanted.most_mm = options.free_deviation_mm;
  wanted.threads = static_cast<int>(processors());
  if (options.group_of) {
    wanted.group_of = [&options](std::uint32_t move) -> std::uint32_t {
      return move == MeshPatch::kNotCut ? kNoGroup : options.group_of(move);
    };
  }
  return source->sparse_surface(wanted);
}

Tiles take_tiles(const StockModel& stock, const PageMeshOptions& options) {
  constexpr std::size_t kAtATime = 64;
  constexpr double kOfCell = 0.1;
  const double cell_mm = detail_cell_mm(stock);
  Tiles out;
  Joiner joiner(out.whole);
  const std::size_t count = stock.tile_count();
  const Sample sample(count);
  const std::size_t enough = 2 * options.most_triangles / std::max<std::size_t>(1, count);
  const std::unique_ptr<SparseSurface> sparse = sparse_surface_of(stock, options);
  // A model is read by one thread: some work things out when they are first asked.
  std::vector<std::unique_ptr<StockModel>> copies;
  for (unsigned i = 1; i < processors(); ++i) copies.push_back(stock.snapshot());
  for (std::size_t begin = 0; begin < count; begin += kAtATime) {
    const std::size_t end = std::min(count, begin + kAtATime);
    std::vector<PageSurface> parts(end - begin);
    std::vector<std::vector<glm::vec3>> samples(end - begin);
    std::vector<std::size_t> full(end - begin);
    std::atomic<std::size_t> next{begin};
    const auto work = [&](const StockModel& model) {
      for (std::size_t at; (at = next++) < end;) {
        const auto tile = static_cast<std::uint32_t>(at);
        MeshPatch patch = model.patch(tile, 0);
        full[at - begin] = patch.surface_indices().size() / 3;
        sample.take(patch, samples[at - begin]);
        if (sparse) patch = sparse->patch(tile);
        PageSurface& part = parts[at - begin];
        Joiner(part).add(surface_of(std::move(patch), cell_mm, options));
        // What would go later goes here, where all processors work: as far as a tenth of a cell.
        for (double most_mm = options.free_deviation_mm;; most_mm *= 2) {
          simplify_surface(part, {.most_mm = most_mm, .keeps_rim = true});
          if (part.indices.size() / 3 <= enough || 2 * most_mm > kOfCell * cell_mm) break;
        }
      }
    };
    std::vector<std::jthread> helpers;
    for (const auto& copy : copies) helpers.emplace_back([&] { work(*copy); });
    work(stock);
    helpers.clear();
    for (std::size_t i = 0; i < parts.size(); ++i) {
      joiner.add(parts[i]);
      out.sample.insert(out.sample.end(), samples[i].begin(), samples[i].end());
      out.full_triangles += full[i];
    }
  }
  return out;
}

/// Who cut a triangle. Where corners differ one of them was not cut: on a wall, whose upper ones
/// are those of the top, it is cut all the same.
std::uint8_t who_cut(const std::array<std::uint16_t, 3>& corners, bool is_wall) {
  std::array<std::uint8_t, 3> who;
  for (std::size_t k = 0; k < 3; ++k) who[k] = static_cast<std::uint8_t>(corners[k] & 0xff);
  std::ranges::sort(who);
  if (is_wall) return who[0];
  return who[2] == kNoGroup ? kNoGroup : who[1];
}

/// Upright, and not a side of the blank.
bool is_wall(const PageSurface& surface, std::size_t first, const Box& blank) {
  std::array<Vec3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) corners[k] = surface.corners[surface.indices[first + k]];
  const Vec3 across = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  constexpr double kUpright = 0.02, kSame_mm = 1e-4;
  if (std::abs(across.z) > kUpright * glm::length(across)) return false;
  for (int axis = 0; axis < 2; ++axis) {
    for (const double side : {blank.min[axis], blank.max[axis]}) {
      if (std::ranges::all_of(corners,
                              [&](const Vec3& p) { return std::abs(p[axis] - side) < kSame_mm; }))
        return false;
    }
  }
  return true;
}

/// The one in the middle.
std::uint8_t deviation_of(std::array<std::uint16_t, 3> corners) {
  for (std::uint16_t& corner : corners) corner = static_cast<std::uint16_t>(corner >> 8);
  std::ranges::sort(corners);
  return static_cast<std::uint8_t>(corners[1]);
}

void name_triangles(const PageSurface& surface, const Box& blank, const PageMeshOptions& options,
                    PageMesh& mesh) {
  for (std::size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
    std::array<std::uint16_t, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = surface.groups[surface.indices[i + k]];
    if (options.group_of) mesh.groups.push_back(who_cut(corners, is_wall(surface, i, blank)));
    if (options.design) mesh.deviations.push_back(deviation_of(corners));
  }
}

double farthest_mm(const PageSurface& surface, const std::vector<glm::vec3>& sample) {
  TriangleMesh mesh;
  mesh.positions_mm = surface.corners;
  mesh.triangles.reserve(surface.indices.size() / 3);
  for (std::size_t i = 0; i + 2 < surface.indices.size(); i += 3)
    mesh.triangles.push_back({surface.indices[i], surface.indices[i + 1], surface.indices[i + 2]});
  if (mesh.triangles.empty()) return 0;
  const TriangleTree tree(mesh);
  double farthest2 = 0;
  std::uint32_t hint = 0;
  for (const glm::vec3& corner : sample) {
    const NearestPoint nearest = tree.nearest(Vec3(corner), hint);
    hint = nearest.triangle;
    farthest2 = std::max(farthest2, nearest.distance2_mm2);
  }
  return std::sqrt(farthest2);
}

/// Corners that triangles name, in the order of their naming, as numbers of 16 bits.
void pack(const PageSurface& surface, PageMesh& mesh) {
  constexpr double kSteps = 65535;
  std::vector<std::uint32_t> numbers(surface.corners.size(), 0xffff'ffffu);
  std::vector<std::uint32_t> used;
  for (const std::uint32_t corner : surface.indices) {
    if (numbers[corner] == 0xffff'ffffu) {
      numbers[corner] = static_cast<std::uint32_t>(used.size());
      used.push_back(corner);
      mesh.box_mm.extend(Vec3(surface.corners[corner]));
    }
    mesh.triangles.push_back(numbers[corner]);
  }
  if (used.empty()) return;
  const Vec3 size = mesh.box_mm.size();
  mesh.places.reserve(3 * used.size());
  for (const std::uint32_t corner : used) {
    for (int axis = 0; axis < 3; ++axis) {
      const double share =
          size[axis] > 0
              ? (static_cast<double>(surface.corners[corner][axis]) - mesh.box_mm.min[axis]) /
                    size[axis]
              : 0;
      mesh.places.push_back(
          static_cast<std::uint16_t>(std::lround(std::clamp(share, 0.0, 1.0) * kSteps)));
    }
  }
}

}  // namespace

DeviationClass deviation_class(double deviation_mm, double tolerance_mm) {
  const double tolerances = deviation_mm / tolerance_mm;
  if (tolerances < -2) return DeviationClass::kDeepGouge;
  if (tolerances < -1) return DeviationClass::kGouge;
  if (tolerances <= 1) return DeviationClass::kWithin;
  return tolerances <= 2 ? DeviationClass::kExcess : DeviationClass::kHighExcess;
}

PageMesh page_mesh(const StockModel& stock, const PageMeshOptions& options) {
  PageMesh mesh;
  Tiles tiles = take_tiles(stock, options);
  PageSurface& surface = tiles.whole;
  mesh.full_triangles = tiles.full_triangles;
  simplify_surface(surface, {.most_mm = options.free_deviation_mm});
  // What is still too much gives up as little as it can.
  const Vec3 size = stock.bounds_mm().size();
  const double largest_mm = std::max({size.x, size.y, size.z});
  for (double most_mm = 2 * options.free_deviation_mm;
       surface.indices.size() / 3 > options.most_triangles && most_mm < largest_mm; most_mm *= 2) {
    simplify_surface(surface, {.most_mm = most_mm, .least_triangles = options.most_triangles});
  }
  mesh.deviation_mm = farthest_mm(surface, tiles.sample);
  mesh.measured = tiles.sample.size();
  pack(surface, mesh);
  if (!surface.groups.empty()) name_triangles(surface, stock.bounds_mm(), options, mesh);
  // Numbers of 16 bits are off by half of one.
  constexpr double kHalfStep = 0.5 / 65535;
  if (!mesh.box_mm.empty()) mesh.deviation_mm += kHalfStep * glm::length(mesh.box_mm.size());
  return mesh;
}

}  // namespace kerf
