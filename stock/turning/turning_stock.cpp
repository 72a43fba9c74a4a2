#include "stock/turning/turning_stock.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/portable_math.h"
#include "base/translate.h"
#include "stock/cutter/insert_shape.h"
#include "stock/state_bytes.h"
#include "stock/turning/revolve.h"
#include "stock/turning/tap.h"
#include "stock/turning/turning_state.h"

namespace kerf {
namespace {

/// Of a tool that stands still along the axis: what its shank does beyond is not looked at.
constexpr double kAxialLength_mm = 200;

Vec2 in_plane(const Vec3& p) { return {p.z, p.x}; }

Vec3 rotated(const Vec3& v, const Vec3& axis, double angle) {
  const double c = portable::cos(angle), s = portable::sin(angle);
  return c * v + s * glm::cross(axis, v) + (1 - c) * glm::dot(axis, v) * axis;
}

/// An arc that is none in the plane, in straight ways.
void append_chords(const CutMove& move, std::vector<TurnMove>& moves) {
  const CutArc& arc = *move.arc;
  const Vec3 from = move.from_mm - arc.center_mm, to = move.to_mm - arc.center_mm;
  const double low = glm::dot(from, arc.axis), high = glm::dot(to, arc.axis);
  const Vec3 across = from - low * arc.axis;
  const double r0 = glm::length(across), r1 = glm::length(to - high * arc.axis);
  const std::optional<turning::ArcSteps> steps =
      turning::way_steps(std::max(r0, r1), arc.sweep_rad);
  if (!steps) return;
  Vec2 at = in_plane(move.from_mm);
  for (int i = 0; i < steps->count && r0 > 0; ++i) {
    const double t = (i + 0.5) / steps->count;
    const double radius = (r0 + t * (r1 - r0)) * steps->outward;
    const Vec3 p = arc.center_mm + radius / r0 * rotated(across, arc.axis, t * arc.sweep_rad) +
                   (low + t * (high - low)) * arc.axis;
    moves.push_back({at, in_plane(p), std::nullopt, move.id});
    at = in_plane(p);
  }
  moves.push_back({at, in_plane(move.to_mm), std::nullopt, move.id});
}

/// Of a model that has no skirts.
void append(MeshPatch& patch, const MeshPatch& other) {
  const auto first = static_cast<std::uint32_t>(patch.vertices.size());
  patch.vertices.insert(patch.vertices.end(), other.vertices.begin(), other.vertices.end());
  patch.cut_by.insert(patch.cut_by.end(), other.cut_by.begin(), other.cut_by.end());
  patch.indices.reserve(patch.indices.size() + other.indices.size());
  for (const std::uint32_t index : other.indices) patch.indices.push_back(first + index);
  patch.skirt_begin = static_cast<std::uint32_t>(patch.indices.size());
}

/// What a tool on the axis leaves is the same whatever the lead, but for a tap's.
std::vector<TurnMove> moves_of(const Cutter& cutter, const CutMove& move) {
  std::vector<TurnMove> moves = turning_moves(move);
  if (cutter.insert() == nullptr) {
    for (TurnMove& turn : moves) turn.lead_mm = 0;
  }
  return moves;
}

}  // namespace

std::shared_ptr<const InsertOutline> turning_outline(const Cutter& cutter) {
  if (cutter.insert() != nullptr) return cutter.insert();
  std::optional<InsertOutline> axial = axial_outline(cutter, kAxialLength_mm);
  return axial ? std::make_shared<const InsertOutline>(std::move(*axial)) : nullptr;
}

std::vector<TurnMove> turning_moves(const CutMove& move) {
  TurnMove turn{in_plane(move.from_mm), in_plane(move.to_mm), std::nullopt, move.id};
  if (!move.arc) {
    turn.lead_mm = move.lead_mm;
    return {turn};
  }
  const CutArc& arc = *move.arc;
  if (std::abs(arc.axis.y) == 1) {
    turn.arc = TurnArc{in_plane(arc.center_mm), arc.axis.y * arc.sweep_rad};
    return {turn};
  }
  std::vector<TurnMove> moves;
  append_chords(move, moves);
  return moves;
}

TurningStock::TurningStock(TurnedPart part) : part_(std::move(part)) {}

const TurningTool& TurningStock::tool_of(const Cutter& cutter) const {
  // Of a cutter without one the outline is made each time: calls take many moves.
  const auto is_of = [&](const Ready& ready) {
    return ready.tool && cutter.insert() != nullptr && cutter.insert() == ready.outline;
  };
  if (!is_of(ready_)) {
    std::swap(ready_, ready_before_);
    if (is_of(ready_)) return *ready_.tool;
    ready_ = {};
    ready_.outline = turning_outline(cutter);
    ready_.tool.emplace(*ready_.outline);
  }
  return *ready_.tool;
}

void TurningStock::cut(const Cutter& cutter, std::span<const CutMove> moves,
                       std::vector<CutReport>& reports) {
  last_cuts_.clear();
  const TurningTool& tool = tool_of(cutter);
  for (const CutMove& move : moves) {
    TurnCut& whole = last_cuts_.emplace_back();
    whole.id = move.id;
    if (!cut_by_tap(cutter, move, whole))
      for (const TurnMove& turn : moves_of(cutter, move)) whole.extend(part_.cut(tool, turn));
    CutReport report;
    report.id = move.id;
    report.removed_mm3 = whole.removed_mm3;
    report.depth_mm = whole.depth_mm;
    reports.push_back(report);
  }
}

/// A tool on the axis that goes in step with the workpiece is a tap. False: it is none.
bool TurningStock::cut_by_tap(const Cutter& cutter, const CutMove& move, TurnCut& whole) {
  if (cutter.insert() != nullptr) return false;
  TurnMove turn = turning_moves(move).front();
  const bool is_axial = turn.from_mm.y == 0 && turn.to_mm.y == 0;
  if (!turn.winds() || !is_axial) return false;
  const std::optional<TapTools> tap =
      tap_tools(2 * cutter.radius_mm(), std::abs(turn.lead_mm), kAxialLength_mm);
  if (!tap) return false;
  TurnMove straight = turn;
  straight.lead_mm = 0;
  whole.extend(part_.cut(tap->core, straight));
  // On the way out it runs in the thread that it has cut.
  if (turn.to_mm.x < turn.from_mm.x) {
    whole.extend(part_.cut(tap->groove, turn));
    part_.turn_back();
  }
  return true;
}

void TurningStock::finish(std::vector<CutReport>&) {}

std::optional<TurnContact> TurningStock::first_turn_contact(const Cutter& cutter,
                                                            const CutMove& move,
                                                            double tolerance_mm) const {
  const TurningTool& tool = tool_of(cutter);
  if (ready_.inset_mm != tolerance_mm) {
    ready_.inset = tool.inset(tolerance_mm);
    ready_.inset_mm = tolerance_mm;
  }
  std::optional<TurnContact> first;
  const std::vector<TurnMove> turns = moves_of(cutter, move);
  for (std::size_t i = 0; i < turns.size(); ++i) {
    std::optional<TurnContact> met = part_.first_contact(*ready_.inset, turns[i]);
    if (!met) continue;
    met->depth_mm += tolerance_mm;
    if (!first) {
      first = met;
      first->t = (static_cast<double>(i) + met->t) / static_cast<double>(turns.size());
      continue;
    }
    first->depth_mm = std::max(first->depth_mm, met->depth_mm);
    for (std::size_t side = 0; side < kInsertSides; ++side)
      first->side_mm[side] = std::max(first->side_mm[side], met->side_mm[side]);
  }
  return first;
}

std::optional<Contact> TurningStock::first_contact(const Cutter& cutter, const CutMove& move,
                                                   double tolerance_mm) const {
  const std::optional<TurnContact> met = first_turn_contact(cutter, move, tolerance_mm);
  if (!met) return std::nullopt;
  return Contact{Vec3(met->at_mm.y, move.from_mm.y, met->at_mm.x), met->depth_mm};
}

std::optional<std::uint32_t> TurningStock::cut_id_at(const Vec3& point_mm) const {
  /// As near as patches of the coarsest level are to the part: what is nearest counts.
  constexpr double kNear_mm = 3 * TurnedPart::kCoarsestPatch_mm;
  constexpr double kStep_rad = 2 * kPi / turning::kPatchSegments;
  const double angle = portable::atan2(point_mm.y, point_mm.x) / kStep_rad;
  const double off_rad = (angle - std::floor(angle) - 0.5) * kStep_rad;
  const double on_facet = portable::hypot(point_mm.x, point_mm.y);
  const double r = on_facet * portable::cos(off_rad) / portable::cos(kStep_rad / 2);
  return part_.cut_id_at({point_mm.z, r}, portable::atan2(point_mm.y, point_mm.x), kNear_mm);
}

Done TurningStock::save(const std::string& path) const {
  return turning::write_part(path, part_.saved());
}

Result<std::unique_ptr<TurningStock>> TurningStock::load(const std::string& path) {
  const Result<std::string> bytes = read_state_bytes(path);
  if (!bytes) return Error{bytes.error()};
  Result<turning::SavedPart> saved = turning::parse_part(*bytes, path);
  if (!saved) return Error{saved.error()};
  return std::make_unique<TurningStock>(TurnedPart::restored(std::move(saved.value())));
}

std::unique_ptr<StockModel> TurningStock::snapshot() const {
  auto copy = std::make_unique<TurningStock>(part_);
  return copy;
}

std::size_t TurningStock::unique_bytes() const { return part_.unique_bytes(); }

Done TurningStock::can_cut(const Cutter& cutter) {
  if (turning_outline(cutter) != nullptr) return std::monostate{};
  return Error{
      trf("{}: cannot be cut with on a lathe; a tool that stands still has no hollow arcs "
          "and is at most {} mm long",
          cutter.spec(), kAxialLength_mm)};
}

Box TurningStock::bounds_mm() const { return part_.bounds_mm(); }
double TurningStock::cell_mm() const { return 1 / turning::kUnitsPerMm; }
std::size_t TurningStock::cell_count() const { return part_.corner_count(); }
double TurningStock::blank_mm3() const { return part_.blank_mm3(); }
double TurningStock::remaining_mm3() const { return part_.remaining_mm3(); }
std::string TurningStock::digest() const { return part_.digest(); }
TriangleMesh TurningStock::mesh(double tolerance_mm) const { return part_.mesh(tolerance_mm); }

Box TurningStock::tile_box(std::uint32_t tile) const {
  Box box = part_.bounds_mm();
  box.min.z = part_.band_low_z_mm(tile);
  box.max.z = part_.band_low_z_mm(tile + 1);
  return box;
}

std::vector<std::uint32_t> TurningStock::take_dirty_tiles() {
  seen_versions_.resize(tile_count(), 0);  // no band has version 0
  std::vector<std::uint32_t> dirty;
  for (std::uint32_t t = 0; t < tile_count(); ++t) {
    if (seen_versions_[t] != part_.band_version(t)) dirty.push_back(t);
    seen_versions_[t] = part_.band_version(t);
  }
  return dirty;
}

std::vector<std::uint32_t> TurningStock::differing_tiles(const StockModel& other) const {
  const auto* const turned = dynamic_cast<const TurningStock*>(&other);
  const bool comparable = turned != nullptr && turned->bounds_mm() == bounds_mm();
  std::vector<std::uint32_t> differing;
  for (std::uint32_t t = 0; t < tile_count(); ++t) {
    if (!comparable || turned->part_.band_version(t) != part_.band_version(t))
      differing.push_back(t);
  }
  return differing;
}

std::uint64_t TurningStock::patch_version(std::uint32_t tile) const {
  return part_.band_version(tile);
}

MeshPatch TurningStock::patch(std::uint32_t tile, int level) const {
  MeshPatch patch = part_.patch(tile, level);
  if (!part_.freed().empty() && part_.freed().back().part) {
    append(patch, part_.freed().back().part->patch(tile, level));
  }
  return patch;
}

}  // namespace kerf
