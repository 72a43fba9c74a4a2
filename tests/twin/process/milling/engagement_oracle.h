// tests/twin/process/milling/engagement_oracle.h - how a tool is engaged by exact geometry: every
// past move is asked about every point.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <string>
#include <unordered_map>
#include <vector>

#include "stock/stock_model.h"
#include "twin/process/engagement.h"

namespace kerf {

inline constexpr double kOracleDegree = kPi / 180;
/// The oracle's tool is so far ahead of its place, and what is thinner is not there.
inline constexpr double kOracleStep_mm = 2e-3, kOracleFilm_mm = 2e-6;

struct PastMove {
  const Cutter* cutter;
  CutMove move;
  Box box;  ///< of what it comes over
};

/// How the tool is engaged, found by asking.
struct EngagementTruth {
  double arc = 0, entry = 0, exit = 0;
  double effective_mm = 0;
  double deep_mm = 0;  ///< the highest over what the tool leaves, of all places in material
};

/// Cutters outlive it.
class EngagementOracle {
 public:
  explicit EngagementOracle(const Box& blank) : blank_(blank) {}
  void add(const Cutter& cutter, const CutMove& move) {
    Box box;
    const double reach = cutter.radius_mm() + (move.arc ? 0.1 : 0);
    for (int k = 0; k <= 200; ++k) {
      box.extend(place(move, k / 200.0) - Vec3(reach));
      box.extend(place(move, k / 200.0) + Vec3(reach));
    }
    past_.push_back({&cutter, move, box});
    for (int x = tile_of(box.min.x); x <= tile_of(box.max.x); ++x) {
      for (int y = tile_of(box.min.y); y <= tile_of(box.max.y); ++y)
        by_tile_[key_of(x, y)].push_back(past_.size() - 1);
    }
  }

  /// Height of the material at a point, when the move's own way up to `until` has been cut.
  double height(const Vec2& p, const Cutter& cutter, const CutMove& own, double until) const {
    if (p.x < blank_.min.x || p.x > blank_.max.x || p.y < blank_.min.y || p.y > blank_.max.y)
      return blank_.min.z;
    double height = blank_.max.z;
    const auto tile = by_tile_.find(key_of(tile_of(p.x), tile_of(p.y)));
    const std::vector<std::size_t> none;
    for (const std::size_t n : tile == by_tile_.end() ? none : tile->second) {
      const PastMove& past = past_[n];
      if (past.box.min.x > p.x || past.box.max.x < p.x || past.box.min.y > p.y ||
          past.box.max.y < p.y)
        continue;
      height = std::min(height, left_by(*past.cutter, past.move, 1, p));
    }
    if (until > 0) height = std::min(height, left_by(cutter, own, until, p));
    return std::max(height, blank_.min.z);
  }

  /// Is the point cut by what is left of the way?
  bool is_on_way(const Vec2& p, const Cutter& cutter, const CutMove& own, double from) const {
    CutMove rest = own;
    rest.from_mm = place(own, from);
    if (rest.arc) rest.arc->sweep_rad *= 1 - from;
    rest.from_mm.z = rest.to_mm.z = 0;
    return left_by(cutter, rest, 1, p) < 1e9;
  }

  /// In so many directions, and out to so many radii of what is not flat.
  EngagementTruth look(const Cutter& cutter, const CutMove& move, double at, int angles = 360,
                       int most_radii = 60) const {
    const double length = way_mm(move);
    const double part = at + kOracleStep_mm / length;
    const Vec3 tip = place(move, part);
    const Vec3 next = place(move, part + 1e-6 / length);
    const Vec2 ahead = glm::normalize(Vec2(next - tip)), left(-ahead.y, ahead.x);
    const double radius = cutter.radius_mm();
    const bool flat = cutter.height_mm(radius * (1 - 1e-9)) <= 0;
    EngagementTruth truth;
    // Out to where is it in material, in each direction?
    std::vector<double> out(static_cast<std::size_t>(angles), 0.0);
    double farthest = 0;
    for (int k = 0; k < angles; ++k) {
      const double phi = kPi * (k + 0.5) / angles;  // from the left
      const Vec2 way = std::cos(phi) * left + std::sin(phi) * ahead;
      const int radii = flat ? 1 : most_radii;
      // In some directions the highest of all radii, too.
      const bool to_middle = !flat && k % kDeepEach == 0;
      for (int n = radii; n > 0 && (to_middle || out[static_cast<std::size_t>(k)] == 0); --n) {
        const double r = radius * (1 - 1e-9) * n / radii;
        const Vec2 p = Vec2(tip) + r * way;
        const double own = std::max(tip.z, blank_.min.z) + cutter.height_mm(r);
        if (own + kOracleFilm_mm >= blank_.max.z) continue;
        const double stands = height(p, cutter, move, at);
        if (stands <= own + kOracleFilm_mm || !is_on_way(p, cutter, move, at)) continue;
        out[static_cast<std::size_t>(k)] = std::max(out[static_cast<std::size_t>(k)], r);
        // What the way itself has just cut beside the place stands above it, all the same.
        const double stood = flat ? stands : height(p, cutter, move, long_before(cutter, move, at));
        const double leaves =
            own + cutter.height_mm(r * std::abs(std::cos(phi))) - cutter.height_mm(r);
        truth.deep_mm = std::max(truth.deep_mm, stood - leaves);
      }
      farthest = std::max(farthest, out[static_cast<std::size_t>(k)]);
    }
    if (farthest <= 0) return truth;
    truth.effective_mm = 2 * farthest;
    if (!flat) return weighed(truth, cutter, move, at);
    int first = -1, last = -1, count = 0;
    for (int k = 0; k < angles; ++k) {
      if (out[static_cast<std::size_t>(k)] < 0.5 * farthest) continue;
      first = first < 0 ? k : first, last = k, ++count;
    }
    truth.arc = kPi * count / angles;
    truth.entry = kPi * first / angles, truth.exit = kPi * (last + 1) / angles;
    return truth;
  }

  /// What is not flat: its directions count by how high its edge is in material there; what is
  /// thinner than 0.05 mm by its thickness.
  EngagementTruth weighed(EngagementTruth truth, const Cutter& cutter, const CutMove& move,
                          double at) const {
    constexpr int kAngles = 180, kRadii = 100;
    constexpr double kThin_mm = 0.05;
    const double part = at + kOracleStep_mm / way_mm(move);
    const Vec3 tip = place(move, part), next = place(move, part + 1e-6 / way_mm(move));
    const Vec2 ahead = glm::normalize(Vec2(next - tip)), left(-ahead.y, ahead.x);
    const double radius = cutter.radius_mm() * (1 - 1e-9), floor = std::max(tip.z, blank_.min.z);
    const double before = long_before(cutter, move, at);
    double sum = 0, sum_phi = 0, sum_phi2 = 0, sum_square = 0;
    for (int k = 0; k < kAngles; ++k) {
      const double phi = kPi * (k + 0.5) / kAngles;
      const Vec2 way = std::cos(phi) * left + std::sin(phi) * ahead;
      const auto over = [&](double r) {
        const Vec2 p = Vec2(tip) + r * way;
        const double own = floor + cutter.height_mm(r);
        if (own + kOracleFilm_mm >= blank_.max.z) return 0.0;
        const double stands = height(p, cutter, move, at);
        if (stands <= own + kOracleFilm_mm || !is_on_way(p, cutter, move, at)) return 0.0;
        return height(p, cutter, move, before) - own;
      };
      double high = over(radius);  // of what is above the profile's end
      for (int n = 0; n < kRadii; ++n) {
        // Closer together farther out, where a ball is steep.
        const double r0 = radius * std::sin(kPi / 2 * n / kRadii);
        const double r1 = radius * std::sin(kPi / 2 * (n + 1) / kRadii);
        const double rise = cutter.height_mm(r1) - cutter.height_mm(r0);
        if (rise <= 0) continue;
        const double depth = over(0.5 * (r0 + r1));
        const double thick = depth * (r1 - r0) / std::hypot(r1 - r0, rise);
        high += rise * std::min(1.0, thick / kThin_mm);
      }
      sum += high, sum_square += high * high;
      sum_phi += high * phi, sum_phi2 += high * phi * phi;
    }
    if (sum <= 0) return truth;
    const double middle = sum_phi / sum;
    const double half = std::sqrt(std::max(0.0, 3 * (sum_phi2 / sum - middle * middle)));
    truth.entry = std::max(0.0, middle - half), truth.exit = std::min(kPi, middle + half);
    truth.arc = std::min(kPi / kAngles * sum * sum / sum_square, truth.exit - truth.entry);
    return truth;
  }

  /// So far an arc may come back to what it has cut.
  static double long_before(const Cutter& cutter, const CutMove& move, double at) {
    if (!move.arc) return 0;
    const double radius = glm::length(Vec2(move.from_mm - move.arc->center_mm));
    return std::max(
        0.0, at - std::min(kPi, 2 * cutter.radius_mm() / radius) / std::abs(move.arc->sweep_rad));
  }

  static constexpr int kDeepEach = 6;
  static double way_mm(const CutMove& m) {
    if (!m.arc) return glm::length(Vec2(m.to_mm - m.from_mm));
    return std::abs(m.arc->sweep_rad) * glm::length(Vec2(m.from_mm - m.arc->center_mm));
  }
  static Vec3 place(const CutMove& m, double t) {
    if (!m.arc) return m.from_mm + t * (m.to_mm - m.from_mm);
    const Vec2 arm(m.from_mm - m.arc->center_mm);
    const double angle = m.arc->sweep_rad * m.arc->axis.z * t;
    return {m.arc->center_mm.x + std::cos(angle) * arm.x - std::sin(angle) * arm.y,
            m.arc->center_mm.y + std::sin(angle) * arm.x + std::cos(angle) * arm.y,
            m.from_mm.z + t * (m.to_mm.z - m.from_mm.z)};
  }

 private:
  /// By the nearest place of a level way; of others the best of many.
  static double left_by(const Cutter& cutter, const CutMove& m, double until, const Vec2& p) {
    const double radius = cutter.radius_mm();
    const auto low_at = [&](double t) {
      const Vec3 tip = place(m, t);
      const double distance = glm::length(p - Vec2(tip));
      return distance > radius ? 1e9 : tip.z + cutter.height_mm(distance);
    };
    if (!m.arc && m.from_mm.z == m.to_mm.z) {
      const Vec2 way(m.to_mm - m.from_mm), arm = p - Vec2(m.from_mm);
      const double length2 = glm::dot(way, way);
      return low_at(length2 > 0 ? std::clamp(glm::dot(arm, way) / length2, 0.0, until) : 0);
    }
    if (m.arc && m.from_mm.z == m.to_mm.z) {
      const Vec2 from(m.from_mm - m.arc->center_mm), arm = p - Vec2(m.arc->center_mm);
      const double sweep = m.arc->sweep_rad * m.arc->axis.z;
      double turned = std::atan2(arm.y, arm.x) - std::atan2(from.y, from.x);
      turned = std::fmod(sweep < 0 ? -turned : turned, 2 * kPi);
      if (turned < 0) turned += 2 * kPi;
      const double t = turned / std::abs(sweep);
      return t <= until ? low_at(t) : std::min(low_at(0), low_at(until));
    }
    // The best of some, and narrower about it.
    double low = 1e9, best = 0;
    const int places = way_mm(m) < 3 ? 20 : 200;
    for (int k = 0; k <= places; ++k) {
      const double t = until * k / places, here = low_at(t);
      if (here < low) low = here, best = t;
    }
    if (low >= 1e9) return low;
    double a = std::max(0.0, best - until / places), b = std::min(until, best + until / places);
    for (int k = 0; k < 40; ++k) {
      const double third = (b - a) / 3;
      (low_at(a + third) < low_at(b - third) ? b : a) =
          low_at(a + third) < low_at(b - third) ? b - third : a + third;
    }
    low = std::min(low, low_at(0.5 * (a + b)));
    return low;
  }

  /// Moves are found by squares.
  static constexpr double kTile_mm = 2;
  static int tile_of(double at) { return static_cast<int>(std::floor(at / kTile_mm)); }
  static std::int64_t key_of(int x, int y) { return std::int64_t{x} * 1'000'000 + y; }

  Box blank_;
  std::vector<PastMove> past_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> by_tile_;
};

/// How far from it looks are.
struct EngagementErrors {
  double most = 0;
  int looks = 0, within = 0;
  /// Of depths: those off by more than kSameDepth_mm.
  int deeper = 0, shallower = 0;
  static constexpr double kSameDepth_mm = 0.02;
  std::vector<double> all;
  void add(const EngagementLook& found, const EngagementTruth& truth) {
    const double off = found.is_engaged() && truth.arc > 0
                           ? std::max({std::abs(found.angle_rad - truth.arc),
                                       std::abs(found.entry_rad - truth.entry),
                                       std::abs(found.exit_rad - truth.exit)})
                           : std::max(found.angle_rad, truth.arc);
    all.push_back(off / kOracleDegree);
    if (found.deep_mm > truth.deep_mm + kSameDepth_mm) ++deeper;
    if (found.deep_mm < truth.deep_mm - kSameDepth_mm) ++shallower;
    ++looks;
    if (off <= 2 * kOracleDegree) ++within;
    most = std::max(most, off);
  }
  std::string text() {
    std::sort(all.begin(), all.end());
    const auto at = [&](double share) {
      return std::to_string(
          all[static_cast<std::size_t>(share * (static_cast<double>(all.size()) - 1))]);
    };
    return std::to_string(within) + " of " + std::to_string(looks) + " within 2 degrees; p50 " +
           at(0.5) + " p90 " + at(0.9) + " p95 " + at(0.95) + " p99 " + at(0.99) + " most " +
           at(1) + "; too deep " + std::to_string(deeper) + ", not deep enough " +
           std::to_string(shallower);
  }
};

}  // namespace kerf
