// kerf shadow beside an MTConnect agent: what is cut, and what is said.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/machine_io/mtconnect/agent_process.h"
#include "tests/twin/cli/kerf_process.h"

namespace kerf {
namespace {

std::vector<std::string> shadow_of(const AgentProcess& agent, const TestFolder& folder) {
  return {"shadow",
          "--set",
          "source.type=mtconnect",
          "--set",
          "source.url=" + agent.url(),
          "--set",
          "view.window=no",
          "--stock",
          "box:0,-10,-5:40,10,0",
          "--tool",
          "4=flat:6",
          "--cell",
          "0.1",
          "--set",
          "machine.tool_length=none",
          "--json",
          folder.file("live.json")};
}

/// A slot right through a block: 40 mm long, 6 mm wide, 2 mm deep.
TEST(AgentCommand, ASlotIsCutFromWhatAnAgentTells) {
  AgentProcess agent;
  if (!agent.is_there()) GTEST_SKIP() << "no /usr/bin/python3";
  for (const char* const streams : {"stream yes", "stream no"}) {
    SCOPED_TRACE(streams);
    agent.tell(streams);
    agent.tell("slot 40");
    agent.tell("forget");
    const TestFolder folder;
    KerfCall call;
    call.arguments = shadow_of(agent, folder);
    for (const std::string& more : {std::string("--for"), std::string("6"), std::string("--record"),
                                    folder.file("slot.csv")}) {
      call.arguments.push_back(more);
    }
    const KerfResult result = run_kerf(call);
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    const nlohmann::json report =
        nlohmann::json::parse(read_file(folder.file("live.json")), nullptr, false);
    ASSERT_FALSE(report.is_discarded());
    EXPECT_NEAR(report["stock"]["removed_mm3"].get<double>(), 40 * 6 * 2, 2.5);
    EXPECT_EQ(report["live"]["gaps"], 0);
    EXPECT_EQ(report["live"]["lost"], 0);
    // They came from another process by way of a stream: no age is none.
    EXPECT_GT(report["live"]["age_ms"]["median"].get<double>(), 0.5);
    EXPECT_LT(report["live"]["age_ms"]["median"].get<double>(), 300);

    KerfCall replay;
    replay.arguments = {"replay",  folder.file("slot.csv"),
                        "--set",   "view.window=no",
                        "--stock", "box:0,-10,-5:40,10,0",
                        "--tool",  "4=flat:6",
                        "--cell",  "0.1",
                        "--set",   "machine.tool_length=none",
                        "--speed", "max",
                        "--json",  folder.file("replay.json")};
    EXPECT_EQ(run_kerf(replay).exit_code, 0);
    const nlohmann::json again =
        nlohmann::json::parse(read_file(folder.file("replay.json")), nullptr, false);
    ASSERT_FALSE(again.is_discarded());
    EXPECT_EQ(again["stock"]["digest"], report["stock"]["digest"]);
  }
}

TEST(AgentCommand, AMachineThatIsNotThereIsNamed) {
  AgentProcess agent;
  if (!agent.is_there()) GTEST_SKIP() << "no /usr/bin/python3";
  const TestFolder folder;
  KerfCall call;
  call.arguments = shadow_of(agent, folder);
  for (const char* const more : {"--for", "10", "--set", "source.device=Lathe"}) {
    call.arguments.push_back(more);
  }
  const KerfResult result = run_kerf(call);
  EXPECT_EQ(result.exit_code, 4) << result.out;
  EXPECT_NE(result.err.find("the agent has no device Lathe (source.device); it has Test"),
            std::string::npos)
      << result.err;
}

}  // namespace
}  // namespace kerf
