#include "twin/machines/machine_bodies.h"

#include <gtest/gtest.h>

#include "base/mesh_file.h"
#include "tests/base/temporary_folder.h"
#include "twin/machines/mesh_builder.h"

namespace kerf {
namespace {

LinkSpec spec(const char* name, const char* parent, JointKind joint, const char* shape = "") {
  LinkSpec link;
  link.chain.name = name;
  link.chain.parent = parent;
  link.chain.joint = joint;
  if (*shape != 0) link.bodies = parse_blank(shape)->bodies;
  return link;
}

/// A frame with a cover, on which a head slides that carries a nose; a table beside them.
LinkedMachine mill() {
  LinkedMachine machine;
  machine.links = {spec("frame", "", JointKind::kFixed, "box:0,0,0:10,10,10"),
                   spec("cover", "frame", JointKind::kFixed, "box:0,0,0:1,1,1+cylinder:0,0,0:5:3"),
                   spec("head", "frame", JointKind::kPrismatic),
                   spec("nose", "head", JointKind::kFixed, "cylinder:0,0,0:5:3"),
                   spec("floor", "", JointKind::kFixed, "box:0,0,-5:10,10,-4"),
                   spec("table", "floor", JointKind::kPrismatic, "box:0,0,-4:10,10,-3")};
  machine.workpiece_on = "table";
  machine.tool_on = "nose";
  return machine;
}

TEST(MachineBodies, ALinkWithoutAShapeHasNone) {
  Diagnostics diagnostics;
  const MachineBodiesPointer machine = bodies_of(mill(), diagnostics);
  ASSERT_TRUE(machine);
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_FALSE(machine->guessed);
  ASSERT_EQ(machine->bodies.size(), 5U);
  EXPECT_EQ(machine->bodies[1].name, "cover");
  EXPECT_EQ(machine->bodies[1].solids[0]->pieces().size(), 2U);
  EXPECT_EQ(machine->bodies[2].name, "nose");
  EXPECT_EQ(machine->bodies[2].link, 3U);
}

TEST(MachineBodies, WhatNothingMovesAgainstEachOtherIsOneGroup) {
  Diagnostics diagnostics;
  const KinematicChain chain = bodies_of(mill(), diagnostics)->chain;
  const std::vector<std::size_t> groups = rigid_groups(chain);
  EXPECT_EQ(groups[0], groups[1]) << "frame and cover";
  EXPECT_EQ(groups[0], groups[4]) << "both stand on the floor";
  EXPECT_EQ(groups[2], groups[3]) << "head and nose";
  EXPECT_NE(groups[0], groups[2]);
  EXPECT_NE(groups[2], groups[5]);
  EXPECT_TRUE(are_neighbours(chain, 0, 2));
  EXPECT_TRUE(are_neighbours(chain, 2, 0));
  EXPECT_FALSE(are_neighbours(chain, 0, 3)) << "the nose may come back to the frame";
}

TEST(MachineBodies, MeshesAreReadAndPlaced) {
  const TemporaryFolder folder;
  MeshBuilder mesh;
  mesh.box({0, 0, 0}, {2, 2, 2});
  ASSERT_TRUE(write_stl(folder / "nose.stl", mesh.mesh()));
  LinkedMachine machine = mill();
  machine.links[3].stl_path = folder / "nose.stl";
  machine.links[3].mm_per_unit = 25.4;
  machine.links[3].mesh_offset_mm = {1, 0, 0};
  Diagnostics diagnostics;
  const MachineBodiesPointer bodies = bodies_of(machine, diagnostics);
  ASSERT_TRUE(bodies);
  ASSERT_EQ(bodies->bodies[2].solids.size(), 2U) << "mesh along with shape";
  const Solid& solid = *bodies->bodies[2].solids[1];
  EXPECT_TRUE(solid.is_closed());
  EXPECT_NEAR(solid.box_mm().min.x, 1, 1e-4);
  EXPECT_NEAR(solid.box_mm().max.x, 51.8, 1e-4);

  // Too many triangles: drawn, but left out here.
  const MachineBodiesPointer less = bodies_of(machine, diagnostics, 11);
  ASSERT_TRUE(less);
  EXPECT_EQ(less->bodies[2].solids.size(), 1U);
  ASSERT_EQ(diagnostics.size(), 1U);
  EXPECT_EQ(diagnostics[0].severity, Severity::kNote);
  EXPECT_NE(diagnostics[0].message.find("has 12 triangles"), std::string::npos);
  diagnostics.clear();

  machine.links[3].stl_path = folder / "gone.stl";
  EXPECT_FALSE(bodies_of(machine, diagnostics));
  ASSERT_EQ(diagnostics.size(), 1U);
  EXPECT_EQ(diagnostics[0].severity, Severity::kError);
  EXPECT_NE(diagnostics[0].message.find("gone.stl"), std::string::npos);
}

TEST(MachineBodies, ABuiltInMachineIsAGuess) {
  const MachineModel model = builtin_machine(MachineKind::kKneeMill, {});
  const MachineBodiesPointer machine = bodies_of(model);
  EXPECT_TRUE(machine->guessed);
  EXPECT_EQ(machine->bodies.size(), model.links.size());
}

}  // namespace
}  // namespace kerf
