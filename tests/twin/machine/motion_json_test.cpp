#include "twin/machine/motion_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/twin/process/motions.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

std::string line_of(const Motion& motion, const TimedStep& step = {}) {
  MotionJson writer;
  writer.set_files({"part.ngc", "a \"b\"\\\xff.ngc"});
  std::string out;
  writer.append(motion, step, out);
  return out;
}

TEST(MotionJson, AFeedMoveIsOneLine) {
  MotionList list;
  list.tool(3).spindle(true).at({0, 0, 5}).feed_rate(300).feed({12.3456, -0.0, -1e-9});
  TimedStep step;
  step.start_s = 1.25;
  step.duration_s = 0.1 + 0.2;
  EXPECT_EQ(
      line_of(list.last(), step),
      "{\"line\":2,\"file\":\"part.ngc\",\"kind\":\"feed\",\"from\":[0,0,5],\"to\":[12.3456,0,"
      "0],\"feed\":300,\"tool\":3,\"spindle\":\"cw\",\"rpm\":10000,\"t\":1.25,\"duration\":0.3}"
      "\n");
}

TEST(MotionJson, ArcsSayHowTheyTurn) {
  MotionList list;
  list.at({10, 0, 0}).arc({-10, 0, -2}, {0, 0, 0}, {0, 0, 1}, kPi);
  const Json json = Json::parse(line_of(list.last()));
  EXPECT_EQ(json["kind"], "arc");
  EXPECT_EQ(json["center"], Json({0, 0, 0}));
  EXPECT_EQ(json["axis"], Json({0, 0, 1}));
  EXPECT_EQ(json["sweep_deg"], 180);
  EXPECT_EQ(json["to"], Json({-10, 0, -2}));
}

TEST(MotionJson, WhatIsNotKnownOrDoesNotApplyIsLeftOut) {
  MotionList list;
  list.traverse({1, 2, 3});
  list.last().start_known = false;
  const Json first = Json::parse(line_of(list.last()));
  EXPECT_TRUE(first["from"].is_null());
  for (const char* name : {"feed", "feed_per_rev", "spindle", "rpm", "coolant", "from_abc",
                           "center", "path", "blend_mm"}) {
    EXPECT_FALSE(first.contains(name)) << name;
  }
  list.dwell(1.5);
  const Json dwell = Json::parse(line_of(list.last()));
  EXPECT_EQ(dwell["kind"], "dwell");
  EXPECT_FALSE(dwell.contains("to"));
}

TEST(MotionJson, RotaryCoolantAndPathMode) {
  MotionList list;
  list.feed({1, 0, 0});
  Motion m = list.last();
  m.to_abc_deg = {90, 0, -1};
  m.flood = m.mist = true;
  m.feed_per_rev = true;
  m.blend_tolerance_mm = 0.5F;
  m.merge_tolerance_mm = 0.25F;
  const Json json = Json::parse(line_of(m));
  EXPECT_EQ(json["from_abc"], Json({0, 0, 0}));
  EXPECT_EQ(json["to_abc"], Json({90, 0, -1}));
  EXPECT_FALSE(json.contains("to_uvw"));
  m.from_uvw_mm = {0, 0, -10.5};
  EXPECT_EQ(Json::parse(line_of(m))["from_uvw"], Json({0, 0, -10.5}));
  EXPECT_EQ(Json::parse(line_of(m))["to_uvw"], Json({0, 0, 0}));
  EXPECT_EQ(json["coolant"], Json({"flood", "mist"}));
  EXPECT_EQ(json["feed_per_rev"], true);
  EXPECT_EQ(json["blend_mm"], 0.5);
  EXPECT_EQ(json["merge_mm"], 0.25);
  m.path_mode = PathMode::kExactStop;
  EXPECT_EQ(Json::parse(line_of(m))["path"], "exact-stop");
  m.path_mode = PathMode::kExactPath;
  EXPECT_EQ(Json::parse(line_of(m))["path"], "exact-path");
}

TEST(MotionJson, FileNamesAreQuotedAndMayBeUnknown) {
  MotionList list;
  list.feed({1, 0, 0});
  Motion m = list.last();
  m.source.file = 1;
  EXPECT_EQ(Json::parse(line_of(m))["file"], "a \"b\"\\\xef\xbf\xbd.ngc");
  m.source.file = 7;
  EXPECT_TRUE(Json::parse(line_of(m))["file"].is_null());
}

TEST(MotionJson, LargeNumbersStayNumbers) {
  MotionList list;
  list.feed({1e20, 123456.789, 0.000001});
  const Json json = Json::parse(line_of(list.last()));
  EXPECT_DOUBLE_EQ(json["to"][0].get<double>(), 1e20);
  EXPECT_DOUBLE_EQ(json["to"][1].get<double>(), 123456.789);
  EXPECT_DOUBLE_EQ(json["to"][2].get<double>(), 1e-6);
}

}  // namespace
}  // namespace kerf
