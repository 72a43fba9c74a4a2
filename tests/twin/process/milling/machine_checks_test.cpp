// Collisions of a machine against brute force: random machines, whose links are looked at a
// thousand times along each motion of random programs.
#include "twin/process/milling/machine_checks.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <utility>

#include "stock/zmap/zmap.h"
#include "twin/machine/kinematics/kinematics_setup.h"

namespace kerf {
namespace {

constexpr int kSamples = 250;
using Random = std::mt19937;

double draw(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

LinkSpec link(const char* name, const char* parent, JointKind joint, std::uint8_t input,
              const Vec3& direction, const Vec3& origin_mm, const std::string& shape) {
  LinkSpec out;
  out.chain.name = name;
  out.chain.parent = parent;
  out.chain.joint = joint;
  out.chain.input = input;
  out.chain.direction = direction;
  out.chain.origin_mm = origin_mm;
  if (!shape.empty()) out.bodies = parse_blank(shape)->bodies;
  return out;
}

std::string post(Random& random, double z0, double z1) {
  const double x = draw(random, -150, 150), y = draw(random, -150, 150);
  return fmt::format("box:{},{},{}:{},{},{}", x, y, z0, x + draw(random, 5, 30),
                     y + draw(random, 5, 30), z1);
}

/// A table in X that turns about Z, with posts on it; a head in Y and Z that swivels about Y.
LinkedMachine random_machine(Random& random) {
  LinkedMachine machine;
  const double fork = draw(random, 20, 40), ram = draw(random, 30, 60);
  machine.links = {
      link("frame", "", JointKind::kFixed, 0, {0, 0, 1}, Vec3(0.0), post(random, -300, -120)),
      link("table", "frame", JointKind::kPrismatic, 0, {-1, 0, 0}, Vec3(0.0),
           "box:-120,-90,-220:120,90,-190"),
      link("platter", "table", JointKind::kRotary, 5, {0, 0, -1},
           {draw(random, -20, 20), draw(random, -20, 20), -30},
           "cylinder:0,0,-158:-150:120+" + post(random, -150, draw(random, -110, -60))),
      link("saddle", "frame", JointKind::kPrismatic, 1, {0, 1, 0}, Vec3(0.0), ""),
      link("ram", "saddle", JointKind::kPrismatic, 2, {0, 0, 1}, Vec3(0.0),
           fmt::format("box:-{0},-{0},130:{0},{0},300", ram)),
      link("fork", "ram", JointKind::kRotary, 4, {0, 1, 0}, {0, 0, 80},
           fmt::format("box:-{0},-{0},-40:{0},{0},40", fork)),
      link("nose", "fork", JointKind::kFixed, 0, {0, 0, 1}, {0, 0, -80}, "cylinder:0,0,0:45:40")};
  machine.workpiece_on = "platter";
  machine.tool_on = "nose";
  return machine;
}

std::vector<Motion> random_program(Random& random) {
  std::vector<Motion> program;
  Motion now;
  now.to_mm = {0, 0, 120};
  now.tool = 1;
  now.tool_offset_mm = {0, 0, 60};
  for (int line = 1; line <= 25; ++line) {
    Motion m = now;
    m.source.line = static_cast<std::uint32_t>(line);
    m.kind = draw(random, 0, 1) < 0.5 ? MotionKind::kTraverse : MotionKind::kFeed;
    m.from_mm = now.to_mm;
    m.from_abc_deg = now.to_abc_deg;
    m.to_mm = {draw(random, -120, 120), draw(random, -120, 120), draw(random, -60, 130)};
    if (line % 3 == 0) m.to_mm = m.from_mm + Vec3(draw(random, -2, 2), draw(random, -2, 2), 0);
    if (line % 2 == 0) m.to_abc_deg = {0, draw(random, -100, 100), draw(random, -180, 180)};
    program.push_back(m);
    now = m;
  }
  return program;
}

double gap_of_solids(const Solid& a, const Solid& b, const Pose& b_from_a, double thinner_mm) {
  std::vector<RoundedDisc> discs;
  std::array<Vec3, 2> corners{};
  double least = std::numeric_limits<double>::infinity();
  for (const Convex& piece : a.pieces()) {
    const Convex thin = eroded(piece, thinner_mm, discs, corners);
    for (const Convex& still : b.pieces())
      least = std::min(least, gap_of({thin, b_from_a, b_from_a}, still, least, 1e-4).high_mm);
  }
  return least;
}

using Names = std::pair<std::string, std::string>;
struct Seen {
  double least_mm = std::numeric_limits<double>::infinity();
  bool touched = false;  ///< by more than any tolerance
};

/// The bodies of a machine at one place of a motion.
class Oracle {
 public:
  Oracle(const MachineBodies& machine, const MachineKinematics& kinematics)
      : machine_(machine),
        path_(ToolPath::create(kinematics, {}, {}).value()),
        poses_(machine.chain.links().size()) {}

  double gap(std::size_t a, std::size_t b, const Motion& m, double t, double thinner_mm) {
    machine_.chain.forward(*path_.machine_at(m, t), poses_);
    const LinkBody &one = machine_.bodies[a], &other = machine_.bodies[b];
    return gap_of_solids(*one.solids[0], *other.solids[0],
                         poses_[other.link].inverse() * poses_[one.link], thinner_mm);
  }

 private:
  const MachineBodies& machine_;
  ToolPath path_;
  std::vector<Pose> poses_;
};

class MachineChecksTest : public ::testing::TestWithParam<bool> {};

TEST_P(MachineChecksTest, FindWhatBruteForceFinds) {
  int touching = 0, clear = 0, near = 0;
  for (unsigned seed = 1; seed <= 25; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const LinkedMachine description = random_machine(random);
    Diagnostics diagnostics;
    const MachineBodiesPointer machine = bodies_of(description, diagnostics);
    ASSERT_TRUE(machine);
    const MachineKinematics kinematics =
        kinematics_of_links({description.links_of_chain(), description.workpiece_on,
                             description.tool_on, GetParam()},
                            "XYZBC")
            .value();
    const std::vector<Motion> program = random_program(random);

    ZMapOptions options;
    options.blank = parse_blank("box:-1,-1,-600:1,1,-599").value();  // out of the way
    options.cell_mm = 1;
    const std::unique_ptr<ZMap> stock = std::move(ZMap::create(options).value());
    FindingLog log;
    MachineChecks checks(*stock, log, [] {});
    CheckOptions wishes;
    wishes.collisions.machine = machine;
    checks.set_options(wishes);
    checks.set_place(std::make_shared<const MachineKinematics>(kinematics), {});
    for (const Motion& m : program) {
      TimedStep step;
      step.start_s = m.source.line;
      step.duration_s = 1;
      checks.check(m, step);
    }
    checks.finish();

    Oracle oracle(*machine, kinematics);
    std::map<Names, Seen> seen;
    const std::vector<std::size_t> groups = rigid_groups(machine->chain);
    for (std::size_t a = 0; a < machine->bodies.size(); ++a) {
      for (std::size_t b = a + 1; b < machine->bodies.size(); ++b) {
        const std::size_t la = machine->bodies[a].link, lb = machine->bodies[b].link;
        if (groups[la] == groups[lb] || are_neighbours(machine->chain, la, lb)) continue;
        if (oracle.gap(a, b, program.front(), 0, 0) <= 0) continue;  // drawn so: told as a note
        Seen& pair = seen[{machine->bodies[a].name, machine->bodies[b].name}];
        for (const Motion& m : program) {
          for (int i = 0; i <= kSamples; ++i) {
            const double t = static_cast<double>(i) / kSamples;
            const double gap = oracle.gap(a, b, m, t, 0);
            pair.least_mm = std::min(pair.least_mm, gap);
            if (gap <= 0 && !pair.touched) pair.touched = oracle.gap(a, b, m, t, 0.05) <= 0;
          }
        }
      }
    }
    for (const CollisionPair& row : checks.table()) {
      const auto at = seen.find({row.first, row.other});
      if (at == seen.end()) continue;
      SCOPED_TRACE(row.first + " and " + row.other);
      const Seen& pair = at->second;
      if (pair.touched) {
        ++touching;
        EXPECT_GE(row.contacts, 1U) << "missed";
      }
      if (row.contacts > 0) continue;
      EXPECT_FALSE(pair.touched);
      ++clear;
      if (!row.least_clearance_mm) {
        EXPECT_GT(pair.least_mm, 9.8);
        continue;
      }
      ++near;
      // Samples are never nearer than the least.
      EXPECT_LE(*row.least_clearance_mm, pair.least_mm * 1.03 + 0.01);
    }
    // Each thing that is told is so, where it is told.
    for (const Finding& finding : log.kept()) {
      if (finding.severity != Severity::kError) continue;
      const Motion& m = program[finding.source.line - 1];
      const double t = *finding.time_s - finding.source.line;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t a = 0; a < machine->bodies.size(); ++a) {
        for (std::size_t b = a + 1; b < machine->bodies.size(); ++b) {
          if (finding.text != fmt::format("link '{}' touches link '{}'", machine->bodies[a].name,
                                          machine->bodies[b].name))
            continue;
          least = oracle.gap(a, b, m, t, 0);
          // A little before they are apart, if they were so where the motion began.
          if (oracle.gap(a, b, m, 0, 0) > 0 && t > 0.01) {
            EXPECT_GT(oracle.gap(a, b, m, t - 0.01, 0.011), 0) << finding.text;
          }
        }
      }
      EXPECT_LE(least, 0.01) << finding.text << ", line " << finding.source.line;
    }
  }
  EXPECT_GT(touching, 10) << clear << " clear, " << near << " near";
  EXPECT_GT(clear, 10);
  EXPECT_GT(near, 0);
}

INSTANTIATE_TEST_SUITE_P(FollowsTip, MachineChecksTest, ::testing::Bool());

}  // namespace
}  // namespace kerf
