#include "twin/serve/packed_patch.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>

namespace kerf {
namespace {

constexpr std::size_t kMostShort = 65536;

void put_bytes(std::string& out, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 0xffU);
}

void put_float(std::string& out, float value) {
  put_bytes(out, std::bit_cast<std::uint32_t>(value), 4);
}

}  // namespace

std::string packed(const MeshPatch& patch) {
  glm::vec3 low(0.0F), high(0.0F);
  if (!patch.vertices.empty()) low = high = patch.vertices.front().position_mm;
  for (const MeshVertex& vertex : patch.vertices) {
    low = glm::min(low, vertex.position_mm);
    high = glm::max(high, vertex.position_mm);
  }
  const glm::vec3 size = high - low;
  std::string out;
  out.reserve(kPackedHead + kPackedCorner * patch.vertices.size() + 4 * patch.indices.size() + 4);
  put_bytes(out, patch.tile, 4);
  put_bytes(out, static_cast<std::uint32_t>(patch.vertices.size()), 4);
  put_bytes(out, static_cast<std::uint32_t>(patch.indices.size()), 4);
  for (int axis = 0; axis < 3; ++axis) put_float(out, low[axis]);
  for (int axis = 0; axis < 3; ++axis) put_float(out, size[axis]);
  for (std::size_t i = 0; i < patch.vertices.size(); ++i) {
    const MeshVertex& vertex = patch.vertices[i];
    for (int axis = 0; axis < 3; ++axis) {
      const float share =
          size[axis] > 0 ? (vertex.position_mm[axis] - low[axis]) / size[axis] : 0.0F;
      put_bytes(out, static_cast<std::uint32_t>(std::lround(share * 65535.0F)), 2);
    }
    const glm::vec3 normal = unpack_normal(vertex.normal);
    for (int axis = 0; axis < 3; ++axis) {
      put_bytes(out, static_cast<std::uint32_t>(std::lround(normal[axis] * 127.0F)), 1);
    }
    const bool is_cut = !patch.cut_by.empty() && patch.cut_by[i] != MeshPatch::kNotCut;
    put_bytes(out, is_cut ? 1 : 0, 1);
  }
  const int index_bytes = patch.vertices.size() > kMostShort ? 4 : 2;
  for (const std::uint32_t index : patch.indices) put_bytes(out, index, index_bytes);
  while (out.size() % 4 != 0) out += '\0';
  return out;
}

}  // namespace kerf
