#include "twin/cli/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "base/translate.h"
#include "twin/cli/console.h"

namespace kerf {
namespace {

constexpr int kBarWidth = 30;
constexpr auto kFirstDraw = std::chrono::milliseconds(500);  // short runs show nothing
constexpr auto kRedraw = std::chrono::milliseconds(100);

}  // namespace

std::string progress_line(double done, double elapsed_s) {
  if (done < 0) return trf("running  {:.0f} s", elapsed_s);
  const double share = std::clamp(done, 0.0, 1.0);
  const int full = static_cast<int>(share * kBarWidth);
  return fmt::format("[{}{}] {:3.0f} %  {:.0f} s", std::string(static_cast<std::size_t>(full), '#'),
                     std::string(static_cast<std::size_t>(kBarWidth - full), '.'), share * 100,
                     elapsed_s);
}

ProgressBar::ProgressBar(std::function<double()> progress, bool wanted) {
  if (!wanted || isatty(STDERR_FILENO) == 0) return;
  thread_ = std::thread([this, progress = std::move(progress)] { draw_until_stopped(progress); });
}

ProgressBar::~ProgressBar() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void ProgressBar::draw_until_stopped(const std::function<double()>& progress) {
  const auto start = std::chrono::steady_clock::now();
  std::unique_lock lock(mutex_);
  bool drawn = false;
  auto wait = kFirstDraw;
  while (!wake_.wait_for(lock, wait, [&] { return stopped_; })) {
    wait = kRedraw;
    const double elapsed =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    kerf::print(stderr, "\r\033[K{}", progress_line(progress(), elapsed));
    flush_console();
    drawn = true;
  }
  if (drawn) {
    kerf::print(stderr, "\r\033[K");
    flush_console();
  }
}

}  // namespace kerf
