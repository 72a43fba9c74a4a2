#include "stock/zmap/zmap.h"

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "base/translate.h"
#include "mesh/mesh_body.h"
#include "stock/move_reach.h"
#include "stock/zmap/blank_grid.h"
#include "stock/zmap/contact.h"
#include "stock/zmap/cutter_components.h"
#include "stock/zmap/height_columns.h"
#include "stock/zmap/height_mesh.h"
#include "stock/zmap/height_sweeper.h"
#include "stock/zmap/height_view.h"
#include "stock/zmap/part_contact.h"
#include "stock/zmap/part_gap.h"
#include "stock/zmap/sparse_tiles.h"
#include "stock/zmap/state_file.h"
#include "stock/zmap/tile_cut_ids.h"
#include "stock/zmap/tile_grid.h"
#include "stock/zmap/tile_patch.h"
#include "stock/zmap/wall_marks.h"
#include "stock/zmap/wall_volume.h"

namespace kerf {

struct ZMap::Impl {
  HeightSweeper sweeper;
  double blank_mm3 = 0;

  /// What take_dirty_tiles() last saw of each tile; empty before its first call.
  struct SeenTile {
    std::uint64_t version, hash;
  };
  std::vector<SeenTile> seen;
  TileTops tops;

  Impl(TileGrid heights, double blank_volume_mm3, ZMapKernel kernel, int threads)
      : sweeper(std::move(heights), kernel, threads), blank_mm3(blank_volume_mm3) {}
  TileGrid& grid() { return sweeper.grid; }
  double beside_cells_mm3() {
    const WallMarks& walls = sweeper.walls();
    return wall_volume_mm3(grid(), walls);
  }
  double volume_mm3() { return volume_of(grid()) + beside_cells_mm3(); }
};

ZMap::ZMap(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ZMap::~ZMap() = default;

Result<std::unique_ptr<ZMap>> ZMap::create(const ZMapOptions& options) {
  if (const auto& mesh = options.blank.mesh; mesh && mesh->body && !mesh->body->is_height_field())
    return Error{tr("a Z-map cannot hold it: the mesh has undercuts; models mmap and octree do")};
  Result<TileGrid> grid = make_blank_grid(options.blank, options.cell_mm, kMaxCells, tr("a Z-map"),
                                          options.keeps_cut_ids);
  if (!grid) return Error{grid.error()};
  auto impl = std::make_unique<Impl>(std::move(*grid), 0, options.kernel, options.threads);
  impl->sweeper.follow_sides(options.blank);
  impl->sweeper.keep_walls(options.blank.bodies);
  impl->blank_mm3 = impl->volume_mm3();
  return std::unique_ptr<ZMap>(new ZMap(std::move(impl)));
}

Done ZMap::can_cut(const Cutter& cutter) {
  if (cutter.undercuts()) {
    return Error{trf(
        "{} cuts below itself (its neck is thinner than its head); a Z-map cannot hold undercuts",
        cutter.spec())};
  }
  return check_bottom(cutter, tr("a Z-map"));
}

void ZMap::cut(const Cutter& cutter, std::span<const CutMove> moves,
               std::vector<CutReport>& reports) {
  impl_->sweeper.cut(cutter, moves, nullptr, reports);
}

void ZMap::finish(std::vector<CutReport>& reports) { impl_->sweeper.finish(nullptr, reports); }

std::optional<Contact> ZMap::first_contact(const Cutter& cutter, const CutMove& move,
                                           double tolerance_mm) const {
  const std::optional<CutMove> near = within_reach(move, bounds_mm());
  if (!near) return std::nullopt;
  return find_first_contact({impl_->grid(), impl_->sweeper.traces(), nullptr, true},
                            convex_components(cutter.profile()), *near, tolerance_mm);
}

double ZMap::part_spare_mm(const CarriedPart& part, const CutMove& move, double enough_mm,
                           double most_mm) const {
  const std::optional<CutMove> near = within_reach(move, bounds_mm());
  if (!near) return most_mm;
  return find_part_spare_mm(impl_->grid(), impl_->tops, part, *near, enough_mm, most_mm);
}

std::optional<PartContact> ZMap::part_contact(const Cutter& cutter, const CarriedPart& part,
                                              const CutMove& move, double tolerance_mm) const {
  const std::optional<CutMove> near = within_reach(move, bounds_mm());
  if (!near) return std::nullopt;
  return find_part_contact(impl_->grid(), impl_->tops, cutter, part, *near, tolerance_mm);
}

std::optional<PartGap> ZMap::part_gap(const Cutter& cutter, const CarriedPart& part,
                                      const CutMove& move, double below_mm) const {
  const std::optional<CutMove> near = within_reach(move, bounds_mm());
  if (!near) return std::nullopt;
  return find_part_gap(impl_->grid(), impl_->tops, cutter, part, *near, below_mm);
}

std::unique_ptr<StockModel> ZMap::snapshot() const {
  impl_->sweeper.walls();  // once for both
  auto copy = std::make_unique<Impl>(*impl_);
  copy->grid().unpack();
  copy->sweeper.pool = std::make_shared<WorkerPool>(1);
  copy->seen.clear();
  std::vector<CutReport> ignored;
  copy->sweeper.finish(nullptr, ignored);
  copy->sweeper.walls();  // before others may ask for them
  return std::unique_ptr<StockModel>(new ZMap(std::move(copy)));
}

std::shared_ptr<const HeightGrid> ZMap::height_grid() const { return height_view(impl_->grid()); }

std::optional<HeightGrid> ZMap::present_heights() const { return present_view(impl_->grid()); }

void ZMap::keep_cut_ids(bool keep) {
  assert(!impl_->sweeper.holds_back());
  impl_->grid().keep_cut_ids(keep);
}

std::uint32_t ZMap::present_cut_id(int i, int j) const {
  const TileGrid& grid = impl_->grid();
  return grid.keeps_cut_ids() ? grid.cut_id(i, j) : MeshPatch::kNotCut;
}

std::array<std::uint32_t, 4> ZMap::present_cut_ids_of_four(int i, int j) const {
  return impl_->grid().cut_ids_of_four(i, j);
}

void ZMap::read_present_cut_ids(int i, int j, bool along_x, std::span<std::uint32_t> out) const {
  impl_->grid().read_cut_ids(i, j, along_x, out);
}

bool ZMap::keeps_cut_ids() const { return impl_->grid().keeps_cut_ids(); }

std::optional<std::uint32_t> ZMap::cut_id_at(const Vec3& point_mm) const {
  if (!keeps_cut_ids()) return std::nullopt;
  const std::uint32_t id = kerf::cut_id_at(impl_->grid(), point_mm);
  return id == MeshPatch::kNotCut ? std::nullopt : std::optional(id);
}

std::size_t ZMap::unique_bytes() const {
  return impl_->grid().unique_bytes() + impl_->sweeper.walls().unique_bytes();
}

bool ZMap::pack(std::span<StockModel* const> copies, std::size_t at) const {
  std::vector<TileGrid*> grids;
  grids.reserve(copies.size());
  for (StockModel* const copy : copies) {
    ZMap* const map = dynamic_cast<ZMap*>(copy);
    if (map == nullptr) return true;
    grids.push_back(&map->impl_->grid());
  }
  dynamic_cast<ZMap&>(*copies[at]).impl_->sweeper.forget_traces();
  return TileGrid::pack(grids, at);
}

std::size_t ZMap::kept_bytes(const StockModel& before, const StockModel* after) const {
  const auto grid_of = [](const StockModel* model) {
    const ZMap* const map = dynamic_cast<const ZMap*>(model);
    return map ? &map->impl_->grid() : nullptr;
  };
  const TileGrid* const earlier = grid_of(&before);
  return earlier ? impl_->grid().kept_bytes(*earlier, grid_of(after))
                 : StockModel::kept_bytes(before, after);
}

Box ZMap::bounds_mm() const { return impl_->grid().bounds_mm(); }
double ZMap::cell_mm() const {
  return std::max(impl_->grid().cell_x_mm(), impl_->grid().cell_y_mm());
}
std::size_t ZMap::cell_count() const {
  return static_cast<std::size_t>(impl_->grid().nx()) *
         static_cast<std::size_t>(impl_->grid().ny());
}
double ZMap::blank_mm3() const { return impl_->blank_mm3; }
double ZMap::remaining_mm3() const { return impl_->volume_mm3(); }
double ZMap::beside_cells_mm3() const { return impl_->beside_cells_mm3(); }
int ZMap::nx() const { return impl_->grid().nx(); }
int ZMap::ny() const { return impl_->grid().ny(); }
float ZMap::height_mm(int i, int j) const { return impl_->grid().height(i, j); }

std::vector<float> ZMap::heights_mm() const {
  const TileGrid& grid = impl_->grid();
  std::vector<float> heights(cell_count());
  for (int j = 0; j < grid.ny(); ++j)
    grid.copy_row(
        j, heights.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.nx()));
  return heights;
}

std::string ZMap::digest() const { return hash_of(impl_->grid()).text(); }

TriangleMesh ZMap::mesh(double tolerance_mm) const {
  const std::vector<float> heights = heights_mm();
  const std::vector<CellStep> steps = cell_steps(impl_->grid(), impl_->sweeper.walls());
  return mesh_height_grid({nx(), ny(), bounds_mm(), heights, steps}, tolerance_mm,
                          impl_->sweeper.pool->threads());
}

std::size_t ZMap::tile_count() const { return impl_->grid().tile_count(); }
Box ZMap::tile_box(std::uint32_t tile) const { return impl_->grid().tile_box(tile); }

std::vector<std::uint32_t> ZMap::take_dirty_tiles() {
  TileGrid& grid = impl_->grid();
  std::vector<Impl::SeenTile>& seen = impl_->seen;
  const bool first = seen.empty();
  seen.resize(grid.tile_count());
  std::vector<std::uint32_t> dirty;
  for (std::uint32_t i = 0; i < seen.size(); ++i) {
    if (!first && seen[i].version == grid.version(i)) continue;
    const std::uint64_t hash = XXH3_64bits(grid.tile(i), kTileFloats * sizeof(float));
    if (!first && seen[i].hash == hash) {
      grid.restore_version(i, seen[i].version);
      continue;
    }
    seen[i] = {grid.version(i), hash};
    dirty.push_back(i);
  }
  return dirty;
}

std::vector<std::uint32_t> ZMap::differing_tiles(const StockModel& other) const {
  const TileGrid& a = impl_->grid();
  const ZMap* const map = dynamic_cast<const ZMap*>(&other);
  const TileGrid* const b = map ? &map->impl_->grid() : nullptr;
  const bool alike = b && a.nx() == b->nx() && a.ny() == b->ny() && a.bounds_mm() == b->bounds_mm();
  // Numbers of moves lie behind the heights.
  const std::size_t bytes = alike ? std::min(a.tile_bytes(), b->tile_bytes()) : 0;
  std::vector<std::uint32_t> differing;
  for (std::uint32_t i = 0; i < a.tile_count(); ++i) {
    if (alike && a.tile(i) == b->tile(i)) continue;
    if (!alike || std::memcmp(a.tile(i), b->tile(i), bytes) != 0) differing.push_back(i);
  }
  return differing;
}

std::uint64_t ZMap::patch_version(std::uint32_t tile) const {
  return tile_patch_version(impl_->grid(), tile);
}

MeshPatch ZMap::patch(std::uint32_t tile, int level) const {
  MeshPatch patch = make_tile_patch(impl_->grid(), tile, level);
  patch.version = patch_version(tile);
  return patch;
}

std::unique_ptr<SparseSurface> ZMap::sparse_surface(const SparseOptions& options) const {
  return std::make_unique<SparseTiles>(impl_->grid(), options);
}

Done ZMap::save(const std::string& path) const {
  return write_state(path, impl_->grid(), impl_->sweeper.walls(), impl_->blank_mm3);
}

Result<std::unique_ptr<ZMap>> ZMap::load(const std::string& path, int threads, ZMapKernel kernel) {
  Result<SavedState> state = read_state(path);
  if (!state) return Error{state.error()};
  return of_heights(std::move(state.value()), threads, kernel);
}

std::unique_ptr<ZMap> ZMap::of_heights(SavedState heights, int threads, ZMapKernel kernel) {
  auto impl = std::make_unique<Impl>(std::move(heights.grid), heights.blank_mm3, kernel, threads);
  impl->sweeper.forget_traces();
  impl->sweeper.keep_walls();
  for (const PlacedMark& placed : heights.marks)
    impl->sweeper.walls().add(placed.tile, placed.mark, impl->grid());
  return std::unique_ptr<ZMap>(new ZMap(std::move(impl)));
}

ColumnLayout ZMap::column_layout() const { return column_layout_of(impl_->grid()); }

std::uint64_t ZMap::column_version(std::uint32_t tile) const { return impl_->grid().version(tile); }

void ZMap::read_columns(std::uint32_t tile, ColumnRuns& out) const {
  read_height_columns(
      impl_->grid(), tile, [](std::size_t, const auto&) {}, out);
}

}  // namespace kerf
