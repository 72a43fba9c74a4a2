#include "twin/view/patch_feeder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/compare/patch_deviation.h"

namespace kerf {
namespace {

constexpr double kCellsPerPixel = 2.0;
/// Of a picture whose size is not known yet.
constexpr double kUsualPixels = 800.0;

}  // namespace

void PatchFeeder::follow(std::shared_ptr<const StockModel> stock) {
  const std::size_t tiles = stock ? stock->tile_count() : 0;
  const bool same_blank = stock_ && stock && shown_.size() == tiles &&
                          stock_->bounds_mm() == stock->bounds_mm() &&
                          stock_->cell_mm() == stock->cell_mm();
  if (!same_blank) {
    shown_.assign(tiles, {});
    triangles_ = 0;
    next_ = 0;
    if (stock && pixel_mm_ == 0) {
      const Vec3 size = stock->bounds_mm().size();
      pixel_mm_ = std::max({size.x, size.y, size.z}) / kUsualPixels;
    }
  }
  stock_ = std::move(stock);
  behind_ = stock_ != nullptr;
}

void PatchFeeder::set_detail(double pixel_mm) {
  pixel_mm_ = pixel_mm;
  behind_ = stock_ != nullptr;
}

void PatchFeeder::compare_with(std::shared_ptr<const DesignPart> design, double tolerance_mm) {
  design_ = std::move(design);
  tolerance_mm_ = tolerance_mm;
}

int PatchFeeder::wanted_level() const {
  if (design_) return 0;
  const double joined = pixel_mm_ / (stock_->cell_mm() * kCellsPerPixel);
  if (!(joined >= 1)) return 0;
  const int level = 1 + static_cast<int>(std::floor(std::log2(joined)));
  return std::min(level, StockModel::kPatchLevels - 1);
}

std::shared_ptr<const MeshPatch> PatchFeeder::patch(std::uint32_t tile, int level) const {
  auto patch = std::make_shared<MeshPatch>(stock_->patch(tile, level));
  if (design_) add_deviation(*design_, {stock_->cell_mm(), tolerance_mm_}, patch.get());
  return patch;
}

std::vector<std::shared_ptr<const MeshPatch>> PatchFeeder::make_until(Clock::time_point deadline) {
  std::vector<std::shared_ptr<const MeshPatch>> made;
  if (!behind_) return made;
  const auto level = static_cast<std::int8_t>(wanted_level());
  const auto make = [&](std::size_t tile) {
    auto made_patch = patch(static_cast<std::uint32_t>(tile), level);
    Shown& shown = shown_[tile];
    const auto triangles = static_cast<std::uint32_t>(made_patch->indices.size() / 3);
    triangles_ = triangles_ - shown.triangles + triangles;
    shown = {made_patch->version, triangles, level};
    made.push_back(std::move(made_patch));
  };
  const auto late = [&] { return !made.empty() && Clock::now() >= deadline; };
  // From where the last slice ended, so that a workpiece that changes faster than it can be drawn
  // is drawn everywhere nevertheless.
  const std::size_t tiles = shown_.size();
  for (const bool cut_ones : {true, false}) {
    for (std::size_t i = 0; i < tiles; ++i) {
      const std::size_t tile = (next_ + i) % tiles;
      const Shown& shown = shown_[tile];
      const bool cut = shown.level < 0 ||
                       shown.version != stock_->patch_version(static_cast<std::uint32_t>(tile));
      if (cut_ones ? !cut : shown.level == level) continue;
      make(tile);
      if (late()) {
        next_ = (tile + 1) % tiles;
        return made;
      }
    }
  }
  next_ = 0;
  behind_ = false;
  return made;
}

}  // namespace kerf
