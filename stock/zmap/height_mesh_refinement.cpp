#include "stock/zmap/height_mesh_refinement.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#include "stock/zmap/height_mesh_parallel.h"

namespace kerf {
namespace {

/// The error of a point that must be split whatever the tolerance.
constexpr float kAlways = std::numeric_limits<float>::infinity();

/// Rounding of the errors themselves, in units of the greatest height: each is a difference of two
/// heights after at most four roundings. Taken off the tolerance, so that it is kept.
constexpr float kErrorRounding = 4 * std::numeric_limits<float>::epsilon();

/// Below this many points per thread, starting the thread takes longer.
constexpr std::size_t kLeastPoints = 32768;

/// Slots of lines 0..steps: of those beyond the last cell only the ends of squares that cross it.
std::vector<std::size_t> slots(int cells, int steps, std::size_t& count) {
  std::vector<std::size_t> slot(std::size_t(steps) + 1, 0);
  for (int u = 0; u < cells; ++u) slot[std::size_t(u)] = std::size_t(u);
  count = std::size_t(cells);
  for (int s = 1; s <= steps; s *= 2) {
    const std::size_t end = std::size_t((cells - 1 + s - 1) / s * s);
    if (end >= std::size_t(cells) && slot[end] == 0) slot[end] = count++;
  }
  return slot;
}

}  // namespace

Refinement::Refinement(const Relief& relief, const StepSquares* steps, double tolerance_mm,
                       int threads)
    : relief_(relief),
      steps_squares_(steps),
      cells_(relief.cells_mm()),
      nx_(relief.nx()),
      ny_(relief.ny()),
      threads_(threads),
      limit_mm_(
          std::max(0.0f, float(tolerance_mm) - kErrorRounding * relief.greatest_magnitude_mm())) {
  assert(nx_ >= 2 && ny_ >= 2);
  while (steps_ < std::max(nx_, ny_) - 1) steps_ *= 2;
  std::size_t rows = 0;
  column_slot_ = slots(nx_, steps_, stride_);
  row_slot_ = slots(ny_, steps_, rows);
  errors_.assign(rows * stride_, 0.0f);
  no_errors_.assign(stride_, 0.0f);
  if (relief.has_holes()) keep_cells_around_holes();
  if (steps != nullptr) keep_cells_around_steps();
  for (int s = 2; s <= steps_; s *= 2) measure_level(s, threads);
}

/// Where material and hole meet within one cell of a node, the node is kept: then no larger
/// triangle covers both.
void Refinement::keep_cells_around_holes() {
  constexpr unsigned char kSolid = 1;
  constexpr unsigned char kHole = 2;
  std::vector<unsigned char> kinds(std::size_t(nx_) * std::size_t(ny_));  // within a cell along x
  for (int j = 0; j < ny_; ++j) {
    unsigned char* const line = kinds.data() + std::size_t(j) * std::size_t(nx_);
    for (int i = 0; i < nx_; ++i) {
      const unsigned char kind = relief_.cell_is_solid(i, j) ? kSolid : kHole;
      line[i] |= kind;
      if (i > 0) line[i - 1] |= kind;
      if (i + 1 < nx_) line[i + 1] |= kind;
    }
  }
  for (int v = 0; v <= steps_; ++v) {
    if (v >= ny_ && row_slot_[std::size_t(v)] == 0) continue;
    for (int u = 0; u <= steps_; ++u) {
      if (u >= nx_ && column_slot_[std::size_t(u)] == 0) continue;
      unsigned char kind = 0;
      for (int j = std::max(row(v) - 1, 0); j <= std::min(row(v) + 1, ny_ - 1); ++j) {
        kind |= kinds[std::size_t(j) * std::size_t(nx_) + std::size_t(column(u))];
      }
      if (kind == (kSolid | kHole)) errors(v)[column_slot_[std::size_t(u)]] = kAlways;
    }
  }
}

/// All corners of what has been divided.
void Refinement::keep_cells_around_steps() {
  for (int v = 0; v <= steps_; ++v) {
    if (v >= ny_ && row_slot_[std::size_t(v)] == 0) continue;
    for (int u = 0; u <= steps_; ++u) {
      if (u >= nx_ && column_slot_[std::size_t(u)] == 0) continue;
      const int i = column(u), j = row(v);
      if (steps_squares_->is_divided(i, j) || steps_squares_->is_divided(i + 1, j) ||
          steps_squares_->is_divided(i, j + 1) || steps_squares_->is_divided(i + 1, j + 1))
        errors(v)[column_slot_[std::size_t(u)]] = kAlways;
    }
  }
}

/// Half a square that has been divided.
bool Refinement::is_elsewhere(const Triangle& t, bool on_floor) const {
  const auto [u_low, u_high] = std::minmax({t.a.u, t.b.u, t.c.u});
  const auto [v_low, v_high] = std::minmax({t.a.v, t.b.v, t.c.v});
  if (u_high - u_low > 1 || v_high - v_low > 1) return false;
  return steps_squares_->is_divided(u_low + 1, v_low + 1) &&
         (!on_floor || steps_squares_->is_open(u_low + 1, v_low + 1));
}

// ---- Errors, from the smallest squares up -------------------------------------------------------

/// Squares of edge s: first the middles of their edges, which rest on the centres of the squares of
/// edge s / 2, then their centres, which rest on those middles.
void Refinement::measure_level(int s, int threads) {
  const int bands = (ny_ - 1 + s - 1) / s;
  const std::size_t least_bands = kLeastPoints / std::size_t((nx_ - 1) / s + 1) + 1;
  parallel_parts(std::size_t(bands) + 1, least_bands, threads, [&](std::size_t q0, std::size_t q1) {
    for (int q = int(q0); q < int(q1); ++q) {
      measure_edges_along_x(s, q * s);
      if (q < bands) measure_edges_along_y(s, q * s);
    }
  });
  parallel_parts(std::size_t(bands), least_bands, threads, [&](std::size_t q0, std::size_t q1) {
    for (int q = int(q0); q < int(q1); ++q) measure_centres(s, q * s);
  });
}

/// delta: how far the surface moves when this point is split, below: the greatest error of what the
/// split leaves. Their sum is a bound; where that alone is too much, it is measured.
float Refinement::settle(float delta, float below, bool measurable, auto&& measure) const {
  const float bound = delta + below;
  if (bound <= limit_mm_ || delta > limit_mm_ || below > limit_mm_ || !measurable) return bound;
  return measure();
}

/// Middles of the horizontal edges of length s in row v0.
void Refinement::measure_edges_along_x(int s, int v0) {
  const int half = s / 2;
  const int quarter = s / 4;
  const bool has_above = v0 < ny_ - 1;
  const bool has_below = v0 > 0 && v0 - half < ny_ - 1;
  const float* const h = heights(v0);
  float* const e = errors(v0);
  const float* const above = s > 2 && has_above ? errors(v0 + quarter) : no_errors_.data();
  const float* const under = s > 2 && has_below ? errors(v0 - quarter) : no_errors_.data();
  const bool whole = v0 < ny_ && (!has_above || v0 + half < ny_);
  int u = 0;
  for (; u + s < nx_; u += s) {
    const int m = u + half;
    const int l = u + quarter;
    const int r = m + quarter;
    const float delta = std::abs(h[m] - 0.5f * (h[u] + h[u + s]));
    const float below =
        std::max({e[m], std::max(above[l], above[r]), std::max(under[l], under[r])});
    e[m] = settle(delta, below, whole, [&] { return measure_edge_along_x(s, u, v0); });
  }
  if (u >= nx_ - 1) return;
  // The last edge crosses the edge of the grid.
  const float t = float(column(u + half) - u) / float(nx_ - 1 - u);
  const float line = h[u] + t * (h[nx_ - 1] - h[u]);
  const std::size_t l = column_slot_[std::size_t(u + quarter)];
  const std::size_t m = column_slot_[std::size_t(u + half)];
  float below = std::max({e[m], above[l], under[l]});
  if (u + half < nx_ - 1) {
    const std::size_t r = column_slot_[std::size_t(u + half + quarter)];
    below = std::max({below, above[r], under[r]});
  }
  e[m] = std::abs(h[column(u + half)] - line) + below;
}

/// Middles of the vertical edges of length s that begin in row v0.
void Refinement::measure_edges_along_y(int s, int v0) {
  const int half = s / 2;
  const int quarter = s / 4;
  const float* const ha = heights(v0);
  const float* const hm = heights(v0 + half);
  const float* const hb = heights(v0 + s);
  float* const e = errors(v0 + half);
  const bool has_upper = v0 + half < ny_ - 1;
  const float* const lower = s > 2 ? errors(v0 + quarter) : no_errors_.data();
  const float* const upper = s > 2 && has_upper ? errors(v0 + half + quarter) : no_errors_.data();
  const bool whole_rows = v0 + s < ny_;
  const float t = float(row(v0 + half) - v0) / float(row(v0 + s) - v0);
  for (int u = 0; u < nx_ - 1 + s; u += s) {
    const int i = column(u);
    const std::size_t m = column_slot_[std::size_t(u)];
    const bool has_right = u < nx_ - 1;
    const bool has_left = u > 0 && u - half < nx_ - 1;
    float below = e[m];
    if (has_right) {
      const std::size_t r = column_slot_[std::size_t(u + quarter)];
      below = std::max({below, lower[r], upper[r]});
    }
    if (has_left) {
      const std::size_t l = column_slot_[std::size_t(u - quarter)];
      below = std::max({below, lower[l], upper[l]});
    }
    const bool whole = whole_rows && u < nx_ && (!has_right || u + half < nx_);
    const float delta = std::abs(hm[i] - (ha[i] + t * (hb[i] - ha[i])));
    e[m] = settle(delta, below, whole, [&] { return measure_edge_along_y(s, u, v0); });
  }
}

/// Centres of the squares of edge s that begin in row v0.
void Refinement::measure_centres(int s, int v0) {
  const int half = s / 2;
  const float* const ha = heights(v0);
  const float* const hm = heights(v0 + half);
  const float* const hb = heights(v0 + s);
  const float* const lower = errors(v0);
  const float* const upper = errors(v0 + s);
  float* const e = errors(v0 + half);
  const bool whole_rows = v0 + s < ny_;
  for (int u = 0; u < nx_ - 1; u += s) {
    const std::size_t a = std::size_t(u);
    const std::size_t m = column_slot_[std::size_t(u + half)];
    const std::size_t b = column_slot_[std::size_t(u + s)];
    const float below = std::max({e[m], std::max(e[a], e[b]), std::max(lower[m], upper[m])});
    const bool whole = whole_rows && u + s < nx_;
    float delta = 0.0f;
    if (whole) {
      const bool rises = ((u ^ v0) & s) == 0;
      const float ends = rises ? ha[u] + hb[u + s] : ha[u + s] + hb[u];
      delta = std::abs(hm[u + half] - 0.5f * ends);
    } else {
      delta = centre_delta(s, u, v0);
    }
    e[m] = settle(delta, below, whole, [&] { return measure_square(s, u, v0); });
  }
}

/// For a square that crosses the edge of the grid: its centre is drawn off the diagonal, so the two
/// surfaces differ most either at the centre or where the diagonal crosses the edge from the centre
/// to the corner on the diagonal's other side.
float Refinement::centre_delta(int s, int u0, int v0) const {
  const float width = float(column(u0 + s) - u0);
  const float depth = float(row(v0 + s) - v0);
  float x = float(column(u0 + s / 2) - u0) / width;
  const float y = float(row(v0 + s / 2) - v0) / depth;
  float a = heights(v0)[u0];
  float b = heights(v0)[column(u0 + s)];
  float c = heights(v0 + s)[column(u0 + s)];
  float d = heights(v0 + s)[u0];
  const float centre = heights(v0 + s / 2)[column(u0 + s / 2)];
  if (((u0 ^ v0) & s) != 0) {  // the diagonal falls: mirror the square
    std::swap(a, b);
    std::swap(c, d);
    x = 1.0f - x;
  }
  const bool under_diagonal = x >= y;
  const float plane =
      under_diagonal ? a + (b - a) * x + (c - b) * y : a + (d - a) * y + (c - d) * x;
  const float off = std::abs(x - y);
  const float r = off / (1.0f + off);  // of the way from the centre to the opposite corner
  const float split = centre + r * ((under_diagonal ? d : b) - centre);
  const float along = (1.0f - r) * (under_diagonal ? x : y);
  const float unsplit = a + along * (c - a);
  return std::max(std::abs(centre - plane), std::abs(split - unsplit));
}

// ---- Errors measured over all cells -------------------------------------------------------------
// Edges of triangles run along edges of the network of all cells, so that the surfaces differ most
// at a cell centre. This does not hold for squares that cross the edge of the grid.

/// Greatest |h[k] - (start + slope k)|. Compared as integers, which orders non-negative floats
/// alike and can be vectorized without giving up on the rules of floating point.
float Refinement::row_deviation(const float* h, int count, float start, float slope) const {
  std::int32_t greatest = 0;
  for (int k = 0; k < count; ++k) {
    const float deviation = std::abs(h[k] - (start + slope * float(k)));
    greatest = std::max(greatest, std::bit_cast<std::int32_t>(deviation));
  }
  return std::bit_cast<float>(greatest);
}

float Refinement::measure_edge_along_x(int s, int u0, int v0) const {
  const int half = s / 2;
  const float a = heights(v0)[u0];
  const float along = (heights(v0)[u0 + s] - a) / float(s);
  float greatest = 0.0f;
  for (const int side : {-1, 1}) {
    if (v0 + side * half < 0 || v0 + side * half >= ny_) continue;
    const float apex = heights(v0 + side * half)[u0 + half];
    const float across = (apex - (a + along * float(half))) / float(half);
    for (int t = 0; t <= half && greatest <= limit_mm_; ++t) {
      const float start = a + across * float(t) + along * float(t);
      const float* const h = heights(v0 + side * t) + u0 + t;
      greatest = std::max(greatest, row_deviation(h, s - 2 * t + 1, start, along));
    }
  }
  return greatest;
}

float Refinement::measure_edge_along_y(int s, int u0, int v0) const {
  const int half = s / 2;
  const float a = heights(v0)[u0];
  const float along = (heights(v0 + s)[u0] - a) / float(s);
  float greatest = 0.0f;
  for (const int side : {-1, 1}) {
    if (u0 + side * half < 0 || u0 + side * half >= nx_) continue;
    const float apex = heights(v0 + half)[u0 + side * half];
    const float across = (apex - (a + along * float(half))) / float(side * half);
    for (int t = 0; t <= s && greatest <= limit_mm_; ++t) {
      const int reach = std::min(t, s - t);
      const int first = side < 0 ? -reach : 0;
      const float start = a + along * float(t) + across * float(first);
      const float* const h = heights(v0 + t) + u0 + first;
      greatest = std::max(greatest, row_deviation(h, reach + 1, start, across));
    }
  }
  return greatest;
}

float Refinement::measure_square(int s, int u0, int v0) const {
  const float a = heights(v0)[u0];
  const float b = heights(v0)[u0 + s];
  const float c = heights(v0 + s)[u0 + s];
  const float d = heights(v0 + s)[u0];
  const float low_x = (b - a) / float(s);   // slope along x in the triangle of the lower edge
  const float high_x = (c - d) / float(s);  // and of the upper edge
  const float left_y = (d - a) / float(s);
  const bool rises = ((u0 ^ v0) & s) == 0;
  float greatest = 0.0f;
  for (int t = 0; t <= s && greatest <= limit_mm_; ++t) {
    const float* const h = heights(v0 + t) + u0;
    // Along the row: one triangle up to the diagonal, the other beyond.
    const int at = rises ? t : s - t;
    const float left = a + left_y * float(t);
    const float diagonal =
        rises ? a + (c - a) * (float(t) / float(s)) : d + (b - d) * (float(s - t) / float(s));
    greatest = std::max(greatest, row_deviation(h, at + 1, left, rises ? high_x : low_x));
    greatest =
        std::max(greatest, row_deviation(h + at, s - at + 1, diagonal, rises ? low_x : high_x));
  }
  return greatest;
}

// ---- Triangles, from the whole square down ------------------------------------------------------

std::vector<NodeTriangle> Refinement::surface() const { return extract(limit_mm_, false); }

std::vector<NodeTriangle> Refinement::floor() const {
  return extract(std::numeric_limits<float>::max(), true);
}

bool Refinement::is_beyond(const Triangle& t) const {
  return std::min({t.a.u, t.b.u, t.c.u}) >= nx_ - 1 || std::min({t.a.v, t.b.v, t.c.v}) >= ny_ - 1;
}

bool Refinement::is_split(const Triangle& t, float limit) const {
  if (std::abs(t.a.u - t.b.u) <= 1 && std::abs(t.a.v - t.b.v) <= 1) return false;
  return error({(t.a.u + t.b.u) / 2, (t.a.v + t.b.v) / 2}) > limit;
}

/// The upper levels are walked first, into a list of triangles in order; then the list is divided
/// among the threads.
std::vector<NodeTriangle> Refinement::extract(float limit, bool on_floor) const {
  constexpr int kListedLevels = 10;
  const int s = steps_;
  std::vector<Triangle> list{{{s, s}, {0, 0}, {s, 0}}, {{0, 0}, {s, s}, {0, s}}};
  for (int level = 0; level < kListedLevels; ++level) {
    std::vector<Triangle> next;
    for (const Triangle& t : list) {
      if (is_beyond(t)) continue;
      if (!is_split(t, limit)) {
        next.push_back(t);
        continue;
      }
      const Node m{(t.a.u + t.b.u) / 2, (t.a.v + t.b.v) / 2};
      next.push_back({t.c, t.a, m});
      next.push_back({t.b, t.c, m});
    }
    list = std::move(next);
  }
  std::vector<std::vector<NodeTriangle>> parts(list.size());
  parallel_parts(list.size(), 16, threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) extract_below(list[i], limit, on_floor, parts[i]);
  });
  std::size_t count = 0;
  for (const auto& part : parts) count += part.size();
  std::vector<NodeTriangle> all;
  all.reserve(count);
  for (auto& part : parts) {
    all.insert(all.end(), part.begin(), part.end());
    std::vector<NodeTriangle>().swap(part);
  }
  return all;
}

void Refinement::extract_below(const Triangle& t, float limit, bool on_floor,
                               std::vector<NodeTriangle>& out) const {
  if (is_beyond(t)) return;
  if (!is_split(t, limit)) return emit(t, on_floor, out);
  const Node m{(t.a.u + t.b.u) / 2, (t.a.v + t.b.v) / 2};
  extract_below({t.c, t.a, m}, limit, on_floor, out);
  extract_below({t.b, t.c, m}, limit, on_floor, out);
}

void Refinement::emit(const Triangle& t, bool on_floor, std::vector<NodeTriangle>& out) const {
  if (steps_squares_ != nullptr && is_elsewhere(t, on_floor)) return;
  NodeTriangle keys;
  bool solid = !relief_.has_holes();
  const Node* const corners[3] = {&t.a, &t.b, &t.c};
  for (std::size_t k = 0; k < 3; ++k) {
    const int i = column(corners[k]->u) + 1;
    const int j = row(corners[k]->v) + 1;
    solid = solid || relief_.node_is_solid(i, j);
    keys[k] = on_floor ? relief_.floor_key(i, j) : relief_.top_key(i, j);
  }
  if (solid) out.push_back(keys);
}

}  // namespace kerf
