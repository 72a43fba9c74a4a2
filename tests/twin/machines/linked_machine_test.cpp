#include "twin/machines/linked_machine.h"

#include <gtest/gtest.h>

#include "base/mesh_file.h"
#include "tests/base/temporary_folder.h"
#include "twin/machines/mesh_builder.h"

namespace kerf {
namespace {

LinkSpec spec(std::string name, JointKind joint, std::uint8_t input, Vec3 direction) {
  LinkSpec link;
  link.chain.name = std::move(name);
  link.chain.joint = joint;
  link.chain.input = input;
  link.chain.direction = direction;
  return link;
}

LinkedMachine router() {
  LinkedMachine machine;
  machine.links = {spec("table", JointKind::kFixed, 0, {}),
                   spec("head", JointKind::kPrismatic, 2, {0, 0, 1})};
  machine.links[0].bodies = parse_blank("box:0,0,-20:300,200,0")->bodies;
  machine.workpiece_on = "table";
  machine.tool_on = "head";
  return machine;
}

TEST(LinkedMachine, ShapesAndMeshesHangOnTheirLinks) {
  MeshBuilder cube;
  cube.box({0, 0, 0}, {1, 1, 1});
  const TemporaryFolder folder;
  const std::string path = folder / "cube.stl";
  ASSERT_TRUE(write_stl(path, cube.mesh()));
  LinkedMachine description = router();
  description.links[1].stl_path = path;
  description.links[1].mm_per_unit = 25.4;
  description.links[1].mesh_offset_mm = {0, 0, 5};
  description.links[1].color = 0x80112233;
  Diagnostics diagnostics;
  const std::optional<MachineModel> model =
      linked_machine(description, shift({10, 0, 0}), diagnostics);
  ASSERT_TRUE(model) << diagnostics.at(0).message;
  EXPECT_EQ(model->links[1].color, 0x80112233U);
  const Box box = bounds_of(*model->links[1].mesh);
  EXPECT_NEAR(box.min.z, 5, 1e-5);
  EXPECT_NEAR(box.max.z, 30.4, 1e-5);
  EXPECT_EQ(model->links[0].mesh->triangles.size(), 12U);
  EXPECT_EQ(tool_stand(*model, {{0, 0, 40}, {}}, 30).tip_mm, Vec3(-10, 0, 10));
}

TEST(LinkedMachine, MissingAndBrokenFilesAreAllNamed) {
  LinkedMachine description = router();
  description.links[0].stl_path = "/nonexistent/table.stl";
  description.links[1].stl_path = "/dev/null";
  Diagnostics diagnostics;
  EXPECT_FALSE(linked_machine(description, {}, diagnostics));
  ASSERT_EQ(diagnostics.size(), 2U);
  EXPECT_EQ(diagnostics[0].message,
            "the link 'table' of the machine cannot be read: cannot read /nonexistent/table.stl: "
            "No such file or directory");
  EXPECT_EQ(diagnostics[1].message,
            "the link 'head' of the machine cannot be read: cannot read /dev/null: it is not a "
            "regular file");
}

TEST(LinkedMachine, AChainThatIsNoneIsRefused) {
  LinkedMachine description = router();
  description.tool_on = "spindle";
  Diagnostics diagnostics;
  EXPECT_FALSE(linked_machine(description, {}, diagnostics));
  ASSERT_EQ(diagnostics.size(), 1U);
  EXPECT_EQ(diagnostics[0].message,
            "the machine's links: 'spindle' is no link; there are table, head");
}

}  // namespace
}  // namespace kerf
