#include "twin/process/milling/scallops.h"

#include <algorithm>
#include <cmath>

namespace kerf {
namespace {

/// A surface bends down by more than this part of what it bends up in a pass.
constexpr double kBendsDown = 0.25;

/// Through the values of three cells, at a place in cells from the first.
double parabola(double a, double b, double c, double at) {
  return a + at * (b - a) + 0.5 * at * (at - 1) * (a - 2 * b + c);
}

}  // namespace

void ScallopScan::read(bool is_row, int line) {
  const int count = is_row ? heights_.nx() : heights_.ny();
  z_.resize(static_cast<std::size_t>(count));
  tool_of_.resize(z_.size());
  numbers_.resize(z_.size());
  owners_.read_present_cut_ids(is_row ? 0 : line, is_row ? line : 0, is_row, numbers_);
  if (is_row) {
    const HeightGrid::Row row(heights_, line);
    const float floor = heights_.floor_mm();
    for (int i = 0; i < count; ++i)
      z_[static_cast<std::size_t>(i)] = static_cast<double>(std::max(floor, row.kept(i)));
  } else {
    constexpr int kSide = HeightGrid::kTileCells;
    const float floor = heights_.floor_mm();
    for (int ty = 0; ty < heights_.tiles_y(); ++ty) {
      const float* const tile = heights_.tile(line / kSide, ty);
      // Each block is in memory of its own, which is asked for in time.
      if (ty + 1 < heights_.tiles_y()) {
        const float* const next = heights_.tile(line / kSide, ty + 1);
        for (int y = 0; y < kSide; y += HeightGrid::kBlockY)
          __builtin_prefetch(next + HeightGrid::offset(line, y));
      }
      for (int j = ty * kSide; j < std::min(count, (ty + 1) * kSide); ++j)
        z_[static_cast<std::size_t>(j)] =
            static_cast<double>(std::max(floor, tile[HeightGrid::offset(line, j)]));
    }
  }
  std::uint32_t last = MeshPatch::kNotCut;
  int tool = -1;
  for (std::size_t k = 0; k < z_.size(); ++k) {
    if (numbers_[k] != last) tool = ways_.round_tool_of(numbers_[k]);
    last = numbers_[k];
    tool_of_[k] = tool;
  }
}

/// More than heights that are rounded, of one tool.
bool ScallopScan::bends_down(std::size_t k, double bend) const {
  const int tool = tool_of_[k];
  if (tool < 0 || tool_of_[k - 1] != tool || tool_of_[k + 1] != tool) return false;
  return bend > kBendsDown * edge_mm_ * edge_mm_ / ways_.radius_mm(tool) + kRounding_mm;
}

/// Where what rises on one side meets what falls on the other.
ScallopScan::Crest ScallopScan::crest_at(std::size_t first, std::size_t last) const {
  const std::size_t highest = z_[first] >= z_[last] ? first : last;
  Crest crest{static_cast<double>(highest), z_[highest], last};
  if (first < 2 || last + 2 >= z_.size()) return crest;
  const auto left = [&](double at) {
    return parabola(z_[first - 2], z_[first - 1], z_[first], at - static_cast<double>(first - 2));
  };
  const auto right = [&](double at) {
    return parabola(z_[last + 2], z_[last + 1], z_[last], static_cast<double>(last + 2) - at);
  };
  // Their difference is a parabola, too: through its values at both ends and between them.
  const double low = static_cast<double>(first) - 0.5, high = static_cast<double>(last) + 0.5;
  const double half = 0.5 * (high - low);
  const auto apart = [&](double at) { return left(at) - right(at); };
  const double begin = apart(low), middle = apart(low + half), end = apart(high);
  if (begin > 0 || end < 0) return crest;
  const double bend = 0.5 * (begin - 2 * middle + end), slope = middle - begin - bend;
  const double root = std::sqrt(std::max(0.0, slope * slope - 4 * bend * begin));
  const double steps = slope + root > 0 ? -2 * begin / (slope + root) : 1;
  crest.at = low + half * std::clamp(steps, 0.0, 2.0), crest.height = left(crest.at);
  return crest;
}

void ScallopScan::take(bool is_row, int line, const Crest& from, const Crest& to) {
  const double cells = to.at - from.at;
  const int tool = tool_of_[from.last];
  const double radius = ways_.radius_mm(tool);
  if (cells < kLeastCells || cells * edge_mm_ > 2 * radius) return;
  const double slope = (to.height - from.height) / cells;
  const auto below = [&](std::size_t k) {
    return from.height + slope * (static_cast<double>(k) - from.at) - z_[k];
  };
  const auto first = static_cast<std::size_t>(std::ceil(from.at));
  const auto last = static_cast<std::size_t>(std::floor(to.at));
  std::size_t deepest = first;
  double most = below(first);
  for (std::size_t k = first; k <= last; ++k) {
    if (tool_of_[k] != tool) return;
    const double deep = below(k);
    if (deep > most) most = deep, deepest = k;
  }
  if (deepest <= first || deepest >= last) return;
  const double a = below(deepest - 1), b = below(deepest), c = below(deepest + 1);
  const double bend = a - 2 * b + c;
  const double deep = bend < 0 ? b - (c - a) * (c - a) / (8 * bend) : b;
  const auto cell = static_cast<int>(deepest);
  const int i = is_row ? cell : line, j = is_row ? line : cell;
  const auto height = [&](int step) {
    return static_cast<double>(is_row ? heights_.height(i, j + step)
                                      : heights_.height(i + step, j));
  };
  const double along = slope / edge_mm_, across = (height(1) - height(-1)) / (2 * edge_mm_);
  const double high = deep / std::sqrt(1 + along * along + across * across);
  if (high <= kRounding_mm || high > radius) return;
  Found& found = found_[static_cast<std::size_t>(tool)];
  if (high > found.spread.most()) {
    const Box& box = heights_.bounds_mm();
    found.at_mm = {box.min.x + (i + 0.5) * edge_mm_, box.min.y + (j + 0.5) * edge_mm_, z_[deepest]};
  }
  found.spread.add(high, 1, {});
  ++found.count;
}

void ScallopScan::walk(bool is_row, int line) {
  read(is_row, line);
  Crest before;
  bool has_before = false;
  for (std::size_t k = 1; k + 1 < z_.size(); ++k) {
    if (tool_of_[k] < 0) has_before = false;
    if (!is_crest(k)) continue;
    const std::size_t last = k + 2 < z_.size() && is_crest(k + 1) ? k + 1 : k;
    const Crest crest = crest_at(k, last);
    if (has_before) take(is_row, line, before, crest);
    before = crest;
    has_before = true;
    k = last;
  }
}

std::vector<ScallopsOfTool> ScallopScan::run() {
  edge_mm_ = std::max(heights_.cell_x_mm(), heights_.cell_y_mm());
  found_.assign(ways_.tools(), {});
  for (const bool is_row : {true, false}) {
    const int lines = is_row ? heights_.ny() : heights_.nx();
    const int each = std::max(1, lines / kLines);
    for (int line = 1; line + 1 < lines; line += each) walk(is_row, line);
  }
  std::vector<ScallopsOfTool> out;
  for (std::size_t n = 0; n < found_.size(); ++n) {
    const Found& found = found_[n];
    if (found.count == 0) continue;
    const auto tool = static_cast<int>(n);
    out.push_back({ways_.number_of(tool),
                   ways_.shape_of(tool),
                   {found.spread.not_above(0.95), found.spread.most(), found.at_mm, found.count}});
  }
  return out;
}

}  // namespace kerf
