// twin/cli/view_load.h - from what `kerf view` was asked for to what is shown.
#pragma once

#include <memory>
#include <string>

#include "base/diagnostic.h"
#include "twin/cli/view_options.h"
#include "twin/findings/outcome.h"
#include "twin/playback/load_program.h"
#include "twin/scene/player_scene.h"

namespace kerf {

enum class ViewKind { kProgram, kState, kLog };

/// What the file is, by its first bytes; by its name where they do not tell.
ViewKind view_kind_of(const std::string& path);

/// Program, blank, tools; null on error.
std::unique_ptr<LoadedProgram> load_viewed(const ViewRequest& request, ViewKind kind,
                                           const LoadControl& control, Diagnostics& diagnostics,
                                           Outcome& outcome);

/// With the machine around it. What is wrong with that one is said; the program is shown without.
ViewedProgram viewed(const ViewRequest& request, const LoadedProgram& loaded);

/// The block that the interpreter refused, if there is one, and why the program is not whole.
void print_faults(const LoadedProgram& loaded);

/// What was taken for want of better, and the command that says so.
void print_guesses(const ViewRequest& request, const LoadedProgram& loaded);

Diagnostic fault_of(std::string message, std::string hint = {});
int view_exit_code(Outcome outcome, const Diagnostics& diagnostics);

}  // namespace kerf
