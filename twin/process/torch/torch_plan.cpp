#include "twin/process/torch/torch_plan.h"

#include <utility>

#include "base/translate.h"
#include "twin/machine/torch_moves.h"
#include "twin/motion/motion_nearest.h"
#include "twin/process/torch/kerf_resolver.h"
#include "twin/process/torch/torch_holds.h"
#include "twin/process/torch/torch_stage.h"

namespace kerf {
namespace {

class BurningMoves final : public OrderedMoves {
 public:
  explicit BurningMoves(TorchMoves moves) : moves_(std::move(moves)) {}

  void append(std::size_t i, const MotionAt& motion_at, double fraction, const Cutter& cutter,
              std::uint64_t id, std::vector<CutMove>& out) const override {
    Motion motion = motion_at(i);
    if (fraction < 1) motion = part_of(motion, 0, fraction);
    if (moves_.burns(motion)) moves_.append(motion, moves_.pierces(i, motion_at), cutter, id, out);
  }

 private:
  TorchMoves moves_;
};

/// The kerf of each motion that burns.
class KerfTools final : public MotionTools {
 public:
  KerfTools(const BeamSettings& beam, const ToolSources& sources, ToolResolver::CutterCheck can_cut)
      : moves_(beam.trigger, beam.pierce_mm),
        resolver_(sources, can_cut),
        kerfs_(resolver_, beam.kerf_mm, beam.is_qtplasmac) {}

  Tool of(const Motion& motion, std::span<const TorchMaterial> materials) override {
    return {moves_.burns(motion) ? &kerfs_.of(motion, materials) : nullptr};
  }
  bool by_shape() const override { return true; }

 private:
  TorchMoves moves_;
  ToolResolver resolver_;
  KerfResolver kerfs_;
};

class TorchPlan final : public ProcessPlan {
 public:
  TorchPlan(BeamSettings beam, std::string warning)
      : beam_(std::move(beam)), warning_(std::move(warning)) {}

  std::unique_ptr<Process> make(ProcessSite& site) const override {
    return std::make_unique<TorchStage>(site, beam_);
  }
  std::unique_ptr<MotionTools> tools(const ToolSources& sources,
                                     ToolResolver::CutterCheck can_cut) const override {
    return std::make_unique<KerfTools>(beam_, sources, can_cut);
  }
  ProcessTraits traits() const override {
    ProcessTraits traits;
    traits.slides = traits.by_length = false;
    traits.is_beam = true;
    return traits;
  }
  /// Of a QtPlasmaC machine alone: others stand only where their program says so.
  MakeHolds holds() const override {
    if (!beam_.is_qtplasmac) return {};
    return [arc = beam_.trigger] { return std::make_unique<TorchHolds>(arc); };
  }
  std::shared_ptr<const OrderedMoves> moves() const override {
    return std::make_shared<BurningMoves>(TorchMoves(beam_.trigger, beam_.pierce_mm));
  }
  std::string warning() const override { return warning_; }
  const BeamSettings* beam() const override { return &beam_; }

 private:
  BeamSettings beam_;
  std::string warning_;
};

}  // namespace

ProcessPointer torch_process(BeamSettings settings) {
  return std::make_shared<TorchPlan>(std::move(settings), "");
}

ProcessPointer choose_torch(const ProcessWish& wish) {
  if (!wish.is_sheet || wish.turret) return nullptr;
  BeamSettings beam = beam_settings(wish.beam, wish.is_qtplasmac);
  beam.guessed = wish.guessed;
  std::string warning;
  if (!wish.has_program) {
    beam.trigger = BeamTrigger();
    if (wish.beam.trigger) {
      warning = tr(
          "--beam: without a program (--program) the beam is on while the source's spindle turns, "
          "whatever the trigger");
    }
  }
  return std::make_shared<TorchPlan>(std::move(beam), std::move(warning));
}

}  // namespace kerf
