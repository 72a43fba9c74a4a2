#include "twin/compare/design_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "base/placement.h"

namespace kerf {
namespace {

using Mat3 = glm::dmat3;

constexpr int kMostSteps = 80;
constexpr double kStill_mm = 1e-7;
/// Points that face otherwise than their triangle by more than 45 degrees are of another face.
constexpr double kSameFace = 0.7;
constexpr double kFarther = 3;
/// What nothing holds stays: part of the greatest diagonal element.
constexpr double kHeld = 1e-7;

Mat3 turned_about(const Vec3& rotation) {
  const double angle = glm::length(rotation);
  if (angle == 0) return Mat3(1);
  const Vec3 u = rotation / angle;
  const double c = std::cos(angle), s = std::sin(angle);
  const Mat3 across(0, u.z, -u.y, -u.z, 0, u.x, u.y, -u.x, 0);
  return Mat3(c) + s * across + (1 - c) * glm::outerProduct(u, u);
}

Mat3 matrix_of(const DesignPlacement& placement) {
  const DesignPlacement turn{Vec3(0), placement.turn_deg};
  return {turn.placed({1, 0, 0}), turn.placed({0, 1, 0}), turn.placed({0, 0, 1})};
}

/// R = Rz Ry Rx.
DesignPlacement placement_of(const Mat3& turn, const Vec3& shift) {
  constexpr double kToDeg = 180 / kPi;
  const double sin_y = std::clamp(-turn[0][2], -1.0, 1.0);
  Vec3 deg(0);
  deg.y = std::asin(sin_y) * kToDeg;
  if (std::abs(sin_y) < 1 - 1e-12) {
    deg.x = std::atan2(turn[1][2], turn[2][2]) * kToDeg;
    deg.z = std::atan2(turn[0][1], turn[0][0]) * kToDeg;
  } else {
    deg.z = std::atan2(-turn[1][0], turn[1][1]) * kToDeg;
  }
  return {shift, deg};
}

using Vec6 = std::array<double, 6>;
using Mat6 = std::array<Vec6, 6>;

/// Solves a x = b for a symmetric positive matrix, by Cholesky's way. False: it is none.
bool solve(Mat6 a, Vec6 b, Vec6& x) {
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
      if (i == j) {
        if (!(sum > 0)) return false;
        a[i][i] = std::sqrt(sum);
      } else {
        a[i][j] = sum / a[j][j];
      }
    }
  }
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  for (std::size_t i = 6; i-- > 0;) {
    for (std::size_t k = i + 1; k < 6; ++k) b[i] -= a[k][i] * b[k];
    b[i] /= a[i][i];
  }
  x = b;
  return true;
}

struct Pair {
  Vec3 point, normal;  ///< in the design's frame; of the design
  double off = 0;
  double doubt = 0;
};

class Fitter {
 public:
  Fitter(const DesignPart& design, const std::vector<FitPoint>& points)
      : design_(design), points_(points) {}

  std::optional<DesignFit> run(const DesignPlacement& start) {
    turn_ = glm::transpose(matrix_of(start));
    shift_ = -(turn_ * start.shift_mm);
    for (int step = 0; step < kMostSteps; ++step) {
      find_pairs();
      if (pairs_.size() < 6) return std::nullopt;
      const double moved = improve();
      if (moved < kStill_mm) break;
    }
    find_pairs();
    if (pairs_.size() < 6) return std::nullopt;
    DesignFit fit;
    double sum = 0;
    for (const Pair& pair : pairs_) sum += pair.off * pair.off;
    fit.residue_mm = std::sqrt(sum / static_cast<double>(pairs_.size()));
    fit.share = static_cast<double>(pairs_.size()) / static_cast<double>(points_.size());
    const Mat3 back = glm::transpose(turn_);
    fit.placement = placement_of(back, -(back * shift_));
    return fit;
  }

 private:
  void find_pairs() {
    pairs_.clear();
    std::uint32_t hint = 0;
    for (const FitPoint& p : points_) {
      const Vec3 at = turn_ * p.at_mm + shift_, facing = turn_ * p.normal;
      const NearestPoint near = design_.nearest(at, hint);
      hint = near.triangle;
      const std::array<glm::vec3, 3>& c = design_.corners(near.triangle);
      Vec3 normal = glm::cross(Vec3(c[1]) - Vec3(c[0]), Vec3(c[2]) - Vec3(c[0]));
      const double size = glm::length(normal);
      if (!(size > 0)) continue;
      normal *= (design_.is_inside_out() ? -1 : 1) / size;
      if (glm::dot(normal, facing) < kSameFace) continue;
      pairs_.push_back({at, normal, glm::dot(at - near.point_mm, normal), p.doubt_mm});
    }
    if (pairs_.empty()) return;
    std::vector<double> sizes;
    sizes.reserve(pairs_.size());
    for (const Pair& pair : pairs_) sizes.push_back(std::abs(pair.off));
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    const double most = std::max(kFarther * *middle, 1e-6);
    std::erase_if(pairs_, [most](const Pair& pair) {
      return std::abs(pair.off) > std::max(most, pair.doubt);
    });
  }

  /// Returns how far the farthest point went, about.
  double improve() {
    Vec3 middle(0);
    for (const Pair& pair : pairs_) middle += pair.point;
    middle /= static_cast<double>(pairs_.size());
    Mat6 a{};
    Vec6 b{};
    double reach = 0;
    for (const Pair& pair : pairs_) {
      const Vec3 arm = pair.point - middle;
      reach = std::max(reach, glm::length(arm));
      const Vec3 by_turn = glm::cross(arm, pair.normal);
      const Vec6 row{by_turn.x, by_turn.y, by_turn.z, pair.normal.x, pair.normal.y, pair.normal.z};
      for (std::size_t i = 0; i < 6; ++i) {
        b[i] -= row[i] * pair.off;
        for (std::size_t j = 0; j < 6; ++j) a[i][j] += row[i] * row[j];
      }
    }
    const double count = static_cast<double>(pairs_.size());
    for (std::size_t i = 0; i < 6; ++i)
      a[i][i] += kHeld * count * (i < 3 ? reach * reach : 1.0) + 1e-12;
    Vec6 x{};
    if (!solve(a, b, x)) return 0;
    const Vec3 rotation(x[0], x[1], x[2]), way(x[3], x[4], x[5]);
    const Mat3 turn = turned_about(rotation);
    turn_ = turn * turn_;
    shift_ = turn * (shift_ - middle) + middle + way;
    return glm::length(rotation) * reach + glm::length(way);
  }

  const DesignPart& design_;
  const std::vector<FitPoint>& points_;
  Mat3 turn_{1};  ///< from the workpiece frame to the design's, before the shift
  Vec3 shift_{0};
  std::vector<Pair> pairs_;
};

/// Calls take(corners, area) for what was cut, or for all.
template <class Take>
void each_surface(const StockModel& stock, bool only_cut, const Take& take) {
  for (std::uint32_t tile = 0; tile < stock.tile_count(); ++tile) {
    const MeshPatch patch = stock.patch(tile, 0);
    const std::span<const std::uint32_t> indices = patch.surface_indices();
    for (std::size_t n = 0; n + 2 < indices.size(); n += 3) {
      if (only_cut && !patch.cut_by.empty()) {
        const auto is_blank = [&](std::size_t k) {
          return patch.cut_by[indices[n + k]] == MeshPatch::kNotCut;
        };
        if (is_blank(0) || is_blank(1) || is_blank(2)) continue;
      }
      std::array<Vec3, 3> corners;
      for (std::size_t k = 0; k < 3; ++k)
        corners[k] = Vec3(patch.vertices[indices[n + k]].position_mm);
      const Vec3 across = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
      take(corners, across, 0.5 * glm::length(across));
    }
  }
}

}  // namespace

std::vector<FitPoint> fit_points(const StockModel& stock, std::size_t count) {
  double area = 0;
  bool only_cut = true;
  const auto measure = [&](const auto&, const Vec3&, double mm2) { area += mm2; };
  each_surface(stock, true, measure);
  if (area == 0) {
    only_cut = false;
    each_surface(stock, false, measure);
  }
  std::vector<FitPoint> points;
  points.reserve(count + 1);
  const double step = area / static_cast<double>(count);
  const double half_cell_mm = 0.5 * stock.cell_mm();
  double walked = 0.5 * step, turn = 0;
  each_surface(stock, only_cut, [&](const auto& corners, const Vec3& across, double mm2) {
    if (!(mm2 > 0)) return;
    for (walked -= mm2; walked < 0; walked += step) {
      // Places that do not repeat: multiples of two irrational numbers (R2 sequence).
      turn += 1;
      double u = std::fmod(0.7548776662466927 * turn, 1.0);
      double v = std::fmod(0.5698402909980532 * turn, 1.0);
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      const Vec3 normal = glm::normalize(across);
      points.push_back({corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]),
                        normal, half_cell_mm * glm::length(Vec2(normal))});
    }
  });
  return points;
}

std::optional<DesignFit> fit_design(const DesignPart& design, const std::vector<FitPoint>& points,
                                    const DesignPlacement& start) {
  return Fitter(design, points).run(start);
}

namespace {

/// A close fit of few points is none.
double badness(const DesignFit& fit) { return (fit.residue_mm + 1e-3) / (fit.share * fit.share); }

void keep_better(const std::optional<DesignFit>& fit, std::optional<DesignFit>& best) {
  if (fit && (!best || badness(*fit) < badness(*best))) best = fit;
}

Box turned_box(const Box& own, const Vec3& turn_deg) {
  Placement turn = Placement::turned(turn_deg);
  return turn.placed(own);
}

/// In its middle with the tops level, and corner on corner.
std::array<Vec3, 2> guessed_shifts(const Box& blank, const Box& box) {
  Vec3 centered = 0.5 * (blank.min + blank.max - box.min - box.max);
  centered.z = blank.max.z - box.max.z;
  return {centered, blank.min - box.min};
}

/// All ways to lay it on its sides from how it lies, itself left out, as turns about X, Y, Z.
std::vector<Vec3> quarter_turns(const Vec3& start_deg) {
  const Mat3 start = matrix_of({Vec3(0), start_deg});
  std::vector<Mat3> known{start};
  std::vector<Vec3> out;
  for (const double x : {0.0, 90.0, 180.0, 270.0})
    for (const double y : {0.0, 90.0, 270.0})
      for (const double z : {0.0, 90.0, 180.0, 270.0}) {
        const Mat3 turn = matrix_of({Vec3(0), Vec3(x, y, z)}) * start;
        const bool is_known = std::ranges::any_of(known, [&](const Mat3& other) {
          double off = 0;
          for (int k = 0; k < 3; ++k) off = std::max(off, glm::length(turn[k] - other[k]));
          return off < 1e-6;
        });
        if (is_known) continue;
        known.push_back(turn);
        out.push_back(placement_of(turn, Vec3(0)).turn_deg);
      }
  return out;
}

bool goes_into(const Box& box, const Box& blank) {
  constexpr double kShare = 1.02, kSpare_mm = 1;
  const Vec3 size = box.size(), most = blank.size();
  for (int axis = 0; axis < 3; ++axis)
    if (size[axis] > kShare * most[axis] + kSpare_mm) return false;
  return true;
}

}  // namespace

std::optional<DesignFit> fit_design_in_blank(const DesignPart& design, const Box& blank,
                                             const std::vector<FitPoint>& points,
                                             const DesignPlacement& start) {
  std::optional<DesignFit> best = fit_design(design, points, start);
  for (const Vec3& shift : guessed_shifts(blank, turned_box(design.box_mm(), start.turn_deg)))
    keep_better(fit_design(design, points, {shift, start.turn_deg}), best);
  constexpr double kGood_mm = 0.02;
  if (best && badness(*best) < kGood_mm) return best;
  // It may lie on another side. Few points tell which; then all say where.
  constexpr std::size_t kEach = 10, kClosest = 3;
  std::vector<FitPoint> some;
  for (std::size_t n = 0; n < points.size(); n += kEach) some.push_back(points[n]);
  std::vector<DesignFit> found;
  for (const Vec3& turn_deg : quarter_turns(start.turn_deg)) {
    const Box box = turned_box(design.box_mm(), turn_deg);
    if (!goes_into(box, blank)) continue;
    for (const Vec3& shift : guessed_shifts(blank, box)) {
      if (const auto fit = fit_design(design, some, {shift, turn_deg})) found.push_back(*fit);
    }
  }
  std::ranges::stable_sort(
      found, [](const DesignFit& a, const DesignFit& b) { return badness(a) < badness(b); });
  for (std::size_t n = 0; n < std::min(kClosest, found.size()); ++n)
    keep_better(fit_design(design, points, found[n].placement), best);
  return best;
}

}  // namespace kerf
