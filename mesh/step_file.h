// mesh/step_file.h - meshes of STEP files, by the program kerf-step.
#pragma once

#include <string>

#include "base/result.h"

namespace kerf {

/// How far triangles may lie from the faces of the model.
inline constexpr double kStepDeviation_mm = 0.01;

/// The model's surface as a binary STL in mm, as kerf-step writes it (mesh/kerf_step/). kerf-step
/// is looked for where $KERF_STEP says, beside this program, and in the PATH. Error: it is not
/// installed, cannot read the file (its words), or writes more than `most_bytes`.
Result<std::string> step_as_stl(const std::string& path, std::size_t most_bytes);

}  // namespace kerf
