// What of a library counts for a program, and what is told of it.
#include "twin/program/library_tools.h"

#include <gtest/gtest.h>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "twin/job/stock_choice.h"

namespace kerf {
namespace {

LibraryTool tool(std::optional<int> number, const char* shape, const char* name = "") {
  LibraryTool out;
  out.number = number;
  out.name = name;
  out.path = "shop.json";
  if (*shape != 0) out.cutter = parse_shape(shape).value();
  if (*shape == 0) out.trouble = "its kind 'x' is not known";
  return out;
}

std::string said(const Diagnostics& diagnostics) {
  std::string out;
  for (const Diagnostic& one : diagnostics) {
    EXPECT_EQ(one.severity, Severity::kWarning) << one.message;
    EXPECT_EQ(one.file, "shop.json");
    out += one.message + (one.hint.empty() ? "" : " (" + one.hint + ")") + "\n";
  }
  return out;
}

struct Gathered {
  ToolSources sources;
  Diagnostics diagnostics;
  explicit Gathered(std::vector<LibraryTool> tools, std::vector<ToolShapeArgument> arguments = {}) {
    sources.arguments = std::move(arguments);
    add_library_tools({{"shop.json", "Fusion", std::move(tools)}}, nullptr, sources, diagnostics);
  }
};

TEST(LibraryTools, FirstOfTwoCountsAndOthersAreTold) {
  LibraryTool odd = tool(5, "ball:6");
  odd.remarks = {"its corner is left out"};
  const Gathered all({tool(3, "flat:6", "first"), tool(3, "flat:8", "second"), tool({}, "flat:1"),
                      tool(4, "", "Thread mill"), odd});
  EXPECT_EQ(said(all.diagnostics),
            "tool 3 (second): another tool has this number already; the first one counts\n"
            "tool 4 (Thread mill): its kind 'x' is not known; it is left out (--tool 4=SHAPE "
            "describes it)\n"
            "tool 5: its corner is left out\n"
            "1 tool has no number, and is left out (kerf tools shop.json lists them)\n");
  ASSERT_EQ(all.sources.library.size(), 3u);
  EXPECT_EQ(all.sources.library[0].cutter->spec(), "flat:6");
}

TEST(LibraryTools, WhatAnArgumentDescribesIsNotToldOf) {
  const Gathered all({tool(4, "", "Thread mill")}, {parse_tool_argument("4=flat:5").value()});
  EXPECT_EQ(said(all.diagnostics), "");
}

TEST(LibraryTools, OrderOfSources) {
  Gathered all({tool(1, "flat:6", "of the shop"), tool(2, "flat:7"), tool(3, "", "odd")},
               {parse_tool_argument("1=flat:5").value()});
  ToolHint comment;
  comment.tool = 2;
  comment.line = 3;
  comment.dialect = "fusion";
  comment.shape = "ball:4";
  all.sources.hints.push_back(comment);
  ToolResolver resolver(all.sources, ZMap::can_cut);
  EXPECT_EQ(resolver.mount(1, 10).origin, "--tool");
  EXPECT_EQ(resolver.mount(2, 10).origin, "tool library shop.json");
  EXPECT_EQ(resolver.mount(2, 10).cutter->spec(), "flat:7");
  EXPECT_FALSE(resolver.mount(2, 10).guessed);
  EXPECT_FALSE(resolver.mount(3, 10).cutter);
  EXPECT_EQ(resolver.mount(3, 10).trouble, "tool library shop.json: its kind 'x' is not known");
  EXPECT_TRUE(all.sources.describes());
}

TEST(LibraryTools, DiametersOfTheToolTable) {
  Gathered all({tool(1, "flat:8", "8 mm"), tool(2, "flat:6"), tool(3, "taper:2:5:flute=20"),
                tool(4, "flat:8")},
               {parse_tool_argument("4=flat:5").value()});
  for (const auto& [number, diameter_mm] :
       {std::pair(1, 6.0), std::pair(2, 6.009), std::pair(3, 2.0), std::pair(4, 6.0)}) {
    ToolTableRow row;
    row.tool = number;
    row.line = 10 + number;
    row.diameter_mm = diameter_mm;
    all.sources.table.push_back(row);
  }
  compare_with_table(all.sources, all.diagnostics);
  EXPECT_EQ(said(all.diagnostics),
            "tool 1 (8 mm): the tool table (line 11) says 6 mm, the library 8 mm; the library "
            "counts\n");
}

TEST(LibraryTools, OnlyWhatAProgramNamesChoosesTheModel) {
  Gathered all({tool(1, "flat:8"), tool(2, "lollipop:8:4")});
  EXPECT_FALSE(stock_needs(all.sources).undercut.empty());
  all.sources.named_of_library = {1};
  EXPECT_TRUE(stock_needs(all.sources).undercut.empty());
}

}  // namespace
}  // namespace kerf
