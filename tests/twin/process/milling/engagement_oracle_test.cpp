// What EngagementScan says against exact geometry: every past move is asked about every point.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "twin/process/milling/engagement_scan.h"

namespace kerf {
namespace {

constexpr double kOracleDegree = kPi / 180;
constexpr double kOracleCell_mm = 0.1;
/// The oracle's tool is so far ahead of its place, and what is thinner is not there.
constexpr double kStep_mm = 2e-3, kFilm_mm = 1e-4;

struct PastMove {
  const Cutter* cutter;
  CutMove move;
};

/// How the tool is engaged, found by asking.
struct Truth {
  double arc = 0, entry = 0, exit = 0;
};

class EngagementOracle {
 public:
  explicit EngagementOracle(const Box& blank) : blank_(blank) {}
  void add(const Cutter& cutter, const CutMove& move) { past_.push_back({&cutter, move}); }

  /// Height of the material at a point, when the move's own way up to `until` has been cut.
  double height(const Vec2& p, const Cutter& cutter, const CutMove& own, double until) const {
    if (p.x < blank_.min.x || p.x > blank_.max.x || p.y < blank_.min.y || p.y > blank_.max.y)
      return blank_.min.z;
    double height = blank_.max.z;
    for (const PastMove& past : past_)
      height = std::min(height, left_by(*past.cutter, past.move, 1, p));
    if (until > 0) height = std::min(height, left_by(cutter, own, until, p));
    return std::max(height, blank_.min.z);
  }

  /// Is the point cut by what is left of the way?
  bool is_on_way(const Vec2& p, const Cutter& cutter, const CutMove& own, double from) const {
    for (int k = 0; k <= 200; ++k) {
      const double t = from + (1 - from) * k / 200;
      if (glm::length(p - Vec2(place(own, t))) < cutter.radius_mm()) return true;
    }
    return false;
  }

  Truth look(const Cutter& cutter, const CutMove& move, double at) const {
    const double length = way_mm(move);
    const double part = at + kStep_mm / length;
    const Vec3 tip = place(move, part);
    const Vec3 next = place(move, part + 1e-6 / length);
    const Vec2 ahead = glm::normalize(Vec2(next - tip)), left(-ahead.y, ahead.x);
    const double radius = cutter.radius_mm();
    const bool flat = cutter.height_mm(radius * (1 - 1e-9)) <= 0;
    // Out to where is it in material, in each direction?
    constexpr int kAngles = 720;
    std::vector<double> out(kAngles, 0.0);
    double farthest = 0;
    for (int k = 0; k < kAngles; ++k) {
      const double phi = kPi * (k + 0.5) / kAngles;  // from the left
      const Vec2 way = std::cos(phi) * left + std::sin(phi) * ahead;
      const int radii = flat ? 1 : 80;
      for (int n = radii; n > 0 && out[static_cast<std::size_t>(k)] == 0; --n) {
        const double r = radius * (1 - 1e-9) * n / radii;
        const Vec2 p = Vec2(tip) + r * way;
        const double own = std::max(tip.z, blank_.min.z) + cutter.height_mm(r);
        if (own + kFilm_mm >= blank_.max.z) continue;
        if (height(p, cutter, move, at) > own + kFilm_mm && is_on_way(p, cutter, move, at))
          out[static_cast<std::size_t>(k)] = r;
      }
      farthest = std::max(farthest, out[static_cast<std::size_t>(k)]);
    }
    Truth truth;
    if (farthest <= 0) return truth;
    int first = -1, last = -1, count = 0;
    for (int k = 0; k < kAngles; ++k) {
      if (out[static_cast<std::size_t>(k)] < 0.5 * farthest) continue;
      first = first < 0 ? k : first, last = k, ++count;
    }
    truth.arc = kPi * count / kAngles;
    truth.entry = kPi * first / kAngles, truth.exit = kPi * (last + 1) / kAngles;
    return truth;
  }

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
    double low = 1e9;
    constexpr int kPlaces = 2000;
    for (int k = 0; k <= kPlaces; ++k) low = std::min(low, low_at(until * k / kPlaces));
    return low;
  }

  Box blank_;
  std::vector<PastMove> past_;
};

struct Off {
  double most = 0;
  int looks = 0, within = 0, engaged_wrong = 0;
  std::vector<double> all;
  void add(const EngagementLook& found, const Truth& truth) {
    const double off = found.is_engaged() && truth.arc > 0
                           ? std::max({std::abs(found.angle_rad - truth.arc),
                                       std::abs(found.entry_rad - truth.entry),
                                       std::abs(found.exit_rad - truth.exit)})
                           : std::max(found.angle_rad, truth.arc);
    all.push_back(off / kOracleDegree);
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
           at(0.5) + " p90 " + at(0.9) + " p95 " + at(0.95) + " p99 " + at(0.99) + " most " + at(1);
  }
};

/// Moves at random, of all upright tools, each over what those before have left.
class EngagementOracleTest : public testing::TestWithParam<const char*> {};

TEST_P(EngagementOracleTest, AnglesAreThoseOfExactGeometry) {
  const std::string shape = GetParam();
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  const Cutter cutter = parse_shape(shape).value();
  const Cutter other = parse_shape("flat:5").value();
  Off off;
  for (int round = 0; round < 6; ++round) {
    ZMapOptions options;
    options.blank = parse_blank("box:0,0,-10:40,30,0").value();
    options.cell_mm = kOracleCell_mm;
    const std::unique_ptr<ZMap> stock = std::move(ZMap::create(options).value());
    stock->keep_cut_ids(true);
    EngagementOracle oracle(stock->bounds_mm());
    PastWays ways;
    EngagementScan scan;
    Vec3 at(40 * unit(random), 30 * unit(random), -1 - 3 * unit(random));
    for (std::uint64_t n = 0; n < 24; ++n) {
      const bool by_other = n % 6 == 5;
      CutMove move;
      move.id = n;
      move.from_mm = at;
      const double kind = unit(random);
      const double turned = 2 * kPi * unit(random), length = 3 + 25 * unit(random);
      move.to_mm = at + Vec3(length * std::cos(turned), length * std::sin(turned), 0);
      move.to_mm.x = std::clamp(move.to_mm.x, -3.0, 43.0);
      move.to_mm.y = std::clamp(move.to_mm.y, -3.0, 33.0);
      if (kind > 0.8) move.to_mm.z = std::clamp(at.z + 2 * unit(random) - 1.2, -6.0, -0.3);
      if (kind < 0.3) {
        const double radius = 2 + 8 * unit(random),
                     sweep = (unit(random) < 0.5 ? -1 : 1) * (0.5 + 5.5 * unit(random));
        const Vec2 arm = radius * Vec2(std::cos(turned), std::sin(turned));
        move.arc = CutArc{at - Vec3(arm, 0), {0, 0, 1}, sweep};
        move.to_mm = EngagementOracle::place(move, 1);
      }
      if (glm::length(Vec2(move.to_mm - at)) > 1 && !by_other) {
        for (int k = 0; k < 3; ++k) {
          const double part = 0.05 + 0.85 * unit(random);
          const std::optional<HeightGrid> heights = stock->present_heights();
          EngagementScan::Look asked;
          asked.at = part, asked.owners = stock.get(), asked.ways = &ways;
          const EngagementLook found = scan.look_ahead(*heights, cutter, move, asked);
          const Truth truth = oracle.look(cutter, move, part);
          const double before = off.most;
          off.add(found, truth);
          if (off.most > before && off.most > 2 * kOracleDegree) {
            std::printf(
                "%s round %d move %d%s%s at %.3f: arc %.2f (%.2f) entry %.2f (%.2f) exit %.2f "
                "(%.2f)\n",
                shape.c_str(), round, static_cast<int>(n), move.arc ? " arc" : "",
                move.from_mm.z != move.to_mm.z ? " slope" : "", part,
                found.angle_rad / kOracleDegree, truth.arc / kOracleDegree,
                found.entry_rad / kOracleDegree, truth.entry / kOracleDegree,
                found.exit_rad / kOracleDegree, truth.exit / kOracleDegree);
          }
        }
      }
      const Cutter& by = by_other ? other : cutter;
      std::vector<CutReport> reports;
      stock->cut(by, {&move, 1}, reports);
      stock->finish(reports);
      ways.mount(by);
      ways.add(move);
      oracle.add(by, move);
      at = move.to_mm;
      if (unit(random) < 0.25) at.z = -1 - 4 * unit(random);
    }
  }
  std::printf("%s: %s\n", shape.c_str(), off.text().c_str());
  EXPECT_GT(off.looks, 200);
}

INSTANTIATE_TEST_SUITE_P(Shapes, EngagementOracleTest,
                         testing::Values("flat:8", "flat:3", "ball:8", "ball:4", "bull:8:1",
                                         "bull:6:2", "vee:8:90", "taper:6:10:1", "drill:6:118"));

}  // namespace
}  // namespace kerf
