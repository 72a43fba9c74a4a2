#include "viewer/window/gpu_timer.h"

namespace kerf {

GpuTimer::GpuTimer() { glGenQueries(1, &query_); }
GpuTimer::~GpuTimer() { glDeleteQueries(1, &query_); }

void GpuTimer::begin() {
  if (sink_ms_) return;
  glBeginQuery(GL_TIME_ELAPSED, query_);
  is_running_ = true;
}

bool GpuTimer::end(double* sink_ms) {
  if (is_running_) {
    glEndQuery(GL_TIME_ELAPSED);
    is_running_ = false;
    sink_ms_ = sink_ms;
    repeats_ = 1;
    return true;
  }
  if (sink_ms_ == sink_ms) ++repeats_;
  return false;
}

std::optional<double> GpuTimer::collect() {
  if (!sink_ms_) return std::nullopt;
  GLint is_there = GL_FALSE;
  glGetQueryObjectiv(query_, GL_QUERY_RESULT_AVAILABLE, &is_there);
  if (is_there != GL_TRUE) return std::nullopt;
  GLuint64 elapsed_ns = 0;
  glGetQueryObjectui64v(query_, GL_QUERY_RESULT, &elapsed_ns);
  const double elapsed_ms = static_cast<double>(elapsed_ns) * 1e-6;
  *sink_ms_ += elapsed_ms * repeats_;
  sink_ms_ = nullptr;
  return elapsed_ms;
}

}  // namespace kerf
