#include "twin/process/punch/punch_plan.h"

#include <map>
#include <string_view>
#include <utility>

#include "base/translate.h"
#include "twin/machine/punch_moves.h"
#include "twin/process/punch/punch_holds.h"
#include "twin/process/punch/punch_stage.h"

namespace kerf {
namespace {

class StrokeMoves final : public OrderedMoves {
 public:
  explicit StrokeMoves(TurretPointer turret) : moves_(std::move(turret)) {}

  void append(std::size_t i, const MotionAt& motion_at, double fraction, const Cutter& /*cutter*/,
              std::uint64_t id, std::vector<CutMove>& out) const override {
    moves_.append(i, motion_at, fraction, id, out);
  }

 private:
  PunchMoves moves_;
};

/// The station of each motion, whether it strikes or not.
class StationTools final : public MotionTools {
 public:
  explicit StationTools(TurretPointer turret) : turret_(std::move(turret)) {}

  Tool of(const Motion& motion, std::span<const TorchMaterial> /*materials*/) override {
    if (motion.tool == 0) return {};
    const TurretStation* const station = turret_->station(motion.tool);
    const auto [entry, fresh] = tools_.try_emplace(motion.tool);
    ResolvedTool& tool = entry->second;
    if (fresh) {
      tool.number = motion.tool;
      tool.origin = tr("turret");
      if (station != nullptr) {
        tool.cutter = station->punch;
      } else {
        tool.trouble = tr("the station is empty");
      }
    }
    return {&tool, station ? std::string_view(station->name) : std::string_view()};
  }

 private:
  TurretPointer turret_;
  std::map<int, ResolvedTool> tools_;
};

class PunchPlan final : public ProcessPlan {
 public:
  explicit PunchPlan(TurretPointer turret) : turret_(std::move(turret)) {}

  std::unique_ptr<Process> make(ProcessSite& site) const override {
    return std::make_unique<PunchStage>(site, turret_);
  }
  std::unique_ptr<MotionTools> tools(const ToolSources& /*sources*/,
                                     ToolResolver::CutterCheck /*can_cut*/) const override {
    return std::make_unique<StationTools>(turret_);
  }
  ProcessTraits traits() const override {
    ProcessTraits traits;
    traits.turns = traits.slides = traits.by_length = traits.follows_path = false;
    return traits;
  }
  MakeHolds holds() const override {
    return [turret = turret_] { return std::make_unique<PunchHolds>(turret); };
  }
  std::shared_ptr<const OrderedMoves> moves() const override {
    return std::make_shared<StrokeMoves>(turret_);
  }
  TurretPointer turret() const override { return turret_; }

 private:
  TurretPointer turret_;
};

}  // namespace

ProcessPointer punch_process(TurretPointer turret) {
  return std::make_shared<PunchPlan>(std::move(turret));
}

ProcessPointer choose_punch(const ProcessWish& wish) {
  return wish.is_sheet && wish.turret ? punch_process(wish.turret) : nullptr;
}

}  // namespace kerf
