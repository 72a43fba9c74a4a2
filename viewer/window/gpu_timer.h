// viewer/window/gpu_timer.h - how long the graphics card takes. For the sources of viewer/ only.
#pragma once

#include <epoxy/gl.h>

#include <chrono>
#include <optional>

namespace kerf {

/// Times what the card does without waiting for it: the answer comes some frames later. A software
/// renderer is waited for: what Mesa's llvmpipe answers is the time of that part of the frame that
/// it had not begun before it was asked, anything from a fiftieth to all.
class GpuTimer {
 public:
  explicit GpuTimer(bool is_software);
  GpuTimer(const GpuTimer&) = delete;
  GpuTimer& operator=(const GpuTimer&) = delete;
  ~GpuTimer();

  void begin();
  /// `sink_ms` gets the time added when it is known; frames of its kind that pass meanwhile count
  /// like this one. True if this one is timed.
  bool end(double* sink_ms);
  /// Takes a time that is known by now: that of the one frame that was timed last, once.
  std::optional<double> collect();

 private:
  bool is_software_;
  std::chrono::steady_clock::time_point start_{};
  double elapsed_ms_ = 0.0;
  GLuint query_ = 0;
  bool is_running_ = false;
  int repeats_ = 0;
  double* sink_ms_ = nullptr;
};

}  // namespace kerf
