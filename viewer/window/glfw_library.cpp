#include "viewer/window/glfw_library.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>

#include "base/translate.h"

namespace kerf {
namespace {

constexpr const char* kLibrary = "libglfw.so.3";
constexpr int kNeededMajor = 3, kNeededMinor = 3;

/// Null until open_glfw(). Never closed: GLFW has handlers in Xlib.
void* library = nullptr;

/// A function that is not there is a mistake of ours: open_glfw() has looked at the version.
template <class Function>
Function* function_of(const char* name) {
  void* const found = library != nullptr ? dlsym(library, name) : nullptr;
  if (found == nullptr) std::abort();
  return reinterpret_cast<Function*>(found);
}

}  // namespace

Done open_glfw() {
  if (library != nullptr) return std::monostate{};
  // Global, for those who look up functions of GLFW and of Xlib by name (platform.cpp).
  void* const opened = dlopen(kLibrary, RTLD_NOW | RTLD_GLOBAL);
  if (opened == nullptr) return Error{dlerror()};
  int major = 0, minor = 0, revision = 0;
  const auto get_version =
      reinterpret_cast<decltype(&glfwGetVersion)>(dlsym(opened, "glfwGetVersion"));
  if (get_version != nullptr) get_version(&major, &minor, &revision);
  if (major != kNeededMajor || minor < kNeededMinor) {
    return Error{trf("{} is GLFW {}.{}, and {}.{} is needed", kLibrary, major, minor, kNeededMajor,
                     kNeededMinor)};
  }
  library = opened;
  return std::monostate{};
}

}  // namespace kerf

// What kerf and Dear ImGui call of GLFW: each leads to the library's own. The compiler holds the
// types to those of GLFW's header, and the linker tells of one that is missing.
#define KERF_FORWARD(name, arguments)                                       \
  static auto* const function = kerf::function_of<decltype(::name)>(#name); \
  return function arguments;

extern "C" {
#define KERF_GLFW_0(result, name) \
  result name() { KERF_FORWARD(name, ()) }
#define KERF_GLFW_1(result, name, A) \
  result name(A a) { KERF_FORWARD(name, (a)) }
#define KERF_GLFW_2(result, name, A, B) \
  result name(A a, B b) { KERF_FORWARD(name, (a, b)) }
#define KERF_GLFW_3(result, name, A, B, C) \
  result name(A a, B b, C c) { KERF_FORWARD(name, (a, b, c)) }
#define KERF_GLFW_5(result, name, A, B, C, D, E) \
  result name(A a, B b, C c, D d, E e) { KERF_FORWARD(name, (a, b, c, d, e)) }

// The library, and windows.
KERF_GLFW_0(int, glfwInit)
KERF_GLFW_0(void, glfwTerminate)
KERF_GLFW_1(GLFWerrorfun, glfwSetErrorCallback, GLFWerrorfun)
KERF_GLFW_1(int, glfwGetError, const char**)
KERF_GLFW_1(int, glfwExtensionSupported, const char*)
KERF_GLFW_1(GLFWglproc, glfwGetProcAddress, const char*)
KERF_GLFW_0(double, glfwGetTime)
KERF_GLFW_0(void, glfwDefaultWindowHints)
KERF_GLFW_2(void, glfwWindowHint, int, int)
KERF_GLFW_5(GLFWwindow*, glfwCreateWindow, int, int, const char*, GLFWmonitor*, GLFWwindow*)
KERF_GLFW_1(void, glfwDestroyWindow, GLFWwindow*)
KERF_GLFW_1(int, glfwWindowShouldClose, GLFWwindow*)
KERF_GLFW_2(void, glfwSetWindowShouldClose, GLFWwindow*, int)
KERF_GLFW_2(void, glfwSetWindowTitle, GLFWwindow*, const char*)
KERF_GLFW_3(void, glfwGetWindowSize, GLFWwindow*, int*, int*)
KERF_GLFW_3(void, glfwSetWindowSize, GLFWwindow*, int, int)
KERF_GLFW_3(void, glfwGetFramebufferSize, GLFWwindow*, int*, int*)
KERF_GLFW_3(void, glfwGetWindowContentScale, GLFWwindow*, float*, float*)
KERF_GLFW_2(int, glfwGetWindowAttrib, GLFWwindow*, int)
KERF_GLFW_1(void*, glfwGetWindowUserPointer, GLFWwindow*)
KERF_GLFW_2(void, glfwSetWindowUserPointer, GLFWwindow*, void*)
KERF_GLFW_0(GLFWwindow*, glfwGetCurrentContext)
KERF_GLFW_1(void, glfwMakeContextCurrent, GLFWwindow*)
KERF_GLFW_1(void, glfwSwapBuffers, GLFWwindow*)
KERF_GLFW_1(void, glfwSwapInterval, int)

// Monitors.
KERF_GLFW_1(GLFWmonitor**, glfwGetMonitors, int*)
KERF_GLFW_5(void, glfwGetMonitorWorkarea, GLFWmonitor*, int*, int*, int*, int*)
KERF_GLFW_3(void, glfwGetMonitorContentScale, GLFWmonitor*, float*, float*)
KERF_GLFW_1(GLFWmonitorfun, glfwSetMonitorCallback, GLFWmonitorfun)

// Events.
KERF_GLFW_0(void, glfwPollEvents)
KERF_GLFW_1(void, glfwWaitEventsTimeout, double)
KERF_GLFW_0(void, glfwPostEmptyEvent)
KERF_GLFW_2(GLFWwindowrefreshfun, glfwSetWindowRefreshCallback, GLFWwindow*, GLFWwindowrefreshfun)
KERF_GLFW_2(GLFWwindowfocusfun, glfwSetWindowFocusCallback, GLFWwindow*, GLFWwindowfocusfun)
KERF_GLFW_2(GLFWwindowiconifyfun, glfwSetWindowIconifyCallback, GLFWwindow*, GLFWwindowiconifyfun)
KERF_GLFW_2(GLFWwindowcontentscalefun, glfwSetWindowContentScaleCallback, GLFWwindow*,
            GLFWwindowcontentscalefun)
KERF_GLFW_2(GLFWframebuffersizefun, glfwSetFramebufferSizeCallback, GLFWwindow*,
            GLFWframebuffersizefun)
KERF_GLFW_2(GLFWkeyfun, glfwSetKeyCallback, GLFWwindow*, GLFWkeyfun)
KERF_GLFW_2(GLFWcharfun, glfwSetCharCallback, GLFWwindow*, GLFWcharfun)
KERF_GLFW_2(GLFWmousebuttonfun, glfwSetMouseButtonCallback, GLFWwindow*, GLFWmousebuttonfun)
KERF_GLFW_2(GLFWcursorposfun, glfwSetCursorPosCallback, GLFWwindow*, GLFWcursorposfun)
KERF_GLFW_2(GLFWcursorenterfun, glfwSetCursorEnterCallback, GLFWwindow*, GLFWcursorenterfun)
KERF_GLFW_2(GLFWscrollfun, glfwSetScrollCallback, GLFWwindow*, GLFWscrollfun)
KERF_GLFW_2(GLFWdropfun, glfwSetDropCallback, GLFWwindow*, GLFWdropfun)

// Keys, mouse, clipboard, joysticks.
KERF_GLFW_2(const char*, glfwGetKeyName, int, int)
KERF_GLFW_2(int, glfwGetKey, GLFWwindow*, int)
KERF_GLFW_2(int, glfwGetInputMode, GLFWwindow*, int)
KERF_GLFW_3(void, glfwSetInputMode, GLFWwindow*, int, int)
KERF_GLFW_2(int, glfwGetMouseButton, GLFWwindow*, int)
KERF_GLFW_3(void, glfwGetCursorPos, GLFWwindow*, double*, double*)
KERF_GLFW_3(void, glfwSetCursorPos, GLFWwindow*, double, double)
KERF_GLFW_1(GLFWcursor*, glfwCreateStandardCursor, int)
KERF_GLFW_1(void, glfwDestroyCursor, GLFWcursor*)
KERF_GLFW_2(void, glfwSetCursor, GLFWwindow*, GLFWcursor*)
KERF_GLFW_1(const char*, glfwGetClipboardString, GLFWwindow*)
KERF_GLFW_2(void, glfwSetClipboardString, GLFWwindow*, const char*)
KERF_GLFW_2(const float*, glfwGetJoystickAxes, int, int*)
KERF_GLFW_2(const unsigned char*, glfwGetJoystickButtons, int, int*)
KERF_GLFW_2(int, glfwGetGamepadState, int, GLFWgamepadstate*)
}
