// twin/report/engagement_report.h - how tools were engaged, as JSON and as text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "twin/process/engagement.h"

namespace kerf {

/// tools and passes: tool, cut_mm, plunge_mm, full_slot_mm, climb_mm, ramp_mm, ramp_most_deg,
/// contact_most_mm, effective_diameter_mm, cut_s, removed_mm3, and mean and most of ae_mm,
/// angle_deg, ap_mm, rate_mm3_per_s; of tools shape, diameter_mm, the number of passes, feed_mm,
/// feed_s, air_mm and air_s, of passes file, line, last_line and time_s. passes_total: in all,
/// Engagement::kMostPasses of them are listed. unmeasured_mm, unmeasured_mm3.
nlohmann::ordered_json engagement_json(const Engagement& engagement,
                                       const std::vector<std::string>& files);

/// Lines for the page of text.
std::string engagement_text(const Engagement& engagement);

}  // namespace kerf
