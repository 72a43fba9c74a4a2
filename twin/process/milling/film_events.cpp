#include "twin/process/milling/film_events.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "base/translate.h"

namespace kerf {
namespace {

std::string text_of(const CutFilm& film, const StockModel& stock) {
  return trf(
      "leaves a wall, roof or floor about {:.2g} mm thick: thinner than the cells of {:.3g} mm of "
      "the {}, which loses it ({:.3g} mm2)",
      film.thickness_mm, stock.cell_mm(), stock.name(), film.area_mm2);
}

/// No film as thick has room between the nodes of such cells; two digits, rounded down.
double holding_cell_mm(double thickness_mm) {
  const double digit = std::pow(10.0, std::floor(std::log10(thickness_mm)) - 1);
  return std::floor(thickness_mm / digit) * digit;
}

}  // namespace

FilmEvents::Event* FilmEvents::find(const CutFilm& film, const FilmMove& move) {
  for (Event& event : events_) {
    if (event.move.tool != move.tool) continue;
    if (event.move.source == move.source) return &event;
    Box near = event.box;
    near.min -= kNear_mm;
    near.max += kNear_mm;
    const Vec3& p = film.at_mm;
    bool inside = true;
    for (int a = 0; a < 3; ++a) inside &= p[a] >= near.min[a] && p[a] <= near.max[a];
    if (inside) return &event;
  }
  return nullptr;
}

void FilmEvents::take(const CutFilm& film, const FilmMove& move) {
  if (Event* event = find(film, move)) {
    event->box.extend(film.at_mm);
    event->film.area_mm2 += film.area_mm2;
    log_.reword(event->handle, text_of(event->film, stock_));
    return;
  }
  Finding finding;
  finding.id = FindingId::kThinFilm;
  finding.severity = Severity::kWarning;
  finding.source = move.source;
  finding.time_s = move.time_s;
  finding.position_mm = film.at_mm;
  finding.tool = move.tool;
  finding.text = text_of(film, stock_);
  finding.hint = trf("--cell {:g} would keep it", holding_cell_mm(film.thickness_mm));
  Box box;
  box.extend(film.at_mm);
  // Beyond what the log keeps, all that is left of an event is its count.
  const FindingLog::Handle handle = log_.add(std::move(finding));
  if (events_.size() < FindingLog::kMaxKept) events_.push_back({move, box, film, handle});
}

}  // namespace kerf
