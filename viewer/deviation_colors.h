// viewer/deviation_colors.h - the colours of deviations from a design, in the window and in files.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace kerf {

/// Too much gone in red, right in green, left over in blue: at minus kFullDeviation tolerances, at
/// minus one, at none, at one, at kFullDeviation.
inline constexpr std::array<glm::vec3, 5> kDeviationStops{
    glm::vec3(0.76f, 0.08f, 0.10f), glm::vec3(0.96f, 0.58f, 0.34f), glm::vec3(0.46f, 0.74f, 0.46f),
    glm::vec3(0.48f, 0.70f, 0.94f), glm::vec3(0.10f, 0.22f, 0.74f)};
inline constexpr double kFullDeviation = 2.0;

/// Red, green, blue of a deviation, for files: within the tolerance that of none, beyond it from
/// that of a tolerance on to the full one, as the window has it.
inline std::array<std::uint8_t, 3> deviation_rgb(double deviation_mm, double tolerance_mm) {
  const double tolerances = deviation_mm / tolerance_mm;
  const double size = std::min(std::abs(tolerances), kFullDeviation);
  glm::vec3 color = kDeviationStops[2];
  if (size > 1) {
    const std::size_t full = tolerances < 0 ? 0 : 4, first = tolerances < 0 ? 1 : 3;
    color = glm::mix(kDeviationStops[first], kDeviationStops[full],
                     static_cast<float>((size - 1) / (kFullDeviation - 1)));
  }
  std::array<std::uint8_t, 3> rgb{};
  for (int k = 0; k < 3; ++k)
    rgb[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(std::lround(255.0f * color[k]));
  return rgb;
}

}  // namespace kerf
