#include "twin/cli/window_host.h"

#include <fmt/format.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>

#include "twin/cli/console.h"

namespace kerf {
namespace {

/// The window looks at least so often whether the work is done; it is woken for all else.
constexpr double kPatience_s = 0.5;

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value && *value;
}

}  // namespace

bool has_display() { return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY"); }

Result<int> work_beside_window(const WindowOptions& options, SceneMailbox& mailbox,
                               CommandQueue& commands, std::stop_source& stop,
                               const std::function<int()>& work,
                               const std::function<void(const std::string&)>& on_loss) {
  std::optional<Result<Window>> created = Window::create(options, &mailbox, &commands);
  Result<Window>& window = *created;
  if (!window) return Error{window.error()};
  for (const Diagnostic& fault : window->settings_faults()) {
    kerf::print(stderr, "{}", to_string(fault));
  }
  int code = 0;
  std::atomic<bool> done{false};
  std::thread worker([&] {
    code = work();
    done = true;
    Window::wake();
  });
  std::optional<std::string> trouble;
  for (bool open = true; open;) {
    if (done) window->close();
    const Result<bool> frame = window->frame(kPatience_s);
    if (!frame) trouble = frame.error();
    open = frame && *frame;
  }
  // The work hears of it by the CloseCommand already, if it listens.
  if (trouble) {
    if (on_loss) on_loss(*trouble);
    commands.push(CloseCommand{});
  }
  // It remembers its settings now: the work may be cut short.
  created.reset();
  if (!on_loss) stop.request_stop();
  worker.join();
  if (trouble && !on_loss) return Error{*trouble};
  return code;
}

}  // namespace kerf
