#include "stock/sheet/sheet.h"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>

#include "base/portable_math.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/move_reach.h"
#include "stock/sheet/pieces.h"
#include "stock/sheet/punch_hits.h"
#include "stock/sheet/sheet_border.h"
#include "stock/sheet/sheet_contact.h"
#include "stock/sheet/sheet_mesh.h"
#include "stock/sheet/sheet_state.h"
#include "stock/state_bytes.h"

namespace kerf {
namespace {

/// Beyond it, units do not fit into 64 bits.
constexpr double kMaxPunchCoordinate_mm = 1e13;

/// Moves whose number nobody knows: as many as a full sheet has.
constexpr std::size_t kUsualMoves = 12000;
/// Best for few and for many moves (bench_sheet): tiles cost little while they are whole, and an
/// operation costs what the corners in its tile do.
constexpr double kTilesPerMove = 0.35;
constexpr double kMinTiles = 64, kMaxTiles = sheet::SheetGrid::kMaxTilesEachWay;
/// Narrower tiles are crossed by every move.
constexpr double kMinTileEdge_mm = 5;

struct Tiling {
  int columns = 1, rows = 1;
};

Tiling tiling_for(const SheetOptions& options, const sheet::Rect& box) {
  if (options.tiles_each_way > 0) return {options.tiles_each_way, options.tiles_each_way};
  const std::size_t moves = options.expected_moves > 0 ? options.expected_moves : kUsualMoves;
  const double tiles = std::clamp(kTilesPerMove * static_cast<double>(moves), kMinTiles, kMaxTiles);
  const double edge =
      std::max(std::sqrt(sheet::width_mm(box) * sheet::height_mm(box) / tiles), kMinTileEdge_mm);
  const auto count = [edge](double length) {
    return static_cast<int>(std::clamp(std::round(length / edge), 1.0, kMaxTiles));
  };
  return {count(sheet::width_mm(box)), count(sheet::height_mm(box))};
}

/// Rings that wind once round what the even-odd rings enclose.
sheet::Rings oriented(sheet::Rings rings) {
  if (rings.size() == 1) {
    if (sheet::twice_area(rings[0]) < 0) std::reverse(rings[0].begin(), rings[0].end());
    return rings;
  }
  ClipperLib::Clipper clipper;
  clipper.AddPaths(rings, ClipperLib::ptSubject, true);
  sheet::Rings united;
  clipper.Execute(ClipperLib::ctUnion, united, ClipperLib::pftEvenOdd, ClipperLib::pftEvenOdd);
  return united;
}

PlaneOutline to_outline(const sheet::Rings& rings) {
  PlaneOutline outline;
  for (const sheet::Ring& ring : rings) {
    std::vector<Vec2>& points = outline.rings.emplace_back();
    for (const sheet::Point& p : ring) points.push_back(sheet::to_mm(p));
  }
  return outline;
}

Done check_range(std::string_view name, double value, double low, double high) {
  if (value >= low && value <= high) return std::monostate{};
  return Error{trf("{}: {} is not allowed; must be from {} to {} (mm)", name, number_text(value),
                   number_text(low), number_text(high))};
}

}  // namespace

struct Sheet::Impl {
  explicit Impl(sheet::SavedSheet sheet)
      : grid(std::move(sheet.grid)),
        labels(std::move(sheet.labels)),
        origins(std::make_shared<const sheet::PieceOrigins>(std::move(sheet.origins))),
        bottom_mm(sheet.bottom_mm),
        top_mm(sheet.top_mm),
        tolerance_mm(sheet.arc_tolerance_mm),
        blank_area2(sheet.blank_area2) {}

  CutReport subtract(const sheet::Kerf& kerf, std::uint64_t id) {
    const std::int64_t before = grid.area2();
    changes.clear();
    grid.subtract(kerf, changes);
    CutReport report;
    report.id = id;
    if (changes.empty()) return report;
    labels.update(grid, changes, id);
    changes.clear();  // lets go of the tiles as they were
    report.removed_mm3 = sheet::twice_area_to_mm2(before - grid.area2()) * (top_mm - bottom_mm);
    report.depth_mm = top_mm - bottom_mm;
    return report;
  }

  sheet::SheetGrid grid;
  sheet::PieceLabels labels;
  std::shared_ptr<const sheet::PieceOrigins> origins;  // of pieces that were free when loaded
  double bottom_mm, top_mm, tolerance_mm;
  std::int64_t blank_area2;
  sheet::CircleTables tables;
  std::vector<sheet::TileChange> changes;
  std::vector<std::uint64_t> seen_versions;  // by take_dirty_tiles()
};

Result<std::unique_ptr<Sheet>> Sheet::create(const SheetOptions& options) {
  for (const Done& done : {check_range(tr("sheet: bottom"), options.bottom_mm,
                                       -sheet::kMaxCoordinate_mm, sheet::kMaxCoordinate_mm),
                           check_range(tr("sheet: thickness"), options.top_mm - options.bottom_mm,
                                       sheet::kMinThickness_mm, sheet::kMaxThickness_mm),
                           check_range(tr("sheet: arc tolerance"), options.arc_tolerance_mm,
                                       sheet::kMinTolerance_mm, sheet::kMaxTolerance_mm),
                           check_outline(options.outline)}) {
    if (!done) return Error{done.error()};
  }
  const sheet::Rings rings = oriented(sheet::to_rings(options.outline.rings));
  sheet::Rect box;
  for (const sheet::Ring& ring : rings) box.extend(sheet::bounds_of(ring));
  const Tiling tiling = tiling_for(options, box);
  sheet::SheetGrid grid(rings, tiling.columns, tiling.rows);
  const std::int64_t area2 = grid.area2();
  sheet::PieceLabels labels(grid);
  sheet::SavedSheet uncut{std::move(grid), std::move(labels),        {},   options.bottom_mm,
                          options.top_mm,  options.arc_tolerance_mm, area2};
  return std::unique_ptr<Sheet>(new Sheet(std::make_unique<Impl>(std::move(uncut))));
}

Done Sheet::save(const std::string& path,
                 const std::map<std::uint32_t, PieceOrigin>& origins) const {
  const Impl& m = *impl_;
  sheet::PieceOrigins all = origins;
  all.insert(m.origins->begin(), m.origins->end());
  return sheet::write_sheet(path, {m.grid, m.labels, std::move(all), m.bottom_mm, m.top_mm,
                                   m.tolerance_mm, m.blank_area2});
}

Result<std::unique_ptr<Sheet>> Sheet::load(const std::string& path) {
  const Result<std::string> bytes = read_state_bytes(path);
  if (!bytes) return Error{bytes.error()};
  Result<sheet::SavedSheet> saved = sheet::parse_sheet(*bytes, path);
  if (!saved) return Error{saved.error()};
  return std::unique_ptr<Sheet>(new Sheet(std::make_unique<Impl>(std::move(*saved))));
}

Sheet::Sheet(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Sheet::~Sheet() = default;

void Sheet::cut(const Cutter& cutter, std::span<const CutMove> moves,
                std::vector<CutReport>& reports) {
  if (cutter.footprint() != nullptr) return strike(cutter, moves, reports);
  for (const CutMove& move : moves) {
    if (!within_reach(move, bounds_mm())) {
      reports.push_back({move.id, 0, 0});
      continue;
    }
    const sheet::Kerf kerf =
        sheet::kerf_of_move(move, cutter.radius_mm(), impl_->tolerance_mm, impl_->tables);
    reports.push_back(impl_->subtract(kerf, move.id));
  }
}

/// Strokes of one id are one operation.
void Sheet::strike(const Cutter& punch, std::span<const CutMove> strokes,
                   std::vector<CutReport>& reports) {
  for (std::size_t first = 0, next = 0; first < strokes.size(); first = next) {
    const std::uint64_t id = strokes[first].id;
    next = first + 1;
    while (next < strokes.size() && next - first < sheet::kMostStrokes && strokes[next].id == id) {
      ++next;
    }
    const std::span<const CutMove> together = strokes.subspan(first, next - first);
    reports.push_back(impl_->subtract(sheet::kerf_of_strokes(punch, together), id));
    for (std::size_t i = first + 1; i < next; ++i) reports.push_back({id, 0, 0});
  }
}

void Sheet::finish(std::vector<CutReport>&) {}

CutReport Sheet::punch(const PlaneOutline& shape, const Vec2& position_mm, double angle_rad,
                       std::uint64_t id) {
  const double sum = std::abs(position_mm.x) + std::abs(position_mm.y) + std::abs(angle_rad);
  if (!(sum < kMaxPunchCoordinate_mm)) return {id, 0, 0};
  const double cosine = portable::cos(angle_rad), sine = portable::sin(angle_rad);
  sheet::Kerf kerf;
  std::vector<std::vector<Vec2>> placed = shape.rings;
  for (std::vector<Vec2>& ring : placed) {
    for (Vec2& p : ring)
      p = position_mm + Vec2(cosine * p.x - sine * p.y, sine * p.x + cosine * p.y);
  }
  kerf.rings = oriented(sheet::to_rings(placed));
  for (const sheet::Ring& ring : kerf.rings) kerf.box.extend(sheet::bounds_of(ring));
  return impl_->subtract(kerf, id);
}

std::optional<Contact> Sheet::first_contact(const Cutter& cutter, const CutMove& move,
                                            double tolerance_mm) const {
  const std::vector<Vec2> way = sheet::chords_of_move(move, impl_->tolerance_mm);
  for (const Vec2& p : way) {
    if (!(std::abs(p.x) + std::abs(p.y) < kMaxPunchCoordinate_mm)) return std::nullopt;
  }
  const double radius = std::max(cutter.radius_mm() - tolerance_mm, 0.0);
  const std::optional<double> share = sheet::first_meeting(impl_->grid, way, radius);
  if (!share) return std::nullopt;
  const double chords = static_cast<double>(way.size() - 1);
  const double at = std::min(*share * chords, chords);
  const auto chord = std::min(static_cast<std::size_t>(at), way.size() - 2);
  const Vec2 tip = way[chord] + (at - static_cast<double>(chord)) * (way[chord + 1] - way[chord]);
  const double z = move.from_mm.z + *share * (move.to_mm.z - move.from_mm.z);
  return Contact{Vec3(tip, z), thickness_mm()};
}

bool Sheet::has_material(const Vec2& point_mm) const {
  if (!(std::abs(point_mm.x) + std::abs(point_mm.y) < kMaxPunchCoordinate_mm)) return false;
  return sheet::holds_material(impl_->grid, sheet::to_units(point_mm));
}

std::optional<std::uint32_t> Sheet::piece_at(const Vec2& point_mm) const {
  if (!(std::abs(point_mm.x) + std::abs(point_mm.y) < kMaxPunchCoordinate_mm)) return std::nullopt;
  const std::uint32_t index = sheet::piece_under(impl_->grid, sheet::to_units(point_mm));
  if (index == sheet::kNoPiece) return std::nullopt;
  return impl_->labels.records()[index].number;
}

std::vector<SheetPiece> Sheet::pieces() const {
  const std::vector<sheet::PieceRecord>& records = impl_->labels.records();
  std::vector<std::int64_t> area2(records.size(), 0);
  std::vector<sheet::Rect> boxes(records.size());
  for (std::size_t t = 0; t < impl_->grid.tile_count(); ++t) {
    const sheet::Tile& tile = impl_->grid.tile(t);
    const std::vector<std::uint32_t> owner = sheet::owners(tile);
    for (std::size_t i = 0; i < tile.rings.size(); ++i) {
      const std::uint32_t piece = tile.pieces[owner[i]];
      area2[piece] += tile.rings[i]->area2;
      if (tile.rings[i]->is_outer()) boxes[piece].extend(tile.rings[i]->box);
    }
  }
  std::vector<SheetPiece> pieces;
  for (std::uint32_t i = 0; i < records.size(); ++i) {
    if (boxes[i].empty()) continue;
    SheetPiece& piece = pieces.emplace_back();
    piece.number = records[i].number;
    piece.freed_by = records[i].freed_by;
    piece.area_mm2 = sheet::twice_area_to_mm2(area2[i]);
    piece.min_mm = {sheet::to_mm(boxes[i].min_x), sheet::to_mm(boxes[i].min_y)};
    piece.max_mm = {sheet::to_mm(boxes[i].max_x), sheet::to_mm(boxes[i].max_y)};
    piece.volume_mm3 = piece.area_mm2 * thickness_mm();
    if (const auto origin = impl_->origins->find(piece.number); origin != impl_->origins->end())
      piece.origin = origin->second;
  }
  std::sort(pieces.begin(), pieces.end(),
            [](const SheetPiece& a, const SheetPiece& b) { return a.number < b.number; });
  return pieces;
}

std::size_t Sheet::piece_numbers() const { return impl_->labels.records().size(); }
std::size_t Sheet::blank_piece_numbers() const { return impl_->labels.blank_pieces(); }

PlaneOutline Sheet::outline_of(std::uint32_t piece) const {
  const std::vector<sheet::PieceRecord>& records = impl_->labels.records();
  for (std::uint32_t i = 0; i < records.size(); ++i) {
    if (records[i].number == piece) return to_outline(sheet::outline_of(impl_->grid, i));
  }
  return {};
}

PlaneOutline Sheet::outline() const {
  return to_outline(sheet::outline_of(impl_->grid, sheet::kNoPiece));
}

std::unique_ptr<StockModel> Sheet::snapshot() const {
  return std::unique_ptr<Sheet>(new Sheet(std::make_unique<Impl>(*impl_)));
}

std::size_t Sheet::unique_bytes() const {
  std::size_t bytes = 0;
  for (std::size_t t = 0; t < impl_->grid.tile_count(); ++t) {
    if (impl_->grid.is_shared(t)) continue;
    const sheet::Tile& tile = impl_->grid.tile(t);
    bytes += sizeof tile + tile.runs.capacity() * sizeof(sheet::BorderRun);
    for (const sheet::TileRingPointer& ring : tile.rings) {
      bytes += sizeof ring + sizeof(std::uint32_t);
      if (ring.use_count() == 1)
        bytes += sizeof *ring + ring->points.capacity() * sizeof(sheet::Point);
    }
  }
  return bytes;
}

Done Sheet::accepts(const Cutter& cutter) const {
  const double kerf_mm = 2 * cutter.radius_mm();
  if (kerf_mm >= kMinKerf_mm) return std::monostate{};
  return Error{trf("{}: a kerf of {} mm is not allowed; must be at least {} mm", cutter.spec(),
                   number_text(kerf_mm), number_text(kMinKerf_mm))};
}

Box Sheet::bounds_mm() const {
  const sheet::Rect& box = impl_->grid.bounds();
  return {{sheet::to_mm(box.min_x), sheet::to_mm(box.min_y), impl_->bottom_mm},
          {sheet::to_mm(box.max_x), sheet::to_mm(box.max_y), impl_->top_mm}};
}

double Sheet::cell_mm() const { return 1 / sheet::kUnitsPerMm; }
std::size_t Sheet::cell_count() const { return impl_->grid.corner_count(); }
double Sheet::thickness_mm() const { return impl_->top_mm - impl_->bottom_mm; }
double Sheet::arc_tolerance_mm() const { return impl_->tolerance_mm; }
double Sheet::blank_mm3() const {
  return sheet::twice_area_to_mm2(impl_->blank_area2) * thickness_mm();
}
double Sheet::remaining_mm2() const { return sheet::twice_area_to_mm2(impl_->grid.area2()); }
double Sheet::remaining_mm3() const { return remaining_mm2() * thickness_mm(); }

std::string Sheet::digest() const {
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  const sheet::Rect& box = impl_->grid.bounds();
  const std::int64_t frame[4] = {box.min_x, box.min_y, box.max_x, box.max_y};
  const double heights[2] = {impl_->bottom_mm + 0.0, impl_->top_mm + 0.0};  // -0 is 0
  XXH3_128bits_update(&state, frame, sizeof frame);
  XXH3_128bits_update(&state, heights, sizeof heights);
  for (std::size_t t = 0; t < impl_->grid.tile_count(); ++t) {
    for (const sheet::TileRingPointer& ring : impl_->grid.tile(t).rings) {
      const std::uint64_t place[2] = {t, ring->points.size()};
      XXH3_128bits_update(&state, place, sizeof place);
      XXH3_128bits_update(&state, ring->points.data(), ring->points.size() * sizeof(sheet::Point));
    }
  }
  const XXH128_hash_t hash = XXH3_128bits_digest(&state);
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

TriangleMesh Sheet::mesh(double) const {
  return sheet::extrude(impl_->grid, impl_->bottom_mm, impl_->top_mm);
}

std::size_t Sheet::tile_count() const { return impl_->grid.tile_count(); }

Box Sheet::tile_box(std::uint32_t tile) const {
  const sheet::Rect rect = impl_->grid.tile_rect(tile);
  return {{sheet::to_mm(rect.min_x), sheet::to_mm(rect.min_y), impl_->bottom_mm},
          {sheet::to_mm(rect.max_x), sheet::to_mm(rect.max_y), impl_->top_mm}};
}

std::vector<std::uint32_t> Sheet::take_dirty_tiles() {
  std::vector<std::uint64_t>& seen = impl_->seen_versions;
  seen.resize(tile_count(), 0);  // no tile has version 0
  std::vector<std::uint32_t> dirty;
  for (std::uint32_t t = 0; t < seen.size(); ++t) {
    const std::uint64_t version = impl_->grid.tile(t).version;
    if (seen[t] != version) dirty.push_back(t);
    seen[t] = version;
  }
  return dirty;
}

std::vector<std::uint32_t> Sheet::differing_tiles(const StockModel& other) const {
  const auto* const sheet = dynamic_cast<const Sheet*>(&other);
  const bool comparable = sheet != nullptr && sheet->bounds_mm() == bounds_mm() &&
                          sheet->impl_->grid.columns() == impl_->grid.columns() &&
                          sheet->impl_->grid.rows() == impl_->grid.rows();
  std::vector<std::uint32_t> differing;
  for (std::uint32_t t = 0; t < tile_count(); ++t) {
    if (comparable) {
      const sheet::Tile &mine = impl_->grid.tile(t), &theirs = sheet->impl_->grid.tile(t);
      if (mine.version == theirs.version) continue;
      const bool equal =
          std::equal(mine.rings.begin(), mine.rings.end(), theirs.rings.begin(), theirs.rings.end(),
                     [](const sheet::TileRingPointer& a, const sheet::TileRingPointer& b) {
                       return a->points == b->points;
                     });
      if (equal) continue;
    }
    differing.push_back(t);
  }
  return differing;
}

std::uint64_t Sheet::patch_version(std::uint32_t tile) const {
  std::array<std::uint64_t, 5> versions{impl_->grid.tile(tile).version};
  for (std::size_t side = 0; side < 4; ++side) {
    const std::int64_t next = impl_->grid.neighbour(tile, static_cast<sheet::BorderSide>(side));
    if (next >= 0) versions[side + 1] = impl_->grid.tile(static_cast<std::size_t>(next)).version;
  }
  return XXH3_64bits(versions.data(), sizeof versions);
}

MeshPatch Sheet::patch(std::uint32_t tile, int level) const {
  MeshPatch patch = sheet::extrude_tile(impl_->grid, tile, impl_->bottom_mm, impl_->top_mm);
  patch.version = patch_version(tile);
  patch.level = level;
  return patch;
}

std::uint64_t Sheet::operations() const { return impl_->grid.operations(); }

}  // namespace kerf
