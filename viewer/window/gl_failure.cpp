#include "viewer/window/gl_failure.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/translate.h"

namespace kerf {
namespace {

constexpr unsigned kContextLost = 0x0507;  // GL_CONTEXT_LOST, of OpenGL 4.5

}  // namespace

std::string gl_failure(unsigned reset_status, unsigned error, std::size_t gpu_bytes) {
  const char* const kAgain = tr("what is shown is lost; close the window and open it again");
  switch (reset_status) {
    case GL_NO_ERROR:
      break;
    case GL_GUILTY_CONTEXT_RESET_ARB:
      return trf("the graphics driver was reset after it got stuck on this picture: {}", kAgain);
    case GL_INNOCENT_CONTEXT_RESET_ARB:
      return trf("the graphics driver was reset because of another program: {}", kAgain);
    default:
      return trf("the graphics driver was reset: {}", kAgain);
  }
  if (error == GL_NO_ERROR) return {};
  if (error == kContextLost) return trf("the OpenGL context is lost: {}", kAgain);
  if (error == GL_OUT_OF_MEMORY) {
    return trf(
        "the graphics memory is full with {} MB: use a coarser grid (--cell) or a smaller window",
        gpu_bytes >> 20);
  }
  return trf("OpenGL reports error 0x{:04x}: {}", error, kAgain);
}

std::string present_gl_failure(std::size_t gpu_bytes) {
  // The function has one name in OpenGL 4.5 and another where it is an extension.
  unsigned status = GL_NO_ERROR;
  if (epoxy_gl_version() >= 45) {
    status = glGetGraphicsResetStatus();
  } else if (epoxy_has_gl_extension("GL_ARB_robustness")) {
    status = glGetGraphicsResetStatusARB();
  }
  return gl_failure(status, glGetError(), gpu_bytes);
}

}  // namespace kerf
