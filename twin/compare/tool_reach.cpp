#include "twin/compare/tool_reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace kerf {
namespace {

/// Cells are looked at in blocks of so many each way.
constexpr int kSide = 8, kBlock = kSide * kSide;
/// Beyond the tool's radius: more than any height, and a float that can be added to one.
constexpr float kBeyond_mm = 1e9f;
/// So much of the radius does not count: a middle at the radius itself, but for rounding, is
/// beyond it.
constexpr double kRim_mm = 1e-7;
/// Below all of the design by so much a tip is free.
constexpr float kFree_mm = 1;

int blocks_of(int cells) { return (cells + kSide - 1) / kSide; }

/// Blocks of heights; from a block of negative numbers on where tools may stand beside the grid.
struct Blocks {
  int low = 0;  ///< number of the first block, both ways
  int nx = 0, ny = 0;
  std::vector<std::int32_t> slot;  ///< of each; -1: there is nothing
  std::vector<float> z, most;      ///< kBlock a slot; the greatest of each
  float greatest = 0;

  void set(int low_block, int blocks_x, int blocks_y) {
    low = low_block, nx = blocks_x, ny = blocks_y;
    slot.assign(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny), -1);
    z.clear(), most.clear();
    greatest = -kBeyond_mm;
  }
  bool contains(int bx, int by) const {
    return bx >= low && by >= low && bx < low + nx && by < low + ny;
  }
  std::int32_t& slot_at(int bx, int by) {
    return slot[static_cast<std::size_t>(by - low) * static_cast<std::size_t>(nx) +
                static_cast<std::size_t>(bx - low)];
  }
  std::int32_t slot_at(int bx, int by) const { return const_cast<Blocks*>(this)->slot_at(bx, by); }
  const float* at(std::int32_t n) const { return z.data() + static_cast<std::size_t>(n) * kBlock; }
  void add(int bx, int by, const std::array<float, kBlock>& heights) {
    slot_at(bx, by) = static_cast<std::int32_t>(most.size());
    z.insert(z.end(), heights.begin(), heights.end());
    most.push_back(*std::max_element(heights.begin(), heights.end()));
    greatest = std::max(greatest, most.back());
  }
};

/// The tool's surface by steps of cells from where it stands, which is `shift` of a cell (0 or 0.5,
/// both ways) past the middle of one.
class Kernel {
 public:
  struct Offset {
    int x = 0, y = 0;  ///< of blocks
    float least = 0;   ///< of the surface, between any two of their cells
  };

  Kernel(const Cutter& cutter, const Vec2& cell_mm, const Vec2& shift) {
    const double radius = cutter.radius_mm() - kRim_mm;
    const double cell = std::min(cell_mm.x, cell_mm.y);
    reach_ = static_cast<int>(std::ceil((radius / cell + 1) / kSide));
    half_ = reach_ * kSide + kSide - 1;
    width_ = 2 * half_ + 1;
    surface_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(width_),
                    kBeyond_mm);
    for (int y = -half_; y <= half_; ++y) {
      for (int x = -half_; x <= half_; ++x) {
        const double r = std::hypot((x + shift.x) * cell_mm.x, (y + shift.y) * cell_mm.y);
        if (r <= radius) at(x, y) = static_cast<float>(cutter.height_mm(r));
      }
    }
    find_windows();
    find_offsets();
  }
  int reach_blocks() const { return reach_; }
  const std::vector<Offset>& offsets() const { return offsets_; }
  /// Of a step; rows are width() apart.
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y + half_) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x + half_);
  }
  int width() const { return width_; }
  const float* from(std::size_t index) const { return surface_.data() + index; }
  /// The least of the surface over a block that begins there.
  float least(std::size_t index) const { return windows_[index]; }

 private:
  const float* row(int x, int y) const { return from(index(x, y)); }
  float& at(int x, int y) { return const_cast<float&>(*row(x, y)); }

  /// One way after the other.
  void find_windows() {
    windows_ = surface_;
    const int last = half_ - kSide + 1;
    for (int y = -half_; y <= half_; ++y) {
      for (int x = -half_; x <= last; ++x)
        windows_[index(x, y)] = *std::min_element(row(x, y), row(x, y) + kSide);
    }
    for (int y = -half_; y <= last; ++y) {
      for (int x = -half_; x <= last; ++x) {
        for (int k = 1; k < kSide; ++k)
          windows_[index(x, y)] = std::min(windows_[index(x, y)], windows_[index(x, y + k)]);
      }
    }
  }
  /// Nearest first, by the surface's height.
  void find_offsets() {
    for (int y = -reach_; y <= reach_; ++y) {
      for (int x = -reach_; x <= reach_; ++x) {
        Offset offset{x, y, kBeyond_mm};
        for (int dy = 1 - kSide; dy < kSide; ++dy) {
          const float* const line = row(x * kSide + 1 - kSide, y * kSide + dy);
          offset.least = std::min(offset.least, *std::min_element(line, line + 2 * kSide - 1));
        }
        if (offset.least < kBeyond_mm) offsets_.push_back(offset);
      }
    }
    std::stable_sort(offsets_.begin(), offsets_.end(), [](const Offset& a, const Offset& b) {
      const int near_a = a.x * a.x + a.y * a.y, near_b = b.x * b.x + b.y * b.y;
      return a.least != b.least ? a.least < b.least : near_a < near_b;
    });
  }

  int reach_ = 0, half_ = 0, width_ = 0;
  std::vector<float> surface_, windows_;
  std::vector<Offset> offsets_;
};

/// Two in a row of a block.
using Four = float __attribute__((vector_size(4 * sizeof(float))));

Four four_at(const float* p) {
  Four out;
  std::memcpy(&out, p, sizeof out);
  return out;
}

/// out(o) = max(out(o), max over i of in(i) - surface(o - i)) in one block of `out`. Where it is
/// `enough` already a cell is not looked at more closely. Blocks and cells that cannot change the
/// least of the others are left out.
void raise(const Blocks& in, const Kernel& kernel, int bx, int by,
           const std::array<float, kBlock>& enough, std::array<float, kBlock>& out) {
  const auto least_open = [&] {
    float least = kBeyond_mm;
    for (std::size_t k = 0; k < kBlock; ++k)
      if (out[k] < enough[k]) least = std::min(least, out[k]);
    return least;
  };
  float least = least_open();
  const int width = kernel.width();
  for (const Kernel::Offset& offset : kernel.offsets()) {
    if (in.greatest - offset.least <= least) break;
    const int from_x = bx - offset.x, from_y = by - offset.y;
    if (!in.contains(from_x, from_y)) continue;
    const std::int32_t slot = in.slot_at(from_x, from_y);
    if (slot < 0 || in.most[static_cast<std::size_t>(slot)] - offset.least <= least) continue;
    const float* const heights = in.at(slot);
    std::array<Four, kBlock / 4> best;
    std::memcpy(best.data(), out.data(), sizeof best);
    for (int y = 0, k = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x, ++k) {
        const float height = heights[k];
        const std::size_t at = kernel.index(offset.x * kSide - x, offset.y * kSide - y);
        if (height - kernel.least(at) <= least) continue;
        const Four all{height, height, height, height};
        const float* row = kernel.from(at);
#pragma GCC unroll 8
        for (std::size_t j = 0; j < best.size(); j += 2) {
          const Four left = all - four_at(row), right = all - four_at(row + 4);
          best[j] = left > best[j] ? left : best[j];
          best[j + 1] = right > best[j + 1] ? right : best[j + 1];
          row += width;
        }
      }
    }
    std::memcpy(out.data(), best.data(), sizeof best);
    least = least_open();
  }
}

}  // namespace

ToolReach::ToolReach(int nx, int ny, const Vec2& cell_mm, std::span<const float> design_mm,
                     std::span<const WallPoint> walls)
    : nx_(nx),
      ny_(ny),
      cell_mm_(cell_mm),
      low_mm_(kBeyond_mm),
      design_mm_(design_mm.begin(), design_mm.end()),
      walls_(walls.begin(), walls.end()) {
  for (const float z : design_mm_)
    if (std::isfinite(z)) low_mm_ = std::min(low_mm_, z);
  for (const WallPoint& wall : walls_) low_mm_ = std::min(low_mm_, wall.z_mm);
  if (low_mm_ == kBeyond_mm) low_mm_ = 0;
  const auto block_of = [&](const WallPoint& wall) {
    const int x = static_cast<int>(wall.x_mm / (kSide * cell_mm_.x));
    const int y = static_cast<int>(wall.y_mm / (kSide * cell_mm_.y));
    return static_cast<std::size_t>(std::clamp(y, 0, blocks_of(ny_) - 1)) *
               static_cast<std::size_t>(blocks_of(nx_)) +
           static_cast<std::size_t>(std::clamp(x, 0, blocks_of(nx_) - 1));
  };
  std::stable_sort(walls_.begin(), walls_.end(), [&](const WallPoint& a, const WallPoint& b) {
    return block_of(a) < block_of(b);
  });
  first_wall_.assign(
      static_cast<std::size_t>(blocks_of(nx_)) * static_cast<std::size_t>(blocks_of(ny_)) + 1, 0);
  for (const WallPoint& wall : walls_) ++first_wall_[block_of(wall) + 1];
  for (std::size_t k = 1; k < first_wall_.size(); ++k) first_wall_[k] += first_wall_[k - 1];
}

/// The same as raise() by the points of walls, which lie anywhere.
void ToolReach::raise_by_walls(const Cutter& cutter, const Vec2& shift, int bx, int by,
                               std::span<float> tips) const {
  const double radius = cutter.radius_mm() - kRim_mm;
  const Vec2 side = static_cast<double>(kSide) * cell_mm_;
  const Vec2 first = (Vec2(bx, by) * static_cast<double>(kSide) + Vec2(0.5) + shift) * cell_mm_;
  const Vec2 last = first + (kSide - 1.0) * cell_mm_;
  const auto block = [](double at, double edge, int count) {
    return std::clamp(static_cast<int>(std::floor(at / edge)), 0, count - 1);
  };
  const int low_x = block(first.x - radius, side.x, blocks_of(nx_));
  const int high_x = block(last.x + radius, side.x, blocks_of(nx_));
  const int low_y = block(first.y - radius, side.y, blocks_of(ny_));
  const int high_y = block(last.y + radius, side.y, blocks_of(ny_));
  float least = *std::min_element(tips.begin(), tips.end());
  for (int y = low_y; y <= high_y; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(blocks_of(nx_));
    const std::size_t end = first_wall_[row + static_cast<std::size_t>(high_x) + 1];
    for (std::size_t n = first_wall_[row + static_cast<std::size_t>(low_x)]; n < end; ++n) {
      const WallPoint& wall = walls_[n];
      if (wall.z_mm <= least) continue;
      const Vec2 at(wall.x_mm, wall.y_mm);
      const double apart = glm::length(glm::max(glm::max(first - at, at - last), Vec2(0)));
      if (apart > radius || wall.z_mm - static_cast<float>(cutter.height_mm(apart)) <= least)
        continue;
      for (std::size_t k = 0; k < kBlock; ++k) {
        if (tips[k] >= wall.z_mm) continue;
        const Vec2 place = first + Vec2(k % kSide, k / kSide) * cell_mm_;
        const double r = glm::length(place - at);
        if (r > radius) continue;
        tips[k] = std::max(tips[k], wall.z_mm - static_cast<float>(cutter.height_mm(r)));
      }
      least = *std::min_element(tips.begin(), tips.end());
    }
  }
}

bool ToolReach::takes(const Cutter& cutter) const {
  return 2 * cutter.radius_mm() / std::min(cell_mm_.x, cell_mm_.y) <= kMostCellsAcross;
}

std::vector<float> ToolReach::lowest_mm(const Cutter& cutter, std::span<const std::uint8_t> wanted,
                                        float enough_mm) const {
  const int blocks_x = blocks_of(nx_), blocks_y = blocks_of(ny_);
  const auto cell_of = [&](int bx, int by, std::size_t k) -> std::ptrdiff_t {
    const int i = bx * kSide + static_cast<int>(k) % kSide;
    const int j = by * kSide + static_cast<int>(k) / kSide;
    return i < nx_ && j < ny_ ? static_cast<std::ptrdiff_t>(j) * nx_ + i : -1;
  };
  // So low that nothing of the cutter touches any of the design, and that whatever it leaves is
  // lower than what it leaves where it does.
  const auto top_mm = static_cast<float>(cutter.height_mm(cutter.radius_mm()));
  const float free_mm = low_mm_ - 3 * top_mm - 2 * kFree_mm;
  std::array<float, kBlock> heights{}, enough{};
  Blocks design;
  design.set(0, blocks_x, blocks_y);
  for (int by = 0; by < blocks_y; ++by) {
    for (int bx = 0; bx < blocks_x; ++bx) {
      for (std::size_t k = 0; k < kBlock; ++k) {
        const std::ptrdiff_t cell = cell_of(bx, by, k);
        const float z = cell < 0 ? free_mm : design_mm_[static_cast<std::size_t>(cell)];
        heights[k] = std::max(z, free_mm);
      }
      design.add(bx, by, heights);
    }
  }
  std::vector<float> lowest(design_mm_.size(), kNotAsked);
  /// Of the cells that are wanted, blocks in which one is not low enough yet.
  std::vector<std::uint8_t> open(static_cast<std::size_t>(blocks_x) *
                                 static_cast<std::size_t>(blocks_y));
  const auto open_at = [&](int bx, int by) -> std::uint8_t& {
    return open[static_cast<std::size_t>(by) * static_cast<std::size_t>(blocks_x) +
                static_cast<std::size_t>(bx)];
  };
  for (int by = 0; by < blocks_y; ++by) {
    for (int bx = 0; bx < blocks_x; ++bx) {
      for (std::size_t k = 0; k < kBlock; ++k) {
        const std::ptrdiff_t cell = cell_of(bx, by, k);
        if (cell >= 0 && wanted[static_cast<std::size_t>(cell)] != 0) open_at(bx, by) = 1;
      }
    }
  }
  Blocks tips;  // their places' negatives
  std::vector<std::uint8_t> needed;
  const std::array<float, kBlock> never_enough = [] {
    std::array<float, kBlock> all{};
    all.fill(kBeyond_mm);
    return all;
  }();
  for (const Vec2& shift : {Vec2(0.5, 0.5), Vec2(0, 0), Vec2(0.5, 0), Vec2(0, 0.5)}) {
    // From the place of the tip to a cell it is `shift` less than from cell to cell.
    const Kernel up(cutter, cell_mm_, shift), down(cutter, cell_mm_, -shift);
    const int reach = up.reach_blocks();
    tips.set(-reach, blocks_x + 2 * reach, blocks_y + 2 * reach);
    needed.assign(tips.slot.size(), 0);
    for (int by = 0; by < blocks_y; ++by) {
      for (int bx = 0; bx < blocks_x; ++bx) {
        if (open_at(bx, by) == 0) continue;
        for (const Kernel::Offset& offset : down.offsets()) {
          const int x = bx - offset.x + reach, y = by - offset.y + reach;
          needed[static_cast<std::size_t>(y) * static_cast<std::size_t>(tips.nx) +
                 static_cast<std::size_t>(x)] = 1;
        }
      }
    }
    for (int y = 0; y < tips.ny; ++y) {
      for (int x = 0; x < tips.nx; ++x) {
        if (needed[static_cast<std::size_t>(y) * static_cast<std::size_t>(tips.nx) +
                   static_cast<std::size_t>(x)] == 0)
          continue;
        heights.fill(free_mm - top_mm);
        raise(design, up, x - reach, y - reach, never_enough, heights);
        if (!walls_.empty()) raise_by_walls(cutter, shift, x - reach, y - reach, heights);
        for (float& z : heights) z = -z;
        tips.add(x - reach, y - reach, heights);
      }
    }
    for (int by = 0; by < blocks_y; ++by) {
      for (int bx = 0; bx < blocks_x; ++bx) {
        if (open_at(bx, by) == 0) continue;
        enough.fill(-kBeyond_mm);
        for (std::size_t k = 0; k < kBlock; ++k) {
          const std::ptrdiff_t cell = cell_of(bx, by, k);
          heights[k] = 0;
          if (cell < 0 || wanted[static_cast<std::size_t>(cell)] == 0) continue;
          const float known = lowest[static_cast<std::size_t>(cell)];
          heights[k] = known == kNotAsked ? -kBeyond_mm : -known;
          const float z = design_mm_[static_cast<std::size_t>(cell)];
          enough[k] = -(std::max(z, free_mm) + enough_mm);
        }
        raise(tips, down, bx, by, enough, heights);
        open_at(bx, by) = 0;
        for (std::size_t k = 0; k < kBlock; ++k) {
          if (enough[k] == -kBeyond_mm) continue;
          lowest[static_cast<std::size_t>(cell_of(bx, by, k))] = -heights[k];
          if (heights[k] < enough[k]) open_at(bx, by) = 1;
        }
      }
    }
  }
  for (float& z : lowest)
    if (z < low_mm_ - top_mm - kFree_mm) z = -std::numeric_limits<float>::infinity();
  return lowest;
}

}  // namespace kerf
