#include "stock/octree/brick.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>

namespace kerf::octree {

// Q. Meyer et al., "On floating-point normal vectors", EGSR 2010: the unit sphere unfolded from an
// octahedron.
std::uint32_t pack_direction(const glm::vec3& n) {
  const float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  float x = n.x / sum, y = n.y / sum;
  if (n.z < 0) {
    const float folded_x = (1 - std::abs(y)) * (x < 0 ? -1.0f : 1.0f);
    y = (1 - std::abs(x)) * (y < 0 ? -1.0f : 1.0f);
    x = folded_x;
  }
  const auto bits = [](float value) {
    const int steps = static_cast<int>(std::lround(std::clamp(value, -1.0f, 1.0f) * 32767.0f));
    return static_cast<std::uint32_t>(steps) & 0xffffu;
  };
  return bits(x) | bits(y) << 16;
}

glm::vec3 unpack_direction(std::uint32_t packed) {
  const auto value = [packed](int shift) {
    return static_cast<float>(static_cast<std::int16_t>(packed >> shift & 0xffffu)) / 32767.0f;
  };
  float x = value(0), y = value(16);
  const float z = 1 - std::abs(x) - std::abs(y);
  if (z < 0) {
    const float folded_x = (1 - std::abs(y)) * (x < 0 ? -1.0f : 1.0f);
    y = (1 - std::abs(x)) * (y < 0 ? -1.0f : 1.0f);
    x = folded_x;
  }
  const float scale = 1 / std::sqrt(x * x + y * y + z * z);
  return {x * scale, y * scale, z * scale};
}

Brick* Brick::allocate(int crossings, bool ids) {
  const std::size_t bytes =
      sizeof(Brick) + static_cast<std::size_t>(crossings) * (ids ? std::size_t{10} : 6);
  Brick* brick = new (::operator new(bytes)) Brick;
  brick->crossings = static_cast<std::uint16_t>(crossings);
  brick->has_ids = ids;
  return brick;
}

void Brick::destroy(Brick* brick) {
  brick->~Brick();
  ::operator delete(brick);
}

bool Brick::same_surface(const Brick& other) const {
  return crossings == other.crossings && std::memcmp(columns, other.columns, sizeof columns) == 0 &&
         std::memcmp(directions(), other.directions(), crossings * sizeof(std::uint32_t)) == 0 &&
         std::memcmp(places(), other.places(), crossings * sizeof(std::uint16_t)) == 0;
}

namespace {

std::size_t edge_number(int axis, int i, int j, int k) {
  return static_cast<std::size_t>(axis * kBrickNodes + (j * kBrick + i) * kBrick + k);
}

}  // namespace

void OpenBrick::open(const BrickRef& ref) {
  const Brick* brick = ref.get();
  if (!brick) {
    const bool solid = ref.is_solid();
    std::fill(std::begin(columns), std::end(columns), solid ? kFullColumn : std::uint16_t{0});
    std::fill(std::begin(height_of), std::end(height_of), solid ? kBrick * kEdgeParts : 0);
    volume = solid ? std::int64_t{kBrickNodes} * kNodeVolume : 0;
    top_node = solid ? kBrick : -1;
    top_is_known = false;
    return;
  }
  std::memcpy(columns, brick->columns, sizeof columns);
  std::size_t next = 0;
  for_each_crossed(columns, [&](int axis, int i, int j, int k) {
    const std::size_t e = edge_number(axis, i, j, k);
    place[e] = brick->places()[next];
    direction[e] = brick->directions()[next];
    id[e] = brick->has_ids ? brick->ids()[next] : MeshPatch::kNotCut;
    ++next;
  });
  measure();
}

BrickRef OpenBrick::close(bool with_ids) const {
  const auto all = [&](std::uint16_t state) {
    return std::all_of(std::begin(columns), std::end(columns),
                       [=](std::uint16_t c) { return c == state; });
  };
  if (all(0)) return BrickRef();
  if (all(kFullColumn)) return BrickRef::solid();
  int count = 0;
  for_each_crossed(columns, [&](int, int, int, int) { ++count; });
  Brick* brick = Brick::allocate(count, with_ids);
  std::memcpy(brick->columns, columns, sizeof columns);
  brick->volume = volume;
  auto* directions = const_cast<std::uint32_t*>(brick->directions());
  auto* ids = const_cast<std::uint32_t*>(brick->ids());
  auto* places = const_cast<std::uint16_t*>(brick->places());
  for_each_crossed(columns, [&](int axis, int i, int j, int k) {
    const std::size_t e = edge_number(axis, i, j, k);
    *directions++ = direction[e];
    *places++ = place[e];
    if (with_ids) *ids++ = id[e];
  });
  return BrickRef::adopt(brick);
}

// Counting nodes is right but for how far the surface lies from half way between them, which each
// axis that crosses it tells by itself: all of them together weigh 1, the squares of the normal's
// parts. So an axis along a surface, whose edges do not see it, has no say, and what is left is
// O(cell^2), of edges and curvature.
void OpenBrick::measure() {
  constexpr float kScale = static_cast<float>(kNodeVolume / kEdgeParts);
  unsigned any = 0;
  for (const std::uint16_t column : columns) any |= column;
  top_node = static_cast<int>(std::bit_width(any)) - 1;
  top_is_known = false;
  volume = 0;
  for (int j = 0; j < kBrick; ++j) {
    for (int i = 0; i < kBrick; ++i) {
      const unsigned own = columns[j * kSide + i];
      volume += std::int64_t{std::popcount(own & 0xffu)} * kNodeVolume;
      height_of[j * kBrick + i] = std::popcount(own & own >> 1 & 0xffu) * kEdgeParts;
    }
  }
  for_each_crossed(columns, [&](int axis, int i, int j, int k) {
    const std::size_t e = edge_number(axis, i, j, k);
    const bool solid = (columns[j * kSide + i] >> k & 1u) != 0;
    const float along = unpack_direction(direction[e])[axis];
    const int beyond = solid ? place[e] - kEdgeParts / 2 : kEdgeParts / 2 - place[e];
    share[e] = static_cast<std::int32_t>(along * along * kScale * static_cast<float>(beyond));
    volume += share[e];
    if (axis == 2) height_of[j * kBrick + i] += solid ? place[e] : kEdgeParts - place[e];
  });
}

int OpenBrick::top() {
  if (top_is_known) return top_;
  top_is_known = true;
  top_ = top_node * kEdgeParts;
  if (top_node < 0 || top_node == kBrick) return top_;
  // Where the upper neighbour is empty; there is a crossing on the edge to it.
  for (int j = 0; j < kBrick; ++j) {
    for (int i = 0; i < kBrick; ++i) {
      if (columns[j * kSide + i] >> top_node & 1u)
        top_ = std::max(top_, top_node * kEdgeParts + place[edge_number(2, i, j, top_node)]);
    }
  }
  return top_;
}

}  // namespace kerf::octree
