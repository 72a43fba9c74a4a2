// viewer/window/glfw_library.h - GLFW, opened when a window is wanted. For the sources of
// viewer/window/ only.
#pragma once

#include "base/result.h"

namespace kerf {

/// Opens GLFW's library: from then on its functions may be called, under their own names. kerf is
/// not linked with it, since it brings a graphics stack of 200 MB along, of which a computer that
/// only dry-runs programs makes no use. Error: "libglfw.so.3: cannot open shared object file: No
/// such file or directory", or a version before 3.3. A second call costs nothing.
Done open_glfw();

}  // namespace kerf
