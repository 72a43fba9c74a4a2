#include "twin/process/milling/milling_plan.h"

#include "twin/process/milling/milling_stage.h"
#include "twin/process/mounted_tools.h"

namespace kerf {
namespace {

class MillingPlan final : public ProcessPlan {
 public:
  std::unique_ptr<Process> make(ProcessSite& site) const override {
    return std::make_unique<MillingStage>(site);
  }
  std::unique_ptr<MotionTools> tools(const ToolSources& sources,
                                     ToolResolver::CutterCheck can_cut) const override {
    return std::make_unique<MountedToolList>(sources, can_cut);
  }
};

}  // namespace

ProcessPointer choose_milling(const ProcessWish& /*wish*/) {
  return std::make_shared<MillingPlan>();
}

}  // namespace kerf
