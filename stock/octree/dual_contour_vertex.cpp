#include "stock/octree/dual_contour_vertex.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <utility>

namespace kerf {
namespace {

/// Least ratio of an eigenvalue to the greatest that counts as a fold: one crossing in ten of a
/// face that is turned by 28 degrees makes 0.02, the curvature of a face less than 0.005.
constexpr double kLeastEigenvalue = 0.01;
/// Sweeps of Jacobi's method; four reach double precision, as convergence is quadratic.
constexpr int kJacobiSweeps = 6;
/// Sweeps of the projected Gauss-Seidel method, for the few vertices outside of their cells.
constexpr int kBoxSweeps = 64;
/// Cells: planes that miss a point by no more meet there, if curved faces are taken for planes.
constexpr float kMeetingMiss = 0.05f;
/// Share of a cell by which rounding may carry a vertex that is at the cell's side.
constexpr double kSideRounding = 1e-6;

/// One rotation of Jacobi's method: makes m[p][q] zero.
void rotate(glm::dmat3& m, glm::dmat3& vectors, int p, int q) {
  if (m[p][q] == 0.0) return;
  const double theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
  const double t = (theta < 0.0 ? -1.0 : 1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
  const double cosine = 1.0 / std::sqrt(t * t + 1.0), sine = t * cosine;
  const int r = 3 - p - q;
  const double shift = t * m[p][q], mrp = m[r][p], mrq = m[r][q];
  m[p][p] -= shift;
  m[q][q] += shift;
  m[p][q] = m[q][p] = 0.0;
  m[r][p] = m[p][r] = cosine * mrp - sine * mrq;
  m[r][q] = m[q][r] = sine * mrp + cosine * mrq;
  const glm::dvec3 vp = vectors[p], vq = vectors[q];
  vectors[p] = cosine * vp - sine * vq;
  vectors[q] = sine * vp + cosine * vq;
}

/// Greatest eigenvalue first.
struct Eigen {
  std::array<double, 3> values;
  std::array<glm::dvec3, 3> vectors;
};
Eigen eigen_of(const std::array<double, 6>& a) {
  glm::dmat3 m(a[0], a[1], a[2], a[1], a[3], a[4], a[2], a[4], a[5]);
  glm::dmat3 vectors(1.0);
  const double tiny = 1e-32 * (a[0] + a[3] + a[5]) * (a[0] + a[3] + a[5]);
  for (int sweep = 0; sweep < kJacobiSweeps; ++sweep) {
    if (m[0][1] * m[0][1] + m[0][2] * m[0][2] + m[1][2] * m[1][2] <= tiny) break;
    rotate(m, vectors, 0, 1);
    rotate(m, vectors, 0, 2);
    rotate(m, vectors, 1, 2);
  }
  std::array<int, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return m[i][i] > m[j][j]; });
  Eigen out;
  for (std::size_t n = 0; n < 3; ++n) {
    out.values[n] = m[order[n]][order[n]];
    out.vectors[n] = vectors[order[n]];
  }
  return out;
}

bool is_in_box(const glm::dvec3& x, const glm::dvec3& size) {
  for (int axis = 0; axis < 3; ++axis) {
    const double rounding = kSideRounding * size[axis];
    if (x[axis] < -rounding || x[axis] > size[axis] + rounding) return false;
  }
  return true;
}

/// Whether the planes do meet in a point, and that is near the cell.
bool is_near_meeting(std::span<const DualSample> samples, const glm::vec3& at_mm,
                     const glm::vec3& cell_mm) {
  for (int axis = 0; axis < 3; ++axis) {
    const float reach = (samples.size() > 3 ? kDualReach : kDualReachOfThree) * cell_mm[axis];
    if (at_mm[axis] < -reach || at_mm[axis] > cell_mm[axis] + reach) return false;
  }
  const float most = kMeetingMiss * std::min({cell_mm.x, cell_mm.y, cell_mm.z});
  return std::all_of(samples.begin(), samples.end(), [&](const DualSample& sample) {
    return std::abs(glm::dot(sample.normal, at_mm - sample.at_mm)) <= most;
  });
}

/// The point of the line that is nearest to `at` among those in the box, if there are any.
bool clip_line(const glm::dvec3& at, const glm::dvec3& way, const glm::dvec3& size,
               glm::dvec3* out) {
  double low = -1e30, high = 1e30;
  for (int axis = 0; axis < 3; ++axis) {
    const double rounding = kSideRounding * size[axis];
    const double to_low = -rounding - at[axis], to_high = size[axis] + rounding - at[axis];
    if (std::abs(way[axis]) < 1e-12) {
      if (to_low > 0.0 || to_high < 0.0) return false;
      continue;
    }
    const double one = to_low / way[axis], other = to_high / way[axis];
    low = std::max(low, std::min(one, other));
    high = std::min(high, std::max(one, other));
  }
  if (low > high) return false;
  *out = at + std::clamp(0.0, low, high) * way;
  return true;
}

/// Where the fifth face of a corner had to share a cluster, normals may cancel out.
template <class Vector>
Vector unit_or(const Vector& sum, const Vector& otherwise) {
  return glm::dot(sum, sum) > 1e-6 ? glm::normalize(sum) : otherwise;
}

/// Clusters by the farthest-point rule: the first seed is the normal farthest from the mean, each
/// next one that farthest from all seeds so far, while that is more than kDualSharp.
int find_clusters(std::span<const DualSample> samples, const glm::vec3& mean, DualPlacement* out) {
  const auto farthest = [&](const auto& nearness) {
    std::size_t best = 0;
    for (std::size_t n = 1; n < samples.size(); ++n) {
      if (nearness(n) < nearness(best)) best = n;
    }
    return best;
  };
  std::array<float, kDualEdges> nearest;
  nearest.fill(-2.0f);
  std::size_t seed = farthest([&](std::size_t n) { return glm::dot(samples[n].normal, mean); });
  int clusters = 0;
  for (;;) {
    for (std::size_t n = 0; n < samples.size(); ++n) {
      const float near = glm::dot(samples[n].normal, samples[seed].normal);
      if (near <= nearest[n]) continue;
      nearest[n] = near;
      out->cluster_of[n] = static_cast<std::uint8_t>(clusters);
    }
    ++clusters;
    seed = farthest([&](std::size_t n) { return nearest[n]; });
    if (clusters == DualPlacement::kMaxClusters || nearest[seed] >= kDualSharp) return clusters;
  }
}

}  // namespace

void DualQuadric::add(const glm::dvec3& normal, const glm::dvec3& from_about) {
  square[0] += normal.x * normal.x;
  square[1] += normal.x * normal.y;
  square[2] += normal.x * normal.z;
  square[3] += normal.y * normal.y;
  square[4] += normal.y * normal.z;
  square[5] += normal.z * normal.z;
  right += normal * glm::dot(normal, from_about);
}

DualQuadric::Least DualQuadric::least(const glm::dvec3& about_mm, int rank) const {
  const Eigen eigen = eigen_of(square);
  Least out{about_mm, 0, eigen.vectors[2]};
  for (std::size_t n = 0; n < static_cast<std::size_t>(rank); ++n) {
    if (!(eigen.values[n] > kLeastEigenvalue * eigen.values[0])) break;
    out.at_mm += eigen.vectors[n] * (glm::dot(eigen.vectors[n], right) / eigen.values[n]);
    ++out.rank;
  }
  return out;
}

glm::dvec3 DualQuadric::least_in_box(const Least& least, const glm::dvec3& about_mm,
                                     const glm::dvec3& size_mm) const {
  glm::dvec3 x = glm::clamp(least.at_mm, glm::dvec3(0), size_mm);
  if (is_in_box(least.at_mm, size_mm)) return x;
  glm::dvec3 on_line;
  if (least.rank == 2 && clip_line(least.at_mm, least.last_axis, size_mm, &on_line)) {
    return glm::clamp(on_line, glm::dvec3(0), size_mm);
  }
  const std::array<double, 6>& s = square;
  const glm::dmat3 a(s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5]);
  const double smallest = 1e-9 * (s[0] + s[3] + s[5]);
  for (int sweep = 0; sweep < kBoxSweeps; ++sweep) {
    for (int axis = 0; axis < 3; ++axis) {
      if (a[axis][axis] <= smallest) continue;
      const double slope = right[axis] - glm::dot(a[axis], x - about_mm);
      x[axis] = std::clamp(x[axis] + slope / a[axis][axis], 0.0, size_mm[axis]);
    }
  }
  return x;
}

glm::vec3 place_on_smooth_face(std::span<const DualSample> samples, const glm::vec3& mean_at_mm,
                               const glm::vec3& normal, const glm::vec3& cell_mm) {
  float above = 0.0f;
  for (const DualSample& sample : samples) {
    above += glm::dot(sample.normal, sample.at_mm - mean_at_mm);
  }
  const float step = 0.5f * above / static_cast<float>(samples.size());
  return glm::clamp(mean_at_mm + step * normal, glm::vec3(0), cell_mm);
}

DualPlacement place_dual_vertex(std::span<const DualSample> samples, const glm::vec3& cell_mm) {
  DualPlacement out;
  glm::vec3 at_sum(0), normal_sum(0);
  for (const DualSample& sample : samples) {
    at_sum += sample.at_mm;
    normal_sum += sample.normal;
  }
  const glm::vec3 mean_at = at_sum / static_cast<float>(samples.size());
  out.clusters = find_clusters(samples, normal_sum, &out);
  std::array<glm::vec3, DualPlacement::kMaxClusters> sums{};
  for (std::size_t n = 0; n < samples.size(); ++n) sums[out.cluster_of[n]] += samples[n].normal;
  for (std::size_t n = samples.size(); n-- > 0;) {
    const std::size_t cluster = out.cluster_of[n];
    out.normals[cluster] = unit_or(sums[cluster], samples[n].normal);
  }
  if (out.clusters == 1) {
    out.at_mm = place_on_smooth_face(samples, mean_at, out.normals[0], cell_mm);
    return out;
  }
  const glm::dvec3 about(mean_at);
  DualQuadric quadric;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const glm::dvec3 turned =
        glm::dvec3(samples[n].normal) + glm::dvec3(out.normals[out.cluster_of[n]]);
    quadric.add(unit_or(turned, glm::dvec3(samples[n].normal)),
                glm::dvec3(samples[n].at_mm) - about);
  }
  const glm::dvec3 size(cell_mm);
  const DualQuadric::Least least = quadric.least(about, std::min(out.clusters, 3));
  out.at_mm = glm::vec3(least.at_mm);
  if (!is_near_meeting(samples, out.at_mm, cell_mm))
    out.at_mm = glm::vec3(quadric.least_in_box(least, about, size));
  return out;
}

}  // namespace kerf
