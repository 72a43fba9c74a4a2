// viewer/gl_objects.h - owners of OpenGL objects. For the sources of viewer/ only: includes the GL
// header.
#pragma once

#include <epoxy/gl.h>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <utility>

#include "base/result.h"

namespace kerf {

enum class GlKind { kTexture, kRenderbuffer, kFramebuffer, kBuffer, kVertexArray };

/// One GL name, made by the constructor and deleted by the destructor. A context must be current
/// for both.
template <GlKind kKind>
class GlObject {
 public:
  GlObject();
  GlObject(GlObject&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlObject();
  GLuint name() const { return name_; }

 private:
  GLuint name_ = 0;
};

using GlTexture = GlObject<GlKind::kTexture>;
using GlRenderbuffer = GlObject<GlKind::kRenderbuffer>;
using GlFramebuffer = GlObject<GlKind::kFramebuffer>;
using GlBuffer = GlObject<GlKind::kBuffer>;
using GlVertexArray = GlObject<GlKind::kVertexArray>;

/// A linked shader program. set() acts on this program, which must be in use.
class GlProgram {
 public:
  /// Error: the log of the GL compiler.
  static Result<GlProgram> create(const char* vertex_source, const char* fragment_source);
  /// In the place of one that could not be created: nothing is drawn right until that is told.
  static GlProgram stand_in();
  GlProgram(GlProgram&& other) noexcept
      : name_(std::exchange(other.name_, 0)), is_stand_in_(other.is_stand_in_) {}
  GlProgram& operator=(GlProgram&& other) noexcept {
    std::swap(name_, other.name_);
    std::swap(is_stand_in_, other.is_stand_in_);
    return *this;
  }
  ~GlProgram();

  void use() const { glUseProgram(name_); }
  void set(const char* uniform, int value) const;  ///< Also the unit of a sampler.
  void set(const char* uniform, float value) const;
  void set(const char* uniform, const glm::ivec2& value) const;
  void set(const char* uniform, const glm::vec2& value) const;
  void set(const char* uniform, const glm::vec3& value) const;
  void set(const char* uniform, const glm::vec4& value) const;
  void set(const char* uniform, const glm::mat4& value) const;

 private:
  explicit GlProgram(GLuint name) : name_(name) {}
  GLint location(const char* uniform) const;
  GLuint name_ = 0;
  bool is_stand_in_ = false;
};

/// All programs have been created for now: the compiler gives back its own memory until the next
/// one is, 6 MB of Mesa's.
void release_gl_compiler();

/// Allocates a 2D texture for drawing into: no mipmaps, clamped at the border. `filter`: GL_NEAREST
/// or GL_LINEAR.
void allocate_texture(const GlTexture& texture, GLint internal_format, GLenum format, GLenum type,
                      glm::ivec2 size_px, GLint filter);

/// Binds `texture` to texture unit `unit`.
void bind_texture(int unit, const GlTexture& texture);

}  // namespace kerf
