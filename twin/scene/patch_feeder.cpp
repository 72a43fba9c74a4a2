#include "twin/scene/patch_feeder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <map>
#include <utility>

#include "stock/turning/turned_surface.h"
#include "twin/compare/patch_deviation.h"
#include "twin/scene/part_patches.h"

namespace kerf {
namespace {

/// Of a picture whose size is not known yet.
constexpr double kUsualPixels = 800.0;

}  // namespace

void PatchFeeder::follow(std::shared_ptr<const StockModel> stock) {
  const std::size_t tiles = stock ? stock->tile_count() : 0;
  const bool same_blank = stock_ && stock && shown_.size() == tiles &&
                          stock_->bounds_mm() == stock->bounds_mm() &&
                          stock_->cell_mm() == stock->cell_mm();
  if (same_blank) {
    for (const std::uint32_t tile : stock->differing_tiles(*stock_)) {
      has_news_ = true;
      for (const std::uint32_t near : neighbors_[tile]) shown_[near].is_old = true;
    }
  } else {
    shown_.assign(tiles, {});
    hurried_.clear();
    triangles_ = 0;
    next_ = 0;
    if (stock) start_anew(*stock);
  }
  stock_ = std::move(stock);
  behind_ = stock_ != nullptr;
  if (stock_ && !same_blank) choose_levels();
}

void PatchFeeder::start_anew(const StockModel& stock) { find_neighbors(stock); }

/// However the tiles lie: the middles of two that touch are no farther apart than the longest of
/// all their edges.
void PatchFeeder::find_neighbors(const StockModel& stock) {
  const auto tiles = static_cast<std::uint32_t>(stock.tile_count());
  Vec3 longest(0.0);
  for (std::uint32_t tile = 0; tile < tiles; ++tile) {
    longest = glm::max(longest, stock.tile_box(tile).size());
  }
  using Place = std::array<int, 3>;
  const auto place_of = [&](std::uint32_t tile) {
    const Box box = stock.tile_box(tile);
    const Vec3 at = 0.5 * (box.min + box.max) - stock.bounds_mm().min;
    Place place{};
    for (int axis = 0; axis < 3; ++axis) {
      if (longest[axis] > 0) {
        place[static_cast<std::size_t>(axis)] =
            static_cast<int>(std::floor(at[axis] / longest[axis]));
      }
    }
    return place;
  };
  std::map<Place, std::vector<std::uint32_t>> by_place;
  for (std::uint32_t tile = 0; tile < tiles; ++tile) by_place[place_of(tile)].push_back(tile);
  neighbors_.assign(tiles, {});
  for (std::uint32_t tile = 0; tile < tiles; ++tile) {
    const Place at = place_of(tile);
    for (int near = 0; near < 27; ++near) {
      const auto found =
          by_place.find({at[0] + near % 3 - 1, at[1] + near / 3 % 3 - 1, at[2] + near / 9 - 1});
      if (found == by_place.end()) continue;
      neighbors_[tile].insert(neighbors_[tile].end(), found->second.begin(), found->second.end());
    }
  }
}

/// Back to what was shown before: not old any more.
bool PatchFeeder::is_old(std::size_t tile) {
  Shown& shown = shown_[tile];
  if (shown.is_old && shown.level >= 0 &&
      shown.version == stock_->patch_version(static_cast<std::uint32_t>(tile))) {
    shown.is_old = false;
  }
  return shown.is_old;
}

void PatchFeeder::set_detail(const ViewDetail& detail, std::size_t easy_triangles) {
  detail_ = detail;
  easy_triangles_ = easy_triangles;
  behind_ = stock_ != nullptr;
  if (stock_) choose_levels();
}

void PatchFeeder::compare_with(std::shared_ptr<const DesignPart> design, double tolerance_mm) {
  design_ = std::move(design);
  tolerance_mm_ = tolerance_mm;
  if (stock_) choose_levels();
}

void PatchFeeder::choose_levels() {
  levels_.assign(shown_.size(), 0);
  if (design_) return;
  const Vec3 size = stock_->bounds_mm().size();
  const ViewDetail detail =
      detail_.value_or(ViewDetail{std::max({size.x, size.y, size.z}) / kUsualPixels});
  for (std::uint32_t tile = 0; tile < levels_.size(); ++tile) {
    levels_[tile] = static_cast<std::int8_t>(level_for(detail, stock_->tile_box(tile)));
  }
}

/// Goes by the point of the box that is nearest to the eye; what lies behind the eye is not seen.
int PatchFeeder::level_for(const ViewDetail& detail, const Box& box) const {
  if (detail.largest_in(box) <= 0) return StockModel::kPatchLevels - 1;
  return patch_level(*stock_, detail.smallest_in(box));
}

int PatchFeeder::wanted_level(std::size_t tile) const {
  const int coarser = shown_[tile].is_hurried ? 1 : 0;
  return std::min(levels_[tile] + coarser, StockModel::kPatchLevels - 1);
}

/// From where the last slice ended, so that a workpiece that changes faster than it can be drawn is
/// drawn everywhere nevertheless.
std::vector<std::uint32_t> PatchFeeder::old_tiles() {
  std::vector<std::uint32_t> old;
  const std::size_t tiles = shown_.size();
  for (std::size_t i = 0; i < tiles; ++i) {
    const std::size_t tile = (next_ + i) % tiles;
    if (is_old(tile)) old.push_back(static_cast<std::uint32_t>(tile));
  }
  return old;
}

void PatchFeeder::hurry(const std::vector<std::uint32_t>& cut_ones, Clock::time_point now) {
  if (easy_triangles_ == 0 || design_) return;
  std::size_t triangles = 0;
  for (const std::uint32_t tile : cut_ones) {
    const Shown& shown = shown_[tile];
    const int finer = std::max(0, shown.level - levels_[tile]);
    triangles += std::size_t{shown.triangles} << (2 * finer);
  }
  const bool is_too_much = triangles > easy_triangles_;
  if (std::exchange(has_news_, false)) {
    too_much_ = static_cast<std::uint8_t>(too_much_ << 1 | (is_too_much ? 1 : 0));
  }
  const bool hurries = !hurried_.empty() || std::popcount(too_much_) >= kRounds;
  if (!is_too_much || !hurries) return;
  last_hurry_ = now;
  for (const std::uint32_t tile : cut_ones) {
    Shown& shown = shown_[tile];
    if (shown.level < 0 || std::exchange(shown.is_hurried, true)) continue;
    hurried_.push_back(tile);
  }
}

void PatchFeeder::calm_down(Clock::time_point now) {
  if (hurried_.empty() || now - last_hurry_ < kCalm) return;
  for (const std::uint32_t tile : hurried_) shown_[tile].is_hurried = false;
  hurried_.clear();
  behind_ = true;
}

std::shared_ptr<const MeshPatch> PatchFeeder::make(std::size_t tile) {
  const int level = wanted_level(tile);
  auto patch = std::make_shared<MeshPatch>(stock_->patch(static_cast<std::uint32_t>(tile), level));
  if (design_) add_deviation(*design_, {detail_cell_mm(*stock_), tolerance_mm_}, patch.get());
  Shown& shown = shown_[tile];
  const auto triangles = static_cast<std::uint32_t>(patch->indices.size() / 3);
  triangles_ = triangles_ - shown.triangles + triangles;
  shown.version = patch->version;
  shown.triangles = triangles;
  shown.level = static_cast<std::int8_t>(level);
  shown.is_old = false;
  return patch;
}

std::vector<std::shared_ptr<const MeshPatch>> PatchFeeder::make_until(Clock::time_point deadline) {
  std::vector<std::shared_ptr<const MeshPatch>> made;
  const Clock::time_point now = Clock::now();
  calm_down(now);
  if (!behind_) return made;
  const auto late = [&] { return Clock::now() >= deadline; };
  const std::size_t tiles = shown_.size();
  const auto add = [&](std::size_t tile) {
    made.push_back(make(tile));
    next_ = (tile + 1) % tiles;
  };
  const std::vector<std::uint32_t> cut_ones = old_tiles();
  hurry(cut_ones, now);
  const auto is_shown = [&](std::uint32_t tile) { return shown_[tile].level >= 0; };
  const bool come_together =
      cut_ones.size() <= kTogether && std::all_of(cut_ones.begin(), cut_ones.end(), is_shown);
  for (const std::uint32_t tile : cut_ones) {
    add(tile);
    if (!come_together && late()) return made;
  }
  if (!made.empty() && late()) return made;
  const std::size_t first = next_;
  for (std::size_t i = 0; i < tiles; ++i) {
    const std::size_t tile = (first + i) % tiles;
    if (shown_[tile].level == wanted_level(tile)) continue;
    add(tile);
    if (late()) return made;
  }
  next_ = 0;
  behind_ = false;
  return made;
}

}  // namespace kerf
