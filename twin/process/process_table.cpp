#include "twin/process/process_table.h"

#include <array>

#include "twin/process/milling/milling_plan.h"
#include "twin/process/punch/punch_plan.h"
#include "twin/process/torch/torch_plan.h"
#include "twin/process/turning/turning_plan.h"

namespace kerf {
namespace {

constexpr std::array kProcesses{
    ProcessRow{"turning", choose_turning},
    ProcessRow{"punch", choose_punch},
    ProcessRow{"torch", choose_torch},
    ProcessRow{"milling", choose_milling},
};

}  // namespace

std::span<const ProcessRow> processes() { return kProcesses; }

ProcessPointer choose_process(const ProcessWish& wish) {
  for (const ProcessRow& row : kProcesses) {
    if (ProcessPointer plan = row.choose(wish)) return plan;
  }
  return default_process();
}

ProcessPointer default_process() { return kProcesses.back().choose({}); }

}  // namespace kerf
