#include "twin/compare/comparison.h"

#include "base/translate.h"

namespace kerf {

const char* to_string(CompareVerdict verdict) {
  switch (verdict) {
    case CompareVerdict::kInTolerance:
      return tr_noop("in tolerance");
    case CompareVerdict::kExcessLeft:
      return tr_noop("excess left");
    case CompareVerdict::kGouged:
      break;
  }
  return tr_noop("gouged");
}

}  // namespace kerf
