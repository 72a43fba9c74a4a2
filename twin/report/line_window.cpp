#include "twin/report/line_window.h"

namespace kerf {

LineWindow::Split LineWindow::split(std::span<const Motion> motions) {
  Split split;
  if (begun_ && range_.until == 0) {
    split.within = motions.size();
    return split;
  }
  for (const Motion& m : motions) {
    const std::uint32_t line = m.source.file == 0 ? m.source.line : 0;
    over_ = over_ || (range_.until > 0 && line > range_.until);
    if (over_) break;
    begun_ = begun_ || line >= range_.from;
    ++(begun_ ? split.within : split.before);
  }
  return split;
}

}  // namespace kerf
