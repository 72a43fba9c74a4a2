// twin/cli/view_options.h - what `kerf view` was asked for, from the command line and the
// configuration.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "base/diagnostic.h"
#include "twin/cli/option_reader.h"
#include "twin/cli/run_options.h"
#include "twin/compare/design_part.h"
#include "twin/machines/machine_choice.h"
#include "twin/playback/player.h"
#include "twin/scene/frame_writer.h"

namespace kerf {

/// `kerf view`, understood.
struct ViewRequest {
  RunRequest run;
  std::optional<double> speed;  ///< play at once; infinity: as fast as it can be cut
  std::uint32_t at_line = 0;    ///< shown first; 0: the beginning (of a picture: the end)
  PlayerOptions player;
  std::string png;
  FilmOptions film;                     ///< no folder: none is wanted
  FrameOptions frame;                   ///< for files
  std::optional<DrawMode> window_mode;  ///< none: as the window remembers it, as the next two
  std::optional<ColorBy> color_by;
  std::optional<ColorTarget> color_on;
  CompareRequest compare;                    ///< the design part
  std::shared_ptr<const DesignPart> design;  ///< read by the command, not here
  bool local = true;                         ///< the window redraws only where something changed
  bool at_end = false;                       ///< shown first, as after a dry run
  Arguments written;                         ///< what all this was understood from
  /// Nothing is drawn into files.
  bool wants_window() const { return png.empty() && film.folder.empty(); }
};

/// Reads every option, so that all faults are told at once; with an error among the diagnostics the
/// request is not to be used. The command line goes before the configuration. Opens no file but the
/// configuration.
ViewRequest understand_view(const Arguments& arguments, Diagnostics& diagnostics);

}  // namespace kerf
