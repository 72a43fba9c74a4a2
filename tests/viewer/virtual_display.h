// tests/viewer/virtual_display.h - an X server without a screen, and hands to type with.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "base/result.h"

namespace kerf {

/// Xvfb on a display number of its own choice, which is put into DISPLAY; ended by the destructor.
class VirtualDisplay {
 public:
  /// Error: which Debian package is missing, or what Xvfb said.
  /// `options` are those of Xvfb.
  static Result<VirtualDisplay> start(const std::vector<std::string>& options = {});
  VirtualDisplay(VirtualDisplay&& other) noexcept;
  VirtualDisplay& operator=(VirtualDisplay&& other) noexcept;
  ~VirtualDisplay();

  const std::string& name() const { return name_; }  ///< ":7"
  /// What a desktop tells its programs: "Xft.dpi: 192". False if it cannot be told.
  bool set_resources(const std::string& text) const;
  /// Ends the server at once, as a crash would.
  void kill_server();

 private:
  VirtualDisplay(pid_t pid, std::string name) : pid_(pid), name_(std::move(name)) {}
  pid_t pid_ = 0;
  std::string name_;
};

/// The path of a program of PATH; empty if there is none.
std::string find_program(const std::string& name);

/// Runs xdotool with these words and waits for it; false if it failed.
bool xdotool(const std::string& arguments);

}  // namespace kerf
