#include "twin/process/turning/turning_plan.h"

#include "twin/process/mounted_tools.h"
#include "twin/process/turning/turning_stage.h"

namespace kerf {
namespace {

class TurningPlan final : public ProcessPlan {
 public:
  std::unique_ptr<Process> make(ProcessSite& site) const override {
    return std::make_unique<TurningStage>(site);
  }
  std::unique_ptr<MotionTools> tools(const ToolSources& sources,
                                     ToolResolver::CutterCheck can_cut) const override {
    return std::make_unique<MountedToolList>(sources, can_cut);
  }
};

}  // namespace

ProcessPointer choose_turning(const ProcessWish& wish) {
  return wish.is_turned ? std::make_shared<TurningPlan>() : nullptr;
}

}  // namespace kerf
