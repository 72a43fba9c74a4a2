// Arbitrary bytes as what an MTConnect agent answers: to /probe, then as news of a machine that is
// known, and as parts of a stream, cut anywhere.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "machine_io/mtconnect/device_model.h"
#include "machine_io/mtconnect/device_state.h"
#include "machine_io/mtconnect/multipart.h"
#include "machine_io/mtconnect/stream_answer.h"

namespace {

void take(kerf::DeviceState& state, std::string_view text, const kerf::DeviceModel& device) {
  const auto answer = kerf::parse_streams(text, device);
  if (!answer) {
    if (answer.error().empty()) std::abort();
    return;
  }
  for (const auto& made : state.take(answer->observations)) {
    for (std::size_t i = 0; i < kerf::kMaxPositions; ++i) {
      if (made.sample.has(i) && !(std::abs(made.sample.position[i]) <= 1e7)) std::abort();
    }
    if ((made.sample.fresh & ~made.sample.known) != 0) std::abort();
    if (made.sample.tool < -1 || made.sample.line < -1) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto probe = kerf::parse_probe(text);
  if (!probe && probe.error().empty()) std::abort();
  if (probe) {
    for (const kerf::DeviceModel& device : probe->devices) {
      const auto plan = kerf::plan_items(device, {});
      if (plan ? plan->letters().empty() : plan.error().empty()) std::abort();
    }
  }
  // Of LinuxCNC's names, which the seeds have.
  kerf::DeviceModel device;
  device.name = "mtconnect_demo";
  device.uuid = "linuxcnc-demo-0001";
  kerf::ItemPlan plan;
  plan.axes[0] = kerf::TakenItem{"pos_x", 1, 0};
  plan.axes[1] = kerf::TakenItem{"pos_y", 25.4, 0};
  plan.axes[2] = kerf::TakenItem{"pos_z", 1, 1};
  plan.tool = kerf::TakenItem{"toolnum", 1, 0};
  plan.line = kerf::TakenItem{"line", 1, 0};
  plan.spindle = kerf::TakenItem{"spdl_speed", 1, 0};
  plan.execution = "execution";
  plan.tool_offsets = "tooloffset";
  plan.availability = "avail";
  kerf::DeviceState state(plan, kerf::LoadUnit::kPercentOfPower, 2'000'000);
  take(state, text, device);
  kerf::MultipartReader parts("a1b2");
  const std::size_t step = 1 + size % 61;
  for (std::size_t at = 0; at < size; at += step) {
    parts.add(text.substr(at, step));
    while (const auto part = parts.next()) take(state, *part, device);
  }
  static_cast<void>(kerf::MultipartReader::boundary_of(text));
  if (const auto time = kerf::parse_agent_time(text); time && time->resolution_ns < 1) std::abort();
  return 0;
}
