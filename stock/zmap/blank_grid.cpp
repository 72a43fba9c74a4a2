#include "stock/zmap/blank_grid.h"

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "base/translate.h"

namespace kerf {
namespace {

/// The cells of one row that lie within a body's outline, as up to two runs [first, last).
struct RowRuns {
  int count = 0;
  std::array<std::pair<int, int>, 2> runs{};
  void add(int first, int last) {
    if (first < last) runs[static_cast<std::size_t>(count++)] = {first, last};
  }
  bool operator==(const RowRuns&) const = default;
};

/// Cells of a row of n, centred at x0 + (i + 0.5) * edge, with from <= centre <= to.
std::pair<int, int> cells_between(double from, double to, double x0, double edge, int n) {
  const double first = std::ceil((from - x0) / edge - 0.5 - 1e-9),
               last = std::floor((to - x0) / edge - 0.5 + 1e-9) + 1;
  return {static_cast<int>(std::clamp(first, 0.0, static_cast<double>(n))),
          static_cast<int>(std::clamp(last, 0.0, static_cast<double>(n)))};
}

RowRuns runs_of(const BlankBody& body, const TileGrid& grid, double y) {
  RowRuns out;
  const double x0 = grid.bounds_mm().min.x, edge = grid.cell_x_mm();
  if (body.kind == BlankBody::Kind::kBox) {
    if (y < body.bounds_mm.min.y || y > body.bounds_mm.max.y) return out;
    const auto [first, last] =
        cells_between(body.bounds_mm.min.x, body.bounds_mm.max.x, x0, edge, grid.nx());
    out.add(first, last);
    return out;
  }
  const double dy2 = (y - body.center_mm.y) * (y - body.center_mm.y);
  const double outer2 = 0.25 * body.diameter_mm * body.diameter_mm - dy2;
  if (outer2 < 0) return out;
  const double half = std::sqrt(outer2), cx = body.center_mm.x;
  const auto [first, last] = cells_between(cx - half, cx + half, x0, edge, grid.nx());
  const double inner2 = 0.25 * body.inner_diameter_mm * body.inner_diameter_mm - dy2;
  if (body.kind != BlankBody::Kind::kTube || inner2 <= 0) {
    out.add(first, last);
    return out;
  }
  const double hole = std::sqrt(inner2);
  const auto [hole_first, hole_last] = cells_between(cx - hole, cx + hole, x0, edge, grid.nx());
  out.add(first, std::min(hole_first, last));
  out.add(std::max(hole_last, first), last);
  return out;
}

/// `runs`: one of each body.
void fill_row(std::vector<float>& row, const Blank& blank, const std::vector<RowRuns>& runs,
              float floor_mm) {
  std::fill(row.begin(), row.end(), floor_mm);
  for (std::size_t b = 0; b < runs.size(); ++b) {
    const float top = static_cast<float>(blank.bodies[b].bounds_mm.max.z);
    for (int r = 0; r < runs[b].count; ++r) {
      const auto [first, last] = runs[b].runs[static_cast<std::size_t>(r)];
      for (int i = first; i < last; ++i)
        row[static_cast<std::size_t>(i)] = std::max(row[static_cast<std::size_t>(i)], top);
    }
  }
}

void fill_blank(TileGrid& grid, const Blank& blank) {
  std::vector<float> row(static_cast<std::size_t>(grid.nx()));
  std::vector<RowRuns> now, before;
  for (int j = 0; j < grid.ny(); ++j) {
    const double y = grid.bounds_mm().min.y + (j + 0.5) * grid.cell_y_mm();
    now.clear();
    for (const BlankBody& body : blank.bodies) now.push_back(runs_of(body, grid, y));
    if (j == 0 || now != before) fill_row(row, blank, now, grid.floor_mm());
    now.swap(before);
    grid.set_row(j, row.data());
  }
}

/// Heights up to the top of what is over the middle of each cell.
void fill_mesh(TileGrid& grid, const MeshBody& body) {
  std::vector<float> row(static_cast<std::size_t>(grid.nx()));
  each_mesh_band(body, grid, [&](int first_row, const ColumnGrid& band, const MeshLines& lines) {
    for (int j = 0; j < band.ny; ++j) {
      for (int i = 0; i < band.nx; ++i) {
        const auto cell = static_cast<std::size_t>(i);
        const auto ends = lines.ends(static_cast<std::size_t>(j) * row.size() + cell);
        row[cell] = ends.empty() ? grid.floor_mm() : std::max(grid.floor_mm(), ends.back().at_mm);
      }
      grid.set_row(first_row + j, row.data());
    }
  });
}

std::string memory_text(double cells) {
  return fmt::format("{:.1f} GB", cells * sizeof(float) / 1e9);
}

}  // namespace

Result<TileGrid> make_blank_grid(const Blank& blank, double cell_mm, std::size_t most_cells,
                                 const std::string& model, bool keeps_cut_ids) {
  const double cell = cell_mm;
  const Box box = blank.bounds_mm();
  const MeshBody* const mesh = blank.mesh ? blank.mesh->body.get() : nullptr;
  if (box.empty() || (blank.bodies.empty() && !mesh)) return Error{tr("the blank is empty")};
  const Vec3 size = box.size();
  if (!std::isfinite(cell) || cell <= 0)
    return Error{trf("cell size {} mm is not allowed; must be above 0", cell)};
  if (cell > std::min(size.x, size.y)) {
    return Error{trf(
        "cell size {} mm exceeds the blank, which is {} x {} mm; 0.05 to 0.2 mm suits most parts",
        cell, size.x, size.y)};
  }
  if (const std::string need = need_to_turn(blank); !need.empty())
    return Error{trf("{} cannot hold it: {}", model, need)};
  for (const BlankBody& body : blank.bodies) {
    if (body.kind != BlankBody::Kind::kBox && body.axis != 'z')
      return Error{trf("{} cannot hold a cylinder along {}; its axis must be z", model, body.axis)};
    if (body.bounds_mm.min.z > box.min.z + 1e-9 || body.bounds_mm.max.z <= box.min.z)
      return Error{trf("{} cannot hold a body that begins at Z{} above the blank's floor Z{}",
                       model, body.bounds_mm.min.z, box.min.z)};
  }
  // The slack keeps 100 mm / 0.1 mm at 1000 cells.
  const double nx = std::ceil(size.x / cell - 1e-6), ny = std::ceil(size.y / cell - 1e-6);
  if (nx * ny > static_cast<double>(most_cells)) {
    return Error{trf(
        "cell size {} mm makes {:.0f} x {:.0f} cells and would take {} of memory; at most {} are "
        "allowed",
        cell, nx, ny, memory_text(nx * ny), memory_text(static_cast<double>(most_cells)))};
  }
  TileGrid grid(box, static_cast<int>(nx), static_cast<int>(ny), keeps_cut_ids);
  if (mesh)
    fill_mesh(grid, *mesh);
  else
    fill_blank(grid, blank);
  grid.share_equal_tiles();
  return grid;
}

ColumnGrid columns_of(const TileGrid& grid) { return {grid.bounds_mm(), grid.nx(), grid.ny()}; }

double volume_of(const TileGrid& grid) {
  const auto width = static_cast<std::size_t>(grid.nx());
  std::vector<float> rows(kBlockY * width);
  const double floor = static_cast<double>(grid.floor_mm());
  double sum = 0;
  for (int j = 0; j < grid.ny(); j += kBlockY) {
    grid.copy_rows(j, rows.data());
    // Each row in its order, as if alone; several at once, as an addition waits for the one before.
    std::array<double, kBlockY> sums{};
    for (std::size_t i = 0; i < width; ++i) {
      for (std::size_t y = 0; y < sums.size(); ++y)
        sums[y] += static_cast<double>(rows[y * width + i]) - floor;
    }
    for (int y = 0; y < std::min(kBlockY, grid.ny() - j); ++y)
      sum += sums[static_cast<std::size_t>(y)];
  }
  return sum * grid.cell_x_mm() * grid.cell_y_mm();
}

std::string GridHash::text() const { return fmt::format("{:016x}{:016x}", high, low); }

GridHash hash_of(const TileGrid& grid) {
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  const Box& box = grid.bounds_mm();
  const double frame[6] = {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z};
  const std::int32_t counts[2] = {grid.nx(), grid.ny()};
  XXH3_128bits_update(&state, frame, sizeof frame);
  XXH3_128bits_update(&state, counts, sizeof counts);
  const auto width = static_cast<std::size_t>(grid.nx());
  std::vector<float> rows(kBlockY * width);
  for (int j = 0; j < grid.ny(); j += kBlockY) {
    grid.copy_rows(j, rows.data());
    const std::size_t count = width * static_cast<std::size_t>(std::min(kBlockY, grid.ny() - j));
    for (std::size_t i = 0; i < count; ++i) rows[i] += 0.0f;  // -0 and 0 are the same height
    XXH3_128bits_update(&state, rows.data(), count * sizeof(float));
  }
  const XXH128_hash_t hash = XXH3_128bits_digest(&state);
  return {hash.high64, hash.low64};
}

}  // namespace kerf
