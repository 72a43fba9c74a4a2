#include "machine_io/simulator/load_profile.h"

#include <algorithm>
#include <cmath>

#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

constexpr double kMostTime_s = 1e6, kMostLoad = 327;
constexpr double kRipple = 0.01, kStep = 0.01;
constexpr unsigned kRippleUpdates = 7;

}  // namespace

Result<LoadProfile> LoadProfile::parse(std::string_view text) {
  LoadProfile out;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string_view place = text.substr(at, end - at);
    const std::size_t colon = place.find(':');
    double time_s = 0, load = 0;
    const bool is_read = colon != place.npos && read_number(place.substr(0, colon), time_s) &&
                         read_number(place.substr(colon + 1), load);
    const double least_s = out.places_.empty() ? 0 : out.places_.back().first;
    if (!is_read || !(time_s >= least_s && time_s <= kMostTime_s) ||
        !(std::abs(load) <= kMostLoad)) {
      return Error{
          trf("'{}' is not SECONDS:LOAD with seconds from {:g} on and a load from {:g} to "
              "{:g}",
              place, least_s, -kMostLoad, kMostLoad)};
    }
    out.places_.emplace_back(time_s, load);
    at = end + 1;
  }
  return out;
}

double LoadProfile::at(double time_s, unsigned count) const {
  if (places_.empty()) return 0;
  const auto next = std::find_if(places_.begin(), places_.end(),
                                 [&](const auto& place) { return place.first > time_s; });
  double load = next == places_.end() ? places_.back().second : next->second;
  if (next != places_.begin() && next != places_.end()) {
    const auto& before = *(next - 1);
    const double part = (time_s - before.first) / (next->first - before.first);
    load = before.second + part * (next->second - before.second);
  }
  const double ripple = static_cast<double>(count % kRippleUpdates) / kRippleUpdates - 0.5;
  return load + 2 * ripple * (kRipple * std::abs(load) + kStep);
}

}  // namespace kerf
