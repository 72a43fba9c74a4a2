#include "stock/zmap/zmap.h"

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "base/worker_pool.h"
#include "stock/zmap/contact.h"
#include "stock/zmap/cutter_components.h"
#include "stock/zmap/height_mesh.h"
#include "stock/zmap/height_view.h"
#include "stock/zmap/path_builder.h"
#include "stock/zmap/state_file.h"
#include "stock/zmap/tile_cut_ids.h"
#include "stock/zmap/tile_grid.h"
#include "stock/zmap/tile_patch.h"

namespace kerf {

bool zmap_has_avx2() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

namespace {

struct Kernels {
  SweepKernel* plain = zmap_scalar::run_sweeps;
  SweepKernel* with_ids = zmap_scalar_ids::run_sweeps;
};

Kernels pick_kernels(ZMapKernel kernel) {
#if defined(__x86_64__)
  if (kernel != ZMapKernel::kScalar && zmap_has_avx2())
    return {zmap_avx2::run_sweeps, zmap_avx2_ids::run_sweeps};
#endif
  return {};
}

/// As cells keep it: nothing that cuts may look like kNotCut.
std::uint32_t cut_id_of(std::uint64_t move_id) {
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(move_id, MeshPatch::kNotCut - 1));
}

/// The cells of one row that lie within a body's outline, as up to two runs [first, last).
struct RowRuns {
  int count = 0;
  std::array<std::pair<int, int>, 2> runs;
  void add(int first, int last) {
    if (first < last) runs[static_cast<std::size_t>(count++)] = {first, last};
  }
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

void fill_blank(TileGrid& grid, const Blank& blank) {
  std::vector<float> row(static_cast<std::size_t>(grid.nx()));
  for (int j = 0; j < grid.ny(); ++j) {
    const double y = grid.bounds_mm().min.y + (j + 0.5) * grid.cell_y_mm();
    std::fill(row.begin(), row.end(), grid.floor_mm());
    for (const BlankBody& body : blank.bodies) {
      const float top = static_cast<float>(body.bounds_mm.max.z);
      const RowRuns runs = runs_of(body, grid, y);
      for (int r = 0; r < runs.count; ++r) {
        const auto [first, last] = runs.runs[static_cast<std::size_t>(r)];
        for (int i = first; i < last; ++i)
          row[static_cast<std::size_t>(i)] = std::max(row[static_cast<std::size_t>(i)], top);
      }
    }
    grid.set_row(j, row.data());
  }
}

double volume_of(const TileGrid& grid) {
  std::vector<float> row(static_cast<std::size_t>(grid.nx()));
  const double floor = static_cast<double>(grid.floor_mm());
  double sum = 0;
  for (int j = 0; j < grid.ny(); ++j) {
    grid.copy_row(j, row.data());
    double row_sum = 0;
    for (const float height : row) row_sum += static_cast<double>(height) - floor;
    sum += row_sum;
  }
  return sum * grid.cell_x_mm() * grid.cell_y_mm();
}

/// Moves whose sweeps are worked off together: as many as keep the list of sweeps within the
/// second-level cache.
constexpr std::size_t kMovesAtOnce = 1024;

std::string memory_text(double cells) {
  return fmt::format("{:.1f} GB", cells * sizeof(float) / 1e9);
}

}  // namespace

struct ZMap::Impl {
  TileGrid grid;
  double blank_mm3 = 0;
  Kernels kernels;
  std::shared_ptr<WorkerPool>
      pool;  ///< shared with snapshots made for reading; they cut with their own

  PathBuilder path;
  std::string cutter_spec;
  std::vector<ConvexTool> tools;
  std::uint64_t pending_id = 0;  ///< move whose last segment is held back
  SweepTotals pending_totals;

  /// What take_dirty_tiles() last saw of each tile; empty before its first call.
  struct SeenTile {
    std::uint64_t version, hash;
  };
  std::vector<SeenTile> seen;

  std::vector<SweepOp> ops;  // kept between calls to save allocations
  std::vector<SweepTotals> totals;
  std::vector<float*> pointers;
  std::vector<std::uint32_t> cut_ids;  ///< by report; unused where they are not kept

  explicit Impl(TileGrid g) : grid(std::move(g)) {}
  void use_cutter(const Cutter& cutter, std::vector<CutReport>& reports);
  void cut_some(std::span<const CutMove> moves, std::vector<CutReport>& reports);
  void run(std::size_t report_count);
  GridView view();
  template <class Work>
  void share_out(std::size_t report_count, const GridView& view, const Work& work);
  CutReport report(std::uint64_t id, const SweepTotals& sum) const {
    return {
        id,
        static_cast<double>(sum.removed) * kRemovedUnit_mm * grid.cell_x_mm() * grid.cell_y_mm(),
        static_cast<double>(sum.depth)};
  }
  void finish(std::vector<CutReport>& reports);
};

/// No tile may be written before its first sweep has asked for it: this is how tiles come to be
/// unshared and to have a new version, without a look at either in the kernels' loops.
GridView ZMap::Impl::view() {
  pointers.assign(grid.tile_count(), nullptr);
  GridView view;
  view.tiles = pointers.data();
  view.owner = this;
  view.make_writable = [](void* owner, int tile) {
    Impl& self = *static_cast<Impl*>(owner);
    const std::size_t index = static_cast<std::size_t>(tile);
    return self.pointers[index] = self.grid.make_writable(index);
  };
  view.nx = grid.nx();
  view.ny = grid.ny();
  view.tiles_x = grid.tiles_x();
  view.tiles_y = grid.tiles_y();
  view.x0 = grid.bounds_mm().min.x;
  view.y0 = grid.bounds_mm().min.y;
  view.cell_x = grid.cell_x_mm();
  view.cell_y = grid.cell_y_mm();
  view.per_block_x = 1 / (kBlockX * view.cell_x);
  view.per_block_y = 1 / (kBlockY * view.cell_y);
  view.floor = grid.floor_mm();
  view.cut_ids = cut_ids.data();
  return view;
}

/// Has work(view, thread, threads, totals) done by every thread. Bands of tile rows are dealt out;
/// the sums of a move's bands are integers, so their order does not matter.
template <class Work>
void ZMap::Impl::share_out(std::size_t report_count, const GridView& view, const Work& work) {
  const int threads = pool->threads();
  if (threads == 1) {
    GridView mine = view;
    return work(mine, 0, 1, totals.data());
  }
  std::vector<std::vector<SweepTotals>> parts(static_cast<std::size_t>(threads));
  pool->run([&](int thread) {
    std::vector<SweepTotals>& part = parts[static_cast<std::size_t>(thread)];
    part.resize(report_count);
    GridView mine = view;
    work(mine, thread, threads, part.data());
  });
  for (const std::vector<SweepTotals>& part : parts) {
    for (std::size_t i = 0; i < report_count; ++i) {
      totals[i].removed += part[i].removed;
      totals[i].depth = std::max(totals[i].depth, part[i].depth);
    }
  }
}

/// Works off `ops`; totals[0 .. report_count) receive the sums.
void ZMap::Impl::run(std::size_t report_count) {
  if (ops.empty()) return;
  grid.begin_change();
  const GridView whole = view();
  if (grid.keeps_cut_ids() && tools.size() > 1) {
    // Move by move, or of two that cut equally deep with different parts of the cutter, the
    // earlier would be found by how they are divided into calls.
    share_out(report_count, whole, [&](GridView& mine, int thread, int threads, SweepTotals* sums) {
      for (SweepOp op : ops) {
        for (const ConvexTool& tool : tools) {
          op.use_double |= tool.needs_double;
          kernels.with_ids(mine, tool, &op, 1, thread, threads, sums);
        }
      }
    });
    return ops.clear();
  }
  SweepKernel* const kernel = grid.keeps_cut_ids() ? kernels.with_ids : kernels.plain;
  for (const ConvexTool& tool : tools) {
    if (tool.needs_double)
      for (SweepOp& op : ops) op.use_double = true;
    share_out(report_count, whole, [&](GridView& mine, int thread, int threads, SweepTotals* sums) {
      kernel(mine, tool, ops.data(), ops.size(), thread, threads, sums);
    });
  }
  ops.clear();
}

void ZMap::Impl::finish(std::vector<CutReport>& reports) {
  if (!path.holds_back()) return;
  totals.assign(1, pending_totals);
  cut_ids.assign(1, cut_id_of(pending_id));
  path.set_pending_report(0);
  path.finish(ops);
  run(1);
  reports.push_back(report(pending_id, totals[0]));
}

void ZMap::Impl::use_cutter(const Cutter& cutter, std::vector<CutReport>& reports) {
  if (cutter.spec() == cutter_spec && !tools.empty()) return;
  finish(reports);
  path.restart();
  cutter_spec = cutter.spec();
  tools = convex_components(cutter);
}

ZMap::ZMap(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ZMap::~ZMap() = default;

Result<std::unique_ptr<ZMap>> ZMap::create(const ZMapOptions& options) {
  const double cell = options.cell_mm;
  const Box box = options.blank.bounds_mm();
  if (box.empty() || options.blank.bodies.empty()) return Error{"the blank is empty"};
  const Vec3 size = box.size();
  if (!std::isfinite(cell) || cell <= 0)
    return Error{fmt::format("cell size {} mm is not allowed; must be above 0", cell)};
  if (cell > std::min(size.x, size.y)) {
    return Error{fmt::format(
        "cell size {} mm exceeds the blank, which is {} x {} mm; 0.05 to 0.2 suits most parts",
        cell, size.x, size.y)};
  }
  for (const BlankBody& body : options.blank.bodies) {
    if (body.kind != BlankBody::Kind::kBox && body.axis != 'z')
      return Error{
          fmt::format("a Z-map cannot hold a cylinder along {}; its axis must be z", body.axis)};
    if (body.bounds_mm.min.z > box.min.z + 1e-9 || body.bounds_mm.max.z <= box.min.z)
      return Error{
          fmt::format("a Z-map cannot hold a body that begins at Z{} above the blank's floor Z{}",
                      body.bounds_mm.min.z, box.min.z)};
  }
  // The slack keeps 100 mm / 0.1 mm at 1000 cells.
  const double nx = std::ceil(size.x / cell - 1e-6), ny = std::ceil(size.y / cell - 1e-6);
  if (nx * ny > static_cast<double>(kMaxCells)) {
    return Error{fmt::format(
        "cell size {} mm makes {:.0f} x {:.0f} cells and would take {} of memory; at most {} are "
        "allowed",
        cell, nx, ny, memory_text(nx * ny), memory_text(static_cast<double>(kMaxCells)))};
  }
  auto impl = std::make_unique<Impl>(TileGrid(box, static_cast<int>(nx), static_cast<int>(ny)));
  fill_blank(impl->grid, options.blank);
  impl->blank_mm3 = volume_of(impl->grid);
  impl->kernels = pick_kernels(options.kernel);
  impl->pool = std::make_shared<WorkerPool>(std::max(1, options.threads));
  return std::unique_ptr<ZMap>(new ZMap(std::move(impl)));
}

Done ZMap::can_cut(const Cutter& cutter) {
  if (cutter.undercuts()) {
    return Error{fmt::format(
        "{} cuts below itself (its neck is thinner than its head); a Z-map cannot hold undercuts",
        cutter.spec())};
  }
  for (const ProfilePiece& piece : cutter.profile()) {
    const bool bulges_down =
        piece.kind == ProfilePiece::Kind::kArc && piece.convex && piece.r0 < piece.center_r - 1e-9;
    if (piece.z1 < piece.z0 - 1e-9 || bulges_down) {
      return Error{
          fmt::format("{} has a hollow bottom (its profile falls from radius {:.6g} outward); a "
                      "Z-map cannot cut with it",
                      cutter.spec(), piece.r0)};
    }
  }
  return std::monostate{};
}

void ZMap::cut(const Cutter& cutter, std::span<const CutMove> moves,
               std::vector<CutReport>& reports) {
  impl_->use_cutter(cutter, reports);
  for (std::size_t first = 0; first < moves.size(); first += kMovesAtOnce)
    impl_->cut_some(moves.subspan(first, std::min(kMovesAtOnce, moves.size() - first)), reports);
}

void ZMap::Impl::cut_some(std::span<const CutMove> moves, std::vector<CutReport>& reports) {
  Impl& m = *this;
  // totals[0] is the move held back before, if any; the others follow in order.
  const bool carried = m.path.holds_back();
  const std::size_t first = carried ? 1 : 0;
  m.totals.assign(moves.size() + first, SweepTotals{});
  if (carried) {
    m.totals[0] = m.pending_totals;
    m.path.set_pending_report(0);
  }
  for (std::size_t i = 0; i < moves.size(); ++i)
    m.path.add(moves[i], static_cast<std::uint32_t>(i + first), m.ops);
  if (m.grid.keeps_cut_ids()) {
    m.cut_ids.clear();
    if (carried) m.cut_ids.push_back(cut_id_of(m.pending_id));
    for (const CutMove& move : moves) m.cut_ids.push_back(cut_id_of(move.id));
  }
  m.run(m.totals.size());

  const bool holding = m.path.holds_back();
  if (carried) reports.push_back(m.report(m.pending_id, m.totals[0]));
  for (std::size_t i = 0; i < moves.size(); ++i) {
    if (holding && i + 1 == moves.size()) break;
    reports.push_back(m.report(moves[i].id, m.totals[i + first]));
  }
  if (holding) {
    m.pending_id = moves.back().id;
    m.pending_totals = m.totals.back();
  }
}

void ZMap::finish(std::vector<CutReport>& reports) { impl_->finish(reports); }

std::optional<Contact> ZMap::first_contact(const Cutter& cutter, const CutMove& move,
                                           double tolerance_mm) const {
  return find_first_contact(impl_->grid, cutter, move, tolerance_mm);
}

std::unique_ptr<StockModel> ZMap::snapshot() const {
  auto copy = std::make_unique<Impl>(*impl_);
  copy->pool = std::make_shared<WorkerPool>(1);
  copy->seen.clear();
  std::vector<CutReport> ignored;
  copy->finish(ignored);
  return std::unique_ptr<StockModel>(new ZMap(std::move(copy)));
}

std::shared_ptr<const HeightGrid> ZMap::height_grid() const { return height_view(impl_->grid); }

void ZMap::keep_cut_ids(bool keep) {
  assert(!impl_->path.holds_back());
  impl_->grid.keep_cut_ids(keep);
}

bool ZMap::keeps_cut_ids() const { return impl_->grid.keeps_cut_ids(); }

std::optional<std::uint32_t> ZMap::cut_id_at(const Vec3& point_mm) const {
  if (!keeps_cut_ids()) return std::nullopt;
  const std::uint32_t id = kerf::cut_id_at(impl_->grid, point_mm);
  return id == MeshPatch::kNotCut ? std::nullopt : std::optional(id);
}

std::size_t ZMap::unique_bytes() const { return impl_->grid.unique_bytes(); }

Box ZMap::bounds_mm() const { return impl_->grid.bounds_mm(); }
double ZMap::cell_mm() const { return std::max(impl_->grid.cell_x_mm(), impl_->grid.cell_y_mm()); }
std::size_t ZMap::cell_count() const {
  return static_cast<std::size_t>(impl_->grid.nx()) * static_cast<std::size_t>(impl_->grid.ny());
}
double ZMap::blank_mm3() const { return impl_->blank_mm3; }
double ZMap::remaining_mm3() const { return volume_of(impl_->grid); }
int ZMap::nx() const { return impl_->grid.nx(); }
int ZMap::ny() const { return impl_->grid.ny(); }
float ZMap::height_mm(int i, int j) const { return impl_->grid.height(i, j); }

std::vector<float> ZMap::heights_mm() const {
  const TileGrid& grid = impl_->grid;
  std::vector<float> heights(cell_count());
  for (int j = 0; j < grid.ny(); ++j)
    grid.copy_row(
        j, heights.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.nx()));
  return heights;
}

std::string ZMap::digest() const {
  const TileGrid& grid = impl_->grid;
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  const Box& box = grid.bounds_mm();
  const double frame[6] = {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z};
  const std::int32_t counts[2] = {grid.nx(), grid.ny()};
  XXH3_128bits_update(&state, frame, sizeof frame);
  XXH3_128bits_update(&state, counts, sizeof counts);
  std::vector<float> row(static_cast<std::size_t>(grid.nx()));
  for (int j = 0; j < grid.ny(); ++j) {
    grid.copy_row(j, row.data());
    for (float& height : row) height += 0.0f;  // -0 and 0 are the same height
    XXH3_128bits_update(&state, row.data(), row.size() * sizeof(float));
  }
  const XXH128_hash_t hash = XXH3_128bits_digest(&state);
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

TriangleMesh ZMap::mesh(double tolerance_mm) const {
  const std::vector<float> heights = heights_mm();
  return mesh_height_grid({nx(), ny(), bounds_mm(), heights}, tolerance_mm, impl_->pool->threads());
}

std::size_t ZMap::tile_count() const { return impl_->grid.tile_count(); }
Box ZMap::tile_box(std::uint32_t tile) const { return impl_->grid.tile_box(tile); }

std::vector<std::uint32_t> ZMap::take_dirty_tiles() {
  TileGrid& grid = impl_->grid;
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
  const TileGrid& a = impl_->grid;
  const ZMap* const map = dynamic_cast<const ZMap*>(&other);
  const TileGrid* const b = map ? &map->impl_->grid : nullptr;
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
  return tile_patch_version(impl_->grid, tile);
}

MeshPatch ZMap::patch(std::uint32_t tile, int level) const {
  MeshPatch patch = make_tile_patch(impl_->grid, tile, level);
  patch.version = patch_version(tile);
  return patch;
}

Done ZMap::save(const std::string& path) const {
  return write_state(path, impl_->grid, impl_->blank_mm3);
}

Result<std::unique_ptr<ZMap>> ZMap::load(const std::string& path, int threads, ZMapKernel kernel) {
  Result<SavedState> state = read_state(path);
  if (!state) return Error{state.error()};
  auto impl = std::make_unique<Impl>(std::move(state->grid));
  impl->blank_mm3 = state->blank_mm3;
  impl->kernels = pick_kernels(kernel);
  impl->pool = std::make_shared<WorkerPool>(std::max(1, threads));
  return std::unique_ptr<ZMap>(new ZMap(std::move(impl)));
}

}  // namespace kerf
