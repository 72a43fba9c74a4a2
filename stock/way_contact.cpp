#include "stock/way_contact.h"

#include <algorithm>

namespace kerf {

std::optional<WayContact> first_contact_of(const StockModel& stock, const Cutter& cutter,
                                           std::span<const CutMove> moves, double tolerance_mm,
                                           const WayWatch& watch) {
  if (const auto* searcher = dynamic_cast<const WaySearcher*>(&stock.bare()))
    return searcher->first_contact_of(cutter, moves, tolerance_mm, watch);
  std::optional<WayContact> first;
  for (std::size_t i = 0; i < moves.size(); ++i) {
    if (watch.stop.stop_requested()) return std::nullopt;
    watch.tell(static_cast<double>(i) / static_cast<double>(moves.size()));
    const std::optional<Contact> contact = stock.first_contact(cutter, moves[i], tolerance_mm);
    if (!contact) continue;
    if (!first) first = WayContact{i, *contact};
    first->contact.depth_mm = std::max(first->contact.depth_mm, contact->depth_mm);
  }
  return first;
}

}  // namespace kerf
