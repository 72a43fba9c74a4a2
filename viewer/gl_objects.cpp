#include "viewer/gl_objects.h"

#include <array>
#include <cassert>
#include <glm/gtc/type_ptr.hpp>
#include <string>

namespace kerf {

template <GlKind kKind>
GlObject<kKind>::GlObject() {
  if constexpr (kKind == GlKind::kTexture) glGenTextures(1, &name_);
  if constexpr (kKind == GlKind::kRenderbuffer) glGenRenderbuffers(1, &name_);
  if constexpr (kKind == GlKind::kFramebuffer) glGenFramebuffers(1, &name_);
  if constexpr (kKind == GlKind::kBuffer) glGenBuffers(1, &name_);
  if constexpr (kKind == GlKind::kVertexArray) glGenVertexArrays(1, &name_);
}

template <GlKind kKind>
GlObject<kKind>::~GlObject() {
  if (name_ == 0) return;
  if constexpr (kKind == GlKind::kTexture) glDeleteTextures(1, &name_);
  if constexpr (kKind == GlKind::kRenderbuffer) glDeleteRenderbuffers(1, &name_);
  if constexpr (kKind == GlKind::kFramebuffer) glDeleteFramebuffers(1, &name_);
  if constexpr (kKind == GlKind::kBuffer) glDeleteBuffers(1, &name_);
  if constexpr (kKind == GlKind::kVertexArray) glDeleteVertexArrays(1, &name_);
}

template class GlObject<GlKind::kTexture>;
template class GlObject<GlKind::kRenderbuffer>;
template class GlObject<GlKind::kFramebuffer>;
template class GlObject<GlKind::kBuffer>;
template class GlObject<GlKind::kVertexArray>;

namespace {

/// 0 and a filled `log` if the source does not compile.
GLuint compile(GLenum stage, const char* source, std::string* log) {
  const GLuint shader = glCreateShader(stage);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint ok = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok == GL_TRUE) return shader;
  std::array<char, 2048> text{};
  glGetShaderInfoLog(shader, static_cast<GLsizei>(text.size()), nullptr, text.data());
  glDeleteShader(shader);
  *log = text.data();
  return 0;
}

}  // namespace

Result<GlProgram> GlProgram::create(const char* vertex_source, const char* fragment_source) {
  std::string log;
  const GLuint vertex = compile(GL_VERTEX_SHADER, vertex_source, &log);
  if (vertex == 0) return Error{"OpenGL rejects a vertex shader: " + log};
  const GLuint fragment = compile(GL_FRAGMENT_SHADER, fragment_source, &log);
  if (fragment == 0) {
    glDeleteShader(vertex);
    return Error{"OpenGL rejects a fragment shader: " + log};
  }
  GlProgram program(glCreateProgram());
  glAttachShader(program.name_, vertex);
  glAttachShader(program.name_, fragment);
  glLinkProgram(program.name_);
  for (const GLuint shader : {vertex, fragment}) {
    glDetachShader(program.name_, shader);  // While attached it would keep its memory.
    glDeleteShader(shader);
  }
  GLint ok = GL_FALSE;
  glGetProgramiv(program.name_, GL_LINK_STATUS, &ok);
  if (ok != GL_TRUE) {
    std::array<char, 2048> text{};
    glGetProgramInfoLog(program.name_, static_cast<GLsizei>(text.size()), nullptr, text.data());
    return Error{std::string("OpenGL cannot link a shader program: ") + text.data()};
  }
  return program;
}

GlProgram GlProgram::stand_in() {
  GlProgram program(glCreateProgram());
  program.is_stand_in_ = true;
  return program;
}

GlProgram::~GlProgram() {
  if (name_ != 0) glDeleteProgram(name_);
}

GLint GlProgram::location(const char* uniform) const {
  const GLint found = glGetUniformLocation(name_, uniform);
  assert(found >= 0 || is_stand_in_);  // A misspelt or unused uniform is our mistake.
  return found;
}

void GlProgram::set(const char* uniform, int value) const { glUniform1i(location(uniform), value); }
void GlProgram::set(const char* uniform, float value) const {
  glUniform1f(location(uniform), value);
}
void GlProgram::set(const char* uniform, const glm::ivec2& value) const {
  glUniform2iv(location(uniform), 1, glm::value_ptr(value));
}
void GlProgram::set(const char* uniform, const glm::vec2& value) const {
  glUniform2fv(location(uniform), 1, glm::value_ptr(value));
}
void GlProgram::set(const char* uniform, const glm::vec3& value) const {
  glUniform3fv(location(uniform), 1, glm::value_ptr(value));
}
void GlProgram::set(const char* uniform, const glm::vec4& value) const {
  glUniform4fv(location(uniform), 1, glm::value_ptr(value));
}
void GlProgram::set(const char* uniform, const glm::mat4& value) const {
  glUniformMatrix4fv(location(uniform), 1, GL_FALSE, glm::value_ptr(value));
}

void release_gl_compiler() {
  const bool can = epoxy_gl_version() >= 41 || epoxy_has_gl_extension("GL_ARB_ES2_compatibility");
  if (can) glReleaseShaderCompiler();
}

void allocate_texture(const GlTexture& texture, GLint internal_format, GLenum format, GLenum type,
                      glm::ivec2 size_px, GLint filter) {
  glBindTexture(GL_TEXTURE_2D, texture.name());
  glTexImage2D(GL_TEXTURE_2D, 0, internal_format, size_px.x, size_px.y, 0, format, type, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void bind_texture(int unit, const GlTexture& texture) {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, texture.name());
}

}  // namespace kerf
