// stock/way_contact.h - where a whole motion, of one move or of thousands, first meets material.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <stop_token>

#include "stock/stock_model.h"

namespace kerf {

struct WayContact {
  std::size_t move = 0;  ///< the first that meets material
  Contact contact;       ///< its depth: on all of them, of very many on some thousands
};

/// Of moves that are one motion of one tool, as if none had cut before the next: as
/// StockModel::first_contact(), whose depth is taken over all of them together where the model is a
/// WaySearcher. Nothing, too, once `stop` is requested, which is looked at every few moves.
std::optional<WayContact> first_contact_of(const StockModel& stock, const Cutter& cutter,
                                           std::span<const CutMove> moves, double tolerance_mm,
                                           const std::stop_token& stop);

/// A model that does this better than move by move.
class WaySearcher {
 public:
  virtual ~WaySearcher() = default;
  virtual std::optional<WayContact> first_contact_of(const Cutter& cutter,
                                                     std::span<const CutMove> moves,
                                                     double tolerance_mm,
                                                     const std::stop_token& stop) const = 0;
};

}  // namespace kerf
