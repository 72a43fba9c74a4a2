#include "stock/millturn/mill_turn.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "base/translate.h"
#include "stock/turning/turning_state.h"

namespace kerf {
namespace {

octree::RevolvedBody body_of(const TurnedPart& part) {
  octree::RevolvedBody body;
  body.chains_mm = part.profile();
  if (part.flats()) {
    body.flats = part.flats()->count;
    body.inner_radius_mm = part.flats()->inner_radius_mm;
  }
  return body;
}

/// The part stays at least so far from the box; 0: it may not. Of a tool that keeps its direction.
double box_spare_mm(const Box& box, const CarriedPart& part, const CutMove& move) {
  if (move.axis_from != move.axis_to) return 0;
  double around_mm = part.radius_mm;
  if (move.arc) {
    around_mm += 2 * std::max(glm::distance(move.from_mm, move.arc->center_mm),
                              glm::distance(move.to_mm, move.arc->center_mm));
  }
  const double reach_mm = glm::distance(move.from_mm, box.min) + glm::length(box.size());
  Box way;
  for (const Vec3& tip : {move.from_mm, move.to_mm})
    for (const double along : {part.from_z_mm, std::min(part.to_z_mm, part.from_z_mm + reach_mm)})
      way.extend(tip + along * move.axis_from);
  double apart_mm = 0;
  for (int axis = 0; axis < 3; ++axis) {
    apart_mm = std::max({apart_mm, way.min[axis] - around_mm - box.max[axis],
                         box.min[axis] - way.max[axis] - around_mm});
  }
  return apart_mm;
}

}  // namespace

MillTurn::MillTurn(TurningStock turned, const MillTurnOptions& options)
    : turned_(std::move(turned)), options_(options) {}
MillTurn::~MillTurn() = default;

Result<std::unique_ptr<MillTurn>> MillTurn::create(TurningStock turned,
                                                   const MillTurnOptions& options) {
  auto stock = std::unique_ptr<MillTurn>(new MillTurn(std::move(turned), options));
  // So that nothing can be wrong with it once it is needed. A box costs next to nothing.
  if (const auto tried = stock->box_tree(); !tried) return Error{tried.error()};
  return stock;
}

Result<std::unique_ptr<Octree>> MillTurn::box_tree() const {
  OctreeOptions options;
  BlankBody box;
  box.bounds_mm = turned_.bounds_mm();
  options.blank.bodies.push_back(box);
  options.cell_mm = options_.cell_mm;
  options.threads = options_.threads;
  options.kernel = options_.kernel;
  options.memory_limit_bytes = options_.memory_limit_bytes;
  return Octree::create(options);
}

std::vector<std::uint64_t> MillTurn::bands() const {
  std::vector<std::uint64_t> versions(TurnedPart::kBands);
  for (std::size_t band = 0; band < versions.size(); ++band)
    versions[band] = turned_.part().band_version(band);
  return versions;
}

/// The workpiece as it is turned, as an octree.
std::unique_ptr<MillTurn::Milled> MillTurn::begun() const {
  Result<std::unique_ptr<Octree>> box = box_tree();
  assert(box);  // create() has tried it
  auto milled = std::make_unique<Milled>();
  milled->tree = std::move(box.value());
  milled->tree->keep_cut_ids(keeps_cut_ids());
  follow_profile(*milled);
  milled->beside_mm3 = turned_.remaining_mm3() + threads_mm3() - milled->tree->remaining_mm3();
  return milled;
}

std::unique_ptr<MillTurn::Milled> MillTurn::copy_of(const Milled& milled) const {
  auto copy = std::make_unique<Milled>();
  copy->tree.reset(static_cast<Octree*>(milled.tree->snapshot().release()));
  copy->bands = milled.bands;
  copy->beside_mm3 = milled.beside_mm3;
  return copy;
}

void MillTurn::follow_profile(Milled& milled) const {
  std::vector<std::uint64_t> now = bands();
  if (now == milled.bands) return;
  const TurnedPart& part = turned_.part();
  octree::ZRange range{std::numeric_limits<double>::infinity(),
                       -std::numeric_limits<double>::infinity()};
  for (std::size_t band = 0; band < now.size(); ++band) {
    if (band < milled.bands.size() && milled.bands[band] == now[band]) continue;
    range.low_mm = std::min(range.low_mm, part.band_low_z_mm(band));
    range.high_mm = std::max(range.high_mm, part.band_low_z_mm(band + 1));
  }
  milled.tree->keep_within(body_of(part), range);
  milled.bands = std::move(now);
}

const MillTurn::Milled& MillTurn::shown() const {
  std::vector<std::uint64_t> now = bands();
  if (milled_ && milled_->bands == now) return *milled_;
  if (!shown_ || shown_->bands != now) {
    shown_ = milled_ ? copy_of(*milled_) : begun();
    follow_profile(*shown_);
  }
  return *shown_;
}

void MillTurn::cut(const Cutter& cutter, std::span<const CutMove> moves,
                   std::vector<CutReport>& reports) {
  if (!cutter.live()) {
    turned_.cut(cutter, moves, reports);
    return;
  }
  if (moves.empty()) return;
  if (milled_) {
    follow_profile(*milled_);
    shown_.reset();
    milled_->tree->cut(cutter, moves, reports);
    return;
  }
  shown();  // as it is now: what is milled becomes that
  const std::unique_ptr<StockModel> before = shown_->tree->snapshot();
  shown_->tree->cut(cutter, moves, reports);
  if (shown_->tree->differing_tiles(*before).empty()) return;  // they went through the air
  milled_ = std::move(shown_);
}

std::optional<Contact> MillTurn::first_contact(const Cutter& cutter, const CutMove& move,
                                               double tolerance_mm) const {
  return cutter.live() ? tree().first_contact(cutter, move, tolerance_mm)
                       : turned_.first_contact(cutter, move, tolerance_mm);
}

std::optional<WayContact> MillTurn::first_contact_of(const Cutter& cutter,
                                                     std::span<const CutMove> moves,
                                                     double tolerance_mm,
                                                     const WayWatch& watch) const {
  return cutter.live() ? tree().first_contact_of(cutter, moves, tolerance_mm, watch)
                       : kerf::first_contact_of(turned_, cutter, moves, tolerance_mm, watch);
}

double MillTurn::part_spare_mm(const CarriedPart& part, const CutMove& move, double enough_mm,
                               double most_mm) const {
  // An octree is made only for who comes near.
  const double apart_mm = box_spare_mm(bounds_mm(), part, move);
  if (apart_mm > enough_mm) return std::min(apart_mm, most_mm);
  return tree().part_spare_mm(part, move, enough_mm, most_mm);
}

std::optional<PartContact> MillTurn::part_contact(const Cutter& cutter, const CarriedPart& part,
                                                  const CutMove& move, double tolerance_mm) const {
  return tree().part_contact(cutter, part, move, tolerance_mm);
}

std::optional<PartGap> MillTurn::part_gap(const Cutter& cutter, const CarriedPart& part,
                                          const CutMove& move, double below_mm) const {
  return tree().part_gap(cutter, part, move, below_mm);
}

std::unique_ptr<StockModel> MillTurn::snapshot() const {
  auto copy = std::unique_ptr<MillTurn>(new MillTurn(TurningStock(turned_.part()), options_));
  copy->options_.threads = 1;
  if (!milled_) return copy;
  copy->milled_ = copy_of(*milled_);
  // Whoever looks at the copy may do so on several threads.
  const Milled& now = shown();
  if (&now != milled_.get()) copy->shown_ = copy_of(now);
  return copy;
}

std::size_t MillTurn::unique_bytes() const {
  std::size_t bytes = turned_.unique_bytes();
  for (const auto* part : {milled_.get(), shown_.get()})
    if (part) bytes += part->tree->unique_bytes();
  return bytes;
}

void MillTurn::keep_cut_ids(bool keep) {
  turned_.keep_cut_ids(keep);
  shown_.reset();
  if (milled_) milled_->tree->keep_cut_ids(keep);
}

std::optional<std::uint32_t> MillTurn::cut_id_at(const Vec3& point_mm) const {
  const auto milled = milled_ ? tree().cut_id_at(point_mm) : std::nullopt;
  return milled ? milled : turned_.cut_id_at(point_mm);
}

/// Beside the octree: Milled::beside_mm3, a double, and the turned part's file.
Done MillTurn::save(const std::string& path) const {
  if (!milled_) return turned_.save(path);
  std::string beside(sizeof(double), '\0');
  std::memcpy(beside.data(), &milled_->beside_mm3, sizeof(double));
  return tree().save_with(path, beside + turning::bytes_of_part(turned_.part().saved()));
}

std::unique_ptr<Octree> MillTurn::as_octree() const {
  return std::unique_ptr<Octree>(static_cast<Octree*>(tree().snapshot().release()));
}

Result<std::unique_ptr<MillTurn>> MillTurn::load(const std::string& path,
                                                 const MillTurnOptions& options) {
  std::string beside;
  Result<std::unique_ptr<Octree>> tree =
      Octree::load_with(path, options.threads, options.kernel, beside);
  if (!tree) return Error{tree.error()};
  if (beside.empty()) {
    return Error{trf("{}: nothing in it says how it was turned: a mill has saved it", path)};
  }
  if (beside.size() < sizeof(double)) return Error{trf("{}: the contours are damaged", path)};
  auto milled = std::make_unique<Milled>();
  std::memcpy(&milled->beside_mm3, beside.data(), sizeof(double));
  Result<turning::SavedPart> saved = turning::parse_part(beside.substr(sizeof(double)), path);
  if (!saved) return Error{saved.error()};
  MillTurnOptions as_saved = options;
  as_saved.cell_mm = tree.value()->cell_mm();
  Result<std::unique_ptr<MillTurn>> stock =
      create(TurningStock(TurnedPart::restored(std::move(saved.value()))), as_saved);
  if (!stock) return stock;
  MillTurn& made = **stock;
  const bool fits = tree.value()->bounds_mm() == made.bounds_mm() &&
                    std::abs(milled->beside_mm3) <= made.blank_mm3();
  if (!fits) return Error{trf("{}: the contours are damaged", path)};
  milled->tree = std::move(tree.value());
  milled->bands = made.bands();
  made.milled_ = std::move(milled);
  return stock;
}

Done MillTurn::can_cut(const Cutter& cutter) {
  return cutter.live() ? Octree::can_cut(cutter) : TurningStock::can_cut(cutter);
}

double MillTurn::cell_mm() const { return milled_ ? milled_->tree->cell_mm() : turned_.cell_mm(); }

std::size_t MillTurn::cell_count() const {
  return milled_ ? milled_->tree->cell_count() : turned_.cell_count();
}

double MillTurn::remaining_mm3() const {
  if (!milled_) return turned_.remaining_mm3();
  const Milled& now = shown();
  return now.tree->remaining_mm3() + now.beside_mm3 - threads_mm3();
}

std::string MillTurn::digest() const { return milled_ ? tree().digest() : turned_.digest(); }

TriangleMesh MillTurn::mesh(double tolerance_mm) const {
  return milled_ ? tree().mesh(tolerance_mm) : turned_.mesh(tolerance_mm);
}

std::size_t MillTurn::tile_count() const {
  return milled_ ? milled_->tree->tile_count() : turned_.tile_count();
}

Box MillTurn::tile_box(std::uint32_t tile) const {
  return milled_ ? milled_->tree->tile_box(tile) : turned_.tile_box(tile);
}

std::vector<std::uint32_t> MillTurn::take_dirty_tiles() {
  if (!milled_) return turned_.take_dirty_tiles();
  std::vector<std::uint32_t> dirty;
  if (seen_) {
    dirty = tree().differing_tiles(*seen_);
  } else {
    for (std::uint32_t tile = 0; tile < tile_count(); ++tile) dirty.push_back(tile);
  }
  seen_ = tree().snapshot();
  return dirty;
}

std::vector<std::uint32_t> MillTurn::differing_tiles(const StockModel& other) const {
  const auto* const same = dynamic_cast<const MillTurn*>(&other);
  if (milled_ && same && same->milled_) return tree().differing_tiles(same->tree());
  if (!milled_ && same && !same->milled_) return turned_.differing_tiles(same->turned_);
  std::vector<std::uint32_t> all;
  for (std::uint32_t tile = 0; tile < tile_count(); ++tile) all.push_back(tile);
  return all;
}

std::uint64_t MillTurn::patch_version(std::uint32_t tile) const {
  return milled_ ? tree().patch_version(tile) : turned_.patch_version(tile);
}

MeshPatch MillTurn::patch(std::uint32_t tile, int level) const {
  return milled_ ? tree().patch(tile, level) : turned_.patch(tile, level);
}

}  // namespace kerf
