#include <gtest/gtest.h>

#include "stock/cutter/shape_spec.h"
#include "tests/base/temporary_folder.h"
#include "twin/scene/moment_values.h"
#include "twin/scene/program_text.h"
#include "twin/scene/tool_shape.h"

namespace kerf {
namespace {

Cutter cutter(const std::string& shape) { return parse_tool_argument("1=" + shape).value().cutter; }

TEST(ToolShape, ABallIsRoundBelowAndHasItsFlutes) {
  const auto shape = tool_shape_of(cutter("ball:10:flute=22:shank=8:holder=40x30"));
  ASSERT_GT(shape->cutter.size(), 10u);
  for (const ProfilePoint& p : shape->cutter) {
    if (p.height_mm > 5) continue;
    EXPECT_NEAR(std::hypot(p.radius_mm, p.height_mm - 5), 5, 1e-4);
  }
  EXPECT_FLOAT_EQ(shape->cutter.back().height_mm, 22);
  ASSERT_EQ(shape->holder.size(), 2u);
  EXPECT_FLOAT_EQ(shape->holder[0].radius_mm, 20);
  const auto bare = tool_shape_of(cutter("ball:10:flute=22:shank=8"));
  EXPECT_TRUE(bare->holder.empty());
  ASSERT_EQ(bare->shank.size(), 2u);
  EXPECT_FLOAT_EQ(bare->shank[0].radius_mm, 4);
  EXPECT_FLOAT_EQ(bare->shank[0].height_mm, 22);
}

TEST(ToolShape, OutlinesRunUpward) {
  for (const char* text : {"flat:6", "bull:10:2", "vee:8:90", "drill:5:118", "taper:3:5:0.5"}) {
    const auto shape = tool_shape_of(cutter(text));
    for (std::size_t i = 1; i < shape->cutter.size(); ++i) {
      EXPECT_GE(shape->cutter[i].height_mm, shape->cutter[i - 1].height_mm - 1e-6f) << text;
    }
    EXPECT_FLOAT_EQ(shape->cutter.front().radius_mm, 0) << text;
  }
}

TEST(ToolShape, NamesAreWhatPeopleSay) {
  EXPECT_EQ(tool_name_of(cutter("bull:10:2:flute=22")), "bull 10 2");
  EXPECT_EQ(tool_name_of(cutter("ball:6")), "ball 6");
}

TEST(MomentValues, MachinePositionTurnsAndShifts) {
  WorkpieceFrame frame;
  frame.g5x_mm = {100, 50, -20};
  frame.g92_mm = {1, 0, 0};
  frame.rotation_deg = 90;
  const Vec3 machine = machine_position(frame, {9, 5, 2}, {0, 0, 60});
  EXPECT_NEAR(machine.x, 95, 1e-9);
  EXPECT_NEAR(machine.y, 60, 1e-9);
  EXPECT_NEAR(machine.z, 42, 1e-9);
}

TEST(MomentValues, MachineZeroIsWhereTheMachineSaysZero) {
  WorkpieceFrame frame;
  frame.g5x_mm = {100, 50, -20};
  frame.rotation_deg = 30;
  const auto frames = scene_frames(frame, "G55");
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].name, "G55");
  const Vec3 there = machine_position(frame, frames[1].origin_mm, {0, 0, 0});
  EXPECT_NEAR(glm::length(there), 0, 1e-9);
  const Vec3 along = machine_position(frame, frames[1].origin_mm + 7.0 * frames[1].x_axis, {});
  EXPECT_NEAR(glm::length(along - Vec3(7, 0, 0)), 0, 1e-9);
}

TEST(MomentValues, RotaryAxesOnlyWhereThereAreAny) {
  EXPECT_EQ(axis_readouts({1, 2, 3}, {4, 5, 6}, nullptr).size(), 3u);
  const std::array<double, 3> abc{10, 20, 30};
  const auto axes = axis_readouts({1, 2, 3}, {4, 5, 6}, &abc);
  ASSERT_EQ(axes.size(), 6u);
  EXPECT_EQ(axes[1].machine, 2);
  EXPECT_EQ(axes[1].work, 5);
  EXPECT_TRUE(axes[3].is_rotary);
  EXPECT_EQ(axes[5].work, 30);
}

TEST(ProgramText, WhatCannotBeReadSaysSo) {
  const TemporaryFolder folder;
  const std::string path = folder / "program.ngc";
  write_file(path, "G21\nG0 X1\n");
  const auto text = read_program_text({path, path + ".gone", "-"});
  ASSERT_EQ(text->files.size(), 3u);
  EXPECT_EQ(text->files[0].line(2), "G0 X1");
  EXPECT_NE(text->files[1].line(1).find("No such file"), std::string_view::npos);
  EXPECT_EQ(text->files[2].line_count(), 1);
  EXPECT_NE(read_program_text({path}, 3)->files[0].line(1).find("too long"),
            std::string_view::npos);
}

TEST(SceneValues, FindingsSpeakBothUnits) {
  Finding contact;
  contact.source.line = 4;
  contact.text = "traverse touches the workpiece";
  contact.depth_mm = 2.54;
  contact.position_mm = Vec3(25.4, 0, -1);
  Finding said;
  said.id = FindingId::kInterpreterError;
  said.text = "Radius 3.0 mm is too small";
  const auto list = finding_list({contact, said}, {"part.ngc"});
  ASSERT_EQ(list->findings.size(), 2U);
  EXPECT_EQ(list->findings[0].text_in(LengthUnit::kMm),
            "traverse touches the workpiece, 2.54 mm deep at X25.40 Y0.00 Z-1.00");
  EXPECT_EQ(list->findings[0].text_in(LengthUnit::kInch),
            "traverse touches the workpiece, 0.1 in deep at X1 Y0 Z-0.039");
  EXPECT_EQ(list->findings[1].text_in(LengthUnit::kInch), said.text) << "the program's numbers";
}

}  // namespace
}  // namespace kerf
