// Turrets from YAML: the example, and every fault at its place.
#include <gtest/gtest.h>

#include "tests/twin/config/config_support.h"
#include "twin/config/turret_reader.h"

namespace kerf {
namespace {

constexpr const char* kStations = "stations:\n  1: round:10\n";  // two lines
constexpr const char* kPunch = "punch: {trigger: m101}\n";

struct ReadTurret {
  Diagnostics diagnostics;
  TurretPointer turret;
  explicit ReadTurret(std::string_view text)
      : turret(parse_turret(text, "dir/t.yaml", diagnostics)) {}
  /// "3:5: message (hint)", one a line.
  std::string said() const {
    std::string out;
    for (const Diagnostic& one : diagnostics) {
      EXPECT_EQ(one.file, "dir/t.yaml") << one.message;
      out += fmt::format("{}:{}: {}{}\n", one.line, one.column, one.message,
                         one.hint.empty() ? "" : fmt::format(" ({})", one.hint));
    }
    return out;
  }
};

std::string said_of_turret(const std::string& text) {
  const ReadTurret read(text);
  EXPECT_EQ(read.turret == nullptr, has_error(read.diagnostics));
  return read.said();
}

TEST(Turret, TheExampleHasAllThereIs) {
  Diagnostics diagnostics;
  const TurretPointer turret =
      read_turret(std::string(KERF_CONFIGS_FOLDER) + "/punch/turret.yaml", diagnostics);
  for (const Diagnostic& one : diagnostics) ADD_FAILURE() << to_string(one);
  ASSERT_NE(turret, nullptr);
  EXPECT_GE(turret->stations.size(), 20U);
  EXPECT_TRUE(turret->sheet_moves);
  EXPECT_EQ(turret->trigger.kind(), PunchTrigger::Kind::kState);
  EXPECT_EQ(turret->nibble_pitch_mm, 4);
  EXPECT_EQ(turret->clamps.size(), 2U);
  EXPECT_EQ(turret->user_codes(), std::vector<int>{120});
  EXPECT_TRUE(turret->station(19)->turns);
  EXPECT_EQ(turret->station(99), nullptr);
}

TEST(Turret, EveryKeyMeansWhatItSays) {
  const ReadTurret read(
      "stations:\n"
      "  1: round:10\n"
      "  20: {punch: 'rectangle:30:5', name: slit, angle: -90, index: true, pitch: 28}\n"
      "index: m67:2\n"
      "punch:\n"
      "  trigger: m62:3+!m8\n"
      "  hit: ends\n"
      "  nibble: {pitch: 2.5, while: feed+m62:1}\n"
      "frame: {moves: head}\n"
      "clamps:\n"
      "  - {x: 10, y: -50, width: 60, depth: 70, clearance: 4}\n"
      "regrip:\n"
      "  - {on: M121, x: -30, y: 2}\n"
      "  - {line: 42, x: 7}\n");
  ASSERT_NE(read.turret, nullptr) << read.said();
  const Turret& turret = *read.turret;
  const TurretStation& slit = *turret.station(20);
  EXPECT_EQ(slit.name, "slit");
  EXPECT_EQ(slit.shape, "rectangle:30:5");
  EXPECT_EQ(slit.punch.spec(), "punch:rectangle:30:5");
  EXPECT_EQ(slit.angle_deg, -90);
  EXPECT_TRUE(slit.turns);
  EXPECT_EQ(turret.pitch_mm(20), 28);
  EXPECT_EQ(turret.pitch_mm(1), 2.5);
  EXPECT_FALSE(turret.station(1)->turns);
  EXPECT_EQ(turret.index.analog, 2);
  EXPECT_EQ(turret.trigger.state().terms().size(), 2U);
  EXPECT_TRUE(turret.strikes_at_ends);
  EXPECT_EQ(turret.nibble_pitch_mm, 2.5);
  EXPECT_EQ(turret.nibbles->terms().size(), 2U);
  EXPECT_FALSE(turret.sheet_moves);
  EXPECT_EQ(turret.clamps[0].max_mm, Vec2(70, 20));
  EXPECT_EQ(turret.clamps[0].clearance_mm, 4);
  EXPECT_EQ(turret.regrips[0].user_code, 121);
  EXPECT_EQ(turret.regrips[0].shift_mm, Vec2(-30, 2));
  EXPECT_EQ(turret.regrips[1].line, 42U);
  EXPECT_EQ(turret.regrips[1].shift_mm, Vec2(7, 0));
}

TEST(Turret, Times) {
  const ReadTurret read(std::string(kStations) + kPunch +
                        "times:\n"
                        "  stroke: 0.08\n"
                        "  rate: {1: 600, 2.5: 240}\n"
                        "  turret: {places: 22, step: 0.12, lock: 0.5}\n"
                        "  regrip: 4\n");
  ASSERT_NE(read.turret, nullptr) << read.said();
  const PunchTimes& times = read.turret->times;
  EXPECT_TRUE(times.any());
  EXPECT_EQ(times.stroke_s, 0.08);
  EXPECT_EQ(times.period_by_pitch_s, (std::map<double, double>{{1, 0.1}, {2.5, 0.25}}));
  EXPECT_EQ(times.places, 22);
  EXPECT_EQ(times.step_s, 0.12);
  EXPECT_EQ(times.lock_s, 0.5);
  EXPECT_EQ(times.regrip_s, 4);
  EXPECT_FALSE(ReadTurret(std::string(kStations) + kPunch).turret->times.any()) << "no times";
}

TEST(Turret, FaultsOfTimes) {
  const auto said = [](const std::string& times) {
    return said_of_turret(std::string(kStations) + kPunch + "times: " + times + "\n");
  };
  EXPECT_EQ(said("{stroke: -1}"),
            "4:17: times.stroke: '-1' is not allowed; must be 0 to 3600 (s)\n");
  EXPECT_EQ(said("{stroke: nan}"),
            "4:17: times.stroke: 'nan' is not allowed; must be 0 to 3600 (s)\n");
  EXPECT_EQ(said("{strokes: 1}"), "4:9: times.strokes: unknown key (did you mean stroke?)\n");
  EXPECT_EQ(said("{rate: {}}"),
            "4:15: times.rate: there are none; must be PITCH: STROKES a minute for each (as in 4: "
            "600)\n");
  EXPECT_EQ(said("{rate: 600}"),
            "4:15: times.rate: '600' is not allowed; must be a group of keys\n");
  EXPECT_EQ(said("{rate: {1 mm: 600}}"),
            "4:16: times.rate.1 mm: '1 mm' is no pitch; must be 0.01 to 100000 (mm)\n");
  EXPECT_EQ(said("{rate: {4: 0}}"),
            "4:19: times.rate.4: '0' is not allowed; must be 0.1 to 100000 (strokes a minute)\n");
  EXPECT_EQ(said("{rate: {4: 600, 4.0: 500}}"),
            "4:24: times.rate.4.0: this pitch is given twice\n");
  EXPECT_EQ(said("{turret: {places: 1.5}}"),
            "4:26: times.turret.places: '1.5' is not allowed; must be a whole number\n");
  EXPECT_EQ(said_of_turret("stations: {1: round:3, 30: round:4}\npunch: {trigger: m101}\n"
                           "times: {turret: {places: 22}}\n"),
            "3:26: times.turret.places: 22 are too few: there is a station 30\n");
}

TEST(Turret, FaultsOfStations) {
  const auto said = [](const std::string& station) {
    return said_of_turret("stations:\n  3: " + station + "\n" + kPunch);
  };
  EXPECT_EQ(said_of_turret(kPunch),
            "0:0: stations is missing; must be NUMBER: SHAPE for each (as in 3: round:12)\n");
  EXPECT_EQ(said("round:0"),
            "2:6: stations.3: round:0: diameter D: 0 is not allowed; must be from 0.1 to 1000 "
            "(mm)\n");
  EXPECT_EQ(
      said("[round:3]"),
      "2:6: stations.3: a list is not allowed; must be a shape, as in round:12, or a group of "
      "keys: punch, name, angle, index, pitch\n");
  EXPECT_EQ(said("{name: x}"),
            "2:6: stations.3: punch is missing; must be a shape, as in round:12\n");
  EXPECT_EQ(said("{punch: round:3, angle: 400}"),
            "2:30: stations.3.angle: '400' is not allowed; must be -360 to 360 (degrees)\n");
  EXPECT_EQ(said("{punch: round:3, index: maybe}"),
            "2:30: stations.3.index: 'maybe' is not allowed; must be true or false\n");
  EXPECT_EQ(said("{punch: round:3, angel: 4}"),
            "2:23: stations.3.angel: unknown key (did you mean angle?)\n");
  EXPECT_EQ(said("dxf:none.dxf"),
            "2:6: stations.3: dxf:dir/none.dxf: dir/none.dxf: No such file or directory\n");
  EXPECT_EQ(said_of_turret(std::string("stations: {T1: round:3}\n") + kPunch),
            "1:12: stations.T1: 'T1' is no station; must be the number of a tool, 1 to 99999\n");
  EXPECT_NE(said("hexagon:3").find("2:6: stations.3: hexagon:3: unknown shape 'hexagon'"),
            std::string::npos)
      << said("hexagon:3");
}

TEST(Turret, FaultsOfThePunch) {
  const auto said = [](const std::string& punch) {
    return said_of_turret(std::string(kStations) + punch);
  };
  const std::string wanted =
      " is missing; it says what makes the punch strike (m3, m62:0, m100 .. "
      "m199, g81, z<-1)\n";
  EXPECT_EQ(said("punch: {hit: once}\n"), "3:8: punch: trigger" + wanted);
  EXPECT_EQ(said(""), "0:0: punch.trigger" + wanted);
  EXPECT_NE(said("punch: {trigger: m99}\n").find("3:18: punch.trigger: 'm99' is no trigger; must"),
            std::string::npos);
  EXPECT_EQ(said("punch: {trigger: m3, hit: twice}\n"),
            "3:27: punch.hit: 'twice' is not allowed; must be once or ends\n");
  EXPECT_EQ(said("punch: {trigger: g81, hit: ends}\n"),
            "3:23: punch.hit: is for triggers that stay on; g81 does not\n");
  EXPECT_EQ(said("punch: {trigger: m3, nibble: {pitch: 0}}\n"),
            "3:38: punch.nibble.pitch: '0' is not allowed; must be 0.01 to 100000 (mm)\n");
  EXPECT_EQ(said("punch: {trigger: m3, nibble: {}}\n"),
            "3:30: punch.nibble: pitch is missing; must be mm from stroke to stroke\n");
  EXPECT_EQ(said("punch: {trigger: m101, nibble: {pitch: 2}}\n"),
            "3:32: punch.nibble: while is missing: m101 does not stay on, so it cannot tell on "
            "which feeds the punch nibbles (as in while: m62:1)\n");
  EXPECT_EQ(said_of_turret("stations: {1: {punch: round:3, pitch: 2}}\npunch: {trigger: g81}\n"),
            "2:8: punch: nibble.while is missing: g81 does not stay on, so it cannot tell on which "
            "feeds the punch nibbles (as in while: m62:1)\n");
  EXPECT_EQ(said("punch: {trigger: g81, nibble: {pitch: 2, while: m99}}\n").substr(0, 40),
            "3:49: punch.nibble.while: beam trigger '");
}

TEST(Turret, FaultsOfClampsAndTheRest) {
  const auto said = [](const std::string& rest) {
    return said_of_turret(std::string(kStations) + kPunch + rest);
  };
  EXPECT_EQ(said("clamps: {x: 1}\n"),
            "4:9: clamps: a group of keys is not allowed; must be a list\n");
  EXPECT_EQ(said("clamps:\n  - {x: 1, y: 2, width: -3, depth: 5}\n"),
            "5:25: clamps[1].width: '-3' is not allowed; must be 0.1 to 100000 (mm)\n");
  EXPECT_EQ(said("clamps:\n  - {x: 1, y: 2, width: 3}\n"),
            "5:5: clamps[1]: depth is missing; must be 0.1 to 100000 (mm)\n");
  EXPECT_EQ(said("regrip:\n  - {x: 1}\n"),
            "5:5: regrip[1]: on or line is missing: the M-code, or the line of the program, at "
            "which the clamps move\n");
  EXPECT_EQ(said("regrip:\n  - {on: m120, line: 3, x: 1}\n"),
            "5:5: regrip[1]: on and line are both given; must be one of them\n");
  EXPECT_EQ(said("regrip:\n  - {on: m99, x: 1}\n"),
            "5:10: regrip[1].on: 'm99' is not allowed; must be m100 to m199\n");
  EXPECT_EQ(said("regrip:\n  - {on: m101, x: 1}\n"),
            "5:10: regrip[1].on: m101 makes the punch strike already\n");
  EXPECT_EQ(said("regrip:\n  - {on: m120}\n"),
            "5:5: regrip[1]: x and y are missing: how far the clamps move, in mm\n");
  EXPECT_EQ(said("index: D\n"),
            "4:8: index: 'D' is not allowed; must be A, B, C, or m67:0 to m67:3 (an analog output "
            "in degrees)\n");
  EXPECT_EQ(said("frame: {moves: table}\n"),
            "4:16: frame.moves: 'table' is not allowed; must be sheet or head\n");
  EXPECT_EQ(said("clamp: []\n"), "4:1: clamp: unknown key (did you mean clamps?)\n");
  // All at once.
  const ReadTurret many("stations: {0: round:3}\nindex: x\npunch: {trigger: q}\n");
  EXPECT_EQ(many.diagnostics.size(), 3U) << many.said();
}

TEST(Turret, FilesThatAreNone) {
  const ConfigFolder folder;
  const auto said = [](const std::string& path) {
    Diagnostics diagnostics;
    EXPECT_EQ(read_turret(path, diagnostics), nullptr);
    return diagnostics.empty() ? "" : diagnostics[0].message;
  };
  EXPECT_EQ(said(folder.path() + "/none.yaml"),
            "cannot read the turret: No such file or directory");
  EXPECT_EQ(said(folder.path()), "is a folder; a turret is a file");
  EXPECT_EQ(said(folder.write("e.yaml", " \n")), "is empty");
  EXPECT_NE(said(folder.write("s.yaml", "stations: {1: round:3\n")), "");
  // Drawings are beside the file.
  folder.write("d.svg", "<svg><path d='M0 0H5V5H0Z'/></svg>");
  Diagnostics diagnostics;
  const TurretPointer turret = read_turret(
      folder.write("t.yaml", "stations: {1: svg:d.svg}\npunch: {trigger: m3}\n"), diagnostics);
  for (const Diagnostic& one : diagnostics) ADD_FAILURE() << to_string(one);
  ASSERT_NE(turret, nullptr);
  EXPECT_EQ(turret->station(1)->shape, "svg:d.svg");
}

}  // namespace
}  // namespace kerf
