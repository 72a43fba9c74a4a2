// viewer/window/xlib.h - the few functions of Xlib that put a window into another program's, looked
// up by name: kerf is not linked with X11. For the sources of viewer/window/ only, since X11's
// header has macros such as None.
#pragma once

#include <X11/Xlib.h>

namespace kerf {

struct Xlib {
  decltype(&XOpenDisplay) open_display;
  decltype(&XCloseDisplay) close_display;
  decltype(&XConnectionNumber) connection_number;
  decltype(&XPending) pending;
  decltype(&XNextEvent) next_event;
  decltype(&XSync) sync;
  decltype(&XFlush) flush;
  decltype(&XSetErrorHandler) set_error_handler;
  decltype(&XSetIOErrorExitHandler) set_io_error_exit_handler;
  decltype(&XDefaultRootWindow) default_root_window;
  decltype(&XGetWindowAttributes) get_window_attributes;
  decltype(&XChangeWindowAttributes) change_window_attributes;
  decltype(&XCreateSimpleWindow) create_simple_window;
  decltype(&XDestroyWindow) destroy_window;
  decltype(&XMapWindow) map_window;
  decltype(&XMoveResizeWindow) move_resize_window;
  decltype(&XReparentWindow) reparent_window;
  decltype(&XSelectInput) select_input;
  decltype(&XStoreName) store_name;

  /// Null: there is no libX11 here, or one that lacks something.
  static const Xlib* find();
};

}  // namespace kerf
