#include "twin/compare/deviation_sums.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

namespace kerf {
namespace {

constexpr double kCubeCells = 3;
/// Of a cube's place in one direction; places are counted from a million cubes below zero.
constexpr unsigned kKeyBits = 21;
constexpr std::int64_t kKeyMiddle = std::int64_t{1} << (kKeyBits - 1);
constexpr std::int64_t kKeyLast = (std::int64_t{1} << kKeyBits) - 1;

}  // namespace

DeviationSums::DeviationSums(double tolerance_mm, double cell_mm)
    : tolerance_mm_(tolerance_mm), cube_mm_(kCubeCells * cell_mm) {}

std::uint64_t DeviationSums::key(std::int64_t x, std::int64_t y, std::int64_t z) {
  const auto bits = [](std::int64_t place) {
    return static_cast<std::uint64_t>(std::clamp<std::int64_t>(place + kKeyMiddle, 0, kKeyLast));
  };
  return bits(x) | bits(y) << kKeyBits | bits(z) << 2 * kKeyBits;
}

std::uint64_t DeviationSums::key_of(const Vec3& p) const {
  const auto place = [this](double mm) {
    return static_cast<std::int64_t>(std::floor(mm / cube_mm_));
  };
  return key(place(p.x), place(p.y), place(p.z));
}

void DeviationSums::add(const SurfaceSample& sample) {
  const double size = std::abs(sample.deviation_mm);
  if (!sample.is_extra) {
    area_mm2_ += sample.area_mm2;
    if (size <= tolerance_mm_) within_mm2_ += sample.area_mm2;
    std::size_t steps = 0;
    while (steps < kSteps.size() && size > kSteps[steps] * tolerance_mm_) ++steps;
    bins_[sample.deviation_mm < 0 ? kSteps.size() - steps : kSteps.size() + steps] +=
        sample.area_mm2;
  }
  if (!(size > tolerance_mm_)) return;
  const std::size_t kind = sample.deviation_mm < 0 ? 1 : 0;
  const std::uint64_t at = key_of(sample.at_mm);
  if (last_[kind] == nullptr || last_key_[kind] != at) {
    last_[kind] = &cubes_[kind][at];
    last_key_[kind] = at;
  }
  Cube& cube = *last_[kind];
  if (size > cube.worst_mm) {
    cube.worst_mm = size;
    cube.at_mm = sample.at_mm;
    cube.cut_by = sample.cut_by;
  }
  cube.box_mm.extend(sample.at_mm);
  cube.area_mm2 += sample.is_extra ? 0 : sample.area_mm2;
  cube.volume_mm3 += sample.volume_mm3;
  volume_mm3_[kind] += sample.volume_mm3;
}

void DeviationSums::add_beside(const Vec3& at_mm, bool is_gouge, double volume_mm3) {
  Cubes& cubes = cubes_[is_gouge ? 1 : 0];
  Cube* nearest = nullptr;
  int least = 4;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const int steps = std::abs(x) + std::abs(y) + std::abs(z);
        if (steps >= least) continue;
        const auto found = cubes.find(key_of(at_mm + cube_mm_ * Vec3(x, y, z)));
        if (found == cubes.end()) continue;
        nearest = &found->second;
        least = steps;
      }
  if (nearest == nullptr) return;
  nearest->volume_mm3 += volume_mm3;
  volume_mm3_[is_gouge ? 1 : 0] += volume_mm3;
}

std::vector<DeviationBin> DeviationSums::histogram() const {
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  std::vector<double> edges{-kEndless};
  for (std::size_t n = kSteps.size(); n-- > 0;) edges.push_back(-kSteps[n] * tolerance_mm_);
  for (const double step : kSteps) edges.push_back(step * tolerance_mm_);
  edges.push_back(kEndless);
  std::vector<DeviationBin> bins;
  for (std::size_t n = 0; n < bins_.size(); ++n) bins.push_back({edges[n], edges[n + 1], bins_[n]});
  return bins;
}

void DeviationSums::gather(bool is_gouge, std::vector<FoundRegion>& out) const {
  const Cubes& cubes = cubes_[is_gouge ? 1 : 0];
  // In the order of their places: the result does not depend on how a table is filled.
  std::vector<std::uint64_t> keys;
  keys.reserve(cubes.size());
  for (const auto& [at, cube] : cubes) keys.push_back(at);
  std::ranges::sort(keys);
  std::vector<bool> is_taken(keys.size());
  std::vector<std::size_t> waiting;
  std::unordered_map<std::uint32_t, double> by;
  for (std::size_t first = 0; first < keys.size(); ++first) {
    if (is_taken[first]) continue;
    FoundRegion region;
    region.is_gouge = is_gouge;
    by.clear();
    is_taken[first] = true;
    waiting.assign(1, first);
    while (!waiting.empty()) {
      const std::uint64_t at = keys[waiting.back()];
      waiting.pop_back();
      const Cube& cube = cubes.at(at);
      if (cube.worst_mm > region.worst_mm) {
        region.worst_mm = cube.worst_mm;
        region.at_mm = cube.at_mm;
        region.cut_by = cube.cut_by;
      }
      region.box_mm.extend(cube.box_mm);
      region.area_mm2 += cube.area_mm2;
      region.volume_mm3 += cube.volume_mm3;
      by[cube.cut_by] += cube.volume_mm3;
      const auto place = [at](unsigned axis) {
        return static_cast<std::int64_t>(at >> axis * kKeyBits & std::uint64_t{kKeyLast}) -
               kKeyMiddle;
      };
      for (std::int64_t z = -1; z <= 1; ++z)
        for (std::int64_t y = -1; y <= 1; ++y)
          for (std::int64_t x = -1; x <= 1; ++x) {
            const std::uint64_t beside = key(place(0) + x, place(1) + y, place(2) + z);
            const auto found = std::ranges::lower_bound(keys, beside);
            if (found == keys.end() || *found != beside) continue;
            const auto number = static_cast<std::size_t>(found - keys.begin());
            if (is_taken[number]) continue;
            is_taken[number] = true;
            waiting.push_back(number);
          }
    }
    region.cut_by_mm3.assign(by.begin(), by.end());
    std::ranges::sort(region.cut_by_mm3, [](const auto& a, const auto& b) {
      return a.second != b.second ? a.second > b.second : a.first < b.first;
    });
    out.push_back(std::move(region));
  }
}

std::vector<FoundRegion> DeviationSums::regions() const {
  std::vector<FoundRegion> out;
  gather(true, out);
  const auto gouges = static_cast<std::ptrdiff_t>(out.size());
  gather(false, out);
  const auto by_depth = [](const FoundRegion& a, const FoundRegion& b) {
    return a.worst_mm > b.worst_mm;
  };
  std::stable_sort(out.begin(), out.begin() + gouges, by_depth);
  std::stable_sort(out.begin() + gouges, out.end(), by_depth);
  return out;
}

}  // namespace kerf
