// stock/way_contact.h - where a whole motion, of one move or of thousands, first meets material.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>

#include "stock/stock_model.h"

namespace kerf {

struct WayContact {
  std::size_t move = 0;  ///< the first that meets material
  Contact contact;       ///< its depth: on all of them, of very many on some thousands
};

/// Who waits for a search.
struct WayWatch {
  std::stop_token stop;  ///< looked at every few moves
  /// May be empty. Gets how much of the search is done, rising within 0 .. 1; same thread.
  std::function<void(double)> on_share;

  void tell(double share) const {
    if (on_share) on_share(share);
  }
};

/// Of moves that are one motion of one tool, as if none had cut before the next: as
/// StockModel::first_contact(), whose depth is taken over all of them together where the model is a
/// WaySearcher. Nothing, too, once a stop is requested.
std::optional<WayContact> first_contact_of(const StockModel& stock, const Cutter& cutter,
                                           std::span<const CutMove> moves, double tolerance_mm,
                                           const WayWatch& watch);

/// A model that does this better than move by move.
class WaySearcher {
 public:
  virtual ~WaySearcher() = default;
  virtual std::optional<WayContact> first_contact_of(const Cutter& cutter,
                                                     std::span<const CutMove> moves,
                                                     double tolerance_mm,
                                                     const WayWatch& watch) const = 0;
};

}  // namespace kerf
