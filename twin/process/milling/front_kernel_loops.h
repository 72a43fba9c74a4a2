// twin/process/milling/front_kernel_loops.h - the loops of front_kernel.h, for one set of
// instructions: included by one source for each, in a namespace of its own, since code compiled for
// one must never be linked into another. Nothing here calls what could be: no std, no glm. Loops do
// not branch, that compilers make vectors of them.
#pragma once

#ifndef KERF_FRONT_NAMESPACE
#error "define KERF_FRONT_NAMESPACE before including front_kernel_loops.h"
#endif

#if defined(__AVX2__)
#include <immintrin.h>
#endif

#include "twin/process/milling/front_kernel.h"

// What is written is no table that is read.
#if defined(__clang__)
#define KERF_EACH_APART _Pragma("clang loop vectorize(assume_safety)")
#else
#define KERF_EACH_APART _Pragma("GCC ivdep")
#endif

namespace kerf::KERF_FRONT_NAMESPACE {

static constexpr double kTurn = 3.14159265358979323846;
static constexpr double kFar = __builtin_huge_val();

static inline double least_of(double a, double b) { return b < a ? b : a; }
static inline double most_of(double a, double b) { return a < b ? b : a; }
static inline double size_of(double a) { return __builtin_fabs(a); }
static inline double root_of(double a) { return __builtin_sqrt(a); }
static inline double within(double a, double low, double high) {
  return a < low ? low : high < a ? high : a;
}

static inline double lift_at(const double* lift, double scale, double last, double radius) {
  const double scaled = least_of(radius * scale, last);
  const int k = static_cast<int>(scaled);
  return lift[k] + (scaled - k) * (lift[k + 1] - lift[k]);
}

static void lay_ray(const FrontGrid& grid, const RayLine& line, const FrontEnd& end, int count,
                    RayPlaces& at) {
  const int whole = (count + 3) & ~3;
  const double last_x = grid.nx - 1, last_y = grid.ny - 1;
  const double radius2 = end.is_near ? end.radius2 : kFar;
  KERF_EACH_APART
  for (int n = 0; n < whole; ++n) {
    const double x = line.center_x + at.radius[n] * line.out_x;
    const double y = line.center_y + at.radius[n] * line.out_y;
    const double from_x = (x - grid.min_x) / grid.cell_x - 0.5;
    const double from_y = (y - grid.min_y) / grid.cell_y - 0.5;
    const double arm_x = x - end.x, arm_y = y - end.y;
    const bool has_four = (from_x >= 0) & (from_y >= 0) & (from_x < last_x) & (from_y < last_y);
    const bool is_on_way = (arm_x * arm_x + arm_y * arm_y < radius2) |
                           (arm_x * end.along_x + arm_y * end.along_y <= 0);
    const int i = static_cast<int>(has_four ? from_x : 0.0);
    const int j = static_cast<int>(has_four ? from_y : 0.0);
    at.x[n] = x, at.y[n] = y;
    at.i[n] = i, at.j[n] = j;
    at.right[n] = from_x - i, at.up[n] = from_y - j;
    at.low_x[n] = grid.min_x + (i + 0.5) * grid.cell_x - line.center_x;
    at.low_y[n] = grid.min_y + (j + 0.5) * grid.cell_y - line.center_y;
    at.depth[n] = is_on_way ? 0 : -kFar;
    at.state[n] = has_four ? RayPlaces::kDone : RayPlaces::kAsk;
  }
  constexpr std::int32_t kSide = RayPlaces::kTileCells, kX = RayPlaces::kBlockX,
                         kY = RayPlaces::kBlockY, kBlock = kX * kY, kBlocks = kSide / kX * kBlock;
  KERF_EACH_APART
  for (int n = 0; n < whole; ++n) {
    const std::int32_t x = at.i[n] & (kSide - 1), y = at.j[n] & (kSide - 1);
    const std::int32_t in_x = x & (kX - 1), in_y = y & (kY - 1);
    const std::int32_t offset = (x - in_x) * kY + in_x + (y - in_y) * (kBlocks / kY) + in_y * kX;
    at.offset[n] = ((x == kSide - 1) | (y == kSide - 1)) ? -1 : offset;
    at.next_x[n] = in_x == kX - 1 ? kBlock - (kX - 1) : 1;
    at.next_y[n] = in_y == kY - 1 ? kBlocks - (kY - 1) * kX : kX;
  }
}

static void look_along(const FrontGrid& grid, const RayLine& line, const LiftTable& table,
                       const RayGround& ground, int count, RayPlaces& at) {
  const int whole = (count + 3) & ~3;
  const double* const lift = table.lift;
  const double scale = table.scale, last = table.last, tip = ground.tip;
  const double far_x = grid.cell_x, far_y = grid.cell_y, floor = ground.floor;
  const int walls = ground.knows_owners ? RayPlaces::kOwners : RayPlaces::kAsk;
  const double twist_most = ground.knows_owners ? ground.twist : kFar;
  const double held_from = ground.has_held ? ground.film : kFar;
  KERF_EACH_APART
  for (int n = 0; n < whole; ++n) {
    const double arm_x = at.x[n] - line.center_x, arm_y = at.y[n] - line.center_y;
    at.lift[n] = lift_at(lift, scale, last, root_of(arm_x * arm_x + arm_y * arm_y));
  }
  KERF_EACH_APART
  for (int n = 0; n < whole; ++n) {
    const double a = most_of(floor, static_cast<double>(at.height[0][n]));
    const double b = most_of(floor, static_cast<double>(at.height[1][n]));
    const double c = most_of(floor, static_cast<double>(at.height[2][n]));
    const double d = most_of(floor, static_cast<double>(at.height[3][n]));
    const double highest = most_of(most_of(a, b), most_of(c, d));
    const double lowest = least_of(least_of(a, b), least_of(c, d));
    const double high_x = grid.min_x + (at.i[n] + 1 + 0.5) * far_x - line.center_x;
    const double high_y = grid.min_y + (at.j[n] + 1 + 0.5) * far_y - line.center_y;
    const double low_x2 = at.low_x[n] * at.low_x[n], low_y2 = at.low_y[n] * at.low_y[n];
    const double high_x2 = high_x * high_x, high_y2 = high_y * high_y;
    const double deep_a = a - tip - lift_at(lift, scale, last, root_of(low_x2 + low_y2));
    const double deep_b = b - tip - lift_at(lift, scale, last, root_of(high_x2 + low_y2));
    const double deep_c = c - tip - lift_at(lift, scale, last, root_of(low_x2 + high_y2));
    const double deep_d = d - tip - lift_at(lift, scale, last, root_of(high_x2 + high_y2));
    const double right = at.right[n], up = at.up[n];
    const double sloped = (1 - up) * ((1 - right) * deep_a + right * deep_b) +
                          up * ((1 - right) * deep_c + right * deep_d);
    const double level = highest - tip - at.lift[n];
    const bool is_level = highest - lowest < ground.film;
    const bool is_wall = highest - lowest > ground.wall;
    const bool is_twisted = size_of(deep_a + deep_d - deep_b - deep_c) > twist_most;
    const bool is_off = at.depth[n] < 0;
    const int of_level = level > held_from ? RayPlaces::kHeld : RayPlaces::kDone;
    const int of_rest = is_wall      ? walls
                        : is_twisted ? int{RayPlaces::kOwners}
                                     : int{RayPlaces::kDone};
    const int asked = is_level ? of_level : of_rest;
    const int known = at.state[n] != RayPlaces::kDone ? int{RayPlaces::kAsk} : asked;
    at.state[n] = is_off ? int{RayPlaces::kDone} : known;
    at.depth[n] = is_off ? -kFar : is_level ? level : sloped;
  }
}

using BlockFloats = float __attribute__((vector_size(32)));
using BlockInts = std::int32_t __attribute__((vector_size(32)));
static_assert(sizeof(BlockFloats) == CellBlocks::kCells * sizeof(float));

// By reference: without AVX there is no agreed way to hand such a vector over.
static inline void read_entries(const float* table, const BlockInts& at, BlockFloats& read) {
#if defined(__AVX2__)
  read = _mm256_i32gather_ps(table, reinterpret_cast<const __m256i&>(at), 4);
#else
  for (int n = 0; n < CellBlocks::kCells; ++n) read[n] = table[at[n]];
#endif
}
/// A bit for each that holds.
static inline unsigned bits_of(const BlockInts& holds) {
#if defined(__AVX2__)
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<const __m256&>(holds)));
#else
  unsigned bits = 0;
  for (int n = 0; n < CellBlocks::kCells; ++n) bits |= holds[n] != 0 ? 1U << n : 0U;
  return bits;
#endif
}

static int collect(const CellBlocks& blocks, CellBatch& cells) {
  constexpr int kX = CellBlocks::kX, kCells = CellBlocks::kCells;
  BlockFloats right{}, y2{}, low{}, height{};
  BlockInts first{}, last{};
  double y[kCells];
  for (int n = 0; n < kCells; ++n) {
    y[n] = blocks.y + n / kX * blocks.cell_y;
    right[n] = static_cast<float>(n % kX * blocks.cell_x);
    y2[n] = static_cast<float>(y[n] * y[n]);
    first[n] = blocks.first[n / kX] - blocks.i - n % kX;
    last[n] = blocks.last[n / kX] - blocks.i - n % kX;
  }
  const auto to_part = static_cast<float>(blocks.to_part), tip = static_cast<float>(blocks.tip);
  const auto last_part = static_cast<float>(blocks.last_part);
  int count = cells.count, block = 0;
  for (; block < blocks.count && count + kCells <= CellBatch::kMost; ++block) {
    const float* const heights = blocks.heights + block * kCells;
    const double left = blocks.x + block * kX * blocks.cell_x;
    const BlockFloats x = right + static_cast<float>(left);
    const BlockFloats parts = (x * x + y2) * to_part;
    const BlockFloats within = parts < last_part ? parts : BlockFloats{} + last_part;
    read_entries(blocks.low_lift, __builtin_convertvector(within, BlockInts), low);
    __builtin_memcpy(&height, heights, sizeof height);
    const int i = block * kX;
    const BlockInts is_asked = (first <= i) & (last >= i);
    unsigned bits = bits_of((height - tip > low) & is_asked);
    for (; bits != 0; bits &= bits - 1) {
      const int n = __builtin_ctz(bits);
      cells.x[count] = left + n % kX * blocks.cell_x, cells.y[count] = y[n];
      cells.height[count] = static_cast<double>(heights[n]);
      ++count;
    }
  }
  cells.count = count;
  return block;
}

static void take_cells(const CellGround& ground, const FrontEnd& end, const HeldWay& held,
                       const LiftTable& table, CellBatch& cells) {
  const int count = cells.count;
  const double* const lift = table.lift;
  const double scale = table.scale, last = table.last;
  KERF_EACH_APART
  for (int n = 0; n < count; ++n) {
    const double x = cells.x[n], y = cells.y[n];
    cells.radius[n] = root_of(x * x + y * y);
    cells.lift[n] = lift_at(lift, scale, last, cells.radius[n]);
  }
  if (held.length > 0) {
    const HeldWay way = held;
    const double leans = held.slope != 0 ? 1.0 : 0.0, wall_slope = ground.wall_slope;
    const double cutter2 = ground.radius * ground.radius;
    const double center_x = ground.center_x, center_y = ground.center_y;
    KERF_EACH_APART
    for (int n = 0; n < count; ++n) {
      const double arm_x = center_x + cells.x[n] - way.start_x;
      const double arm_y = center_y + cells.y[n] - way.start_y;
      const double beside = way.along_x * arm_y - way.along_y * arm_x;
      const double along = arm_x * way.along_x + arm_y * way.along_y;
      const double nearest = within(along, 0.0, way.length);
      const double half2 = cutter2 - beside * beside;
      const bool is_over = (along - nearest) * (along - nearest) < half2;
      const double half = root_of(is_over ? half2 : 0.0);
      const double low = most_of(0.0, along - half), high = least_of(way.length, along + half);
      const double leaning = within(along - way.lean * half, low, high);
      const double at = leans > 0 ? leaning : nearest;
      const double distance = root_of((along - at) * (along - at) + beside * beside);
      const double scaled = least_of(distance * scale, last);
      const int k = static_cast<int>(scaled);
      const double step = lift[k + 1] - lift[k];
      const double part = (step * scale > wall_slope ? 0.0 : 1.0) * (scaled - k);
      const double left = way.z + way.slope * at + lift[k] + part * step;
      const double height = cells.height[n];
      const bool is_lower = (height > way.lowest) & is_over & (left < height);
      cells.height[n] = is_lower ? left : height;
    }
  }
  const double radius2 = end.is_near ? end.radius2 : kFar;
  KERF_EACH_APART
  for (int n = 0; n < count; ++n) {
    const double arm_x = ground.center_x + cells.x[n] - end.x;
    const double arm_y = ground.center_y + cells.y[n] - end.y;
    const bool is_on_way = (arm_x * arm_x + arm_y * arm_y < radius2) |
                           (arm_x * end.along_x + arm_y * end.along_y <= 0);
    const double depth = cells.height[n] - (ground.tip + cells.lift[n] + ground.film);
    cells.depth[n] = is_on_way ? depth : -1.0;
  }
  if (ground.slope <= 0) return;
  KERF_EACH_APART
  for (int n = 0; n < count; ++n) {
    const int k = static_cast<int>(least_of(cells.radius[n] * scale, last - 1));
    const double rises = (lift[k + 1] - lift[k]) * scale;
    const double ahead = cells.x[n] * ground.ahead_x + cells.y[n] * ground.ahead_y;
    const bool is_left = rises * ahead <= ground.slope * cells.radius[n];
    cells.depth[n] = is_left ? -1.0 : cells.depth[n];
  }
}

/// atan2, right to 2e-5: a thousandth of the step between two directions.
static inline double direction_of(double y, double x) {
  const double over = size_of(y), out = size_of(x);
  const double part = least_of(over, out) / most_of(most_of(over, out), 1e-300);
  const double square = part * part;
  // Abramowitz and Stegun, Handbook of Mathematical Functions, 4.4.49.
  const double first =
      part *
      (0.9998660 +
       square * (-0.3302995 + square * (0.1801410 + square * (-0.0851330 + square * 0.0208351))));
  const double second = over > out ? kTurn / 2 - first : first;
  const double angle = x < 0 ? kTurn - second : second;
  return y < 0 ? -angle : angle;
}

/// Of directions up to `step`, `per_step` each; what is between two steps is shared by them.
static inline void end_at(CellBatch::End& end, int n, double step, double per_step) {
  const int low = static_cast<int>(step);
  const double beyond = step - low, before = 1 - beyond;
  const double third = 0.5 * per_step * beyond * beyond;
  const double first = 0.5 * per_step * before * before;
  end.low[n] = low;
  end.first[n] = first, end.second[n] = per_step - first - third, end.third[n] = third;
}

static void place_cells(const CellGround& ground, const LiftTable& table,
                        const CellWeights& weights, double least, double per_step,
                        CellBatch& cells) {
  const int count = cells.count;
  const double* const lift = table.lift;
  const double scale = table.scale, last = table.last;
  KERF_EACH_APART
  for (int n = 0; n < count; ++n) {
    const double x = cells.x[n], y = cells.y[n];
    const double ahead = x * ground.ahead_x + y * ground.ahead_y;
    const double beside = ground.ahead_x * y - ground.ahead_y * x;
    cells.ahead[n] = ahead, cells.beside[n] = beside;
    cells.step[n] = (direction_of(beside, ahead) + kTurn / 2) * per_step;
    cells.under[n] = lift_at(lift, scale, last, size_of(beside));
  }
  const double *const height_rad = weights.height_rad, *const thick = weights.thick_per_mm,
                      *const steps = weights.steps;
  double share[CellBatch::kMost];
  KERF_EACH_APART
  for (int n = 0; n < count; ++n) cells.radius[n] = most_of(cells.radius[n], least);
  if (ground.fresh > 0) {
    const double* const upright = weights.upright;
    const double half = 0.5 * ground.fresh, thin = ground.thin, thinnest = ground.thinnest;
    KERF_EACH_APART
    for (int n = 0; n < count; ++n) {
      const double radius = cells.radius[n];
      const int k = static_cast<int>(radius * scale);
      const double chip = within(half * upright[k] * (cells.ahead[n] / radius), thinnest, thin);
      const double counts = thick[k] * (thin / chip);
      share[n] = least_of(1.0, counts * cells.depth[n]) * height_rad[k];
    }
  } else {
    KERF_EACH_APART
    for (int n = 0; n < count; ++n) {
      const int k = static_cast<int>(cells.radius[n] * scale);
      share[n] = least_of(1.0, thick[k] * cells.depth[n]) * height_rad[k];
    }
  }
  const double last_step = weights.last_step;
  KERF_EACH_APART
  for (int n = 0; n < count; ++n) {
    const double wide = steps[static_cast<int>(cells.radius[n] * scale)], step = cells.step[n];
    const double from = within(step - 0.5 * wide, 0.0, last_step);
    const double to = within(step + 0.5 * wide, 0.0, last_step);
    const double dense = from < to ? share[n] / wide : 0.0;
    end_at(cells.first_end, n, from, -dense);
    end_at(cells.last_end, n, to, dense);
  }
  KERF_EACH_APART
  for (int n = 0; n < count; ++n) {
    const double above_tip = least_of(cells.depth[n] + cells.lift[n], ground.most_above_tip);
    cells.deep[n] = above_tip - cells.under[n];
  }
  double deepest = -kFar, farthest = -kFar, leftmost = -kFar, rightmost = kFar;
  for (int n = 0; n < count; ++n) {
    if (cells.ahead[n] < 0) continue;
    deepest = most_of(deepest, cells.deep[n]);
    farthest = most_of(farthest, cells.radius[n]);
    leftmost = most_of(leftmost, cells.beside[n]);
    rightmost = least_of(rightmost, cells.beside[n]);
  }
  cells.most_deep = deepest, cells.most_radius = farthest;
  cells.most_beside = leftmost, cells.least_beside = rightmost;
}

}  // namespace kerf::KERF_FRONT_NAMESPACE
