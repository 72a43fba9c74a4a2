// What every built-in machine promises, over all kinds and rooms of several sizes.
#include "twin/machines/builtin_models.h"

#include <gtest/gtest.h>

#include "tests/twin/machines/mesh_support.h"
#include "twin/machines/mesh_builder.h"

namespace kerf {
namespace {

constexpr std::array kKinds{MachineKind::kKneeMill,   MachineKind::kGantry,    MachineKind::kLathe,
                            MachineKind::kTrunnion,   MachineKind::kPlasma,    MachineKind::kPunch,
                            MachineKind::kBridgeMill, MachineKind::kSwivelMill};

struct Case {
  MachineKind kind;
  MachineRoom room;
  std::string name;
};

/// Small, usual and large workpieces; with and without travels; shifted in the machine.
std::vector<Case> cases() {
  std::vector<Case> all;
  for (const MachineKind kind : kKinds) {
    for (const double size : {0.3, 1.0, 6.0}) {
      for (const bool limited : {false, true}) {
        MachineRoom room;
        room.blank_mm = {Vec3(0, 0, -30) * size, Vec3(120, 80, 0) * size};
        room.tool_length_mm = 60 + 40 * size;
        room.machine_from_workpiece = shift({-50, 30, -200});
        if (kind == MachineKind::kLathe) {
          room.blank_mm = {Vec3(-20, -20, -90) * size, Vec3(20, 20, 0) * size};
          room.machine_from_workpiece = shift({0, 0, -200});
        }
        if (limited) {
          room.travel[0] = AxisTravel{-300, 400};
          room.travel[1] = AxisTravel{-100, 300};
          room.travel[2] = AxisTravel{-400, 0};
        }
        all.push_back(
            {kind, room,
             std::string(name_of(kind)) + (limited ? " limited " : " ") + std::to_string(size)});
      }
    }
  }
  return all;
}

std::vector<Pose> poses_at(const MachineModel& model, const MachinePosition& position) {
  std::vector<Pose> poses(model.links.size());
  model.chain.forward(position, poses);
  return poses;
}

/// Whether the segment from a to b crosses the triangle inside.
bool crosses(const Vec3& a, const Vec3& b, const std::array<Vec3, 3>& t) {
  constexpr double kTouching_mm = 1e-4;  // single precision of the meshes
  const Vec3 n = glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0]));
  const double from = glm::dot(n, a - t[0]);
  const double to = glm::dot(n, b - t[0]);
  if (std::min(from, to) > -kTouching_mm || std::max(from, to) < kTouching_mm) return false;
  const Vec3 p = a + (b - a) * (from / (from - to));
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 side = t[(i + 1) % 3] - t[i];
    if (glm::dot(n, glm::cross(side, p - t[i])) < kTouching_mm * glm::length(side)) return false;
  }
  return true;
}

std::vector<std::array<Vec3, 3>> triangles_at(const TriangleMesh& mesh, const Pose& pose) {
  std::vector<std::array<Vec3, 3>> out;
  for (const auto& t : mesh.triangles) {
    std::array<Vec3, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) corners[i] = pose.point(Vec3(mesh.positions_mm[t[i]]));
    out.push_back(corners);
  }
  return out;
}

bool surfaces_cross(const std::vector<std::array<Vec3, 3>>& a,
                    const std::vector<std::array<Vec3, 3>>& b) {
  for (const auto& s : a) {
    const Vec3 low = glm::min(s[0], glm::min(s[1], s[2]));
    const Vec3 high = glm::max(s[0], glm::max(s[1], s[2]));
    for (const auto& t : b) {
      bool apart = false;
      for (int axis = 0; axis < 3 && !apart; ++axis) {
        apart = std::min({t[0][axis], t[1][axis], t[2][axis]}) > high[axis] ||
                std::max({t[0][axis], t[1][axis], t[2][axis]}) < low[axis];
      }
      if (apart) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        if (crosses(s[i], s[(i + 1) % 3], t) || crosses(t[i], t[(i + 1) % 3], s)) return true;
      }
    }
  }
  return false;
}

TEST(BuiltinModels, EveryLinkIsClosedAndTheWholeIsSmall) {
  for (const Case& one : cases()) {
    const MachineModel model = builtin_machine(one.kind, one.room);
    ASSERT_EQ(model.links.size(), model.chain.links().size());
    std::size_t triangles = 0;
    for (std::size_t i = 0; i < model.links.size(); ++i) {
      const LinkShape& link = model.links[i];
      EXPECT_EQ(link.name, model.chain.links()[i].name);
      EXPECT_EQ(open_edges(*link.mesh), 0U) << one.name << " " << link.name;
      EXPECT_GT(volume_mm3(*link.mesh), 0.0) << one.name << " " << link.name;
      triangles += link.mesh->triangles.size();
    }
    EXPECT_GE(triangles, 300U) << one.name;
    EXPECT_LE(triangles, 5000U) << one.name;
  }
}

/// The workpiece lies on what carries it: no lower than its top, and there is something under it.
TEST(BuiltinModels, TheBlankLiesOnTheTable) {
  for (const Case& one : cases()) {
    if (one.kind == MachineKind::kLathe) continue;
    const MachineModel model = builtin_machine(one.kind, one.room);
    const MachinePosition position = position_of_axes(model, {}, one.room.tool_length_mm);
    std::vector<glm::mat4> poses;
    link_poses(model, position, poses);
    const bool turns = one.kind == MachineKind::kTrunnion || one.kind == MachineKind::kSwivelMill;
    const char* const table = turns ? "platter" : "table";
    const std::size_t at = *model.chain.find(table);
    double top = -1e9;
    for (const glm::vec3& p : model.links[at].mesh->positions_mm) {
      top = std::max(top, static_cast<double>((poses[at] * glm::vec4(p, 1)).z));
    }
    EXPECT_NEAR(top, one.room.blank_mm.min.z, 1e-3) << one.name;
  }
}

TEST(BuiltinModels, TheNoseHoldsTheToolAtItsUpperEnd) {
  for (const Case& one : cases()) {
    const MachineModel model = builtin_machine(one.kind, one.room);
    const std::size_t tool = model.chain.tool_link();
    // Something of the link reaches to its origin and nothing beyond, towards the tip.
    double reach = -1e9;
    for (const glm::vec3& p : model.links[tool].mesh->positions_mm) {
      const Vec3 point(p);
      const Vec3 across = point - glm::dot(point, model.nose_from_tip) * model.nose_from_tip;
      if (glm::length(across) < 0.2 * one.room.tool_length_mm + 25) {
        reach = std::max(reach, -glm::dot(point, model.nose_from_tip));
      }
    }
    EXPECT_NEAR(reach, 0.0, 0.5) << one.name;
  }
}

/// The links that carry the workpiece stay clear of those that carry the tool: at the corners of
/// the travel, with the tip never lower than the top of the blank.
TEST(BuiltinModels, NothingRunsIntoAnotherPart) {
  for (const Case& one : cases()) {
    const MachineModel model = builtin_machine(one.kind, one.room);
    const auto is_above = [&](std::size_t end, std::size_t link) {
      for (std::optional<std::size_t> at = end; at;
           at = model.chain.find(model.chain.links()[*at].parent)) {
        if (*at == link) return true;
      }
      return false;
    };
    const Box& blank = one.room.blank_mm;
    for (int corner = 0; corner < 8; ++corner) {
      AxisValues program{};
      program[0] = (corner & 1) != 0 ? blank.max.x : blank.min.x;
      program[1] = (corner & 2) != 0 ? blank.max.y : blank.min.y;
      program[2] = blank.max.z + ((corner & 4) != 0 ? 20 : 0);
      if (one.kind == MachineKind::kLathe) {
        program = {(corner & 1) != 0 ? blank.max.x : blank.max.x + 20, 0,
                   (corner & 4) != 0 ? blank.max.z : 0.5 * blank.min.z};
      }
      const MachinePosition position = position_of_axes(model, program, one.room.tool_length_mm);
      const std::vector<Pose> poses = poses_at(model, position);
      for (std::size_t i = 0; i < model.links.size(); ++i) {
        for (std::size_t k = 0; k < model.links.size(); ++k) {
          const bool carries_work = is_above(model.chain.workpiece_link(), i);
          const bool carries_tool = is_above(model.chain.tool_link(), k);
          const auto& links = model.chain.links();
          // Parents and children are joined to each other.
          const bool joined = links[i].parent == links[k].name || links[k].parent == links[i].name;
          if (i == k || joined || !carries_work || !carries_tool) continue;
          EXPECT_FALSE(surfaces_cross(triangles_at(*model.links[i].mesh, poses[i]),
                                      triangles_at(*model.links[k].mesh, poses[k])))
              << one.name << ": " << links[i].name << " and " << links[k].name << ", corner "
              << corner;
        }
      }
    }
  }
}

/// The cradle swings free of the table that it stands on.
TEST(BuiltinModels, TheTrunnionTiltsFreely) {
  for (const bool about_y : {false, true}) {
    MachineRoom room;
    room.blank_mm = {{-40, -40, -60}, {40, 40, 0}};
    room.trunnion.tilts_about_y = about_y;
    room.trunnion.side_offset_mm = 12;
    room.trunnion.z_offset_mm = 25;
    const MachineModel model = builtin_machine(MachineKind::kTrunnion, room);
    for (const double tilt : {-110.0, -90.0, -45.0, 0.0, 30.0, 90.0}) {
      MachinePosition position;
      position.axes[about_y ? 4 : 3] = tilt;
      position.axes[5] = 33;
      const std::vector<Pose> poses = poses_at(model, position);
      const std::size_t table = *model.chain.find("table");
      const std::size_t platter = *model.chain.find("platter");
      const std::size_t cradle = *model.chain.find("cradle");
      EXPECT_FALSE(surfaces_cross(triangles_at(*model.links[table].mesh, poses[table]),
                                  triangles_at(*model.links[platter].mesh, poses[platter])))
          << tilt;
      EXPECT_FALSE(surfaces_cross(triangles_at(*model.links[cradle].mesh, poses[cradle]),
                                  triangles_at(*model.links[platter].mesh, poses[platter])))
          << tilt;
    }
  }
}

/// A head that tilts runs into nothing that carries it, as far as such heads tilt.
TEST(BuiltinModels, TheHeadsTiltFreely) {
  for (const MachineKind kind : {MachineKind::kBridgeMill, MachineKind::kSwivelMill}) {
    MachineRoom room;
    room.blank_mm = {{-40, -40, -60}, {40, 40, 0}};
    for (const double pivot_mm : {0.5, 120.0, 300.0}) {
      room.head_pivot_mm = pivot_mm;
      const MachineModel model = builtin_machine(kind, room);
      const std::size_t spindle = model.chain.tool_link();
      for (const double tilt : {-120.0, -90.0, -30.0, 0.0, 45.0, 120.0}) {
        AxisValues program{0, 0, 20, 0, tilt, kind == MachineKind::kBridgeMill ? 70.0 : 0.0};
        const auto position = position_of_tip(model, program, room.tool_length_mm);
        ASSERT_TRUE(position);
        const std::vector<Pose> poses = poses_at(model, *position);
        const auto& links = model.chain.links();
        for (std::size_t i = 0; i < links.size(); ++i) {
          // The swivel holds the spindle; tables are under it.
          const bool carries_tool = links[i].name == "fork" || links[i].name == "ram" ||
                                    links[i].name == "head" || links[i].name == "carriage" ||
                                    links[i].name == "bridge";
          if (!carries_tool) continue;
          EXPECT_FALSE(surfaces_cross(triangles_at(*model.links[i].mesh, poses[i]),
                                      triangles_at(*model.links[spindle].mesh, poses[spindle])))
              << links[i].name << " at B" << tilt << ", pivot " << pivot_mm;
        }
      }
    }
  }
}

TEST(BuiltinModels, LinksAreSeenFromTheWorkpieceFrame) {
  MachineRoom room;
  room.blank_mm = {{0, 0, -10}, {50, 50, 0}};
  room.machine_from_workpiece = shift({100, 0, 0}) * turn({0, 0, 1}, 90);
  const MachineModel model = builtin_machine(MachineKind::kGantry, room);
  EXPECT_EQ(model.name, "gantry router");
  ASSERT_EQ(model.links.size(), 5U);
  std::vector<glm::mat4> poses;
  link_poses(model, position_of_axes(model, {5, 6, 7}, 30), poses);
  ASSERT_EQ(poses.size(), 5U);
  // The nose stands a tool's length over the tip, as the program sees it.
  const glm::vec4 nose = poses[model.chain.tool_link()] * glm::vec4(0, 0, 0, 1);
  EXPECT_NEAR(glm::length(glm::vec3(nose) - glm::vec3(5, 6, 37)), 0.0f, 1e-4f);
  // The table's frame is the machine's: its zero lies at -100 along the turned Y.
  const glm::vec4 zero = poses[1] * glm::vec4(0, 0, 0, 1);
  EXPECT_NEAR(glm::length(glm::vec3(zero) - glm::vec3(0, 100, 0)), 0.0f, 1e-4f);
}

}  // namespace
}  // namespace kerf
