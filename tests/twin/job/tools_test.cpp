#include "twin/job/tools.h"

#include <gtest/gtest.h>

#include "stock/zmap/zmap.h"

namespace kerf {
namespace {

ToolHint hint(int tool, std::uint32_t line, const char* shape, bool guessed = false) {
  ToolHint h;
  h.tool = tool;
  h.line = line;
  h.dialect = "fusion";
  h.shape = shape;
  h.shape_guessed = guessed;
  return h;
}

ToolTableRow row(int tool, double diameter_mm, const char* remark) {
  ToolTableRow r;
  r.tool = tool;
  r.diameter_mm = diameter_mm;
  r.remark = remark;
  r.line = 4;
  return r;
}

ToolShapeArgument argument(const char* text) {
  return std::move(parse_tool_argument(text).value());
}

std::string shape_of(ToolResolver& resolver, int tool, std::uint32_t line = 10) {
  const ResolvedTool& resolved = resolver.mount(tool, line);
  return resolved.cutter ? resolved.cutter->spec() : "";
}

TEST(ToolResolver, ArgumentsComeBeforeCommentsBeforeTheTable) {
  ToolSources sources;
  sources.table = {row(1, 3, "ball nose"), row(2, 3, "ball nose"), row(3, 3, "ball nose")};
  sources.hints = {hint(1, 2, "bull:6:1"), hint(2, 3, "bull:6:1")};
  sources.arguments.push_back(argument("1=flat:8"));
  ToolResolver resolver(sources, ZMap::can_cut);
  EXPECT_EQ(shape_of(resolver, 1), "flat:8");
  EXPECT_EQ(resolver.mount(1, 10).origin, "--tool");
  EXPECT_EQ(shape_of(resolver, 2), "bull:6:1");
  EXPECT_EQ(resolver.mount(2, 10).origin, "comment in line 3 (fusion)");
  EXPECT_EQ(shape_of(resolver, 3), "ball:3");
  EXPECT_EQ(resolver.mount(3, 10).origin, "remark in line 4 of the tool table");
  EXPECT_FALSE(resolver.mount(3, 10).guessed);
}

TEST(ToolResolver, DiameterAloneIsAGuess) {
  ToolSources sources;
  sources.table = {row(5, 4, "")};
  ToolResolver resolver(sources, ZMap::can_cut);
  EXPECT_EQ(shape_of(resolver, 5), "flat:4");
  EXPECT_TRUE(resolver.mount(5, 10).guessed);
}

TEST(ToolResolver, WholeShapesComeBeforeGuessedOnes) {
  ToolSources sources;
  sources.hints = {hint(1, 1, "flat:6", true), hint(1, 9, "ball:6")};
  ToolResolver resolver(sources, ZMap::can_cut);
  EXPECT_EQ(shape_of(resolver, 1), "ball:6");
}

TEST(ToolResolver, NeverGivesOneToolForAnother) {
  ToolSources sources;
  sources.arguments.push_back(argument("1=flat:8"));
  ToolResolver resolver(sources, ZMap::can_cut);
  EXPECT_EQ(shape_of(resolver, 2), "");
  EXPECT_TRUE(resolver.mount(2, 10).trouble.empty());
}

TEST(ToolResolver, CommentWithoutNumberBelongsToTheNextTool) {
  ToolSources sources;
  sources.hints = {hint(-1, 5, "flat:6"), hint(-1, 20, "ball:4")};
  ToolResolver resolver(sources, ZMap::can_cut);
  EXPECT_EQ(shape_of(resolver, 7, 8), "flat:6");
  EXPECT_EQ(shape_of(resolver, 2, 15), "") << "the comment in line 5 is used up";
  EXPECT_EQ(shape_of(resolver, 3, 25), "ball:4");
}

TEST(ToolResolver, RunningTextIsAGuessAndComesLast) {
  ToolSources sources;
  sources.hints = {hint(-1, 5, "flat:6")};
  sources.hints[0].near = true;
  ToolResolver resolver(sources, ZMap::can_cut);
  EXPECT_EQ(shape_of(resolver, 7, 8), "flat:6");
  EXPECT_TRUE(resolver.mount(7, 8).guessed);
  EXPECT_EQ(resolver.mount(7, 8).guess, "that comment names no tool, and may be about another");
  sources.table = {row(7, 3, "ball nose")};
  ToolResolver with_table(sources, ZMap::can_cut);
  EXPECT_EQ(shape_of(with_table, 7, 8), "ball:3");
  EXPECT_FALSE(with_table.mount(7, 8).guessed);
  // A statement at the change comes before the text behind it.
  sources.hints = {hint(-1, 5, "flat:6"), hint(-1, 6, "ball:2")};
  sources.hints[1].near = true;
  ToolResolver at_change(sources, ZMap::can_cut);
  EXPECT_EQ(shape_of(at_change, 7, 8), "flat:6");
}

TEST(ToolResolver, CommentsThatDisagreeAreAGuess) {
  ToolSources sources;
  sources.hints = {hint(1, 1, "flat:6"),      hint(1, 9, "flat:3"),      hint(2, 2, "flat:12.7"),
                   hint(2, 9, "flat:12.69"),  hint(3, 3, "flat:6"),      hint(3, 9, "ball:6"),
                   hint(4, 4, "drill:5:118"), hint(4, 9, "flat:5", true)};
  ToolResolver resolver(sources, ZMap::can_cut);
  EXPECT_EQ(shape_of(resolver, 1), "flat:6");
  EXPECT_TRUE(resolver.mount(1, 10).guessed);
  EXPECT_EQ(resolver.mount(1, 10).guess, "the comment in line 9 describes it as flat:3");
  EXPECT_FALSE(resolver.mount(2, 10).guessed) << "rounded";
  EXPECT_TRUE(resolver.mount(3, 10).guessed);
  EXPECT_FALSE(resolver.mount(4, 10).guessed) << "one of them says less";
}

TEST(ToolResolver, EmptySpindleTakesTheOnlyToolThatIsDescribed) {
  ToolSources one;
  one.arguments.push_back(argument("4=flat:8"));
  ToolResolver resolver(one, ZMap::can_cut);
  EXPECT_EQ(shape_of(resolver, 0), "flat:8");
  EXPECT_TRUE(resolver.mount(0, 1).assumed);
  EXPECT_EQ(resolver.mount(0, 1).number, 4);

  ToolSources two = one;
  two.arguments.push_back(argument("5=flat:8"));
  ToolResolver unsure(two, ZMap::can_cut);
  EXPECT_EQ(shape_of(unsure, 0), "");

  ToolSources comments;
  comments.hints = {hint(3, 2, "ball:6")};
  ToolResolver hinted(comments, ZMap::can_cut);
  EXPECT_EQ(shape_of(hinted, 0), "ball:6");
  EXPECT_EQ(hinted.mount(0, 1).number, 3);
}

TEST(ToolResolver, UndercutsNeedAModelThatHoldsThem) {
  ToolSources sources;
  sources.arguments.push_back(argument("1=lollipop:6:3"));
  ToolResolver zmap(sources, ZMap::can_cut);
  EXPECT_EQ(shape_of(zmap, 1), "");
  EXPECT_EQ(zmap.mount(1, 1).trouble,
            "lollipop:6:3 cuts below itself (its neck is thinner than its head); a Z-map cannot "
            "hold undercuts");
  ToolResolver other(sources, nullptr);
  EXPECT_EQ(shape_of(other, 1), "lollipop:6:3");
}

TEST(ToolResolver, TableRowWithoutDiameterIsNoTool) {
  ToolSources sources;
  sources.table = {row(1, 0, "ball nose")};
  ToolResolver resolver(sources, ZMap::can_cut);
  EXPECT_EQ(shape_of(resolver, 1), "");
  EXPECT_EQ(resolver.mount(1, 1).trouble, "the tool table (line 4) gives no diameter for it");
}

}  // namespace
}  // namespace kerf
