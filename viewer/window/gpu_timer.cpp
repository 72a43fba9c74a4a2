#include "viewer/window/gpu_timer.h"

namespace kerf {

GpuTimer::GpuTimer(bool is_software) : is_software_(is_software) { glGenQueries(1, &query_); }
GpuTimer::~GpuTimer() { glDeleteQueries(1, &query_); }

void GpuTimer::begin() {
  if (sink_ms_) return;
  if (is_software_) {
    start_ = std::chrono::steady_clock::now();
  } else {
    glBeginQuery(GL_TIME_ELAPSED, query_);
  }
  is_running_ = true;
}

bool GpuTimer::end(double* sink_ms) {
  if (is_running_) {
    if (is_software_) {
      glFinish();
      const auto elapsed = std::chrono::steady_clock::now() - start_;
      elapsed_ms_ = std::chrono::duration<double, std::milli>(elapsed).count();
    } else {
      glEndQuery(GL_TIME_ELAPSED);
    }
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
  if (!is_software_) {
    GLint is_there = GL_FALSE;
    glGetQueryObjectiv(query_, GL_QUERY_RESULT_AVAILABLE, &is_there);
    if (is_there != GL_TRUE) return std::nullopt;
    GLuint64 elapsed_ns = 0;
    glGetQueryObjectui64v(query_, GL_QUERY_RESULT, &elapsed_ns);
    elapsed_ms_ = static_cast<double>(elapsed_ns) * 1e-6;
  }
  *sink_ms_ += elapsed_ms_ * repeats_;
  sink_ms_ = nullptr;
  return elapsed_ms_;
}

}  // namespace kerf
