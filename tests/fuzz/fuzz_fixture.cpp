// --fixture, --chuck and --tailstock text from arbitrary bytes; what can be understood is built,
// and held against a tool.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "twin/collision/sweep.h"
#include "twin/job/fixtures.h"
#include "twin/job/work_holding.h"

namespace {

/// --chuck and --tailstock of the same bytes, about a bar.
void hold(const std::string& text) {
  kerf::WorkHolding holding;
  if (const auto chuck = kerf::parse_chuck(text)) holding.chuck = *chuck;
  if (const auto tailstock = kerf::parse_tailstock(text)) holding.tailstock = *tailstock;
  const auto bodies = kerf::holding_bodies(holding, kerf::bar_profile(-60, 0, 40));
  if (!bodies) return;
  for (const kerf::HoldingBody& body : *bodies)
    if (!(body.ring.remaining_mm3() > 0)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  hold(std::string(data, data + size));
  const auto spec = kerf::parse_fixture(std::string(data, data + size));
  if (!spec) {
    if (spec.error().empty()) std::abort();
    return 0;
  }
  if (!spec->mesh_path.empty()) return 0;
  kerf::Diagnostics diagnostics;
  const kerf::FixtureList list = kerf::load_fixtures(std::span(&*spec, 1), diagnostics);
  if (!list) std::abort();
  const std::vector<std::vector<kerf::RoundedDisc>> hulls{{{3, 0, 0}, {3, 40, 0}}};
  const auto tool = kerf::Solid::of_hulls(hulls);
  kerf::CutMove move;
  move.from_mm = {-100, 3, 20};
  move.to_mm = {100, 7, -30};
  kerf::Vec3 guess{0};
  const auto least =
      kerf::least_gap(tool->pieces()[0], kerf::ToolWay(move), *(*list)[0].solid, 1e9, 1e9, guess);
  if (!least || !(least->mm >= 0) || !std::isfinite(least->mm)) std::abort();
  return 0;
}
