// twin/app/view_options.h - what `kerf view` was asked for, from the command line and the
// configuration.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "twin/app/option_reader.h"
#include "twin/app/run_options.h"
#include "twin/compare/design_part.h"
#include "twin/machine_model/machine_choice.h"
#include "twin/playback/player.h"
#include "twin/view/frame_writer.h"

namespace kerf {

/// The arguments as written. Empty = not given.
struct ViewArguments {
  std::string config;
  std::vector<std::string> sets;
  RunArguments run;  ///< run.source.program is PROGRAM, LOG or STATE
  std::string speed;
  std::string at_line;
  std::string keyframes;
  std::string png;
  std::string frames;
  std::string fps;
  std::string size;
  std::string view;
  std::string draw;
  std::string compare;
  std::string tolerance;
  bool no_local = false;
  std::vector<std::string> command;  ///< all of it as written, kerf itself first
};

/// The arguments, understood.
struct ViewRequest {
  RunRequest run;
  std::optional<double> speed;  ///< play at once; infinity: as fast as it can be cut
  std::uint32_t at_line = 0;    ///< shown first; 0: the beginning (of a picture: the end)
  PlayerOptions player;
  std::string png;
  FilmOptions film;                          ///< no folder: none is wanted
  FrameOptions frame;                        ///< for files
  std::optional<DrawRoad> window_road;       ///< none: as the window remembers it
  std::string compare;                       ///< file of the design part
  std::shared_ptr<const DesignPart> design;  ///< read by the command, not here
  double tolerance_mm = 0.05;
  bool local = true;      ///< the window redraws only where something changed
  bool at_end = false;    ///< shown first, as after a dry run
  ViewArguments written;  ///< what all this was understood from
  /// Nothing is drawn into files.
  bool wants_window() const { return png.empty() && film.folder.empty(); }
};

/// Reads every option, so that all faults are told at once; with an error among the diagnostics the
/// request is not to be used. The command line goes before the configuration. Opens no file but the
/// configuration.
ViewRequest understand_view(const ViewArguments& arguments, Diagnostics& diagnostics);

}  // namespace kerf
