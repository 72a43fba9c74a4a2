#include "stock/zmap/mmap/mmap.h"

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <cassert>
#include <cstring>

#include "base/translate.h"
#include "stock/move_reach.h"
#include "stock/state_bytes.h"
#include "stock/zmap/blank_grid.h"
#include "stock/zmap/contact.h"
#include "stock/zmap/cutter_components.h"
#include "stock/zmap/height_columns.h"
#include "stock/zmap/height_mesh.h"
#include "stock/zmap/height_sweeper.h"
#include "stock/zmap/height_view.h"
#include "stock/zmap/mmap/column_patch.h"
#include "stock/zmap/mmap/column_sweeper.h"
#include "stock/zmap/mmap/head_contact.h"
#include "stock/zmap/mmap/mmap_mesh.h"
#include "stock/zmap/mmap/mmap_state.h"
#include "stock/zmap/part_contact.h"
#include "stock/zmap/part_gap.h"
#include "stock/zmap/tile_cut_ids.h"
#include "stock/zmap/tile_patch.h"

namespace kerf {

struct MMap::Impl {
  HeightSweeper sweeper;
  GapGrid gaps;
  double blank_mm3 = 0;
  HeadedTool tool;  ///< of the last cutter with a head
  std::string tool_spec;

  /// What take_dirty_tiles() last saw of each tile; empty before its first call.
  struct SeenTile {
    std::uint64_t version, hash;
  };
  std::vector<SeenTile> seen;
  TileTops tops;

  Impl(TileGrid heights, double blank_volume_mm3, ZMapKernel kernel, int threads)
      : sweeper(std::move(heights), kernel, threads),
        gaps(sweeper.grid.tile_count()),
        blank_mm3(blank_volume_mm3) {}
  TileGrid& grid() { return sweeper.grid; }
  void finish(std::vector<CutReport>& reports) {
    ColumnSweeper columns(sweeper, gaps);
    sweeper.finish(&columns, reports);
  }
  void cut_headed(const Cutter& cutter, std::span<const CutMove> moves,
                  std::vector<CutReport>& reports);
  std::uint64_t hash_of_tile(std::uint32_t tile) const;
};

void MMap::Impl::cut_headed(const Cutter& cutter, std::span<const CutMove> moves,
                            std::vector<CutReport>& reports) {
  ColumnSweeper columns(sweeper, gaps);
  sweeper.end_path(&columns, reports);
  if (cutter.spec() != tool_spec) {
    tool = headed_tool(cutter);
    tool_spec = cutter.spec();
  }
  std::vector<SweepTotals> totals(moves.size());
  columns.cut_headed(tool, moves, totals);
  sweeper.trace(tool.lower, moves);
  sweeper.trace(tool.rays, moves);
  for (std::size_t i = 0; i < moves.size(); ++i)
    reports.push_back(sweeper.report(moves[i].id, totals[i]));
}

std::uint64_t MMap::Impl::hash_of_tile(std::uint32_t tile) const {
  const std::uint64_t heights = XXH3_64bits(sweeper.grid.tile(tile), kTileFloats * sizeof(float));
  const GapTile* const hollow = gaps.tile(tile);
  return hollow != nullptr ? heights ^ hollow->hash() : heights;
}

namespace {

/// Makes gaps of what is below the heights and not in the body; their volume, mm3.
double hollow_out(const MeshBody& body, TileGrid& grid, GapGrid& gaps) {
  double sum = 0;
  std::vector<Gap> column;
  const auto add = [&](float low, float high) {
    if (high - low <= kThinnest_mm) return;
    column.push_back({low, high, MeshPatch::kNotCut, MeshPatch::kNotCut});
    sum += static_cast<double>(high) - static_cast<double>(low);
  };
  each_mesh_band(body, grid, [&](int first_row, const ColumnGrid& band, const MeshLines& lines) {
    for (std::size_t cell = 0; cell < band.size(); ++cell) {
      const auto ends = lines.ends(cell);
      if (ends.empty()) continue;
      column.clear();
      for (std::size_t n = ends.size() - 2; n > 0; n -= 2) add(ends[n - 1].at_mm, ends[n].at_mm);
      add(grid.floor_mm(), ends.front().at_mm);
      if (column.empty()) continue;
      const auto width = static_cast<std::size_t>(band.nx);
      const int i = static_cast<int>(cell % width), j = first_row + static_cast<int>(cell / width);
      const auto tile =
          static_cast<std::size_t>(j / kTileCells) * static_cast<std::size_t>(grid.tiles_x()) +
          static_cast<std::size_t>(i / kTileCells);
      gaps.make_writable(tile).write(TileGrid::offset(i, j), column);
    }
  });
  return sum * grid.cell_x_mm() * grid.cell_y_mm();
}

}  // namespace

MMap::MMap(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MMap::~MMap() = default;

Result<std::unique_ptr<MMap>> MMap::create(const ZMapOptions& options) {
  Result<TileGrid> grid = make_blank_grid(options.blank, options.cell_mm, ZMap::kMaxCells,
                                          tr("an M-map"), options.keeps_cut_ids);
  if (!grid) return Error{grid.error()};
  const double solid_mm3 = volume_of(*grid);
  auto impl = std::make_unique<Impl>(std::move(*grid), solid_mm3, options.kernel, options.threads);
  if (options.blank.mesh && options.blank.mesh->body)
    impl->blank_mm3 -= hollow_out(*options.blank.mesh->body, impl->grid(), impl->gaps);
  impl->sweeper.follow_sides(options.blank);
  return std::unique_ptr<MMap>(new MMap(std::move(impl)));
}

Done MMap::save(const std::string& path) const {
  return write_columns(path, {impl_->grid(), impl_->gaps, impl_->blank_mm3});
}

Result<std::unique_ptr<MMap>> MMap::load(const std::string& path, int threads, ZMapKernel kernel) {
  const Result<std::string> bytes = read_state_bytes(path);
  if (!bytes) return Error{bytes.error()};
  Result<SavedColumns> saved = parse_columns(*bytes, path);
  if (!saved) return Error{saved.error()};
  return of_columns(std::move(saved.value()), threads, kernel);
}

std::unique_ptr<MMap> MMap::of_columns(SavedColumns columns, int threads, ZMapKernel kernel) {
  auto impl =
      std::make_unique<Impl>(std::move(columns.heights), columns.blank_mm3, kernel, threads);
  impl->gaps = std::move(columns.gaps);
  impl->sweeper.forget_traces();
  return std::unique_ptr<MMap>(new MMap(std::move(impl)));
}

Done MMap::can_cut(const Cutter& cutter) { return check_bottom(cutter, tr("an M-map")); }

void MMap::cut(const Cutter& cutter, std::span<const CutMove> moves,
               std::vector<CutReport>& reports) {
  for ([[maybe_unused]] const CutMove& move : moves) assert(move.is_vertical());
  if (cutter.undercuts()) return impl_->cut_headed(cutter, moves, reports);
  ColumnSweeper columns(impl_->sweeper, impl_->gaps);
  impl_->sweeper.cut(cutter, moves, &columns, reports);
}

void MMap::finish(std::vector<CutReport>& reports) { impl_->finish(reports); }

std::optional<Contact> MMap::first_contact(const Cutter& cutter, const CutMove& move,
                                           double tolerance_mm) const {
  assert(move.is_vertical());
  // What goes on upward without end touches the topmost material first.
  const std::optional<CutMove> near = within_reach(move, bounds_mm());
  if (!near) return std::nullopt;
  const HeadedTool tool = headed_tool(cutter);
  const auto is_hollow = [this](std::size_t tile) { return impl_->gaps.tile(tile) != nullptr; };
  ContactField field{impl_->grid(), impl_->sweeper.traces(), is_hollow, true};
  const auto by_rays = find_first_contact(field, tool.rays, *near, tolerance_mm);
  const auto by_head = find_head_contact(impl_->grid(), impl_->gaps, tool, *near, tolerance_mm);
  const auto contact = earlier_contact(*near, by_rays, by_head);
  if (tool.lower.empty()) return contact;
  field.middles = false;
  return earlier_contact(*near, contact,
                         find_first_contact(field, tool.lower, *near, tolerance_mm));
}

double MMap::part_spare_mm(const CarriedPart& part, const CutMove& move, double enough_mm,
                           double most_mm) const {
  const std::optional<CutMove> near = within_reach(move, bounds_mm());
  if (!near) return most_mm;
  return find_part_spare_mm(impl_->grid(), impl_->tops, part, *near, enough_mm, most_mm);
}

std::optional<PartContact> MMap::part_contact(const Cutter& cutter, const CarriedPart& part,
                                              const CutMove& move, double tolerance_mm) const {
  const std::optional<CutMove> near = within_reach(move, bounds_mm());
  if (!near) return std::nullopt;
  return find_part_contact(impl_->grid(), impl_->tops, cutter, part, *near, tolerance_mm);
}

std::optional<PartGap> MMap::part_gap(const Cutter& cutter, const CarriedPart& part,
                                      const CutMove& move, double below_mm) const {
  const std::optional<CutMove> near = within_reach(move, bounds_mm());
  if (!near) return std::nullopt;
  return find_part_gap(impl_->grid(), impl_->tops, cutter, part, *near, below_mm);
}

std::unique_ptr<StockModel> MMap::snapshot() const {
  auto copy = std::make_unique<Impl>(*impl_);
  copy->sweeper.pool = std::make_shared<WorkerPool>(1);
  copy->seen.clear();
  std::vector<CutReport> ignored;
  copy->finish(ignored);
  return std::unique_ptr<StockModel>(new MMap(std::move(copy)));
}

std::size_t MMap::unique_bytes() const {
  return impl_->grid().unique_bytes() + impl_->gaps.unique_bytes();
}

void MMap::keep_cut_ids(bool keep) {
  assert(!impl_->sweeper.holds_back());
  impl_->grid().keep_cut_ids(keep);
}

std::uint32_t MMap::present_cut_id(int i, int j) const {
  const TileGrid& grid = impl_->grid();
  return grid.keeps_cut_ids() ? grid.cut_id(i, j) : MeshPatch::kNotCut;
}

std::array<std::uint32_t, 4> MMap::present_cut_ids_of_four(int i, int j) const {
  return impl_->grid().cut_ids_of_four(i, j);
}

void MMap::read_present_cut_ids(int i, int j, bool along_x, std::span<std::uint32_t> out) const {
  impl_->grid().read_cut_ids(i, j, along_x, out);
}

bool MMap::keeps_cut_ids() const { return impl_->grid().keeps_cut_ids(); }

std::optional<std::uint32_t> MMap::cut_id_at(const Vec3& point_mm) const {
  if (!keeps_cut_ids()) return std::nullopt;
  if (const std::optional<std::uint32_t> id = gap_id_at(impl_->grid(), impl_->gaps, point_mm))
    return id;
  const std::uint32_t id = kerf::cut_id_at(impl_->grid(), point_mm);
  return id == MeshPatch::kNotCut ? std::nullopt : std::optional(id);
}

Box MMap::bounds_mm() const { return impl_->grid().bounds_mm(); }
double MMap::cell_mm() const {
  return std::max(impl_->grid().cell_x_mm(), impl_->grid().cell_y_mm());
}
std::size_t MMap::cell_count() const {
  return static_cast<std::size_t>(nx()) * static_cast<std::size_t>(ny());
}
double MMap::blank_mm3() const { return impl_->blank_mm3; }

double MMap::remaining_mm3() const {
  const TileGrid& grid = impl_->grid();
  double hollow_mm = 0;
  for (std::size_t i = 0; i < grid.tile_count(); ++i) {
    const GapTile* const tile = impl_->gaps.tile(i);
    if (tile == nullptr) continue;
    double sum = 0;
    for (std::size_t cell = 0; cell < kTileFloats; ++cell) {
      tile->each(cell, [&](const Gap& gap) {
        sum += static_cast<double>(gap.high) - static_cast<double>(gap.low);
      });
    }
    hollow_mm += sum;
  }
  return volume_of(grid) - hollow_mm * grid.cell_x_mm() * grid.cell_y_mm();
}

std::string MMap::digest() const {
  const GridHash heights = hash_of(impl_->grid());
  if (!impl_->gaps.any()) return heights.text();
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  XXH3_128bits_update(&state, &heights, sizeof heights);
  for (std::uint64_t i = 0; i < tile_count(); ++i) {
    const GapTile* const tile = impl_->gaps.tile(i);
    if (tile == nullptr) continue;
    const std::uint64_t hashes[2] = {i, tile->hash()};
    XXH3_128bits_update(&state, hashes, sizeof hashes);
  }
  const XXH128_hash_t hash = XXH3_128bits_digest(&state);
  return GridHash{hash.high64, hash.low64}.text();
}

int MMap::nx() const { return impl_->grid().nx(); }
int MMap::ny() const { return impl_->grid().ny(); }
float MMap::height_mm(int i, int j) const { return impl_->grid().height(i, j); }
bool MMap::has_gaps() const { return impl_->gaps.any(); }

std::vector<Gap> MMap::gaps(int i, int j) const {
  std::vector<Gap> out;
  const std::size_t tile =
      static_cast<std::size_t>(j / kTileCells * impl_->grid().tiles_x() + i / kTileCells);
  if (const GapTile* const hollow = impl_->gaps.tile(tile))
    hollow->read(TileGrid::offset(i, j), out);
  return out;
}

TriangleMesh MMap::mesh(double tolerance_mm) const {
  const TileGrid& grid = impl_->grid();
  if (has_gaps()) return mesh_columns(grid, impl_->gaps);
  std::vector<float> heights(cell_count());
  for (int j = 0; j < ny(); ++j)
    grid.copy_row(j, heights.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(nx()));
  return mesh_height_grid({nx(), ny(), bounds_mm(), heights}, tolerance_mm,
                          impl_->sweeper.pool->threads());
}

std::size_t MMap::tile_count() const { return impl_->grid().tile_count(); }
Box MMap::tile_box(std::uint32_t tile) const { return impl_->grid().tile_box(tile); }

std::vector<std::uint32_t> MMap::take_dirty_tiles() {
  TileGrid& grid = impl_->grid();
  std::vector<Impl::SeenTile>& seen = impl_->seen;
  const bool first = seen.empty();
  seen.resize(grid.tile_count());
  std::vector<std::uint32_t> dirty;
  for (std::uint32_t i = 0; i < seen.size(); ++i) {
    if (!first && seen[i].version == grid.version(i)) continue;
    const std::uint64_t hash = impl_->hash_of_tile(i);
    if (!first && seen[i].hash == hash) {
      grid.restore_version(i, seen[i].version);
      continue;
    }
    seen[i] = {grid.version(i), hash};
    dirty.push_back(i);
  }
  return dirty;
}

std::vector<std::uint32_t> MMap::differing_tiles(const StockModel& other) const {
  const TileGrid& a = impl_->grid();
  const MMap* const map = dynamic_cast<const MMap*>(&other);
  const TileGrid* const b = map ? &map->impl_->grid() : nullptr;
  const bool alike = b && a.nx() == b->nx() && a.ny() == b->ny() && a.bounds_mm() == b->bounds_mm();
  // Numbers of moves lie behind the heights.
  const std::size_t bytes = alike ? std::min(a.tile_bytes(), b->tile_bytes()) : 0;
  const auto same = [&](std::uint32_t i) {
    if (a.tile(i) != b->tile(i) && std::memcmp(a.tile(i), b->tile(i), bytes) != 0) return false;
    const GapTile* const ours = impl_->gaps.tile(i);
    const GapTile* const theirs = map->impl_->gaps.tile(i);
    if (ours == theirs) return true;
    return ours && theirs && ours->equals(*theirs, a.keeps_cut_ids() && b->keeps_cut_ids());
  };
  std::vector<std::uint32_t> differing;
  for (std::uint32_t i = 0; i < a.tile_count(); ++i)
    if (!alike || !same(i)) differing.push_back(i);
  return differing;
}

std::uint64_t MMap::patch_version(std::uint32_t tile) const {
  return tile_patch_version(impl_->grid(), tile);
}

MeshPatch MMap::patch(std::uint32_t tile, int level) const {
  MeshPatch patch = gaps_near(impl_->grid(), impl_->gaps, tile)
                        ? make_column_patch(impl_->grid(), impl_->gaps, tile, level)
                        : make_tile_patch(impl_->grid(), tile, level);
  patch.version = patch_version(tile);
  return patch;
}

std::shared_ptr<const HeightGrid> MMap::height_grid() const {
  return has_gaps() ? nullptr : height_view(impl_->grid());
}

std::optional<HeightGrid> MMap::present_heights() const {
  if (has_gaps()) return std::nullopt;
  return present_view(impl_->grid());
}

ColumnLayout MMap::column_layout() const { return column_layout_of(impl_->grid()); }

std::uint64_t MMap::column_version(std::uint32_t tile) const { return impl_->grid().version(tile); }

void MMap::read_columns(std::uint32_t tile, ColumnRuns& out) const {
  const GapTile* const gaps = impl_->gaps.tile(tile);
  read_height_columns(
      impl_->grid(), tile,
      [gaps](std::size_t cell, const auto& see) {
        if (gaps) gaps->each(cell, [&](const Gap& gap) { see(gap.low, gap.high); });
      },
      out);
}

}  // namespace kerf
