// tests/interp_bridge/timing/place_support.h - when a plan passes the places that a machine was
// recorded at.
#pragma once

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "tests/interp_bridge/timing/run_support.h"

namespace kerf {

inline constexpr double kPeriod_s = 0.001;
/// Farther from the programmed way than this the tip is in a corner that is cut.
inline constexpr double kOnWay_mm = 0.002;

/// What a motion that follows the spindle may be off by, besides a share of its time.
inline constexpr double kSpindlePeriods = 6;

struct Sample {
  double t_s = 0;
  Vec3 at_mm{0};
};

/// Rows of program,servo period,x,y,z.
inline std::map<std::string, std::vector<Sample>> recorded_places(const std::string& path) {
  std::map<std::string, std::vector<Sample>> out;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    std::string name;
    Sample sample;
    double period = 0;
    fields >> name >> period >> sample.at_mm.x >> sample.at_mm.y >> sample.at_mm.z;
    sample.t_s = period * kPeriod_s;
    out[name].push_back(sample);
  }
  return out;
}

inline Vec3 at_share(const Motion& m, double share) {
  if (m.kind != MotionKind::kArc) return m.from_mm + share * (m.to_mm - m.from_mm);
  const Vec3 out = m.from_mm - m.arc.center_mm;
  const double rise = glm::dot(m.to_mm - m.from_mm, m.arc.axis);
  const double angle = share * m.arc.sweep_rad;
  const Vec3 along = glm::dot(out, m.arc.axis) * m.arc.axis;
  const Vec3 flat = out - along;
  return m.arc.center_mm + along + share * rise * m.arc.axis + std::cos(angle) * flat +
         std::sin(angle) * glm::cross(m.arc.axis, flat);
}

/// Share of the way that is nearest to a place.
inline double nearest_share(const Motion& m, const Vec3& at_mm) {
  double low = 0, high = 1;
  constexpr int kParts = 64;
  double best = 1e9;
  int where = 0;
  for (int i = 0; i <= kParts; ++i) {
    const double off = glm::length(at_share(m, static_cast<double>(i) / kParts) - at_mm);
    if (off >= best) continue;
    best = off;
    where = i;
  }
  low = std::max(0.0, (where - 1.0) / kParts);
  high = std::min(1.0, (where + 1.0) / kParts);
  for (int i = 0; i < 60; ++i) {
    const double one = low + (high - low) / 3, two = high - (high - low) / 3;
    const bool first =
        glm::length(at_share(m, one) - at_mm) < glm::length(at_share(m, two) - at_mm);
    (first ? high : low) = first ? two : one;
  }
  return (low + high) / 2;
}

struct Passing {
  std::size_t compared = 0, in_corners = 0;
  double worst_s = 0;            ///< by the time of the program
  double in_motion_worst_s = 0;  ///< by the time of its motion: without what came before
  /// Likewise, of places in the corner that the planner passes while both motions run.
  double corner_worst_s = 0;
  double worst_share = 0;   ///< of that, what exceeds two servo periods, over the motion's time
  double even_worst_s = 0;  ///< of ways that are run evenly
};

/// A motion that passes a place, about usual_s off: the tip goes out and comes back on one way.
struct Found {
  std::size_t motion = 0;
  double error_s = 0, even_error_s = 0;
  bool corner = false;
};

inline std::optional<Found> passed(const std::vector<Motion>& motions, const Plan& plan,
                                   const Vec3& at_mm, double now_s, double around_s,
                                   double usual_s) {
  std::optional<Found> found;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const MotionTiming& t = plan.timings[i];
    const Motion& m = motions[i];
    if (!is_move(m) || t.duration_s <= 0) continue;
    if (now_s < t.start_s - around_s || now_s > t.start_s + t.duration_s + around_s) continue;
    const double share = nearest_share(m, at_mm);
    if (glm::length(at_share(m, share) - at_mm) > kOnWay_mm) continue;
    // At its ends it may have stood.
    if (glm::length(m.from_mm - at_mm) < kOnWay_mm || glm::length(m.to_mm - at_mm) < kOnWay_mm) {
      continue;
    }
    const double error_s = t.start_s + t.duration_s * t.way.time_of(share) - now_s;
    if (found && std::abs(error_s - usual_s) >= std::abs(found->error_s - usual_s)) continue;
    const bool corner =
        share < static_cast<double>(t.way.in_way) || share > 1 - static_cast<double>(t.way.out_way);
    found = Found{i, error_s, t.start_s + t.duration_s * share - now_s, corner};
  }
  return found;
}

/// Each recorded place on the programmed way: when the plan passes it, against when it was. By the
/// program's time it may be off by around_s.
inline Passing compare(const std::vector<Motion>& motions, const Plan& plan,
                       const std::vector<Sample>& samples, double around_s) {
  Passing out;
  double begin_s = -1;
  for (std::size_t i = 0; i < motions.size() && begin_s < 0; ++i) {
    if (is_move(motions[i]) && plan.timings[i].duration_s > 0) begin_s = plan.timings[i].start_s;
  }
  std::map<std::size_t, std::vector<double>> of_motion, of_corner;
  double usual_s = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& sample = samples[i];
    // Where it stands it is there long after it has come.
    const bool came_before = i > 0 && samples[i - 1].at_mm == sample.at_mm;
    if (came_before || (i + 1 < samples.size() && samples[i + 1].at_mm == sample.at_mm)) continue;
    const std::optional<Found> found = passed(motions, plan, sample.at_mm - samples.front().at_mm,
                                              begin_s + sample.t_s, around_s, usual_s);
    if (!found) {
      ++out.in_corners;
      continue;
    }
    ++out.compared;
    usual_s = found->error_s;
    out.worst_s = std::max(out.worst_s, std::abs(found->error_s));
    out.even_worst_s = std::max(out.even_worst_s, std::abs(found->even_error_s));
    (found->corner ? of_corner : of_motion)[found->motion].push_back(found->error_s);
  }
  for (auto& [motion, errors_s] : of_motion) {
    std::sort(errors_s.begin(), errors_s.end());
    const double middle_s = errors_s[errors_s.size() / 2];
    const double most_s = std::max(middle_s - errors_s.front(), errors_s.back() - middle_s);
    out.in_motion_worst_s = std::max(out.in_motion_worst_s, most_s);
    for (const double error_s : of_corner[motion]) {
      out.corner_worst_s = std::max(out.corner_worst_s, std::abs(error_s - middle_s));
    }
    const double beyond_s = most_s - kSpindlePeriods * kPeriod_s;
    out.worst_share = std::max(out.worst_share, beyond_s / plan.timings[motion].duration_s);
  }
  return out;
}

}  // namespace kerf
