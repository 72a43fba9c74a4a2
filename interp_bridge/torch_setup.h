// interp_bridge/torch_setup.h - what a dry run of a torch program knows of its machine: QtPlasmaC's
// materials and the values of its HAL pins.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "interp_bridge/filter_modes.h"
#include "interp_bridge/torch_materials.h"

namespace kerf {

/// What the text of a program says to QtPlasmaC.
struct TorchText {
  struct Change {
    std::uint32_t line = 0;
    FilterModes modes;  ///< all of them, from this line on
  };
  /// It asks for a pin of plasmac or qtplasmac, or has a magic comment; or two of these three: a
  /// line `#<holes>=..` or another of the filter's, an M3 with a `$` or S1, an M190 P.
  bool is_qtplasmac = false;
  bool is_filtered = false;     ///< by QtPlasmaC already: its modes are carried out in the text
  std::uint32_t hal_line = 0;   ///< the first with a `#<_hal[..]>`; 0: none
  std::vector<Change> changes;  ///< by line; at most 100 000

  /// In force at a line.
  FilterModes modes_at(std::uint32_t line) const;
};

/// Looks through NC code that comes in pieces of whole lines. Any bytes are accepted; costs little
/// where there is no '#', '(' or 'M'.
class TorchTextScanner {
 public:
  void add(std::string_view text);
  TorchText take();

 private:
  void look_for_torch(std::string_view text);
  void set_mode(std::string_view line, std::uint32_t number);

  TorchText found_;
  FilterModes modes_;
  std::uint32_t lines_ = 0;      ///< in earlier pieces
  bool conversational_ = false;  ///< made by QtPlasmaC, which senses no holes in it
  bool has_modes_ = false;
  bool starts_torch_ = false;
  bool changes_material_ = false;
};

/// What a run is given.
struct TorchRun {
  bool qtplasmac = false;  ///< its filter counts
  bool inch_machine = false;
  bool materials_known = false;              ///< from a file
  std::vector<TorchMaterial> materials;      ///< [0] is the default
  std::map<std::string, double> hal_values;  ///< by name, in the machine's units
  TorchText text;
};

/// The materials of a *_material.cfg as QtPlasmaC writes and reads it: `[MATERIAL_NUMBER_n]` and
/// lines `KEY = value`; lengths in the machine's unit. Behind the number 0 default `rows[0]`; a row
/// of number 0 replaces it. Keys that are missing are 0, with a warning where QtPlasmaC insists on
/// them (PIERCE_HEIGHT, PIERCE_DELAY, CUT_HEIGHT, CUT_SPEED), and one where the heights are those
/// of the other unit. Any bytes are accepted.
void parse_material_file(std::string_view text, const std::string& path, double unit_mm,
                         std::vector<TorchMaterial>& rows, Diagnostics& diagnostics);

/// A QtPlasmaC MACHINE.prefs: the default material into `material`, what [PLASMA_PARAMETERS] puts
/// on pins of plasmac into `hal_values`. All other keys are passed over.
void parse_plasma_prefs(std::string_view text, const std::string& path, double unit_mm,
                        TorchMaterial& material, std::map<std::string, double>& hal_values,
                        Diagnostics& diagnostics);

/// Where a run looks.
struct TorchSources {
  std::string materials_path;  ///< empty: MACHINE_material.cfg beside the INI, if it is there
  std::string ini_path;        ///< empty: no prefs, and no materials but those of materials_path
  std::map<std::string, double> hal_values;  ///< the user's, which count before all others
  bool inch_machine = false;
};

/// Reads them. What no file says is as QtPlasmaC has it before anyone has entered anything (4000
/// mm/min, kerf 1 mm, cut at 1 mm, pierced at 3 mm without delay). An INI whose screen or filter is
/// QtPlasmaC's sets run.qtplasmac. False: a file cannot be read, which has been reported.
bool read_torch_sources(const TorchSources& sources, TorchRun& run, Diagnostics& diagnostics);

/// The same as text for kerf-interp.
std::string torch_run_text(const TorchRun& run);

}  // namespace kerf
