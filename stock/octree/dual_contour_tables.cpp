#include "stock/octree/dual_contour_tables.h"

namespace kerf {
namespace {

constexpr std::size_t slot(int index) { return static_cast<std::size_t>(index); }

/// Corners and edges of a face, counter-clockwise seen from outside; edges[n] follows corners[n].
struct Face {
  std::array<int, 4> corners{};
  std::array<int, 4> edges{};
};

constexpr int edge_between(int one, int other) {
  for (int edge = 0; edge < kDualEdges; ++edge) {
    const int low = dual_edge_corner(edge), high = low | 1 << dual_edge_axis(edge);
    if ((one == low && other == high) || (one == high && other == low)) return edge;
  }
  return -1;
}

constexpr std::array<Face, 6> make_faces() {
  std::array<Face, 6> faces{};
  for (int f = 0; f < 6; ++f) {
    const int axis = f / 2, b = 1 << (axis + 1) % 3, c = 1 << (axis + 2) % 3;
    const int base = f % 2 == 1 ? 1 << axis : 0;
    Face& face = faces[slot(f)];
    face.corners = {base, base | b, base | b | c, base | c};
    if (f % 2 == 0) face.corners = {base, base | c, base | b | c, base | b};
    for (int n = 0; n < 4; ++n) {
      face.edges[slot(n)] = edge_between(face.corners[slot(n)], face.corners[slot((n + 1) % 4)]);
    }
  }
  return faces;
}
constexpr std::array<Face, 6> kFaces = make_faces();

constexpr bool is_solid(int signs, const Face& face, int n) {
  return (signs >> face.corners[slot(n % 4)] & 1) != 0;
}

constexpr bool is_ambiguous(int signs, const Face& face) {
  const bool first = is_solid(signs, face, 0);
  return is_solid(signs, face, 1) != first && is_solid(signs, face, 2) == first &&
         is_solid(signs, face, 3) != first;
}

/// A crossed edge leaves the material on the way round one of its two faces and enters it round the
/// other one. From where it leaves, the loop goes over that face to an edge that enters: the one
/// before the solid corner; the other way, the one after the empty corner.
constexpr DualLoops find_loops(int signs, int other_way_face) {
  std::array<int, kDualEdges> next{};
  for (int& edge : next) edge = -1;
  for (int f = 0; f < 6; ++f) {
    const Face& face = kFaces[slot(f)];
    const int step = f == other_way_face ? 1 : 3;
    for (int n = 0; n < 4; ++n) {
      if (!is_solid(signs, face, n) || is_solid(signs, face, n + 1)) continue;
      int to = (n + step) % 4;
      while (is_solid(signs, face, to) || !is_solid(signs, face, to + 1)) to = (to + step) % 4;
      next[slot(face.edges[slot(n)])] = face.edges[slot(to)];
    }
  }
  DualLoops loops;
  int used = 0;
  std::array<bool, kDualEdges> seen{};
  for (int start = 0; start < kDualEdges; ++start) {
    if (next[slot(start)] < 0 || seen[slot(start)]) continue;
    for (int edge = start; !seen[slot(edge)]; edge = next[slot(edge)]) {
      seen[slot(edge)] = true;
      loops.loop_of[slot(edge)] = loops.count;
      loops.edges[slot(used++)] = static_cast<std::uint8_t>(edge);
    }
    ++loops.count;
    loops.begin[loops.count] = static_cast<std::uint8_t>(used);
  }
  return loops;
}

constexpr bool joins_pairs(const DualLoops& loops, const Face& face) {
  // Opposite edges of the face are in different pairs, whichever way.
  return loops.loop_of[slot(face.edges[0])] == loops.loop_of[slot(face.edges[2])] &&
         loops.loop_of[slot(face.edges[1])] == loops.loop_of[slot(face.edges[3])];
}

constexpr DualTables make_tables() {
  DualTables tables;
  for (int signs = 0; signs < 256; ++signs) {
    tables.loops[slot(signs)] = find_loops(signs, -1);
    tables.lone_face[slot(signs)] = DualTables::kNoFace;
    int ambiguous = 0, lone = 0;
    for (int f = 0; f < 6; ++f) {
      if (!is_ambiguous(signs, kFaces[slot(f)])) continue;
      ++ambiguous;
      lone = f;
    }
    if (ambiguous != 1) continue;
    tables.lone_face[slot(signs)] = static_cast<std::uint8_t>(lone);
    tables.loops[slot(signs + DualTables::kOtherWay)] = find_loops(signs, lone);
    for (const int number : {signs, signs + DualTables::kOtherWay}) {
      tables.is_joined[slot(number)] =
          joins_pairs(tables.loops[slot(number)], kFaces[slot(lone)]) ? 1 : 0;
    }
  }
  return tables;
}

constexpr bool only_lone_faces_join(const DualTables& tables) {
  for (int signs = 0; signs < 256; ++signs) {
    for (int f = 0; f < 6; ++f) {
      const Face& face = kFaces[slot(f)];
      if (is_ambiguous(signs, face) && tables.lone_face[slot(signs)] != f &&
          joins_pairs(tables.loops[slot(signs)], face)) {
        return false;
      }
    }
  }
  return true;
}

constexpr bool one_way_divides(const DualTables& tables) {
  for (int signs = 0; signs < 256; ++signs) {
    if (tables.is_joined[slot(signs)] != 0 &&
        tables.is_joined[slot(signs + DualTables::kOtherWay)] != 0) {
      return false;
    }
  }
  return true;
}

}  // namespace

constexpr DualTables kTables = make_tables();
static_assert(only_lone_faces_join(kTables));
static_assert(one_way_divides(kTables));

constinit const DualTables kDualTables = kTables;

}  // namespace kerf
