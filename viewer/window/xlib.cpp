#include "viewer/window/xlib.h"

#include <dlfcn.h>

#include <type_traits>

namespace kerf {
namespace {

const Xlib* load() {
  // Never closed: it has handlers of ours.
  void* const library = dlopen("libX11.so.6", RTLD_NOW | RTLD_GLOBAL);
  if (library == nullptr) return nullptr;
  static Xlib xlib{};
  bool has_all = true;
  const auto find = [&](auto& function, const char* name) {
    void* const found = dlsym(library, name);
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(found);
    has_all = has_all && found != nullptr;
  };
  find(xlib.open_display, "XOpenDisplay");
  find(xlib.close_display, "XCloseDisplay");
  find(xlib.connection_number, "XConnectionNumber");
  find(xlib.pending, "XPending");
  find(xlib.next_event, "XNextEvent");
  find(xlib.sync, "XSync");
  find(xlib.flush, "XFlush");
  find(xlib.set_error_handler, "XSetErrorHandler");
  find(xlib.set_io_error_exit_handler, "XSetIOErrorExitHandler");
  find(xlib.default_root_window, "XDefaultRootWindow");
  find(xlib.get_window_attributes, "XGetWindowAttributes");
  find(xlib.change_window_attributes, "XChangeWindowAttributes");
  find(xlib.create_simple_window, "XCreateSimpleWindow");
  find(xlib.destroy_window, "XDestroyWindow");
  find(xlib.map_window, "XMapWindow");
  find(xlib.move_resize_window, "XMoveResizeWindow");
  find(xlib.reparent_window, "XReparentWindow");
  find(xlib.select_input, "XSelectInput");
  find(xlib.store_name, "XStoreName");
  return has_all ? &xlib : nullptr;
}

}  // namespace

const Xlib* Xlib::find() {
  static const Xlib* const found = load();
  return found;
}

}  // namespace kerf
