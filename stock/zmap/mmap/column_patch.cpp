#include "stock/zmap/mmap/column_patch.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "stock/stock_model.h"
#include "stock/zmap/mmap/column_relief.h"
#include "surface/wall_shift.h"

namespace kerf {
namespace {

using FaceIndex = ColumnRelief::FaceIndex;
using Face = ColumnRelief::Face;
constexpr FaceIndex kNone = ColumnRelief::kNone;
/// Squares of fewer cells are not looked at for being level.
constexpr int kLeastSquare = 8;
constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

class ColumnPatchBuilder {
 public:
  ColumnPatchBuilder(const ColumnRelief& relief, MeshPatch& patch)
      : r_(relief), patch_(patch), group_of_(4 * relief.face_count()) {}

  void add_surface() {
    places_.reserve(static_cast<std::size_t>((r_.nx() + 1) * (r_.ny() + 1)));
    for (int j = 0; j <= r_.ny(); ++j)
      for (int i = 0; i <= r_.nx(); ++i) places_.push_back(unmoved(i, j) + shift_mm(i, j));
    for (int j = 0; j <= r_.ny(); ++j)
      for (int i = 0; i <= r_.nx(); ++i) find_corner(i, j);
    add_square(0, 0, kTileCells >> r_.level());
    add_ground();
    for (int j = 0; j < r_.ny(); ++j)
      for (int i = 0; i <= r_.nx(); ++i) add_walls(i, j, true);
    for (int j = 0; j <= r_.ny(); ++j)
      for (int i = 0; i < r_.nx(); ++i) add_walls(i, j, false);
    patch_.skirt_begin = static_cast<std::uint32_t>(patch_.indices.size());
  }
  void add_skirts();

 private:
  /// A face of one of the four cells about a corner.
  struct Meeting {
    FaceIndex face;
    std::size_t corner;    ///< of the face
    std::size_t quadrant;  ///< of the cell
    std::size_t group;     ///< of faces that meet: number of the first
  };
  /// Faces that meet at a corner. Becomes a vertex when one is asked for.
  struct Group {
    glm::vec2 xy;
    float z;
    std::uint32_t normal, cut_by;
    std::uint32_t vertex = kNoVertex;
  };
  static std::size_t at(FaceIndex face, std::size_t corner) {
    return 4 * static_cast<std::size_t>(face) + corner;
  }
  const Group& group_at(FaceIndex face, std::size_t corner) const {
    return groups_[group_of_[at(face, corner)]];
  }
  float z_at(FaceIndex face, std::size_t corner) const { return group_at(face, corner).z; }
  std::uint32_t vertex_at(FaceIndex face, std::size_t corner) {
    Group& g = groups_[group_of_[at(face, corner)]];
    if (g.vertex == kNoVertex) g.vertex = add_vertex(g.xy, g.z, g.normal, g.cut_by);
    return g.vertex;
  }
  bool owns(int i, int j) const { return i >= 0 && j >= 0 && i < r_.nx() && j < r_.ny(); }

  glm::vec2 unmoved(int i, int j) const { return {r_.tops().x(i), r_.tops().y(j)}; }
  glm::vec2 shift_mm(int i, int j);
  /// Of all that stands above each other at a corner.
  const glm::vec2& place_of(int i, int j) const {
    return places_[static_cast<std::size_t>(j * (r_.nx() + 1) + i)];
  }
  std::uint32_t add_vertex(const glm::vec2& xy, float z, std::uint32_t normal,
                           std::uint32_t cut_by) {
    patch_.vertices.push_back({{xy, z}, normal});
    if (r_.keeps_cut_ids()) patch_.cut_by.push_back(cut_by);
    return static_cast<std::uint32_t>(patch_.vertices.size() - 1);
  }
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    patch_.indices.insert(patch_.indices.end(), {a, b, c});
  }

  void find_corner(int i, int j);
  void settle_group(int i, int j, std::size_t group);
  struct Place {
    float z;
    std::uint32_t normal;
  };
  Place place_of(int corner, std::span<const Meeting> group) const;
  bool is_level(int i, int j, int size) const;
  void add_square(int i, int j, int size);
  void add_fan(int i, int j, int width, int height, FaceIndex number, bool from_end);
  void add_ground();
  void add_face(int i, int j, FaceIndex f);
  /// How far that corner of the cell's face is moved.
  glm::vec2 moved_mm(int i, int j, FaceIndex f, std::size_t corner) const {
    const int corner_i = i + (corner == 1 || corner == 2), corner_j = j + (corner > 1);
    return group_at(f, corner).xy - unmoved(corner_i, corner_j);
  }
  bool is_square(int i, int j, FaceIndex f) const {
    bool is_square = true;
    for (std::size_t k = 0; k < 4; ++k)
      is_square = is_square && moved_mm(i, j, f, k) == glm::vec2(0);
    return is_square;
  }

  /// A face that ends at the border of two cells, seen from the top downward.
  struct Event {
    float z;
    bool in_before;  ///< of the cell before the border
    FaceIndex face;
    bool operator<(const Event& other) const {
      if (z != other.z) return z > other.z;
      return in_before != other.in_before ? in_before : face < other.face;
    }
  };
  /// One vertical edge of a wall.
  struct WallEnd {
    int i, j;
    std::vector<float> z;
    std::vector<std::uint32_t> vertex;
  };
  bool is_before_solid(const Event& upper) const {
    return upper.in_before == r_.face(upper.face).up;
  }
  template <class Visit>
  void each_wall(int before, bool along_y, const Visit& visit);
  void add_walls(int i, int j, bool along_y);
  void add_wall(int i, int j, bool along_y, const Event& upper, const Event& lower,
                bool before_is_solid);
  WallEnd wall_end(int i, int j, float from, float to) const;
  void zip(const WallEnd& low, const WallEnd& high, bool keep_turn);

  const ColumnRelief& r_;
  MeshPatch& patch_;
  std::vector<glm::vec2> places_;        ///< by corner
  std::vector<std::uint32_t> group_of_;  ///< by face, four corners each
  std::vector<Group> groups_;
  std::vector<Meeting> meetings_, group_;
  std::vector<Event> events_;
};

void ColumnPatchBuilder::find_corner(int i, int j) {
  const std::array<int, 4> cells = TileRelief::cells_about(TileRelief::slot(i, j));
  constexpr std::array<std::size_t, 4> kCornerOf{2, 3, 0, 1};
  meetings_.clear();
  for (std::size_t q = 0; q < 4; ++q) {
    for (FaceIndex f = r_.first_face(cells[q]); f < r_.end_face(cells[q]); ++f)
      meetings_.push_back({f, kCornerOf[q], q, meetings_.size()});
  }
  // Links along the way round: A-B and D-C in x, B-C and A-D in y.
  const auto linked = [&](const Meeting& a, const Meeting& b) {
    const bool in_x = (a.quadrant == 0 && b.quadrant == 1) || (a.quadrant == 3 && b.quadrant == 2);
    const bool in_y = (a.quadrant == 1 && b.quadrant == 2) || (a.quadrant == 0 && b.quadrant == 3);
    return (in_x && r_.next(a.face, false) == b.face) || (in_y && r_.next(a.face, true) == b.face);
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (const Meeting& a : meetings_) {
      for (const Meeting& b : meetings_) {
        if (!linked(a, b) || a.group == b.group) continue;
        const std::size_t from = std::max(a.group, b.group), to = std::min(a.group, b.group);
        for (Meeting& m : meetings_)
          if (m.group == from) m.group = to;
        changed = true;
      }
    }
  }
  for (std::size_t g = 0; g < meetings_.size(); ++g)
    if (meetings_[g].group == g) settle_group(i, j, g);
}

void ColumnPatchBuilder::settle_group(int i, int j, std::size_t group) {
  group_.clear();
  for (const Meeting& m : meetings_)
    if (m.group == group) group_.push_back(m);
  const Place place = place_of(TileRelief::slot(i, j), group_);
  const Meeting* lowest = &group_[0];
  for (const Meeting& m : group_)
    if (r_.face(m.face).z < r_.face(lowest->face).z) lowest = &m;
  const auto number = static_cast<std::uint32_t>(groups_.size());
  const bool is_moved = !r_.face(group_[0].face).is_ground || group_.size() < 4;
  groups_.push_back({is_moved ? place_of(i, j) : unmoved(i, j), place.z, place.normal,
                     r_.face(lowest->face).cut_by});
  for (const Meeting& m : group_) group_of_[at(m.face, m.corner)] = number;
}

ColumnPatchBuilder::Place ColumnPatchBuilder::place_of(int corner,
                                                       std::span<const Meeting> group) const {
  const Face& first = r_.face(group[0].face);
  if (first.is_ground) return {first.z, pack_normal({0, 0, -1})};
  const TileRelief& tops = r_.tops();
  const bool all_tops = std::all_of(group.begin(), group.end(),
                                    [&](const Meeting& m) { return r_.face(m.face).is_top; });
  if (all_tops && group.size() == 4 && !tops.is_split(corner))
    return {tops.corner_z(corner), tops.corner_normal(corner)};
  if (all_tops && tops.is_split(corner)) {
    const TileRelief::Split split = tops.split(corner);
    const std::size_t q = group[0].quadrant;
    const auto alike = std::count(split.group.begin(), split.group.end(), split.group[q]);
    if (static_cast<std::size_t>(alike) == group.size()) {
      const glm::vec2 slope = split.slope[q];
      return {split.z[q], pack_normal(glm::normalize(glm::vec3(-slope.x, -slope.y, 1)))};
    }
  }
  float sum = 0, low = first.z, high = first.z;
  glm::vec2 slope(0);
  for (const Meeting& m : group) {
    const float z = r_.face(m.face).z;
    sum += z;
    low = std::min(low, z);
    high = std::max(high, z);
    slope += r_.slope(m.face);
  }
  const float count = static_cast<float>(group.size());
  slope /= count;
  const glm::vec3 up = glm::normalize(glm::vec3(-slope.x, -slope.y, 1));
  return {std::clamp(sum / count, low, high), pack_normal(first.up ? up : -up)};
}

/// Cells of the square and around it all have the same faces at the same heights, cut by the same
/// moves, and something beside the ground.
bool ColumnPatchBuilder::is_level(int i, int j, int size) const {
  const int cell = TileRelief::slot(i, j);
  const FaceIndex first = r_.first_face(cell), count = r_.end_face(cell) - first;
  if (count == 0) return false;
  for (int y = j - 1; y <= j + size; ++y) {
    for (int x = i - 1; x <= i + size; ++x) {
      const int other = TileRelief::slot(x, y);
      const FaceIndex f = r_.first_face(other);
      if (r_.end_face(other) - f != count) return false;
      for (FaceIndex n = 0; n < count; ++n) {
        const Face& a = r_.face(first + n);
        const Face& b = r_.face(f + n);
        if (a.z != b.z || a.cut_by != b.cut_by || a.is_ground != b.is_ground) return false;
      }
    }
  }
  return true;
}

/// All faces of a square of cells but those on the ground.
void ColumnPatchBuilder::add_square(int i, int j, int size) {
  if (i >= r_.nx() || j >= r_.ny()) return;
  const bool whole = i + size <= r_.nx() && j + size <= r_.ny();
  if (whole && size >= kLeastSquare && is_level(i, j, size)) {
    const int cell = TileRelief::slot(i, j);
    const FaceIndex first = r_.first_face(cell);
    for (FaceIndex f = first; f < r_.end_face(cell); ++f)
      if (!r_.face(f).is_ground) add_fan(i, j, size, size, f - first, false);
    return;
  }
  if (size > kLeastSquare) {
    const int half = size / 2;
    for (const int y : {j, j + half})
      for (const int x : {i, i + half}) add_square(x, y, half);
    return;
  }
  for (int y = j; y < std::min(j + size, r_.ny()); ++y) {
    for (int x = i; x < std::min(i + size, r_.nx()); ++x) {
      const int cell = TileRelief::slot(x, y);
      for (FaceIndex f = r_.first_face(cell); f < r_.end_face(cell); ++f)
        if (!r_.face(f).is_ground) add_face(x, y, f);
    }
  }
}

/// The faces of that number (counted from the lowest one if `from_end`) of a rectangle of cells,
/// which are one level face: triangles from its middle to every corner on its rim.
void ColumnPatchBuilder::add_fan(int i, int j, int width, int height, FaceIndex number,
                                 bool from_end) {
  const auto face_of = [&](int x, int y) {
    const int cell = TileRelief::slot(x, y);
    return from_end ? r_.end_face(cell) - 1 - number : r_.first_face(cell) + number;
  };
  std::vector<std::uint32_t> ring;
  for (int k = 0; k < width; ++k) ring.push_back(vertex_at(face_of(i + k, j), 0));
  for (int k = 0; k < height; ++k) ring.push_back(vertex_at(face_of(i + width - 1, j + k), 1));
  for (int k = width; k > 0; --k) ring.push_back(vertex_at(face_of(i + k - 1, j + height - 1), 2));
  for (int k = height; k > 0; --k) ring.push_back(vertex_at(face_of(i, j + k - 1), 3));
  const std::uint32_t center = vertex_at(face_of(i + width / 2, j + height / 2), 0);
  const bool up = r_.face(face_of(i, j)).up;
  for (std::size_t n = 0; n < ring.size(); ++n) {
    const std::uint32_t a = ring[n], b = ring[n + 1 < ring.size() ? n + 1 : 0];
    add_triangle(center, up ? a : b, up ? b : a);
  }
}

void ColumnPatchBuilder::add_ground() {
  const auto ground_of = [&](int i, int j) {
    const int cell = TileRelief::slot(i, j);
    const FaceIndex last = r_.end_face(cell) - 1;
    return last >= r_.first_face(cell) && r_.face(last).is_ground ? last : kNone;
  };
  bool whole = r_.nx() > 1 && r_.ny() > 1;
  for (int j = 0; j < r_.ny(); ++j)
    for (int i = 0; i < r_.nx(); ++i)
      whole = whole && ground_of(i, j) != kNone && is_square(i, j, ground_of(i, j));
  // A corner on the border that is moved might not be seen from the middle.
  if (whole) return add_fan(0, 0, r_.nx(), r_.ny(), 0, true);
  for (int j = 0; j < r_.ny(); ++j) {
    for (int i = 0; i < r_.nx(); ++i)
      if (const FaceIndex f = ground_of(i, j); f != kNone) add_face(i, j, f);
  }
}

void ColumnPatchBuilder::add_face(int i, int j, FaceIndex f) {
  const auto v = [&](std::size_t corner) { return vertex_at(f, corner); };
  const std::array<float, 4> z{z_at(f, 0), z_at(f, 1), z_at(f, 2), z_at(f, 3)};
  std::array<glm::vec2, 4> shift;
  for (std::size_t k = 0; k < 4; ++k) shift[k] = moved_mm(i, j, f, k) / r_.tops().size_mm(i, j);
  const bool rising = has_rising_diagonal(z, 2 * r_.face(f).z, shift);
  const std::size_t last = rising ? 2 : 3, first = rising ? 0 : 1;
  const bool up = r_.face(f).up;
  add_triangle(v(0), up ? v(1) : v(last), up ? v(last) : v(1));
  add_triangle(v(first), up ? v(2) : v(3), up ? v(3) : v(2));
}

/// Calls visit(upper, lower) with the ends of the walls between a cell and the next one in x
/// (along_y) or in y.
template <class Visit>
void ColumnPatchBuilder::each_wall(int before, bool along_y, const Visit& visit) {
  const int cell = before + (along_y ? 1 : TileRelief::kStride);
  FaceIndex f = r_.first_face(before), g = r_.first_face(cell);
  const FaceIndex f_end = r_.end_face(before), g_end = r_.end_face(cell);
  // From one pair of linked faces to the next: there both cells are solid or neither is, and below
  // it again. So of the faces between every second one, from the top downward, begins a wall: on
  // its own side if there is material below it.
  while (f < f_end || g < g_end) {
    events_.clear();
    for (; f < f_end && r_.next(f, !along_y) == kNone; ++f)
      events_.push_back({r_.face(f).z, true, f});
    for (; g < g_end && r_.before(g, !along_y) == kNone; ++g)
      events_.push_back({r_.face(g).z, false, g});
    ++f;
    ++g;
    std::sort(events_.begin(), events_.end());
    for (std::size_t n = 0; n + 1 < events_.size(); n += 2) visit(events_[n], events_[n + 1]);
  }
}

/// The walls between cell (i, j) and the one before it in x (along_y) or in y.
void ColumnPatchBuilder::add_walls(int i, int j, bool along_y) {
  const int cell = TileRelief::slot(i, j);
  const int before = along_y ? cell - 1 : cell - TileRelief::kStride;
  each_wall(before, along_y, [&](const Event& upper, const Event& lower) {
    const bool before_is_solid = is_before_solid(upper);
    const bool is_ours =
        before_is_solid ? owns(i - (along_y ? 1 : 0), j - (along_y ? 0 : 1)) : owns(i, j);
    if (is_ours) add_wall(i, j, along_y, upper, lower, before_is_solid);
  });
}

/// How far to move corner (i, j) to the course of its walls. Where all tops about it are one level
/// face, that of the highest wall below; the others go with it.
glm::vec2 ColumnPatchBuilder::shift_mm(int i, int j) {
  const TileRelief& tops = r_.tops();
  const int corner = TileRelief::slot(i, j);
  if (tops.is_split(corner)) return tops.shift_mm(i, j);
  const std::array<int, 4> cells = TileRelief::cells_about(corner);
  const auto is_plain = [&](int cell) { return r_.end_face(cell) - r_.first_face(cell) <= 2; };
  const auto is_level = [&](int cell) { return tops.height(cell) == tops.height(cells[0]); };
  if (std::all_of(cells.begin(), cells.end(), is_plain) ||
      !std::all_of(cells.begin(), cells.end(), is_level))
    return glm::vec2(0);
  // By edge, each between a cell and the next one about the corner; of the two that which is first
  // in x or y is the `before`.
  float highest = 0, middle = 0;
  std::size_t edge = 4;
  bool is_high_left = false;
  for (std::size_t q = 0; q < 4; ++q) {
    const bool along_y = q % 2 == 0, is_before_first = q < 2;
    const int before = cells[q == 0 ? 0 : q == 1 ? 1 : q == 2 ? 3 : 0];
    each_wall(before, along_y, [&](const Event& upper, const Event& lower) {
      if (!(upper.z - lower.z > highest)) return;
      highest = upper.z - lower.z;
      middle = 0.5f * (upper.z + lower.z);
      edge = q;
      is_high_left = is_before_solid(upper) != is_before_first;  // the next one about the corner
    });
  }
  if (edge == 4) return glm::vec2(0);
  const auto solid = [&](int x, int y) { return r_.is_solid(x, y, middle) ? 1.0f : 0.0f; };
  const auto in_grid = [&](int x, int y) { return r_.is_in_grid(x, y); };
  const WallShift wall({i, j}, WallShift::kWays[edge], is_high_left, 0.5f,
                       TileRelief::wall_reach(r_.level()), solid, in_grid);
  const bool is_on_border = !(in_grid(i - 1, j - 1) && in_grid(i, j));
  return is_on_border ? glm::vec2(0) : tops.to_mm(wall.shift(glm::vec2(1)), i, j);
}

/// Heights from the one to the other; between them those of the other faces at this corner, since
/// walls between those end there.
ColumnPatchBuilder::WallEnd ColumnPatchBuilder::wall_end(int i, int j, float from, float to) const {
  const std::array<int, 4> cells = TileRelief::cells_about(TileRelief::slot(i, j));
  constexpr std::array<std::size_t, 4> kCornerOf{2, 3, 0, 1};
  WallEnd end{i, j, {from}, {}};
  const float low = std::min(from, to), high = std::max(from, to);
  for (std::size_t q = 0; q < 4; ++q) {
    for (FaceIndex f = r_.first_face(cells[q]); f < r_.end_face(cells[q]); ++f) {
      const float z = z_at(f, kCornerOf[q]);
      if (z > low && z < high) end.z.push_back(z);
    }
  }
  if (from != to) end.z.push_back(to);
  std::sort(end.z.begin(), end.z.end());
  end.z.erase(std::unique(end.z.begin(), end.z.end()), end.z.end());
  if (to < from) std::reverse(end.z.begin(), end.z.end());
  return end;
}

void ColumnPatchBuilder::add_wall(int i, int j, bool along_y, const Event& upper,
                                  const Event& lower, bool before_is_solid) {
  // The corner of a cell at the lower (higher) end of the border.
  const auto corner = [&](const Event& event, bool high) -> std::size_t {
    if (along_y) return event.in_before ? (high ? 2 : 1) : (high ? 3 : 0);
    return event.in_before ? (high ? 2 : 3) : (high ? 1 : 0);
  };
  const auto z = [&](const Event& event, bool high) {
    return z_at(event.face, corner(event, high));
  };
  WallEnd low = wall_end(i, j, z(upper, false), z(lower, false));
  WallEnd high = wall_end(along_y ? i : i + 1, along_y ? j + 1 : j, z(upper, true), z(lower, true));
  if (low.z.size() + high.z.size() == 2) return;
  const glm::ivec2 air =
      before_is_solid ? glm::ivec2(i, j) : glm::ivec2(i - (along_y ? 1 : 0), j - (along_y ? 0 : 1));
  const std::uint32_t made_by = r_.cut_by_below(air.x, air.y, lower.z);
  const glm::vec2 axis(along_y ? 1 : 0, along_y ? 0 : 1);
  const glm::vec2 outward = before_is_solid ? axis : -axis;
  std::array<glm::vec2, 2> facing{outward, outward};
  if (r_.is_in_grid(air.x, air.y)) {
    const float middle = 0.5f * (upper.z + lower.z);
    const auto solid = [&](int x, int y) { return r_.is_solid(x, y, middle) ? 1.0f : 0.0f; };
    const auto in_grid = [&](int x, int y) { return r_.is_in_grid(x, y); };
    const WallCourse course(i, j, along_y, 0.5f, TileRelief::wall_reach(r_.level()), solid,
                            in_grid);
    facing = {course.facing(false, outward), course.facing(true, outward)};
  }
  for (WallEnd* end : {&low, &high}) {
    const std::uint32_t normal = pack_normal(glm::vec3(facing[end == &high ? 1 : 0], 0));
    for (const float at_z : end->z)
      end->vertex.push_back(add_vertex(place_of(end->i, end->j), at_z, normal, made_by));
  }
  // From outside, the end with the higher y is at the right of a wall that faces +x, and the one
  // with the higher x at the left of a wall that faces +y.
  zip(low, high, along_y == before_is_solid);
}

/// Triangles between two vertical edges. `low_is_left`, seen from outside.
void ColumnPatchBuilder::zip(const WallEnd& low, const WallEnd& high, bool low_is_left) {
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    low_is_left ? add_triangle(a, b, c) : add_triangle(a, c, b);
  };
  std::size_t p = 0, q = 0;
  while (p + 1 < low.z.size() || q + 1 < high.z.size()) {
    if (q + 1 == high.z.size() || (p + 1 < low.z.size() && p <= q)) {
      add(low.vertex[p + 1], high.vertex[q], low.vertex[p]);
      ++p;
    } else {
      add(high.vertex[q + 1], high.vertex[q], low.vertex[p]);
      ++q;
    }
  }
}

/// Each piece of material that reaches a border with another tile is closed there.
void ColumnPatchBuilder::add_skirts() {
  const auto add = [&](int i, int j, std::size_t from, std::size_t to) {
    // On the tile's border, wherever corners were moved (see make_tile_patch()).
    const auto at = [&](std::size_t k) { return unmoved(i + (k == 1 || k == 2), j + (k > 1)); };
    const std::array<glm::vec2, 2> border{at(from), at(to)};
    const int cell = TileRelief::slot(i, j);
    for (FaceIndex f = r_.first_face(cell); f < r_.end_face(cell); f += 2) {
      const std::uint32_t a = vertex_at(f, from), b = vertex_at(f, to);
      // With the normals above: where a skirt fills a crack it must not be seen.
      const auto below = [&](std::uint32_t top, std::size_t corner) {
        MeshVertex vertex = patch_.vertices[top];
        vertex.position_mm = {border[corner == from ? 0 : 1], z_at(f + 1, corner)};
        patch_.vertices.push_back(vertex);
        if (r_.keeps_cut_ids()) patch_.cut_by.push_back(patch_.cut_by[top]);
        return static_cast<std::uint32_t>(patch_.vertices.size() - 1);
      };
      const std::uint32_t c = below(a, from), d = below(b, to);
      add_triangle(c, d, b);
      add_triangle(c, b, a);
    }
  };
  const int nx = r_.nx(), ny = r_.ny();
  for (int j = 0; j < ny; ++j) {
    if (r_.is_in_grid(-1, j)) add(0, j, 3, 0);
    if (r_.is_in_grid(nx, j)) add(nx - 1, j, 1, 2);
  }
  for (int i = 0; i < nx; ++i) {
    if (r_.is_in_grid(i, -1)) add(i, 0, 0, 1);
    if (r_.is_in_grid(i, ny)) add(i, ny - 1, 2, 3);
  }
}

}  // namespace

bool gaps_near(const TileGrid& grid, const GapGrid& gaps, std::uint32_t tile) {
  const int tx = static_cast<int>(tile) % grid.tiles_x();
  const int ty = static_cast<int>(tile) / grid.tiles_x();
  for (int y = std::max(0, ty - 1); y <= std::min(ty + 1, grid.tiles_y() - 1); ++y) {
    for (int x = std::max(0, tx - 1); x <= std::min(tx + 1, grid.tiles_x() - 1); ++x)
      if (gaps.tile(static_cast<std::size_t>(y * grid.tiles_x() + x)) != nullptr) return true;
  }
  return false;
}

MeshPatch make_column_patch(const TileGrid& grid, const GapGrid& gaps, std::uint32_t tile,
                            int level) {
  assert(tile < grid.tile_count() && level >= 0 && level < StockModel::kPatchLevels);
  MeshPatch patch;
  patch.tile = tile;
  patch.level = level;
  patch.tiles_in_row = static_cast<std::uint32_t>(grid.tiles_x());
  const ColumnRelief relief(grid, gaps, tile, level);
  ColumnPatchBuilder builder(relief, patch);
  builder.add_surface();
  builder.add_skirts();
  return patch;
}

std::optional<std::uint32_t> gap_id_at(const TileGrid& grid, const GapGrid& gaps,
                                       const Vec3& point_mm) {
  const Box& box = grid.bounds_mm();
  const int i = static_cast<int>(std::floor((point_mm.x - box.min.x) / grid.cell_x_mm()));
  const int j = static_cast<int>(std::floor((point_mm.y - box.min.y) / grid.cell_y_mm()));
  if (i < 0 || j < 0 || i >= grid.nx() || j >= grid.ny()) return std::nullopt;
  const GapTile* const tile =
      gaps.tile(static_cast<std::size_t>(j / kTileCells * grid.tiles_x() + i / kTileCells));
  if (tile == nullptr) return std::nullopt;
  // The top, if it is nearer, has its own number.
  double nearest = std::min(std::abs(static_cast<double>(grid.height(i, j)) - point_mm.z),
                            0.5 * std::max(grid.cell_x_mm(), grid.cell_y_mm()));
  std::optional<std::uint32_t> id;
  const auto look = [&](float z, std::uint32_t z_id) {
    const double distance = std::abs(static_cast<double>(z) - point_mm.z);
    if (distance >= nearest) return;
    nearest = distance;
    id = z_id == MeshPatch::kNotCut ? std::nullopt : std::optional(z_id);
  };
  tile->each(TileGrid::offset(i, j), [&](const Gap& gap) {
    look(gap.high, gap.high_id);
    look(gap.low, gap.low_id);
  });
  return id;
}

}  // namespace kerf
