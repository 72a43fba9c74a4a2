// viewer/window/gl_failure.h - whether OpenGL still works.
#pragma once

#include <cstddef>
#include <string>

namespace kerf {

/// What the values of glGetGraphicsResetStatus and glGetError mean for who uses the program, with
/// the memory that was in use; empty if both are "no error".
std::string gl_failure(unsigned reset_status, unsigned error, std::size_t gpu_bytes);

/// The same for the current context as it is now. Contexts without robustness report a loss as
/// errors, if at all.
std::string present_gl_failure(std::size_t gpu_bytes);

}  // namespace kerf
