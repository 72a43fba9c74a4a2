// twin/compare/deviation_sums.h - adds up the deviations of a surface, and finds what hangs
// together.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "base/geometry.h"
#include "twin/compare/comparison.h"

namespace kerf {

/// A piece of the workpiece's surface, so small that one deviation stands for it.
struct SurfaceSample {
  Vec3 at_mm{0};
  double deviation_mm = 0;
  double area_mm2 = 0;
  double volume_mm3 = 0;  ///< of gouge or excess that is counted with it, positive
  std::uint32_t cut_by = 0;
  /// Nothing is to be added to the area: the place is looked at for itself.
  bool is_extra = false;
};

/// A region before anybody asks for names.
struct FoundRegion {
  bool is_gouge = false;
  double worst_mm = 0;  ///< positive
  Vec3 at_mm{0};
  std::uint32_t cut_by = 0;  ///< there
  Box box_mm;
  double area_mm2 = 0, volume_mm3 = 0;
  std::vector<std::pair<std::uint32_t, double>> cut_by_mm3;  ///< by volume, the greatest first
};

/// Samples beyond the tolerance are put into cubes of three cells; cubes of one kind that touch,
/// at a corner at least, are one region. Memory and time go with what is beyond the tolerance:
/// about 150 bytes a cube, 30 ns a sample. One thread.
class DeviationSums {
 public:
  DeviationSums(double tolerance_mm, double cell_mm);

  void add(const SurfaceSample& sample);
  /// Volume that no deviation beyond the tolerance lies in, such as a thin layer's: it counts where
  /// the cube of the place, or one beside it, has such a deviation of that kind already.
  void add_beside(const Vec3& at_mm, bool is_gouge, double volume_mm3);

  double tolerance_mm() const { return tolerance_mm_; }
  double area_mm2() const { return area_mm2_; }
  double within_mm2() const { return within_mm2_; }
  double volume_mm3(bool is_gouge) const { return volume_mm3_[is_gouge ? 1 : 0]; }
  std::vector<DeviationBin> histogram() const;
  /// Gouges first, of each kind the deepest first.
  std::vector<FoundRegion> regions() const;

  /// In parts of the tolerance, on either side.
  static constexpr std::array kSteps{0.5, 1.0, 2.0, 4.0, 10.0};

 private:
  struct Cube {
    double worst_mm = 0;
    Vec3 at_mm{0};
    std::uint32_t cut_by = 0;
    Box box_mm;
    double area_mm2 = 0, volume_mm3 = 0;
  };
  using Cubes = std::unordered_map<std::uint64_t, Cube>;
  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z);
  std::uint64_t key_of(const Vec3& p) const;
  void gather(bool is_gouge, std::vector<FoundRegion>& out) const;

  double tolerance_mm_, cube_mm_;
  double area_mm2_ = 0, within_mm2_ = 0;
  std::array<double, 2> volume_mm3_{};
  std::array<double, 2 * kSteps.size() + 1> bins_{};
  std::array<Cubes, 2> cubes_;  ///< excess, gouge
  std::array<std::uint64_t, 2> last_key_{};
  std::array<Cube*, 2> last_{};
};

}  // namespace kerf
