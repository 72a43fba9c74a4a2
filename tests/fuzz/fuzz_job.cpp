// Arbitrary bytes as a part in several setups.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "twin/config/job_file.h"

namespace {

void check(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  kerf::Diagnostics diagnostics;
  const auto job = kerf::parse_job(text, "/nowhere/job.yaml", diagnostics);
  check(job.has_value() != kerf::has_error(diagnostics));
  for (const kerf::Diagnostic& one : diagnostics) {
    check(!kerf::to_string(one).empty() && !one.message.empty());
    check(one.line >= 0 && one.column >= (one.line > 0 ? 1 : 0));
  }
  if (!job) return 0;
  check(!job->setups.empty() && job->setups.front().turn.is_none());
  const kerf::Box solid{{0, 0, -20}, {80, 60, 0}};
  for (const kerf::JobSetup& setup : job->setups) {
    // A rigid motion: what is long stays so.
    const kerf::Placement lies = setup.turn.placement(solid);
    const kerf::Vec3 way = lies.placed(solid.max) - lies.placed(solid.min), own = solid.size();
    const double was = own.x * own.x + own.y * own.y + own.z * own.z;
    const double is = way.x * way.x + way.y * way.y + way.z * way.z;
    check(std::abs(is - was) < 1e-6 * was);
    check(setup.time_s >= 0);
  }
  return 0;
}
