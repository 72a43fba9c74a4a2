// viewer/csg/query_pool.h - asks the graphics card whether anything was drawn. For the sources of
// viewer/ only.
#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <vector>

namespace kerf {

/// Occlusion queries, made as they are needed.
class QueryPool {
 public:
  QueryPool() = default;
  QueryPool(const QueryPool&) = delete;
  QueryPool& operator=(const QueryPool&) = delete;
  ~QueryPool() { glDeleteQueries(static_cast<GLsizei>(names_.size()), names_.data()); }

  void begin(std::size_t index) {
    while (names_.size() <= index) glGenQueries(1, &names_.emplace_back(0));
    glBeginQuery(GL_ANY_SAMPLES_PASSED, names_[index]);
  }
  static void end() { glEndQuery(GL_ANY_SAMPLES_PASSED); }
  /// Until the card has come so far.
  void wait(std::size_t index) const { static_cast<void>(has_passed(index)); }
  /// Waits for the card.
  bool has_passed(std::size_t index) const {
    GLuint any = GL_FALSE;
    glGetQueryObjectuiv(names_[index], GL_QUERY_RESULT, &any);
    return any != GL_FALSE;
  }

 private:
  std::vector<GLuint> names_;
};

}  // namespace kerf
