#include "stock/zmap/height_mesh_steps.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/portable_math.h"

namespace kerf {
namespace {

/// Cosine of the turn below which a wall has a corner within a square: about 35 degrees. Rounder
/// ones are chords of a curve, of a radius of three cells or more.
constexpr double kSharpTurn = 0.82;
/// Of a cell: so far a corner is from the square's edges.
constexpr double kInside = 0.01;

/// Of a cell: a shorter way tells nothing of its direction, of places that are known to 1/512.
constexpr double kLeastCourse = 0.5;
/// Of the sum of what lies across walls: below it they run alike.
constexpr double kLeastCrossing = 0.05;
/// Sine between a wall and the grid's edge, below which it is not told where it meets it.
constexpr double kLeastSlant = 0.3;
/// To the squares beyond the edges.
constexpr int kAside[4][2] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

}  // namespace

/// Corners counter-clockwise from low x, y, and the edge that follows each.
struct StepSquares::Square {
  std::array<Corner, 4> corner;
  std::array<std::size_t, 4> edge;       ///< index, or kNone
  std::array<NodeKey, 4> before, after;  ///< points of an edge with a step, as one goes round
  std::array<std::size_t, 4> walls{};    ///< edges with a step, in order
  std::size_t count = 0;
  glm::dvec2 low{0}, high{0};
};

/// How it is divided.
struct StepSquares::Plan {
  Layout::Kind kind = Layout::Kind::kAround;
  std::size_t cut_off = 0;  ///< kSaddle: this corner and the opposite one
  glm::dvec2 middle{0};     ///< kAround: where the walls meet
  bool has_ways = false;
  std::array<glm::dvec2, 4> ways{};  ///< as find_ways() has them
};

StepSquares::StepSquares(const Relief& relief, std::span<const CellStep> steps, bool given_only)
    : relief_(relief),
      has_holes_(relief.has_holes() && !given_only),
      first_key_(static_cast<NodeKey>(2 * relief.node_count())),
      divided_(relief.node_count()) {
  take_steps(steps);
  if (has_holes_) take_holes();
  std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) { return a.at < b.at; });
  // Of two the one that was given.
  edges_.erase(std::unique(edges_.begin(), edges_.end(),
                           [](const Edge& a, const Edge& b) { return a.at == b.at; }),
               edges_.end());
  put_points();
}

bool StepSquares::is_open_square(int i, int j) const {
  return !(relief_.node_is_solid(i, j) && relief_.node_is_solid(i + 1, j) &&
           relief_.node_is_solid(i, j + 1) && relief_.node_is_solid(i + 1, j + 1));
}

/// The outermost nodes have the heights of the cells beside them, and their steps.
void StepSquares::take_steps(std::span<const CellStep> steps) {
  const int last_i = relief_.nx() - 1, last_j = relief_.ny() - 1;
  for (const CellStep& step : steps) {
    const int i = step.i + 1, j = step.j + 1;
    const auto add = [&](int ni, int nj) {
      edges_.push_back({edge_number(ni, nj, step.axis), step.part, step.foot_mm});
    };
    add(i, j);
    if (step.axis == 0) {
      if (step.j == 0) add(i, 0);
      if (step.j == last_j) add(i, relief_.height() - 1);
    } else {
      if (step.i == 0) add(0, j);
      if (step.i == last_i) add(relief_.width() - 1, j);
    }
  }
}

void StepSquares::take_holes() {
  std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) { return a.at < b.at; });
  const std::size_t given = edges_.size();
  const auto is_given = [&](std::uint64_t at) {
    const auto end = edges_.begin() + static_cast<std::ptrdiff_t>(given);
    const auto found = std::lower_bound(
        edges_.begin(), end, at, [](const Edge& e, std::uint64_t number) { return e.at < number; });
    return found != end && found->at == at;
  };
  for (int j = 0; j < relief_.height(); ++j) {
    for (int i = 0; i < relief_.width(); ++i) {
      const bool solid = relief_.node_is_solid(i, j);
      for (int axis = 0; axis < 2; ++axis) {
        const int i2 = i + (axis == 0), j2 = j + (axis == 1);
        if (i2 >= relief_.width() || j2 >= relief_.height()) continue;
        if (solid == relief_.node_is_solid(i2, j2)) continue;
        const std::uint64_t at = edge_number(i, j, axis);
        if (!is_given(at)) edges_.push_back({at, 0.5f, relief_.floor_mm()});
      }
    }
  }
}

/// Two for each edge: the lower one first.
void StepSquares::put_points() {
  const auto width = static_cast<std::uint64_t>(relief_.width());
  row_begin_.assign(static_cast<std::size_t>(relief_.height()) + 1, 0);
  positions_.reserve(2 * edges_.size());
  const auto divide = [&](int i, int j) {
    if (i < 0 || j < 0 || i + 1 >= relief_.width() || j + 1 >= relief_.height()) return;
    const std::size_t at = corner(i, j);
    if (!divided_[at]) squares_.push_back(static_cast<std::uint32_t>(at));
    divided_[at] = true;
  };
  for (Edge& edge : edges_) {
    const int axis = static_cast<int>(edge.at % 2);
    const auto node = edge.at / 2;
    const int i = static_cast<int>(node % width), j = static_cast<int>(node / width);
    const int i2 = i + (axis == 0), j2 = j + (axis == 1);
    ++row_begin_[static_cast<std::size_t>(j) + 1];
    const float a = relief_.node_mm(i, j), b = relief_.node_mm(i2, j2);
    const float high = std::max(a, b);
    const bool is_hole = !(std::min(a, b) > relief_.floor_mm());
    const float low = is_hole ? relief_.floor_mm() : std::clamp(edge.foot_mm, std::min(a, b), high);
    const auto part = static_cast<double>(edge.part);
    const double x = relief_.x_mm(i) + part * (relief_.x_mm(i2) - relief_.x_mm(i));
    const double y = relief_.y_mm(j) + part * (relief_.y_mm(j2) - relief_.y_mm(j));
    positions_.emplace_back(x, y, low);
    positions_.emplace_back(x, y, high);
    divide(i, j);
    divide(axis == 0 ? i : i - 1, axis == 0 ? j - 1 : j);
  }
  for (std::size_t row = 1; row < row_begin_.size(); ++row) row_begin_[row] += row_begin_[row - 1];
  std::sort(squares_.begin(), squares_.end());
  layouts_.resize(squares_.size());
  put_border_points();
}

std::size_t StepSquares::find(int i, int j, int axis) const {
  const std::uint64_t at = edge_number(i, j, axis);
  const auto row = static_cast<std::size_t>(j);
  const auto begin = edges_.begin() + static_cast<std::ptrdiff_t>(row_begin_[row]),
             end = edges_.begin() + static_cast<std::ptrdiff_t>(row_begin_[row + 1]);
  const auto found = std::lower_bound(
      begin, end, at, [](const Edge& e, std::uint64_t number) { return e.at < number; });
  if (found == end || found->at != at) return kNone;
  return static_cast<std::size_t>(found - edges_.begin());
}

std::optional<StepSquares::Points> StepSquares::points(int i, int j, int i2, int j2) const {
  const std::size_t edge = find(std::min(i, i2), std::min(j, j2), j == j2 ? 0 : 1);
  if (edge == kNone) return std::nullopt;
  return points_of(edge, {i, j}, {i2, j2});
}

StepSquares::Points StepSquares::points_of(std::size_t edge, Corner a, Corner b) const {
  const auto low = static_cast<NodeKey>(first_key_ + 2 * edge);
  const bool is_up = relief_.node_mm(a.i, a.j) < relief_.node_mm(b.i, b.j);
  return is_up ? Points{low, low + 1} : Points{low + 1, low};
}

StepSquares::Square StepSquares::square(int i, int j) const {
  Square s;
  s.corner = {{{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
  s.low = {relief_.x_mm(i), relief_.y_mm(j)};
  s.high = {relief_.x_mm(i + 1), relief_.y_mm(j + 1)};
  for (std::size_t k = 0; k < 4; ++k) {
    const Corner a = s.corner[k], b = s.corner[(k + 1) % 4];
    s.edge[k] = find(std::min(a.i, b.i), std::min(a.j, b.j), a.j == b.j ? 0 : 1);
    if (s.edge[k] == kNone) continue;
    const Points at = points_of(s.edge[k], a, b);
    s.before[k] = at.here;
    s.after[k] = at.there;
    s.walls[s.count++] = k;
  }
  return s;
}

bool StepSquares::is_on_floor(NodeKey key) const {
  if (!is_own(key)) return relief_.on_floor(key);
  return !(position_mm(key).z > relief_.floor_mm());
}

glm::dvec3 StepSquares::place(NodeKey key) const {
  return glm::dvec3(is_own(key) ? position_mm(key) : relief_.position_mm(key));
}

NodeKey StepSquares::own_key(const glm::dvec2& xy, float z) {
  positions_.emplace_back(xy.x, xy.y, z);
  return static_cast<NodeKey>(first_key_ + positions_.size() - 1);
}

/// The way of a wall that goes over edge `through` of the square with this low corner, from within
/// it; from farther back where that is too short to tell. None if other walls meet it there.
std::optional<glm::dvec2> StepSquares::course(Corner low, std::size_t through) const {
  constexpr int kMostSquares = 3;
  std::optional<glm::dvec2> end;
  for (int n = 0; n < kMostSquares; ++n) {
    if (low.i < 0 || low.j < 0 || low.i + 1 >= relief_.width() || low.j + 1 >= relief_.height())
      return std::nullopt;
    const Square s = square(low.i, low.j);
    if (s.count != 2) return std::nullopt;
    const std::size_t from = s.walls[0] == through ? s.walls[1] : s.walls[0];
    if (!end) end = glm::dvec2(place(s.before[through]));
    const glm::dvec2 way = *end - glm::dvec2(place(s.before[from]));
    const glm::dvec2 cells = way / (s.high - s.low);
    if (glm::dot(cells, cells) >= kLeastCourse * kLeastCourse) return way;
    low = {low.i + kAside[from][0], low.j + kAside[from][1]};
    through = (from + 2) % 4;
  }
  return std::nullopt;
}

/// Into the square, of the walls that cross its edges, straight on from the squares beyond. False:
/// of one nobody knows.
bool StepSquares::find_ways(const Square& s, std::array<glm::dvec2, 4>& ways) const {
  const Corner low = s.corner[0];
  for (std::size_t w = 0; w < s.count; ++w) {
    const std::size_t k = s.walls[w];
    const std::optional<glm::dvec2> way =
        course({low.i + kAside[k][0], low.j + kAside[k][1]}, (k + 2) % 4);
    if (!way) return false;
    ways[w] = *way;
  }
  return true;
}

/// Where walls that come in by these ways meet; none where that is not within the square, or two
/// are as good as one.
std::optional<glm::dvec2> StepSquares::meeting(const Square& s,
                                               const std::array<glm::dvec2, 4>& ways) const {
  glm::dmat2 sum(0);
  glm::dvec2 right(0), first(0);
  double straight = -1;
  for (std::size_t w = 0; w < s.count; ++w) {
    const glm::dvec2 along = ways[w] / glm::length(ways[w]);
    if (w == 0)
      first = along;
    else
      straight = -glm::dot(first, along);
    // The part across the wall of how far the meeting is from it has the least square.
    const glm::dmat2 across = glm::dmat2(1) - glm::outerProduct(along, along);
    sum += across;
    right += across * glm::dvec2(place(s.before[s.walls[w]]));
  }
  if (s.count == 2 && straight > kSharpTurn) return std::nullopt;
  if (!(glm::determinant(sum) > kLeastCrossing)) return std::nullopt;
  const glm::dvec2 at = glm::inverse(sum) * right;
  const glm::dvec2 margin = kInside * (s.high - s.low);
  const bool is_inside = at.x > s.low.x + margin.x && at.y > s.low.y + margin.y &&
                         at.x < s.high.x - margin.x && at.y < s.high.y - margin.y;
  return is_inside ? std::optional(at) : std::nullopt;
}

/// On the edge of the grid, half a cell beyond the outermost middles, walls go on as they came.
void StepSquares::put_border_points() {
  const int last_i = relief_.width() - 1, last_j = relief_.height() - 1;
  const auto width = static_cast<std::uint64_t>(relief_.width());
  for (std::size_t n = 0; n < edges_.size(); ++n) {
    const int axis = static_cast<int>(edges_[n].at % 2);
    const int i = static_cast<int>(edges_[n].at / 2 % width),
              j = static_cast<int>(edges_[n].at / 2 / width);
    const int across = axis == 0 ? j : i, last = axis == 0 ? last_j : last_i;
    if (across != 0 && across != last) continue;
    // From the square behind the outermost middles, over the edge that leads here.
    const bool is_low = across == 0;
    const int behind = is_low ? 1 : last - 2;
    const Corner low = axis == 0 ? Corner{i, behind} : Corner{behind, j};
    const std::size_t through = axis == 0 ? (is_low ? 0 : 2) : (is_low ? 3 : 1);
    const std::optional<glm::dvec2> way = course(low, through);
    const int out = 1 - axis;
    if (!way || std::abs((*way)[out]) < kLeastSlant * glm::length(*way)) continue;
    const int inner = is_low ? 1 : last - 1;
    const double step = axis == 0 ? relief_.y_mm(across) - relief_.y_mm(inner)
                                  : relief_.x_mm(across) - relief_.x_mm(inner);
    const double from = axis == 0 ? relief_.x_mm(i) : relief_.y_mm(j);
    const double to = axis == 0 ? relief_.x_mm(i + 1) : relief_.y_mm(j + 1);
    glm::vec3* const points = &positions_[2 * n];
    const double at = static_cast<double>(points[0][axis]) + step / (*way)[out] * (*way)[axis];
    const double margin = kInside * (to - from);
    points[0][axis] = points[1][axis] =
        static_cast<float>(std::clamp(at, from + margin, to - margin));
  }
}

/// From its first corner; left out where there is no material.
void StepSquares::add_polygon(std::span<const NodeKey> polygon, std::vector<NodeTriangle>& out) {
  if (has_holes_ &&
      std::all_of(polygon.begin(), polygon.end(), [&](NodeKey key) { return is_on_floor(key); }))
    return;
  for (std::size_t n = 1; n + 1 < polygon.size(); ++n)
    out.push_back({polygon[0], polygon[n], polygon[n + 1]});
}

/// From the wall at edge a to that at edge b, by the corners between them. How many keys.
std::size_t StepSquares::go_round(const Square& s, std::size_t a, std::size_t b,
                                  NodeKey* keys) const {
  std::size_t n = 0;
  keys[n++] = s.after[a];
  for (std::size_t k = (a + 1) % 4;; k = (k + 1) % 4) {
    keys[n++] = relief_.top_key(s.corner[k].i, s.corner[k].j);
    if (k == b) break;
  }
  keys[n++] = s.before[b];
  return n;
}

/// The wall between edges a and b, where a comes first, and what lies between a and b.
void StepSquares::add_chord(const Square& s, std::size_t a, std::size_t b,
                            std::vector<NodeTriangle>& out) {
  std::array<NodeKey, 8> polygon;
  add_polygon({polygon.data(), go_round(s, a, b, polygon.data())}, out);
  out.push_back({s.after[a], s.before[b], s.after[b]});
  out.push_back({s.after[a], s.after[b], s.before[a]});
}

/// Two opposite corners are cut off; the other two hang together.
void StepSquares::add_saddle(const Square& s, std::size_t cut_off, std::vector<NodeTriangle>& out) {
  std::array<NodeKey, 6> middle;
  std::size_t n = 0;
  for (const std::size_t c : {cut_off, cut_off + 2}) {
    const std::size_t k = c % 4, next = (c + 1) % 4;
    add_chord(s, (c + 3) % 4, k, out);
    middle[n++] = s.after[k];
    middle[n++] = relief_.top_key(s.corner[next].i, s.corner[next].j);
    middle[n++] = s.before[next];
  }
  add_polygon(middle, out);
}

/// All walls end in the middle, where each part of the surface has a point of its own height.
void StepSquares::add_around(const Square& s, const glm::dvec2& middle,
                             std::vector<NodeTriangle>& out) {
  std::array<float, 4> z{};
  std::array<NodeKey, 4> key{};
  const std::size_t count = s.count;
  const auto height = [&](NodeKey k) { return position_mm(k).z; };
  for (std::size_t w = 0; w < count; ++w) {
    const float from = height(s.after[s.walls[w]]), to = height(s.before[s.walls[(w + 1) % count]]);
    z[w] = 0.5f * (from + to);
    std::size_t same = 0;
    while (same < w && z[same] != z[w]) ++same;
    key[w] = same < w ? key[same] : own_key(middle, z[w]);
  }
  for (std::size_t w = 0; w < count; ++w) {
    const std::size_t a = s.walls[w], b = s.walls[(w + 1) % count];
    std::array<NodeKey, 9> polygon;
    polygon[0] = key[w];
    add_polygon({polygon.data(), 1 + go_round(s, a, b, &polygon[1])}, out);
  }
  for (std::size_t w = 0; w < count; ++w) {
    const std::size_t before = (w + count - 1) % count, edge = s.walls[w];
    // Down or up the middle, by way of the other points there.
    std::array<std::size_t, 4> others{};
    std::size_t n = 0;
    const float low = std::min(z[w], z[before]), high = std::max(z[w], z[before]);
    for (std::size_t r = 0; r < count; ++r)
      if (z[r] > low && z[r] < high) others[n++] = r;
    std::sort(
        others.begin(), others.begin() + static_cast<std::ptrdiff_t>(n),
        [&](std::size_t p, std::size_t q) { return z[before] > z[w] ? z[p] < z[q] : z[p] > z[q]; });
    NodeKey last = key[w];
    for (std::size_t m = 0; m <= n; ++m) {
      const NodeKey next = m < n ? key[others[m]] : key[before];
      if (next != last) out.push_back({s.after[edge], last, next});
      last = next;
    }
    out.push_back({s.after[edge], key[before], s.before[edge]});
  }
}

StepSquares::Plan StepSquares::plan(const Square& s) const {
  Plan out;
  out.middle = 0.5 * (s.low + s.high);
  if (s.count < 2) return out;
  out.has_ways = find_ways(s, out.ways);
  const std::optional<glm::dvec2> met = out.has_ways ? meeting(s, out.ways) : std::nullopt;
  if (met) out.middle = *met;
  if (s.count == 2 && !met) out.kind = Layout::Kind::kChord;
  if (s.count > 2 && !met) {
    out.middle = glm::dvec2(0);
    for (std::size_t w = 0; w < s.count; ++w)
      out.middle += glm::dvec2(place(s.before[s.walls[w]])) / static_cast<double>(s.count);
  }
  if (s.count < 4) return out;
  std::array<float, 4> z{};
  for (std::size_t c = 0; c < 4; ++c)
    z[c] = 0.5f * (position_mm(s.after[(c + 3) % 4]).z + position_mm(s.before[c]).z);
  const bool is_saddle =
      std::min(z[0], z[2]) > std::max(z[1], z[3]) || std::min(z[1], z[3]) > std::max(z[0], z[2]);
  if (!is_saddle) return out;
  const auto area = [&](std::size_t c) {
    const glm::dvec2 at(place(relief_.top_key(s.corner[c].i, s.corner[c].j)));
    return std::abs(
        cross(glm::dvec2(place(s.before[c])) - at, glm::dvec2(place(s.after[(c + 3) % 4])) - at));
  };
  const auto is_hole = [&](std::size_t c) {
    return !relief_.node_is_solid(s.corner[c].i, s.corner[c].j);
  };
  bool cuts_even = area(0) + area(2) <= area(1) + area(3);
  // A hole hangs together with holes only.
  if (is_hole(0) != is_hole(2)) cuts_even = true;
  if (is_hole(1) != is_hole(3)) cuts_even = false;
  out.kind = Layout::Kind::kSaddle;
  out.cut_off = cuts_even ? 0 : 1;
  return out;
}

void StepSquares::add_square(int i, int j, std::vector<NodeTriangle>& out) {
  const Square s = square(i, j);
  const Plan plan = this->plan(s);
  const auto number = static_cast<std::size_t>(
      std::lower_bound(squares_.begin(), squares_.end(), corner(i, j)) - squares_.begin());
  Layout& layout = layouts_[number];
  layout = {plan.kind, static_cast<std::uint8_t>(plan.cut_off), 0};
  if (plan.kind == Layout::Kind::kChord) {
    const std::size_t a = s.walls[0], b = s.walls[1];
    add_chord(s, a, b, out);
    // What lies on the other side of it; the wall is there already.
    std::vector<NodeTriangle> other;
    add_chord(s, b, a, other);
    out.insert(out.end(), other.begin(), other.end() - 2);
    return;
  }
  if (plan.kind == Layout::Kind::kSaddle) return add_saddle(s, plan.cut_off, out);
  const std::size_t first_own = positions_.size();
  add_around(s, plan.middle, out);
  for (std::size_t own = first_own; own < positions_.size(); ++own)
    if (!(positions_[own].z > relief_.floor_mm()))
      layout.floor = static_cast<NodeKey>(first_key_ + own);
}

/// How high the wall at edge k is, as one goes round: negative where it goes down.
double StepSquares::wall_mm(const Square& s, std::size_t k) const {
  const Edge& edge = edges_[s.edge[k]];
  const Corner a = s.corner[k], b = s.corner[(k + 1) % 4];
  const float from = relief_.node_mm(a.i, a.j), to = relief_.node_mm(b.i, b.j);
  const float high = std::max(from, to);
  const auto wall = static_cast<double>(high - std::clamp(edge.foot_mm, std::min(from, to), high));
  return from < to ? wall : -wall;
}

/// Seen from above, of what lies between the walls at edges a and b, and `middle`.
double StepSquares::part_mm2(const Square& s, std::size_t a, std::size_t b,
                             const glm::dvec2* middle) const {
  std::array<NodeKey, 8> keys;
  const std::size_t count = go_round(s, a, b, keys.data());
  const glm::dvec2 from = middle ? *middle : glm::dvec2(place(keys[0]));
  double twice_mm2 = 0;
  for (std::size_t n = 0; n + 1 < count; ++n)
    twice_mm2 += cross(glm::dvec2(place(keys[n])) - from, glm::dvec2(place(keys[n + 1])) - from);
  return 0.5 * twice_mm2;
}

/// Of a square with one wall, which runs on as a chord in the mesh: what an arc, curved as its
/// course beyond the square says, takes of the part behind the first edge.
double StepSquares::bulge_mm2(const Square& s, const Plan& plan) const {
  if (!plan.has_ways) return 0;
  const auto& way = plan.ways;
  const double in = glm::length(way[0]), out = glm::length(way[1]);
  if (-glm::dot(way[0], way[1]) < kSharpTurn * in * out) return 0;
  const double turn_rad = portable::asin(cross(way[0], -way[1]) / (in * out));
  const double chord = glm::distance(glm::dvec2(place(s.before[s.walls[0]])),
                                     glm::dvec2(place(s.before[s.walls[1]])));
  const double per_mm = turn_rad / (chord + 0.5 * (in + out));
  return per_mm * chord * chord * chord / 12;
}

double StepSquares::surplus_mm3(int i, int j) const {
  const Square s = square(i, j);
  const Plan plan = this->plan(s);
  const glm::dvec2 size = s.high - s.low;
  const double quarter_mm2 = 0.25 * size.x * size.y;
  // Of the part behind each wall. Walls that end within the square do not add up to nothing.
  std::array<double, 4> level_mm{};
  for (std::size_t w = 1; w < s.count; ++w) level_mm[w] = level_mm[w - 1] + wall_mm(s, s.walls[w]);
  const double open_mm = level_mm[s.count - 1] + wall_mm(s, s.walls[0]);
  for (std::size_t w = 1; w < s.count; ++w)
    level_mm[w] -= open_mm * static_cast<double>(w) / static_cast<double>(s.count);
  const bool is_saddle = plan.kind == Layout::Kind::kSaddle;
  if (is_saddle) {
    const std::size_t hangs = plan.cut_off;
    level_mm[hangs] = level_mm[hangs + 2] = 0.5 * (level_mm[hangs] + level_mm[hangs + 2]);
  }
  double sum = plan.kind == Layout::Kind::kChord ? level_mm[1] * bulge_mm2(s, plan) : 0;
  for (std::size_t w = 0; w < s.count; ++w) {
    const std::size_t a = s.walls[w], b = s.walls[(w + 1) % s.count];
    const auto corners = static_cast<double>(s.count == 1 ? 4 : (b + 4 - a) % 4);
    double mm2;
    if (!is_saddle)
      mm2 = part_mm2(s, a, b, plan.kind == Layout::Kind::kAround ? &plan.middle : nullptr);
    else if (w % 2 != plan.cut_off)
      mm2 = part_mm2(s, a, b, nullptr);
    else  // half of what is not cut off
      mm2 = 2 * quarter_mm2 - 0.5 * (part_mm2(s, (w + 1) % 4, (w + 2) % 4, nullptr) +
                                     part_mm2(s, (w + 3) % 4, w, nullptr));
    sum += level_mm[w] * (mm2 - corners * quarter_mm2);
  }
  return sum;
}

void StepSquares::add_surface(std::vector<NodeTriangle>& out) {
  const auto width = static_cast<std::uint32_t>(relief_.width());
  for (const std::uint32_t at : squares_)
    add_square(static_cast<int>(at % width), static_cast<int>(at / width), out);
}

/// As seen from below.
void StepSquares::add_open_floor(int i, int j, std::vector<NodeTriangle>& out) {
  const Square s = square(i, j);
  const auto number = static_cast<std::size_t>(
      std::lower_bound(squares_.begin(), squares_.end(), corner(i, j)) - squares_.begin());
  const Layout& layout = layouts_[number];
  const auto is_solid = [&](std::size_t c) {
    return relief_.node_is_solid(s.corner[c % 4].i, s.corner[c % 4].j);
  };
  const auto floor = [&](std::size_t c) {
    return relief_.floor_key(s.corner[c % 4].i, s.corner[c % 4].j);
  };
  // Of the two points of an edge with a hole at one end that on the floor.
  const auto end = [&](std::size_t k) { return is_solid(k) ? s.after[k] : s.before[k]; };
  if (layout.kind == Layout::Kind::kSaddle && !is_solid(layout.cut_off + 1)) {
    for (const std::size_t c : {std::size_t{layout.cut_off}, std::size_t{layout.cut_off} + 2})
      if (is_solid(c)) out.push_back({floor(c), end((c + 3) % 4), end(c % 4)});
    return;
  }
  std::array<NodeKey, 8> ring;
  std::size_t n = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (layout.kind == Layout::Kind::kAround) {
      if (is_solid(k) && is_solid(k + 1))
        out.push_back({layout.floor, floor(k + 1), floor(k)});
      else if (is_solid(k))
        out.push_back({layout.floor, end(k), floor(k)});
      else if (is_solid(k + 1))
        out.push_back({layout.floor, floor(k + 1), end(k)});
      continue;
    }
    if (is_solid(k)) ring[n++] = floor(k);
    if (is_solid(k) != is_solid(k + 1)) ring[n++] = end(k);
  }
  for (std::size_t m = 1; m + 1 < n; ++m) out.push_back({ring[0], ring[m + 1], ring[m]});
}

void StepSquares::add_floor(std::vector<NodeTriangle>& out) {
  const auto width = static_cast<std::uint32_t>(relief_.width());
  for (const std::uint32_t at : squares_) {
    const int i = static_cast<int>(at % width), j = static_cast<int>(at / width);
    if (is_open_square(i, j)) add_open_floor(i, j, out);
  }
}

}  // namespace kerf
