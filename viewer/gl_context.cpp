#include "viewer/gl_context.h"

// epoxy's headers define what the Khronos headers beside them also define: never include both.
#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "base/translate.h"

namespace kerf {
namespace {

constexpr EGLint kMaxDevices = 16;
constexpr int kMinGlVersion = 33;

bool has_extension(const char* list, std::string_view name) {
  std::string_view rest = list ? list : "";
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == name) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

std::string egl_error() { return fmt::format("EGL error 0x{:04X}", eglGetError()); }

/// A context of `display`, current on this thread; on error nothing stays initialized.
Result<EGLContext> make_current_context(EGLDisplay display) {
  if (display == EGL_NO_DISPLAY) return Error{tr("not offered")};
  if (!eglInitialize(display, nullptr, nullptr)) return Error{tr("cannot start: ") + egl_error()};
  const auto fail = [display](const std::string& reason) {
    eglTerminate(display);
    return Error{reason};
  };
  const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
  if (!has_extension(extensions, "EGL_KHR_create_context") ||
      !has_extension(extensions, "EGL_KHR_surfaceless_context")) {
    return fail(tr("cannot draw without a window"));
  }
  if (!eglBindAPI(EGL_OPENGL_API)) return fail(tr("has no desktop OpenGL"));
  EGLConfig config = EGL_NO_CONFIG_KHR;
  if (!has_extension(extensions, "EGL_KHR_no_config_context")) {
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                             EGL_NONE};
    EGLint count = 0;
    if (!eglChooseConfig(display, wanted, &config, 1, &count) || count == 0) {
      return fail(tr("has no OpenGL configuration"));
    }
  }
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION_KHR,
                               3,
                               EGL_CONTEXT_MINOR_VERSION_KHR,
                               3,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR,
                               EGL_NONE};
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
  if (context == EGL_NO_CONTEXT) return fail(tr("no OpenGL 3.3 core context: ") + egl_error());
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    const std::string reason = tr("context cannot be used: ") + egl_error();
    eglDestroyContext(display, context);
    return fail(reason);
  }
  if (epoxy_gl_version() < kMinGlVersion) {
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
    return fail(trf("OpenGL {}.{} is too old, 3.3 is needed", epoxy_gl_version() / 10,
                    epoxy_gl_version() % 10));
  }
  return context;
}

/// epoxy aborts the process when libEGL is missing, so ask the loader first.
bool egl_library_exists() {
  void* library = dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL);
  if (!library) return false;
  dlclose(library);
  return true;
}

}  // namespace

Result<GlContext> GlContext::create_offscreen() {
  constexpr const char* kHint = tr_noop(
      " (Debian packages: libegl1 libegl-mesa0 libgl1-mesa-dri; no graphics card is needed)");
  if (!egl_library_exists()) {
    return Error{trf("no OpenGL for pictures: libEGL.so.1 is not installed{}", tr(kHint))};
  }
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (!has_extension(client, "EGL_EXT_platform_base")) {
    return Error{
        trf("no OpenGL for pictures: EGL has no driver that works without a window{}", tr(kHint))};
  }
  std::string reasons;
  const auto attempt = [&reasons](const std::string& name, EGLDisplay display) {
    Result<EGLContext> context = make_current_context(display);
    if (context) return *context;
    reasons += (reasons.empty() ? "" : "; ") + name + " " + context.error();
    return EGL_NO_CONTEXT;
  };
  if (has_extension(client, "EGL_MESA_platform_surfaceless")) {
    // The EXT entry: eglGetPlatformDisplay aborts in epoxy, which knows no EGL 1.5 before a display
    // exists.
    EGLDisplay display =
        eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (EGLContext context = attempt(tr("surfaceless platform"), display);
        context != EGL_NO_CONTEXT) {
      return GlContext(display, context);
    }
  }
  if (has_extension(client, "EGL_EXT_platform_device") &&
      has_extension(client, "EGL_EXT_device_enumeration")) {
    std::array<EGLDeviceEXT, kMaxDevices> devices{};
    EGLint count = 0;
    if (!eglQueryDevicesEXT(kMaxDevices, devices.data(), &count)) count = 0;
    for (EGLint i = 0; i < count; ++i) {
      EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT,
                                                    devices[static_cast<std::size_t>(i)], nullptr);
      if (EGLContext context = attempt(trf("device {}", i), display); context != EGL_NO_CONTEXT) {
        return GlContext(display, context);
      }
    }
  }
  if (reasons.empty()) reasons = tr("EGL has no driver that works without a window");
  return Error{trf("no OpenGL for pictures: {}{}", reasons, tr(kHint))};
}

GlContext::GlContext(GlContext&& other) noexcept
    : display_(std::exchange(other.display_, nullptr)),
      context_(std::exchange(other.context_, nullptr)) {}

GlContext& GlContext::operator=(GlContext&& other) noexcept {
  std::swap(display_, other.display_);
  std::swap(context_, other.context_);
  return *this;
}

GlContext::~GlContext() {
  if (!context_) return;
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
  eglTerminate(display_);
}

}  // namespace kerf
