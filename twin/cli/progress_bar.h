// twin/cli/progress_bar.h - one line on a terminal's stderr that shows how far a run is.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace kerf {

/// "[#######.............]  35 %  12 s": done 0..1; without a known total (done < 0) only the
/// seconds.
std::string progress_line(double done, double elapsed_s);

/// Draws ten times a second from a thread of its own, first after half a second, and wipes its line
/// at the end. Does nothing if stderr is no terminal.
class ProgressBar {
 public:
  ProgressBar(std::function<double()> progress, bool wanted);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

 private:
  void draw_until_stopped(const std::function<double()>& progress);
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stopped_ = false;
  std::thread thread_;
};

}  // namespace kerf
