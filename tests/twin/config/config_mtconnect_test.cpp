// Sources of type mtconnect, and what an agent says of its machine where nothing else does.
#include <gtest/gtest.h>

#include "tests/machine_io/mtconnect/agent_process.h"
#include "tests/twin/config/config_support.h"
#include "twin/config/agent_machine.h"
#include "twin/config/make_source.h"

namespace kerf {
namespace {

const std::string kAgent = "source:\n  type: mtconnect\n  url: http://cell:5000\n";

TEST(ConfigMtconnect, ValuesArriveAndArePrinted) {
  const ReadText read(kAgent +
                      "  device: mill\n  position: commanded\n  frame: workpiece\n"
                      "  interval_ms: 10\n  heartbeat_ms: 400\n  gather_ms: 5\n  map:\n"
                      "    X: {item: xabs, scale: 2, offset: -1}\n    tool: {item: t}\n"
                      "    load: {item: 'Spindle, load', unit: A}\n");
  ASSERT_TRUE(read.config) << read.said();
  const auto& agent = std::get<MtconnectSettings>(read.config->source);
  EXPECT_EQ(agent.url, "http://cell:5000");
  EXPECT_EQ(agent.device, "mill");
  EXPECT_TRUE(agent.commanded);
  EXPECT_TRUE(agent.workpiece);
  EXPECT_EQ(agent.interval_ms, 10);
  EXPECT_EQ(agent.heartbeat_ms, 400);
  EXPECT_EQ(agent.gather_ms, 5);
  EXPECT_EQ(agent.axes[0]->item, "xabs");
  EXPECT_EQ(agent.axes[0]->scale, 2);
  EXPECT_EQ(agent.axes[0]->offset, -1);
  EXPECT_EQ(agent.tool->item, "t");
  EXPECT_EQ(agent.load->item, "Spindle, load");
  EXPECT_EQ(agent.load_unit, LoadUnit::kAmperes);
  const std::string printed = effective_yaml(*read.config);
  const ReadText again(printed);
  ASSERT_TRUE(again.config) << again.said() << printed;
  EXPECT_EQ(effective_yaml(*again.config), printed);
  EXPECT_NE(printed.find("X: {item: xabs, scale: 2, offset: -1}"), std::string::npos) << printed;
  Diagnostics diagnostics;
  const auto source = make_source(*read.config, diagnostics);
  ASSERT_TRUE(source);
  EXPECT_EQ(source->describe(), "mtconnect http://cell:5000 device mill");
  EXPECT_EQ(coordinates_of(*read.config, *source), CoordinateKind::kAxes);
  EXPECT_TRUE(frame_for(*read.config, *source).workpiece_frame);
  EXPECT_EQ(load_unit_of(*read.config, *source), LoadUnit::kAmperes);
}

TEST(ConfigMtconnect, Faults) {
  EXPECT_EQ(said_of("source:\n  type: mtconnect\n"),
            "1:1: source: url is missing; must be the agent's address (as in "
            "http://192.168.1.7:5000)\n");
  EXPECT_EQ(said_of("source:\n  type: mtconnect\n  url: cell\n"),
            "3:8: source.url: 'cell' is not allowed; must be http://HOST:PORT or "
            "https://HOST:PORT\n");
  EXPECT_EQ(said_of(kAgent + "  units: inch\n"),
            "4:10: source.units: inch is not allowed; must be mm: /probe says the units\n");
  EXPECT_EQ(said_of(kAgent + "  coordinates: joints\n"),
            "4:16: source.coordinates: joints is not allowed; must be axes: that is what agents "
            "have\n");
  EXPECT_EQ(said_of(kAgent + "  heartbeat_ms: 500\n"),
            "4:17: source.heartbeat_ms: a machine that stands would be stale: heartbeat_ms, 500, "
            "must be below stale_after_ms, 500\n");
  EXPECT_EQ(said_of(kAgent + "  stale_after_ms: 150\n"),
            "4:19: source.stale_after_ms: a machine that stands would be stale: heartbeat_ms, 200, "
            "must be below stale_after_ms, 150\n");
  EXPECT_EQ(said_of(kAgent + "  map: {trigger: {item: x}, X: {}}\n"),
            "4:9: source.map.trigger: no agent tells a trigger (X to W, tool, line, spindle, "
            "tool_offset_z and load are chosen here)\n"
            "4:29: source.map.X: item is missing; must be the id or the name of a data item (as "
            "/probe has them)\n");
  EXPECT_EQ(said_of(kAgent + "  poll_hz: 5\n"),
            "4:3: source.poll_hz: is a key of sources of type modbus; this one is mtconnect\n");
}

std::string said_of(const Diagnostics& diagnostics) {
  std::string out;
  for (const Diagnostic& one : diagnostics) out += to_string(one);
  return out;
}

TEST(AgentMachine, AnAgentThatDoesNotAnswerIsANote) {
  LiveConfig config;
  MtconnectSettings agent;
  agent.url = "http://127.0.0.1:1";
  config.source = agent;
  TimelineOptions timeline;
  const double before = timeline.limits.axes[0].max;
  Diagnostics diagnostics;
  take_agent_machine(config, timeline, diagnostics);
  ASSERT_EQ(diagnostics.size(), 1U);
  EXPECT_EQ(diagnostics[0].severity, Severity::kNote);
  EXPECT_NE(diagnostics[0].message.find("are not known: /probe: "), std::string::npos);
  EXPECT_EQ(timeline.limits.axes[0].max, before);
}

TEST(AgentMachine, LimitsAndKinematicsOfTheProbe) {
  AgentProcess process;
  if (!process.is_there()) GTEST_SKIP() << "no /usr/bin/python3";
  process.tell("kinematics xyzac-trt-kins");
  LiveConfig config;
  MtconnectSettings agent;
  agent.url = process.url();
  config.source = agent;
  TimelineOptions timeline;
  const double y_before = timeline.limits.axes[1].max;
  Diagnostics diagnostics;
  take_agent_machine(config, timeline, diagnostics);
  EXPECT_EQ(timeline.limits.axes[0].min, -25.5);
  EXPECT_EQ(timeline.limits.axes[0].max, 400);
  // Y has none, Z half of them: no limits.
  EXPECT_EQ(timeline.limits.axes[1].max, y_before);
  EXPECT_FALSE(timeline.limits_known);  // speeds are not known
  EXPECT_TRUE(timeline.kinematics_known);
  const std::string said = said_of(diagnostics);
  EXPECT_NE(said.find("limits of the axes, by Test: X -25.5..400"), std::string::npos) << said;
  EXPECT_NE(said.find("kinematics, by the agent: xyzac-trt-kins"), std::string::npos) << said;

  // What somebody says goes before it.
  config.machine.ini = "mill.ini";
  TimelineOptions other;
  Diagnostics none;
  take_agent_machine(config, other, none);
  EXPECT_TRUE(none.empty());
  EXPECT_FALSE(other.kinematics_known);

  // A module that is not known is told, and the machine's axes are straight then.
  config.machine.ini.reset();
  process.tell("kinematics homemade");
  Diagnostics warned;
  take_agent_machine(config, other, warned);
  EXPECT_FALSE(other.kinematics_known);
  EXPECT_NE(said_of(warned).find("warning"), std::string::npos) << said_of(warned);
}

}  // namespace
}  // namespace kerf
