// machine.model and machine.links of a configuration.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/twin/config/config_support.h"

namespace kerf {
namespace {

constexpr const char* kLinks =
    "machine:\n"
    "  workpiece_on: table\n"
    "  tool_on: head\n"
    "  links:\n"
    "    - {name: base, mesh: 'box:0,0,-50:300,200,-20'}\n"
    "    - name: table\n"
    "      parent: base\n"
    "      axis: X\n"
    "      direction: -1,0,0\n"
    "      stl: parts/table.stl\n"
    "      stl_units: inch\n"
    "      stl_offset: 0, 0, -3.5\n"
    "      color: \"#10203040\"\n"
    "    - {name: tilt, axis: A, origin: '1,2,3'}\n"
    "    - {name: head, parent: tilt, axis: J2, moves: turn, direction: '0,0,-1', color: "
    "'#0000ff'}\n";

TEST(MachineConfig, LinksArrive) {
  const ReadText read(kLinks);
  ASSERT_TRUE(read.config) << read.said();
  ASSERT_TRUE(read.config->machine.drawn.links);
  const LinkedMachine& machine = *read.config->machine.drawn.links;
  EXPECT_EQ(machine.workpiece_on, "table");
  ASSERT_EQ(machine.links.size(), 4U);
  EXPECT_EQ(machine.links[0].bodies.size(), 1U);
  EXPECT_EQ(machine.links[0].chain.joint, JointKind::kFixed);
  const LinkSpec& table = machine.links[1];
  EXPECT_EQ(table.chain.joint, JointKind::kPrismatic);
  EXPECT_EQ(table.chain.direction, Vec3(-1, 0, 0));
  EXPECT_EQ(table.stl_path, "dir/parts/table.stl");
  EXPECT_EQ(table.mm_per_unit, 25.4);
  EXPECT_EQ(table.mesh_offset_mm, Vec3(0, 0, -3.5));
  EXPECT_EQ(table.color, 0x40302010U);
  EXPECT_EQ(machine.links[2].chain.joint, JointKind::kRotary);
  EXPECT_EQ(machine.links[2].chain.direction, Vec3(1, 0, 0));
  EXPECT_EQ(machine.links[2].chain.origin_mm, Vec3(1, 2, 3));
  EXPECT_TRUE(machine.links[3].chain.by_joint);
  EXPECT_EQ(machine.links[3].chain.input, 2);
  EXPECT_EQ(machine.links[3].chain.joint, JointKind::kRotary);
  EXPECT_EQ(machine.links[3].color, 0xffff0000U);
}

TEST(MachineConfig, PrintedItReadsTheSame) {
  const ReadText read(kLinks);
  ASSERT_TRUE(read.config);
  const std::string printed = effective_yaml(*read.config);
  Diagnostics diagnostics;
  const auto again = parse_config(printed, "printed.yaml", {}, diagnostics);
  ASSERT_TRUE(again) << printed << (diagnostics.empty() ? "" : to_string(diagnostics[0]));
  EXPECT_EQ(effective_yaml(*again), printed);
  EXPECT_EQ(again->machine.drawn.links->links[1].color, 0x40302010U);
}

TEST(MachineConfig, Models) {
  const ReadText read("machine: {model: trunnion}\n");
  ASSERT_TRUE(read.config);
  EXPECT_EQ(read.config->machine.drawn.kind, MachineKind::kTrunnion);
  EXPECT_EQ(said_of("machine: {model: knee}\n").substr(0, 31), "1:18: machine.model: 'knee' is ");
  EXPECT_EQ(said_of("machine: {model: lathe, tool_on: a}\n"),
            "1:25: machine.tool_on: has no place without links\n");
  // Every kind that there is can be chosen, by the name that it prints.
  for (int kind = 0; kind <= static_cast<int>(MachineKind::kPunch); ++kind) {
    const auto wanted = static_cast<MachineKind>(kind);
    const ReadText one(fmt::format("machine: {{model: {}}}\n", name_of(wanted)));
    ASSERT_TRUE(one.config) << one.said();
    EXPECT_EQ(one.config->machine.drawn.kind, wanted);
  }
}

TEST(MachineConfig, FaultsPointAtTheirPlace) {
  const std::string head = "machine:\n  workpiece_on: t\n  tool_on: t\n  links:\n";
  EXPECT_EQ(said_of(head + "    - {name: t, axis: Q}\n"),
            "5:23: machine.links[1].axis: 'Q' is not allowed; must be one of X, Y, Z, A, B, C, U, "
            "V, W or J0 to J8\n");
  EXPECT_EQ(said_of(head + "    - {name: t, axis: X, direction: '1,0'}\n").substr(0, 30),
            "5:37: machine.links[1].directi");
  EXPECT_EQ(said_of(head + "    - {name: t, parent: u}\n"),
            "5:25: machine.links[1].parent: 'u' is no link; there are t\n");
  EXPECT_EQ(said_of(head + "    - {name: t}\n    - {mesh: 'box:0,0,0:1,1,1'}\n"),
            "6:7: machine.links[2]: name is missing; must be a text\n");
  EXPECT_EQ(said_of(head + "    - {name: t, axis: X, direction: '0,0,0'}\n"),
            "5:37: machine.links[1].direction: a direction of no length points nowhere\n");
  EXPECT_EQ(said_of(head + "    - {name: t, axis: J1}\n"),
            "5:7: machine.links[1]: direction is missing; must be three numbers, x,y,z\n");
  EXPECT_EQ(said_of(head + "    - {name: t, color: '#12345'}\n"),
            "5:24: machine.links[1].color: '#12345' is not allowed; must be #RRGGBB or #RRGGBBAA "
            "(in quotes, as '#' begins a comment: \"#8090a0\")\n");
  EXPECT_EQ(said_of(head + "    - {name: t, stl_units: mm}\n"),
            "5:17: machine.links[1].stl_units: has no place in a link without stl\n");
  EXPECT_EQ(said_of(head + "    - {name: t, moves: turn}\n"),
            "5:17: machine.links[1].moves: has no place in a link without axis, which does not "
            "move\n");
  EXPECT_EQ(said_of(head + "    - {name: t, mash: a}\n"),
            "5:17: machine.links[1].mash: unknown key (did you mean mesh?)\n");
  EXPECT_EQ(said_of(head + "    - t\n"),
            "5:7: machine.links[1]: 't' is not allowed; must be a group of keys\n");
  EXPECT_EQ(said_of("machine: {links: 3}\n"),
            "1:18: machine.links: '3' is not allowed; must be a list of groups of keys\n");
  EXPECT_EQ(said_of("machine: {links: []}\n"),
            "1:18: machine.links: is empty; a machine has at least one link\n");
  EXPECT_EQ(said_of("machine:\n  model: lathe\n  tool_on: b\n  links: [{name: t}]\n"),
            "1:1: machine: workpiece_on is missing; must be the name of a link\n"
            "2:3: machine.model: has no place beside links\n"
            "3:12: machine.tool_on: 'b' is no link; there are t\n");
}

TEST(MachineConfig, PairsAndTheirClearancesArrive) {
  const ReadText read(std::string(kLinks) +
                      "  ignore: [[head, table], [tool, 'my vise']]\n"
                      "fixtures:\n"
                      "  - {name: my vise, shape: 'box:0,0,0:1,1,1', at: '1,2,3', on: table}\n"
                      "clearances:\n"
                      "  - {pair: [head, my vise], mm: 2.5}\n");
  ASSERT_TRUE(read.config) << read.said();
  const std::vector<NamedPair> pairs{{"head", "table"}, {"tool", "my vise"}};
  EXPECT_EQ(read.config->machine.ignore, pairs);
  ASSERT_EQ(read.config->fixtures.size(), 1U);
  EXPECT_EQ(read.config->fixtures[0].on, "table");
  ASSERT_EQ(read.config->clearances.size(), 1U);
  EXPECT_EQ(read.config->clearances[0].pair, (NamedPair{"head", "my vise"}));
  EXPECT_EQ(read.config->clearances[0].mm, 2.5);
  const std::string printed = effective_yaml(*read.config);
  Diagnostics diagnostics;
  const auto again = parse_config(printed, "printed.yaml", {}, diagnostics);
  ASSERT_TRUE(again) << printed;
  EXPECT_EQ(effective_yaml(*again), printed);
  EXPECT_EQ(again->machine.ignore, pairs);
}

TEST(MachineConfig, PairsAreOfTwo) {
  const auto said = [](const std::string& text) {
    const ReadText read(text);
    EXPECT_FALSE(read.config) << text;
    return read.said();
  };
  for (const char* pairs : {"[[a]]", "[[a, b, c]]", "[a, b]", "[[a, [b]]]", "[{a: b}]"}) {
    EXPECT_NE(said(fmt::format("machine: {{ignore: {}}}\n", pairs))
                  .find("is not allowed; must be two names, [a, b]"),
              std::string::npos)
        << pairs;
  }
  EXPECT_NE(said("machine: {ignore: 3}\n").find("a list of pairs"), std::string::npos);
  EXPECT_NE(said("clearances: [{pair: [a], mm: 1}]\n").find("must be two names"),
            std::string::npos);
  EXPECT_NE(said("clearances: [{mm: 1}]\n").find("pair is missing"), std::string::npos);
  EXPECT_NE(said("clearances: [{pair: [a, b]}]\n").find("mm is missing"), std::string::npos);
}

}  // namespace
}  // namespace kerf
