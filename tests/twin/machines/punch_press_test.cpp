// The drawn punch press of a turret: stations, clamps, ram, and what moves.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "stock/sheet/punch_hits.h"
#include "stock/sheet/punch_shape.h"
#include "tests/twin/machines/mesh_support.h"
#include "twin/machines/builtin_models.h"
#include "twin/machines/mesh_builder.h"

namespace kerf {
namespace {

constexpr double kLength_mm = 120;
constexpr int kStations = 22;

MachineRoom room_with_turret(bool sheet_moves) {
  auto turret = std::make_shared<Turret>();
  for (int i = 0; i < kStations; ++i) {
    const int number = 3 * i + 1;
    Cutter punch = std::move(*punch_cutter("punch:round:10", *parse_punch_shape("round:10", 0.01)));
    turret->stations.emplace(number,
                             TurretStation{number, "", "round:10", std::move(punch), 0, false, 0});
  }
  turret->clamps = {{{50, -60}, {100, 15}, 5}};
  turret->sheet_moves = sheet_moves;
  MachineRoom room;
  room.blank_mm = {{0, 0, -2}, {400, 300, 0}};
  room.reach_mm = {{10, 20, 5}, {390, 290, 5}};
  room.machine_from_workpiece = shift({-30, 40, -200});
  room.tool_length_mm = kLength_mm;
  room.turret = std::move(turret);
  return room;
}

/// Where a link's mesh is in the workpiece frame.
Box place_of(const MachineModel& model, const MachinePosition& position, const char* link) {
  std::vector<glm::mat4> poses;
  link_poses(model, position, poses);
  const std::size_t at = model.chain.find(link).value();
  Box box;
  for (const glm::vec3& p : model.links[at].mesh->positions_mm) {
    box.extend(Vec3(poses[at] * glm::vec4(p, 1)));
  }
  return box;
}

MachinePosition over(const MachineModel& model, double x, double y) {
  AxisValues program{};
  program[0] = x;
  program[1] = y;
  program[2] = 5;
  return position_of_axes(model, program, kLength_mm);
}

TEST(PunchPress, SheetOrHeadMoves) {
  for (const bool sheet_moves : {true, false}) {
    const MachineModel model = builtin_machine(MachineKind::kPunch, room_with_turret(sheet_moves));
    std::vector<Pose> a(model.links.size()), b(model.links.size());
    model.chain.forward(over(model, 20, 30), a);
    model.chain.forward(over(model, 220, 130), b);
    const std::size_t frame = *model.chain.find("frame"), clamps = *model.chain.find("clamps");
    const Vec3 of_frame = b[frame].origin_mm - a[frame].origin_mm;
    const Vec3 of_sheet = b[clamps].origin_mm - a[clamps].origin_mm;
    EXPECT_EQ(of_frame, sheet_moves ? Vec3(0, 0, 0) : Vec3(200, 100, 0));
    EXPECT_EQ(of_sheet, sheet_moves ? Vec3(-200, -100, 0) : Vec3(0, 0, 0));
    // Seen from the sheet both are the same: the ram over the place of the program.
    const Box ram = place_of(model, over(model, 220, 130), "ram");
    EXPECT_NEAR(0.5 * (ram.min.x + ram.max.x), 220, 1e-3);
    EXPECT_NEAR(0.5 * (ram.min.y + ram.max.y), 130, 1e-3);
    for (const LinkShape& link : model.links) EXPECT_EQ(open_edges(*link.mesh), 0U) << link.name;
  }
}

TEST(PunchPress, TheTurretTurnsStationsToTheRam) {
  const MachineModel model = builtin_machine(MachineKind::kPunch, room_with_turret(true));
  const std::size_t turret = *model.chain.find("turret"), ram = *model.chain.find("ram");
  // The stations' upper ends are the highest circles around the disc.
  const auto axis_of_nearest = [&](double turned_deg) {
    MachinePosition position = over(model, 100, 100);
    position.joints[kTurret] = turned_deg;
    std::vector<Pose> poses(model.links.size());
    model.chain.forward(position, poses);
    double nearest = 1e9;
    const TriangleMesh& mesh = *model.links[turret].mesh;
    for (const glm::vec3& p : mesh.positions_mm) {
      const Vec3 place = poses[turret].point(Vec3(p));
      nearest = std::min(nearest, glm::length(Vec2(place) - Vec2(poses[ram].origin_mm)));
    }
    return nearest;
  };
  const double step = 360.0 / kStations;
  EXPECT_NEAR(axis_of_nearest(0), 0, 0.5) << "a cylinder's axis: the middle of its lid";
  EXPECT_NEAR(axis_of_nearest(7 * step), 0, 0.5);
  EXPECT_GT(axis_of_nearest(0.5 * step), 1);
}

TEST(PunchPress, ClampsHoldTheSheetAndReGrip) {
  const MachineModel model = builtin_machine(MachineKind::kPunch, room_with_turret(true));
  MachinePosition position = over(model, 100, 100);
  const Box before = place_of(model, position, "jaws");
  EXPECT_NEAR(before.min.x, 50, 1e-3);
  EXPECT_NEAR(before.max.y, 15, 1e-3);
  EXPECT_LT(before.min.z, -2);
  EXPECT_GT(before.max.z, 0);
  position.joints[kGripX] = 30;
  position.joints[kGripY] = -4;
  const Box after = place_of(model, position, "jaws");
  EXPECT_NEAR(after.min.x, 80, 1e-3);
  EXPECT_NEAR(after.max.y, 11, 1e-3);
}

TEST(PunchPress, EachStationHasItsPunch) {
  const MachineModel model = builtin_machine(MachineKind::kPunch, room_with_turret(true));
  const std::size_t third = model.chain.find(punch_link(7)).value();
  EXPECT_NEAR(volume_mm3(*model.links[third].mesh), kPi * 25 * 40, 5);
  // Brought to the ram it is where the tool is.
  MachinePosition position = over(model, 100, 80);
  position.joints[kTurret] = 2 * 360.0 / kStations;
  const Box place = place_of(model, position, punch_link(7).c_str());
  EXPECT_NEAR(0.5 * (place.min.x + place.max.x), 100, 0.01);
  EXPECT_NEAR(0.5 * (place.min.y + place.max.y), 80, 0.01);
}

TEST(PunchPress, TheRamComesDown) {
  const MachineModel model = builtin_machine(MachineKind::kPunch, room_with_turret(true));
  MachinePosition position = over(model, 100, 100);
  const Box up = place_of(model, position, "ram");
  EXPECT_NEAR(up.min.z, 5 + kLength_mm, 1e-3);
  position.joints[kStroke] = -8;
  EXPECT_NEAR(place_of(model, position, "ram").min.z, 5 + kLength_mm - 8, 1e-3);
}

}  // namespace
}  // namespace kerf
