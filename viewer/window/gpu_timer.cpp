#include "viewer/window/gpu_timer.h"

namespace kerf {

GpuTimer::GpuTimer() { glGenQueries(1, &query_); }
GpuTimer::~GpuTimer() { glDeleteQueries(1, &query_); }

void GpuTimer::begin() {
  if (sink_ms_) return;
  glBeginQuery(GL_TIME_ELAPSED, query_);
  is_running_ = true;
}

void GpuTimer::end(double* sink_ms) {
  if (is_running_) {
    glEndQuery(GL_TIME_ELAPSED);
    is_running_ = false;
    sink_ms_ = sink_ms;
    repeats_ = 1;
  } else if (sink_ms_ == sink_ms) {
    ++repeats_;
  }
}

void GpuTimer::collect() {
  if (!sink_ms_) return;
  GLint is_there = GL_FALSE;
  glGetQueryObjectiv(query_, GL_QUERY_RESULT_AVAILABLE, &is_there);
  if (is_there != GL_TRUE) return;
  GLuint64 elapsed_ns = 0;
  glGetQueryObjectui64v(query_, GL_QUERY_RESULT, &elapsed_ns);
  *sink_ms_ += static_cast<double>(elapsed_ns) * 1e-6 * repeats_;
  sink_ms_ = nullptr;
}

}  // namespace kerf
