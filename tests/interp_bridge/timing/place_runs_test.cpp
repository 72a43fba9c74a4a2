// When the tip passes places on its way: the programs of tests/live/kinematics/place_programs.ngc
// against where a real LinuxCNC 2.9 was, servo period by servo period
// (tests/live/kinematics/record_places), limits as MachineLimits::small_mill() has them.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include "tests/interp_bridge/timing/run_support.h"

namespace kerf {
namespace {

constexpr double kPeriod_s = 0.001;
/// Farther from the programmed way than this the tip is in a corner that is cut.
constexpr double kOnWay_mm = 0.002;

/// Servo periods. Within a motion; and with what the stops before it have added up to.
constexpr double kInMotion = 2;
constexpr double kInProgram = 8;

struct Sample {
  double t_s = 0;
  Vec3 at_mm{0};
};

std::map<std::string, std::vector<Sample>> recorded_places() {
  std::map<std::string, std::vector<Sample>> out;
  std::ifstream file(PLACE_TIMES);
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

std::map<std::string, std::string> programs() {
  std::map<std::string, std::string> out;
  std::ifstream file(PLACE_PROGRAMS);
  std::string* text = nullptr;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("% ", 0) == 0) {
      text = &out[line.substr(2)];
    } else if (text != nullptr) {
      *text += line + "\n";
    }
  }
  return out;
}

Vec3 at_share(const Motion& m, double share) {
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
double nearest_share(const Motion& m, const Vec3& at_mm) {
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
  double even_worst_s = 0;       ///< of ways that are run evenly
};

/// A motion that passes a place, and when.
struct Found {
  std::size_t motion = 0;
  double error_s = 0, even_error_s = 0;
};

std::optional<Found> passed(const std::vector<Motion>& motions, const Plan& plan, const Vec3& at_mm,
                            double now_s) {
  constexpr double kAround_s = 0.06;
  std::optional<Found> found;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const MotionTiming& t = plan.timings[i];
    const Motion& m = motions[i];
    if (!is_move(m) || t.duration_s <= 0) continue;
    if (now_s < t.start_s - kAround_s || now_s > t.start_s + t.duration_s + kAround_s) continue;
    const double share = nearest_share(m, at_mm);
    if (glm::length(at_share(m, share) - at_mm) > kOnWay_mm) continue;
    const double error_s = t.start_s + t.duration_s * t.way.time_of(share) - now_s;
    if (found && std::abs(error_s) >= std::abs(found->error_s)) continue;
    found = Found{i, error_s, t.start_s + t.duration_s * share - now_s};
  }
  return found;
}

/// Each recorded place on the programmed way: when the plan passes it, against when it was.
Passing compare(const std::vector<Motion>& motions, const Plan& plan,
                const std::vector<Sample>& samples) {
  Passing out;
  double begin_s = -1;
  for (std::size_t i = 0; i < motions.size() && begin_s < 0; ++i) {
    if (is_move(motions[i]) && plan.timings[i].duration_s > 0) begin_s = plan.timings[i].start_s;
  }
  std::map<std::size_t, std::vector<double>> of_motion;
  for (const Sample& sample : samples) {
    const std::optional<Found> found =
        passed(motions, plan, sample.at_mm - samples.front().at_mm, begin_s + sample.t_s);
    if (!found) {
      ++out.in_corners;
      continue;
    }
    ++out.compared;
    out.worst_s = std::max(out.worst_s, std::abs(found->error_s));
    out.even_worst_s = std::max(out.even_worst_s, std::abs(found->even_error_s));
    of_motion[found->motion].push_back(found->error_s);
  }
  for (auto& [motion, errors_s] : of_motion) {
    std::sort(errors_s.begin(), errors_s.end());
    const double usual_s = errors_s[errors_s.size() / 2];
    out.in_motion_worst_s =
        std::max({out.in_motion_worst_s, usual_s - errors_s.front(), errors_s.back() - usual_s});
  }
  return out;
}

TEST(PlaceRuns, PassedWhenARealLinuxCncPassedThem) {
  const TestFolder folder;
  const auto texts = programs();
  const auto recorded = recorded_places();
  ASSERT_EQ(recorded.size(), texts.size());
  std::printf("%-16s %8s %8s %9s %10s %9s\n", "program", "places", "corners", "worst ms",
              "in motion", "evenly");
  for (const auto& [name, samples] : recorded) {
    ProgramOptions options;
    options.path = folder.write("places.ngc", texts.at(name));
    options.interpreter = InterpreterChoice::kText;
    ProgramRun run = run_program(options);
    ASSERT_TRUE(run.opened) << run.messages();
    place_start(run.motions, {{0, 0, 0}}, true);
    const Passing passing = compare(run.motions, plan_of(run.motions), samples);
    std::printf("%-16s %8zu %8zu %9.2f %10.2f %9.2f\n", name.c_str(), passing.compared,
                passing.in_corners, 1000 * passing.worst_s, 1000 * passing.in_motion_worst_s,
                1000 * passing.even_worst_s);
    EXPECT_GT(passing.compared, 200U) << name;
    EXPECT_LT(passing.in_motion_worst_s, kInMotion * kPeriod_s) << name;
    EXPECT_LT(passing.worst_s, kInProgram * kPeriod_s) << name;
    EXPECT_GT(passing.even_worst_s, 50 * kPeriod_s) << name;
  }
}

}  // namespace
}  // namespace kerf
