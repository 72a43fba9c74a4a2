#include "twin/compare/patch_deviation.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace kerf {
namespace {

/// The diagonal of a cell on a slope of 20 degrees: cells are not divided.
constexpr float kFinest_cells = 1.5f;
/// Longer edges are halved unseen: the deviation between their ends is not guessed.
constexpr float kCoarsest_cells = 16.0f;
constexpr float kShownPart = 0.25f;
constexpr float kReach_tolerances = 40.0f;

class Refiner {
 public:
  Refiner(const DesignPart& design, const DeviationDetail& detail, MeshPatch& patch)
      : probe_(design),
        patch_(patch),
        finest_mm_(kFinest_cells * static_cast<float>(detail.cell_mm)),
        coarsest_mm_(kCoarsest_cells * static_cast<float>(detail.cell_mm)),
        tolerance_mm_(static_cast<float>(detail.tolerance_mm)),
        reach_mm_(detail.reach_mm > 0 ? static_cast<float>(detail.reach_mm)
                                      : kReach_tolerances * tolerance_mm_) {
    patch_.deviation_mm.reserve(patch_.vertices.size() + patch_.vertices.size() / 4);
    for (const MeshVertex& vertex : patch_.vertices) {
      patch_.deviation_mm.push_back(deviation_at(vertex.position_mm));
    }
  }

  void refine() {
    made_.reserve(patch_.indices.size());
    for (std::uint32_t n = 0; n + 2 < patch_.skirt_begin; n += 3) {
      divide({patch_.indices[n], patch_.indices[n + 1], patch_.indices[n + 2]});
    }
    const auto skirts = patch_.skirt_indices();
    const auto skirt_begin = static_cast<std::uint32_t>(made_.size());
    made_.insert(made_.end(), skirts.begin(), skirts.end());
    patch_.indices = std::move(made_);
    patch_.skirt_begin = skirt_begin;
  }

 private:
  using Triangle = std::array<std::uint32_t, 3>;
  static constexpr std::uint32_t kWhole = MeshPatch::kNotCut;

  float deviation_at(const glm::vec3& p) {
    return static_cast<float>(probe_.distance_mm(Vec3(p), static_cast<double>(reach_mm_)));
  }

  /// The vertex that halves an edge, kWhole if none does. By positions and deviations of its ends
  /// alone: the same from all triangles, in all patches.
  std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
    const glm::vec3 from = patch_.vertices[a].position_mm, to = patch_.vertices[b].position_mm;
    const glm::vec3 way = to - from;
    const float length2 = glm::dot(way, way);
    if (length2 <= finest_mm_ * finest_mm_) return kWhole;
    const auto [known, is_new] =
        middles_.try_emplace(std::uint64_t{std::min(a, b)} << 32U | std::max(a, b), kWhole);
    if (!is_new) return known->second;
    const float first = patch_.deviation_mm[a], last = patch_.deviation_mm[b];
    // All of it is so far from the surface that it has one colour.
    const bool is_far = first == last && std::abs(first) >= reach_mm_;
    if (is_far && length2 <= reach_mm_ * reach_mm_) return kWhole;
    const glm::vec3 at = 0.5f * (from + to);
    const float deviation = deviation_at(at);
    const bool is_plain = std::abs(deviation - 0.5f * (first + last)) <= kShownPart * tolerance_mm_;
    if (is_plain && length2 <= coarsest_mm_ * coarsest_mm_) return kWhole;
    return known->second = add(a, b, at, deviation);
  }

  std::uint32_t add(std::uint32_t a, std::uint32_t b, const glm::vec3& at, float deviation) {
    const auto vertex = static_cast<std::uint32_t>(patch_.vertices.size());
    const glm::vec3 normal =
        unpack_normal(patch_.vertices[a].normal) + unpack_normal(patch_.vertices[b].normal);
    const bool is_plain = glm::dot(normal, normal) > 0.01f;
    patch_.vertices.push_back(
        {at, is_plain ? pack_normal(glm::normalize(normal)) : patch_.vertices[a].normal});
    patch_.deviation_mm.push_back(deviation);
    if (!patch_.cut_by.empty()) {
      // As on walls: what is lower tells who cut.
      const bool a_is_lower = patch_.vertices[a].position_mm.z <= patch_.vertices[b].position_mm.z;
      patch_.cut_by.push_back(patch_.cut_by[a_is_lower ? a : b]);
    }
    return vertex;
  }

  /// Appends the vertices that divide an edge, and its end.
  void append_divided(std::uint32_t a, std::uint32_t b, std::vector<std::uint32_t>& chain) {
    const std::uint32_t half = middle(a, b);
    if (half != kWhole) {
      append_divided(a, half, chain);
      append_divided(half, b, chain);
    } else {
      chain.push_back(b);
    }
  }

  float length2(std::uint32_t a, std::uint32_t b) const {
    const glm::vec3 way = patch_.vertices[a].position_mm - patch_.vertices[b].position_mm;
    return glm::dot(way, way);
  }

  /// Triangles between the sides of one, whose edges are divided; no vertices come inside. Large
  /// triangles of patches are a cell wide at most, or spokes of a fan: their edges are all of them.
  ///
  ///          apex            from the apex to the base, which is the shortest edge, each time the
  ///          /|              shorter way across
  ///      l1 o-o r1
  ///        /_/|
  ///    l2 o---o r2
  void divide(const Triangle& t) {
    std::size_t base = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if (length2(t[k], t[(k + 1) % 3]) < length2(t[base], t[(base + 1) % 3])) base = k;
    }
    const std::uint32_t first = t[base], second = t[(base + 1) % 3], apex = t[(base + 2) % 3];
    left_.assign(1, apex);
    right_.assign(1, apex);
    floor_.assign(1, first);
    append_divided(apex, first, left_);
    append_divided(apex, second, right_);
    append_divided(first, second, floor_);
    std::size_t l = 1, r = 1;  // up to here there are triangles, but for the first
    std::uint32_t tip = apex;
    while (l + 1 < left_.size() || r + 1 < right_.size()) {
      add_triangle(tip, left_[l], right_[r]);
      const bool goes_left = r + 1 == right_.size() ||
                             (l + 1 < left_.size() &&
                              length2(left_[l + 1], right_[r]) <= length2(left_[l], right_[r + 1]));
      tip = goes_left ? left_[l++] : right_[r++];
    }
    for (std::size_t n = 0; n + 1 < floor_.size(); ++n) {
      add_triangle(tip, floor_[n], floor_[n + 1]);
    }
  }

  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    made_.insert(made_.end(), {a, b, c});
  }

  DesignProbe probe_;
  MeshPatch& patch_;
  float finest_mm_, coarsest_mm_, tolerance_mm_, reach_mm_;
  std::unordered_map<std::uint64_t, std::uint32_t> middles_;
  std::vector<std::uint32_t> made_, left_, right_, floor_;
};

}  // namespace

void add_deviation(const DesignPart& design, const DeviationDetail& detail, MeshPatch* patch) {
  patch->deviation_mm.clear();
  if (patch->vertices.empty()) return;
  Refiner(design, detail, *patch).refine();
}

}  // namespace kerf
