#include "machine_io/hal/loaded_file.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string_view>
#include <utility>
#include <vector>

#include "machine_io/hal/hal_source.h"

namespace kerf {

std::string find_kerf_status() { return find_hal_program("kerf-status"); }

LoadedFile::LoadedFile(std::string executable, std::string nml_file)
    : executable_(std::move(executable)), nml_file_(std::move(nml_file)) {}

void LoadedFile::wait(std::chrono::milliseconds patience) {
  if (!child_ && Clock::now() >= retry_at_) {
    std::vector<std::string> arguments;
    if (!nml_file_.empty()) arguments = {"--nml", nml_file_};
    Result<HalChild> started = HalChild::start(executable_, arguments);
    if (started) child_ = std::move(*started);
    retry_at_ = Clock::now() + kRetry;
    lines_.forget();
  }
  std::array<pollfd, 2> waits{{{child_ ? child_->records_fd() : -1, POLLIN, 0},
                               {child_ ? child_->messages_fd() : -1, POLLIN, 0}}};
  if (poll(waits.data(), waits.size(), static_cast<int>(patience.count())) <= 0) return;
  if (waits[1].revents != 0) {
    std::array<char, 512> said{};  // why it ends, which kerf-hal says as well
    [[maybe_unused]] const ssize_t got = read(child_->messages_fd(), said.data(), said.size());
  }
  if (waits[0].revents != 0) take_lines();
}

void LoadedFile::take_lines() {
  std::array<char, 4096> bytes{};
  const ssize_t got = read(child_->records_fd(), bytes.data(), bytes.size());
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (got <= 0) {
    child_.reset();
    lines_.forget();
    return;
  }
  lines_.take({bytes.data(), static_cast<std::size_t>(got)});
}

}  // namespace kerf
