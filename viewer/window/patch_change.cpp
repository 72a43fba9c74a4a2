#include "viewer/window/patch_change.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace kerf {
namespace {

/// Odd numbers with evenly spread bits, for multiplicative hashing.
constexpr std::uint64_t kSpread = 0x9e37'79b9'7f4a'7c15;
constexpr std::uint64_t kMix = 0xd6e8'feb8'6659'fd93;

std::uint64_t mixed(std::uint64_t value) {
  value = (value ^ value >> 32) * kMix;
  return value ^ value >> 29;
}

std::uint64_t both(float low, float high) {
  return std::bit_cast<std::uint32_t>(low) |
         static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(high)) << 32;
}

/// Of all that is drawn of a vertex.
std::uint64_t hash_of(const MeshPatch& patch, std::size_t v) {
  const MeshVertex& vertex = patch.vertices[v];
  std::uint64_t hash = mixed(both(vertex.position_mm.x, vertex.position_mm.y));
  hash = mixed(hash * kSpread + (std::bit_cast<std::uint32_t>(vertex.position_mm.z) |
                                 static_cast<std::uint64_t>(vertex.normal) << 32));
  if (v < patch.cut_by.size()) hash = mixed(hash * kSpread + patch.cut_by[v]);
  if (v < patch.deviation_mm.size()) {
    hash = mixed(hash * kSpread + std::bit_cast<std::uint32_t>(patch.deviation_mm[v]));
  }
  return hash;
}

struct Triangles {
  const MeshPatch& patch;
  std::vector<std::uint64_t> hashes;  // never 0

  Triangles(const MeshPatch& of, bool with_skirts) : patch(of) {
    std::vector<std::uint64_t> of_vertex(patch.vertices.size());
    for (std::size_t v = 0; v < of_vertex.size(); ++v) of_vertex[v] = hash_of(patch, v);
    const std::size_t end = with_skirts ? patch.indices.size() : patch.skirt_begin;
    hashes.reserve(end / 3);
    for (std::size_t t = 0; t + 2 < end; t += 3) {
      const auto corner = [&](std::size_t k) { return of_vertex[patch.indices[t + k]]; };
      const std::uint64_t hash = mixed((corner(0) * kSpread + corner(1)) * kSpread + corner(2));
      hashes.push_back(hash | 1);
    }
  }
  void extend(Box* box, std::size_t triangle) const {
    for (std::size_t corner = 3 * triangle; corner < 3 * triangle + 3; ++corner) {
      box->extend(Vec3(patch.vertices[patch.indices[corner]].position_mm));
    }
  }
};

/// The hashes of some triangles, for the question whether one is among them.
class HashSet {
 public:
  explicit HashSet(std::size_t count)
      : slots_(std::bit_ceil(2 * count + 2), 0), mask_(slots_.size() - 1) {}
  void insert(std::uint64_t hash) {
    std::uint64_t& slot = find(hash);
    slot = hash;
  }
  bool contains(std::uint64_t hash) { return find(hash) != 0; }

 private:
  std::uint64_t& find(std::uint64_t hash) {
    std::size_t at = hash >> 1 & mask_;
    while (slots_[at] != 0 && slots_[at] != hash) at = (at + 1) & mask_;
    return slots_[at];
  }
  std::vector<std::uint64_t> slots_;
  std::size_t mask_;
};

/// Triangles [first, end of `of`) that `other` does not have between the same bounds.
void extend_by_missing(Box* box, const Triangles& of, std::size_t first, std::size_t end,
                       const Triangles& other, std::size_t other_end) {
  HashSet known(other_end - first);
  for (std::size_t t = first; t < other_end; ++t) known.insert(other.hashes[t]);
  for (std::size_t t = first; t < end; ++t) {
    if (!known.contains(of.hashes[t])) of.extend(box, t);
  }
}

}  // namespace

Box changed_box(const MeshPatch* before, const MeshPatch& after, bool with_skirts) {
  Box box;
  const Triangles newer(after, with_skirts);
  if (!before) {
    for (std::size_t t = 0; t < newer.hashes.size(); ++t) newer.extend(&box, t);
    return box;
  }
  const Triangles older(*before, with_skirts);
  std::size_t first = 0, older_end = older.hashes.size(), newer_end = newer.hashes.size();
  const std::size_t shorter = std::min(older_end, newer_end);
  while (first < shorter && older.hashes[first] == newer.hashes[first]) ++first;
  while (std::min(older_end, newer_end) > first &&
         older.hashes[older_end - 1] == newer.hashes[newer_end - 1]) {
    --older_end;
    --newer_end;
  }
  extend_by_missing(&box, older, first, older_end, newer, newer_end);
  extend_by_missing(&box, newer, first, newer_end, older, older_end);
  return box;
}

}  // namespace kerf
