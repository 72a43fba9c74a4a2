#include "viewer/window/screen_tab.h"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "base/translate.h"
#include "viewer/window/xlib.h"

namespace kerf {
namespace {

/// Before anybody has taken the window.
constexpr unsigned kFirstWidth_px = 640, kFirstHeight_px = 480;

/// A request failed: one for a window that is gone, which is looked at afterwards.
bool has_failed = false;

/// The display broke. Set instead of the end of the program, which is Xlib's way.
bool is_lost = false;

}  // namespace

std::optional<std::uint32_t> window_id_from(const std::string& text) {
  const bool is_hex = text.starts_with("0x") || text.starts_with("0X");
  const std::string_view digits = std::string_view(text).substr(is_hex ? 2 : 0);
  std::uint32_t id = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stopped, error] = std::from_chars(digits.data(), end, id, is_hex ? 16 : 10);
  // X11's ids have 29 bits.
  constexpr std::uint32_t kMost = 0x1FFFFFFF;
  if (error != std::errc() || stopped != end || id == 0 || id > kMost) return std::nullopt;
  return id;
}

struct ScreenTab::Impl {
  const Xlib* x = nullptr;
  Display* display = nullptr;
  ::Window window = 0;
  ::Window parent = 0;  ///< 0: whoever takes it gives it its size
  bool is_ours = true;

  bool fit() {
    if (parent == 0) return true;
    XWindowAttributes around{};
    has_failed = false;
    if (x->get_window_attributes(display, parent, &around) == 0 || has_failed) return false;
    x->move_resize_window(display, window, 0, 0, static_cast<unsigned>(std::max(1, around.width)),
                          static_cast<unsigned>(std::max(1, around.height)));
    x->flush(display);
    return true;
  }
  bool follow() {
    // Each answer of the display may bring more news along.
    while (!is_lost && x->pending(display) > 0) {
      XEvent event;
      x->next_event(display, &event);
      if (is_lost) break;
      // A socket of GTK that dies without a farewell leaves the tab's window to the screen's
      // background.
      if (event.type == DestroyNotify &&
          (event.xdestroywindow.window == window || event.xdestroywindow.window == parent))
        return false;
      if (event.type == ConfigureNotify && event.xconfigure.window == parent && !fit())
        return false;
    }
    return !is_lost;
  }
};

Result<ScreenTab> ScreenTab::open(std::optional<std::uint32_t> parent) {
  const char* const name = std::getenv("DISPLAY");
  if (name == nullptr || *name == '\0') {
    return Error{tr("there is no X11 display (DISPLAY is not set): no tab")};
  }
  auto impl = std::make_unique<Impl>();
  impl->x = Xlib::find();
  if (impl->x == nullptr) return Error{tr("there is no X11 here (libX11.so.6): no tab")};
  const Xlib& x = *impl->x;
  impl->display = x.open_display(nullptr);
  if (impl->display == nullptr) {
    return Error{trf("the display DISPLAY={} cannot be opened: no tab", name)};
  }
  x.set_error_handler([](Display*, XErrorEvent*) {
    has_failed = true;
    return 0;
  });
  x.set_io_error_exit_handler(
      impl->display, [](Display*, void*) { is_lost = true; }, nullptr);
  ::Window around = x.default_root_window(impl->display);
  unsigned width = kFirstWidth_px, height = kFirstHeight_px;
  if (parent) {
    XWindowAttributes found{};
    has_failed = false;
    if (x.get_window_attributes(impl->display, *parent, &found) == 0 || has_failed) {
      return Error{trf("there is no window {} on the display {}", *parent, name)};
    }
    around = impl->parent = *parent;
    width = static_cast<unsigned>(std::max(1, found.width));
    height = static_cast<unsigned>(std::max(1, found.height));
    x.select_input(impl->display, *parent, StructureNotifyMask);
  }
  impl->window = x.create_simple_window(impl->display, around, 0, 0, width, height, 0, 0, 0);
  // No window manager, and no socket of GTK, has a say in when it is shown and how large it is.
  XSetWindowAttributes wishes{};
  wishes.override_redirect = True;
  x.change_window_attributes(impl->display, impl->window, CWOverrideRedirect, &wishes);
  x.select_input(impl->display, impl->window, StructureNotifyMask);
  x.store_name(impl->display, impl->window, "kerf");
  if (parent) x.map_window(impl->display, impl->window);
  has_failed = false;
  x.sync(impl->display, False);
  if (has_failed) return Error{trf("there is no window {} on the display {}", *parent, name)};
  return ScreenTab(std::move(impl));
}

ScreenTab::ScreenTab(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ScreenTab::ScreenTab(ScreenTab&&) noexcept = default;
ScreenTab& ScreenTab::operator=(ScreenTab&&) noexcept = default;

ScreenTab::~ScreenTab() {
  if (!impl_ || !impl_->is_ours) return;
  if (is_lost) return;
  impl_->x->destroy_window(impl_->display, impl_->window);
  impl_->x->close_display(impl_->display);
}

std::uint32_t ScreenTab::id() const { return static_cast<std::uint32_t>(impl_->window); }

int ScreenTab::connection_fd() const { return impl_->x->connection_number(impl_->display); }

bool ScreenTab::follow() { return impl_->follow(); }

void ScreenTab::forget() {
  impl_->is_ours = false;
  close(connection_fd());
}

}  // namespace kerf
