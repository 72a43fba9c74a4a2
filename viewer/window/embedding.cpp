#include "viewer/window/embedding.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <dlfcn.h>

#include <algorithm>
#include <utility>

#include "base/translate.h"
#include "viewer/window/xlib.h"

namespace kerf {
namespace {

/// What GLFW listens to, but for keys: an event that nobody wants goes on to the window around.
constexpr long kWithoutKeys =
    StructureNotifyMask | PointerMotionMask | ButtonPressMask | ButtonReleaseMask | ExposureMask |
    FocusChangeMask | VisibilityChangeMask | EnterWindowMask | LeaveWindowMask | PropertyChangeMask;

}  // namespace

struct Embedding::Impl {
  const Xlib* x = nullptr;
  Display* display = nullptr;
  ::Window window = 0;
  ::Window around = 0;
  int width_px = 0, height_px = 0;
  bool is_covered = false;
};

Result<Embedding> Embedding::into(std::uint32_t around, GLFWwindow* window) {
  auto impl = std::make_unique<Impl>();
  impl->x = Xlib::find();
  const auto get_display =
      reinterpret_cast<Display* (*)()>(dlsym(RTLD_DEFAULT, "glfwGetX11Display"));
  const auto get_window =
      reinterpret_cast<::Window (*)(GLFWwindow*)>(dlsym(RTLD_DEFAULT, "glfwGetX11Window"));
  if (impl->x != nullptr && get_display != nullptr && get_window != nullptr) {
    impl->display = get_display();
    impl->window = impl->display != nullptr ? get_window(window) : 0;
  }
  if (impl->window == 0) return Error{tr("no window: GLFW has no X11 here, which a tab needs")};
  const Xlib& x = *impl->x;
  XWindowAttributes found{};
  if (x.get_window_attributes(impl->display, around, &found) == 0) {
    return Error{trf("no window: there is no window {}", around)};
  }
  impl->around = around;
  XSetWindowAttributes wishes{};
  wishes.override_redirect = True;
  x.change_window_attributes(impl->display, impl->window, CWOverrideRedirect, &wishes);
  x.select_input(impl->display, impl->window, kWithoutKeys);
  // Its events end the waiting for those of our own window.
  x.select_input(impl->display, around, StructureNotifyMask);
  x.reparent_window(impl->display, impl->window, around, 0, 0);
  Embedding embedding(std::move(impl));
  embedding.follow();
  x.map_window(embedding.impl_->display, embedding.impl_->window);
  x.sync(embedding.impl_->display, False);
  return embedding;
}

Embedding::Embedding(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Embedding::Embedding(Embedding&&) noexcept = default;
Embedding& Embedding::operator=(Embedding&&) noexcept = default;
Embedding::~Embedding() = default;

void Embedding::follow() {
  XWindowAttributes found{};
  if (impl_->x->get_window_attributes(impl_->display, impl_->around, &found) == 0) return;
  impl_->is_covered = found.map_state != IsViewable;
  if (found.width == impl_->width_px && found.height == impl_->height_px) return;
  impl_->width_px = found.width;
  impl_->height_px = found.height;
  impl_->x->move_resize_window(impl_->display, impl_->window, 0, 0,
                               static_cast<unsigned>(std::max(1, found.width)),
                               static_cast<unsigned>(std::max(1, found.height)));
  impl_->x->flush(impl_->display);
}

bool Embedding::is_covered() const { return impl_->is_covered; }

}  // namespace kerf
