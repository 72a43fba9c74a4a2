#include "twin/report/live_load.h"

#include "base/translate.h"
#include "twin/job/load_text.h"

namespace kerf {

std::string text_of(const LoadNow& load) {
  const std::string measured = load_text(load.measured);
  if (!load.low || !load.high) return fmt::format("{} {}", measured, sign_of(load.unit));
  return trf("{} {} ({} to {})", measured, sign_of(load.unit), load_text(*load.low),
             load_text(*load.high));
}

}  // namespace kerf
