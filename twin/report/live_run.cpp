#include "twin/report/live_run.h"

#include "base/translate.h"

namespace kerf {

const char* to_string(RunEnd end) {
  switch (end) {
    case RunEnd::kRuns:
      return tr_noop("runs");
    case RunEnd::kFinished:
      return tr_noop("finished");
    case RunEnd::kAborted:
      return tr_noop("aborted");
    case RunEnd::kUnseen:
      return tr_noop("unseen");
  }
  return "";
}

}  // namespace kerf
