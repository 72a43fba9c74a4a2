#include "viewer/window/platform.h"

#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <mutex>
#include <string>

#include "base/translate.h"
#include "viewer/window/glfw_library.h"
#include "viewer/window/scene_renderer.h"

/// As Xlib calls it.
struct _XDisplay;

namespace kerf {
namespace {

constexpr const char* kWithout = tr_noop("pictures need no display: --png FILE");
/// A Raspberry Pi 4, for one, has 3.1.
constexpr const char* kSoftware =
    tr_noop("LIBGL_ALWAYS_SOFTWARE=1 before the command lets the processor draw");
constexpr int kNeededGlVersion = 33;

std::mutex wake_mutex;
bool can_wake = false;  // guarded by wake_mutex

/// The last thing GLFW complained of.
std::string& complaint() {
  static std::string text;
  return text;
}

std::string display_name() {
  for (const char* variable : {"DISPLAY", "WAYLAND_DISPLAY"}) {
    const char* value = std::getenv(variable);
    if (value != nullptr && *value != '\0') return fmt::format("{}={}", variable, value);
  }
  return "";
}

/// Set when Xlib finds that the server is gone. It ends the program then unless it is told not to.
std::atomic<bool> display_is_lost = false;

/// Keeps Xlib from ending the program. Looked up by name, as GLFW has loaded Xlib already: no other
/// part of the window knows which window system it has. Without XSetIOErrorExitHandler (libX11
/// before 1.7) it stays as it was.
void survive_lost_display() {
  using ErrorHandler = int (*)(_XDisplay*);
  using ExitHandler = void (*)(_XDisplay*, void*);
  const auto set_handler =
      reinterpret_cast<ErrorHandler (*)(ErrorHandler)>(dlsym(RTLD_DEFAULT, "XSetIOErrorHandler"));
  const auto set_exit = reinterpret_cast<void (*)(_XDisplay*, ExitHandler, void*)>(
      dlsym(RTLD_DEFAULT, "XSetIOErrorExitHandler"));
  const auto get_display =
      reinterpret_cast<_XDisplay* (*)()>(dlsym(RTLD_DEFAULT, "glfwGetX11Display"));
  if (set_handler == nullptr || set_exit == nullptr || get_display == nullptr) return;
  _XDisplay* display = get_display();
  if (display == nullptr) return;
  set_handler([](_XDisplay*) {
    display_is_lost = true;
    return 0;
  });
  set_exit(
      display, [](_XDisplay*, void*) { display_is_lost = true; }, nullptr);
}

/// What Xlib tells of a request that failed, as Xlib lays it out.
struct XError {
  int type;
  _XDisplay* display;
  unsigned long resource;
  unsigned long serial;
  unsigned char code, request, minor;
};
constexpr unsigned char kBadWindow = 3, kBadDrawable = 9;

std::atomic<unsigned long> window_id = 0;  // 0: none, or not X11
std::atomic<bool> window_is_gone = false;

/// Xlib ends the program at the first request that fails, such as drawing into a window that
/// another program has destroyed. To be called when the window is there: GLFW sets Xlib's own way
/// of failing again while it makes one.
void survive_destroyed_window(GLFWwindow* window) {
  using ErrorHandler = int (*)(_XDisplay*, const XError*);
  const auto set_handler =
      reinterpret_cast<ErrorHandler (*)(ErrorHandler)>(dlsym(RTLD_DEFAULT, "XSetErrorHandler"));
  const auto get_id =
      reinterpret_cast<unsigned long (*)(GLFWwindow*)>(dlsym(RTLD_DEFAULT, "glfwGetX11Window"));
  if (set_handler == nullptr || get_id == nullptr) return;
  window_id = get_id(window);
  if (window_id == 0) return;
  set_handler([](_XDisplay*, const XError* error) {
    const bool is_ours = error->code == kBadWindow || error->code == kBadDrawable;
    if (is_ours && error->resource == window_id) window_is_gone = true;
    return 0;
  });
}

/// GLFW 3.4 takes Wayland where there is both; 3.3 knows X11 alone, and no such hint.
void ask_for_x11() {
  constexpr int kPlatform = 0x00050003, kPlatformX11 = 0x00060004;  // of GLFW 3.4's header
  int major = 0, minor = 0, revision = 0;
  const auto get_version =
      reinterpret_cast<void (*)(int*, int*, int*)>(dlsym(RTLD_DEFAULT, "glfwGetVersion"));
  const auto set_hint = reinterpret_cast<void (*)(int, int)>(dlsym(RTLD_DEFAULT, "glfwInitHint"));
  if (get_version == nullptr || set_hint == nullptr) return;
  get_version(&major, &minor, &revision);
  if (minor >= 4) set_hint(kPlatform, kPlatformX11);
}

/// Version and renderer of the OpenGL that a window gets without asking for one.
std::string found_gl() {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  GLFWwindow* window = glfwCreateWindow(16, 16, "", nullptr, nullptr);
  if (window == nullptr) return tr("no OpenGL at all");
  glfwMakeContextCurrent(window);
  const auto string_of = [](GLenum name) {
    const GLubyte* value = glGetString(name);
    return value != nullptr ? std::string(reinterpret_cast<const char*>(value)) : "?";
  };
  std::string found = fmt::format("OpenGL {} ({})", string_of(GL_VERSION), string_of(GL_RENDERER));
  glfwDestroyWindow(window);
  return found;
}

/// A window may be larger than every screen: it was remembered from a larger one, or its size was
/// doubled for a fine one. Then it takes what there is.
void fit_on_screens(GLFWwindow* window) {
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  int most_width = 0, most_height = 0;
  for (int i = 0; i < count; ++i) {
    int x = 0, y = 0, width = 0, height = 0;
    glfwGetMonitorWorkarea(monitors[i], &x, &y, &width, &height);
    most_width = std::max(most_width, width);
    most_height = std::max(most_height, height);
  }
  if (most_width <= 0 || most_height <= 0) return;
  int width = 0, height = 0;
  glfwGetWindowSize(window, &width, &height);
  if (width <= most_width && height <= most_height) return;
  glfwSetWindowSize(window, std::min(width, most_width), std::min(height, most_height));
}

}  // namespace

/// GLX_MESA_copy_sub_buffer: copies a rectangle of the back buffer, of which nothing else is
/// touched or asked. Looked up by name like the rest of Xlib.
struct Platform::Parts {
  using Copy = void (*)(_XDisplay*, unsigned long, int, int, int, int);
  Copy copy;
  _XDisplay* display;
  unsigned long drawable;
};

void Platform::find_parts(GLFWwindow* window) {
  if (SceneRenderer::detail_px() == 1.0) return;  // a graphics card
  if (glfwExtensionSupported("GLX_MESA_copy_sub_buffer") != GLFW_TRUE) return;
  const auto copy = reinterpret_cast<Parts::Copy>(glfwGetProcAddress("glXCopySubBufferMESA"));
  const auto get_display =
      reinterpret_cast<_XDisplay* (*)()>(dlsym(RTLD_DEFAULT, "glfwGetX11Display"));
  const auto get_drawable =
      reinterpret_cast<unsigned long (*)(GLFWwindow*)>(dlsym(RTLD_DEFAULT, "glfwGetGLXWindow"));
  if (copy == nullptr || get_display == nullptr || get_drawable == nullptr) return;
  const Parts parts{copy, get_display(), get_drawable(window)};
  if (parts.display == nullptr || parts.drawable == 0) return;
  parts_ = std::make_shared<const Parts>(parts);
}

void Platform::take_new_size(GLFWwindow* window) const {
  if (parts_) glfwSwapBuffers(window);
}

void Platform::show(GLFWwindow* window, const std::vector<ScreenRect>& rects) const {
  if (!parts_) {
    glfwSwapBuffers(window);
    return;
  }
  for (const ScreenRect& rect : rects) {
    parts_->copy(parts_->display, parts_->drawable, rect.min.x, rect.min.y, rect.max.x - rect.min.x,
                 rect.max.y - rect.min.y);
  }
}

Platform::~Platform() {
  if (!is_started_) return;
  {
    const std::lock_guard lock(wake_mutex);
    can_wake = false;
  }
  if (!display_is_lost) glfwTerminate();
}

Done Platform::start(bool needs_x11) {
  if (const Done opened = open_glfw(); !opened) {
    return Error{trf("no window: it needs GLFW, Debian's package libglfw3 ({}); {}", opened.error(),
                     tr(kWithout))};
  }
  complaint().clear();
  glfwSetErrorCallback([](int, const char* text) { complaint() = text; });
  if (needs_x11) ask_for_x11();
  if (glfwInit() != GLFW_TRUE) {
    const std::string display = display_name();
    if (display.empty()) {
      return Error{trf("no window: there is no display (DISPLAY is not set); {}", tr(kWithout))};
    }
    return Error{trf("no window: the display {} cannot be opened ({}); {}", display, complaint(),
                     tr(kWithout))};
  }
  is_started_ = true;
  window_is_gone = false;
  survive_lost_display();
  const std::lock_guard lock(wake_mutex);
  can_wake = true;
  return std::monostate{};
}

void Platform::survive_destroyed(GLFWwindow* window) { survive_destroyed_window(window); }

Result<GLFWwindow*> Platform::open_window(int width_px, int height_px, const char* title,
                                          bool is_inside) {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  // To hear of a reset, which would otherwise freeze the picture without a word.
  glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);  // the scene has framebuffers of its own
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, is_inside ? GLFW_FALSE : GLFW_TRUE);
  if (is_inside) {
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    glfwWindowHint(GLFW_DECORATED, GLFW_FALSE);
    glfwWindowHint(GLFW_FOCUSED, GLFW_FALSE);
    glfwWindowHint(GLFW_FOCUS_ON_SHOW, GLFW_FALSE);
  }
  GLFWwindow* window = glfwCreateWindow(width_px, height_px, title, nullptr, nullptr);
  if (window == nullptr) {
    const std::string reason = complaint();
    return Error{trf("no window: OpenGL 3.3 is needed; the display {} has {} ({}); {}; {}",
                     display_name(), found_gl(), reason, tr(kSoftware), tr(kWithout))};
  }
  glfwMakeContextCurrent(window);
  if (epoxy_gl_version() < kNeededGlVersion) {
    const int found = epoxy_gl_version();
    glfwDestroyWindow(window);
    return Error{trf("no window: OpenGL 3.3 is needed; the display {} has {}.{}; {}; {}",
                     display_name(), found / 10, found % 10, tr(kSoftware), tr(kWithout))};
  }
  if (!is_inside) fit_on_screens(window);
  glfwSwapInterval(0);  // the window counts its frames itself, and must not wait for a hidden one
  find_parts(window);
  survive_destroyed_window(window);
  return window;
}

bool Platform::is_lost() { return display_is_lost; }

bool Platform::is_gone(GLFWwindow* window) {
  if (window_id == 0 || display_is_lost || window_is_gone) return window_is_gone;
  int width = 0, height = 0;
  glfwGetWindowSize(window, &width, &height);
  return window_is_gone;
}

Done Platform::check() const {
  if (display_is_lost) {
    return Error{trf("the window is gone: the connection to the display {} broke", display_name())};
  }
  if (glfwGetCurrentContext() == nullptr) {
    return Error{trf("the window is gone: its OpenGL context is lost ({})", complaint())};
  }
  return std::monostate{};
}

void Platform::wake() {
  const std::lock_guard lock(wake_mutex);
  if (can_wake) glfwPostEmptyEvent();
}

}  // namespace kerf
