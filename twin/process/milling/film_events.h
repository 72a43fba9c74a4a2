// twin/process/milling/film_events.h - the finding thin-film: what a move has left is too thin for
// the model.
#pragma once

#include <vector>

#include "base/geometry.h"
#include "interp_bridge/motion.h"
#include "stock/stock_model.h"
#include "twin/findings/finding.h"

namespace kerf {

/// Which move left a film.
struct FilmMove {
  SourceRef source;
  double time_s = 0;  ///< of the motion's start
  int tool = 0;
};

/// One finding for each place: films that the same tool leaves by the same line of the program, or
/// within kNear_mm of what it has left before, are one event, whose area adds up.
class FilmEvents {
 public:
  static constexpr double kNear_mm = 10;

  FilmEvents(const StockModel& stock, FindingLog& log) : stock_(stock), log_(log) {}
  /// `film` has an area.
  void take(const CutFilm& film, const FilmMove& move);
  void forget() { events_.clear(); }

 private:
  struct Event {
    FilmMove move;  ///< the first
    Box box;        ///< places so far
    CutFilm film;   ///< the first, with all the area
    FindingLog::Handle handle;
  };
  Event* find(const CutFilm& film, const FilmMove& move);

  const StockModel& stock_;
  FindingLog& log_;
  std::vector<Event> events_;
};

}  // namespace kerf
