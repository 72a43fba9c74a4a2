#include "twin/page/page_spots.h"

#include <fmt/format.h>

namespace kerf {

std::string PageSpots::link(const SourceRef& source, const std::optional<Vec3>& place_mm) {
  if (source.line == 0) return {};
  spots_.push_back({source, place_mm});
  return fmt::format("<button type=\"button\" class=\"spot\" data-spot=\"{}\">{}</button>",
                     spots_.size() - 1, source.line);
}

}  // namespace kerf
