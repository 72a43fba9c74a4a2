#include "viewer/window/desktop_theme.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "base/small_file.h"
#include "base/text_scan.h"

// Xlib's own name; its headers are not needed for pointers to it.
struct _XDisplay;

namespace kerf {
namespace {

constexpr std::uint32_t kMostSettingsBytes = 1u << 20;

/// Reads what a program on a computer of either byte order has written; what lies beyond the end
/// reads as nothing, for ever.
class XsettingsReader {
 public:
  explicit XsettingsReader(std::string_view bytes) : bytes_(bytes) {
    is_high_first_ = !bytes.empty() && bytes.front() != 0;
  }
  bool is_over() const { return at_ > bytes_.size(); }
  void skip(std::size_t count) { at_ = std::min(at_ + count, bytes_.size() + 1); }
  std::uint32_t number(std::size_t size) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t place = at_ + (is_high_first_ ? i : size - 1 - i);
      const auto byte = place < bytes_.size() ? static_cast<unsigned char>(bytes_[place]) : 0u;
      value = value << 8 | byte;
    }
    skip(size);
    return value;
  }
  /// With the bytes that fill it up to a multiple of 4.
  std::string_view text(std::size_t size) {
    const std::string_view found =
        at_ <= bytes_.size() ? bytes_.substr(at_, size) : std::string_view();
    skip((size + 3) / 4 * 4);
    return found;
  }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool is_high_first_;
};

template <class Function>
Function find(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_DEFAULT, name));
}

/// The settings of the desktop; empty where there are none, or where the window is not X11's.
std::string read_xsettings() {
  using Display = struct _XDisplay;
  using Atom = unsigned long;
  using XWindow = unsigned long;
  const auto get_display = find<Display* (*)()>("glfwGetX11Display");
  const auto screen_of = find<int (*)(Display*)>("XDefaultScreen");
  const auto intern = find<Atom (*)(Display*, const char*, int)>("XInternAtom");
  const auto owner_of = find<XWindow (*)(Display*, Atom)>("XGetSelectionOwner");
  const auto get =
      find<int (*)(Display*, XWindow, Atom, long, long, int, Atom, Atom*, int*, unsigned long*,
                   unsigned long*, unsigned char**)>("XGetWindowProperty");
  const auto release = find<int (*)(void*)>("XFree");
  if (!get_display || !screen_of || !intern || !owner_of || !get || !release) return "";
  Display* const display = get_display();
  if (display == nullptr) return "";
  const std::string manager = "_XSETTINGS_S" + std::to_string(screen_of(display));
  const XWindow owner = owner_of(display, intern(display, manager.c_str(), 0));
  if (owner == 0) return "";
  const Atom property = intern(display, "_XSETTINGS_SETTINGS", 0);
  Atom type = 0;
  int format = 0;
  unsigned long count = 0, rest = 0;
  unsigned char* data = nullptr;
  constexpr Atom kAnyType = 0;
  const int failed = get(display, owner, property, 0, kMostSettingsBytes / 4, 0, kAnyType, &type,
                         &format, &count, &rest, &data);
  std::string bytes;
  if (failed == 0 && format == 8 && data != nullptr) {
    bytes.assign(reinterpret_cast<const char*>(data), count);
  }
  if (data != nullptr) release(data);
  return bytes;
}

std::string settings_ini() {
  const char* const config = std::getenv("XDG_CONFIG_HOME");
  const char* const home = std::getenv("HOME");
  std::string folder;
  if (config != nullptr && *config == '/') {
    folder = config;
  } else if (home != nullptr && *home != '\0') {
    folder = std::string(home) + "/.config";
  } else {
    return "";
  }
  std::ifstream file(folder + "/gtk-3.0/settings.ini", std::ios::binary);
  return read_up_to(file, kMostSettingsBytes);
}

}  // namespace

std::optional<bool> is_dark_theme(std::string_view name) {
  if (name.empty()) return std::nullopt;
  return contains(to_lower(name), "dark");
}

std::optional<bool> dark_by_xsettings(std::string_view bytes) {
  constexpr std::uint32_t kInteger = 0, kString = 1, kColor = 2;
  XsettingsReader reader(bytes);
  reader.skip(8);  // byte order, serial number
  const std::uint32_t count = reader.number(4);
  for (std::uint32_t i = 0; i < count && !reader.is_over(); ++i) {
    const std::uint32_t type = reader.number(1);
    reader.skip(1);
    const std::uint32_t name_size = reader.number(2);
    const std::string_view name = reader.text(name_size);
    reader.skip(4);  // when it was last changed
    if (type == kString) {
      const std::uint32_t size = reader.number(4);
      const std::string_view value = reader.text(size);
      if (name == "Net/ThemeName" && !reader.is_over()) return is_dark_theme(value);
    } else if (type == kInteger) {
      reader.skip(4);
    } else if (type == kColor) {
      reader.skip(8);
    } else {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

std::optional<bool> dark_by_settings_ini(std::string_view text) {
  std::optional<bool> by_name;
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) continue;
    const std::string_view name = trim(line.substr(0, equals), is_line_blank);
    const std::string_view value = trim(line.substr(equals + 1), is_line_blank);
    if (name == "gtk-application-prefer-dark-theme" && (value == "1" || value == "true")) {
      return true;
    }
    if (name == "gtk-theme-name") by_name = is_dark_theme(value);
  }
  return by_name;
}

std::optional<bool> desktop_is_dark() {
  const char* const variable = std::getenv("GTK_THEME");
  if (variable != nullptr && *variable != '\0') return is_dark_theme(variable);
  if (const auto found = dark_by_xsettings(read_xsettings())) return found;
  return dark_by_settings_ini(settings_ini());
}

}  // namespace kerf
