// tests/twin/process/stages.h - what a process has done, by the process that it is.
#pragma once

#include "twin/process/cut_stage.h"
#include "twin/process/punch/punch_stage.h"
#include "twin/process/torch/torch_stage.h"
#include "twin/report/sheet_report.h"

namespace kerf::test {

inline const TorchStage& torch_of(const CutStage& stage) {
  return dynamic_cast<const TorchStage&>(stage.process());
}
inline const PunchStage& punch_of(const CutStage& stage) {
  return dynamic_cast<const PunchStage&>(stage.process());
}
inline const TorchTotals& cuts_of(const SheetReport& report) {
  return dynamic_cast<const TorchSums&>(*report.sums).totals;
}

}  // namespace kerf::test
