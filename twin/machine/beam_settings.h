// twin/machine/beam_settings.h - what a dry run is told of a torch, laser or jet.
#pragma once

#include <optional>
#include <vector>

#include "interp_bridge/beam_trigger.h"
#include "interp_bridge/torch_materials.h"

namespace kerf {

/// As the user gave it; for sheets alone.
struct BeamOptions {
  std::optional<BeamTrigger> trigger;  ///< absent: plasmac for programs of QtPlasmaC, else m3
  double kerf_mm = 0;               ///< of every tool that --tool does not describe; 0: not given
  double pierce_mm = 0;             ///< diameter of pierced holes; 0: the kerf
  double slats_mm = 0;              ///< from one slat of the table to the next; 0: not known
  double density_kg_per_m3 = 7850;  ///< steel
};

/// The same for one program.
struct BeamSettings {
  BeamTrigger trigger;
  double kerf_mm = 0;
  double pierce_mm = 0;
  double slats_mm = 0;
  /// A machine of QtPlasmaC: it lifts the torch between cuts by itself, and the kerf is that of the
  /// material.
  bool is_qtplasmac = false;
  /// The sheet is a guess, and trigger and kerf may be: no errors come of it.
  bool guessed = false;
  std::vector<TorchMaterial> materials;  ///< as far as they are known; TorchState::material
};

inline BeamSettings beam_settings(const BeamOptions& options, bool is_qtplasmac) {
  BeamSettings settings;
  if (options.trigger) {
    settings.trigger = *options.trigger;
  } else if (is_qtplasmac) {
    settings.trigger = BeamTrigger::parse("plasmac").value();
  }
  settings.kerf_mm = options.kerf_mm;
  settings.pierce_mm = options.pierce_mm;
  settings.slats_mm = options.slats_mm;
  settings.is_qtplasmac = is_qtplasmac;
  return settings;
}

}  // namespace kerf
