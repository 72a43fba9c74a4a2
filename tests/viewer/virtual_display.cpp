#include "tests/viewer/virtual_display.h"

#include <dlfcn.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <sstream>
#include <utility>
#include <vector>

namespace kerf {
namespace {

constexpr int kStartTimeout_ms = 20'000;

/// Xvfb writes its display number and a newline when it is ready.
std::string read_number(int fd) {
  std::string text;
  std::array<char, 16> buffer{};
  while (text.find('\n') == std::string::npos) {
    pollfd ready{fd, POLLIN, 0};
    if (poll(&ready, 1, kStartTimeout_ms) <= 0) return "";
    const ssize_t count = read(fd, buffer.data(), buffer.size());
    if (count <= 0) return "";
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
  return text.substr(0, text.find('\n'));
}

}  // namespace

std::string find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  std::string folder;
  while (std::getline(folders, folder, ':')) {
    const std::string candidate = folder + "/" + name;
    if (access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  return "";
}

Result<VirtualDisplay> VirtualDisplay::start(const std::vector<std::string>& options) {
  const std::string program = find_program("Xvfb");
  if (program.empty()) return Error{"Xvfb is not installed (Debian package xvfb)"};
  if (find_program("xdotool").empty()) {
    return Error{"xdotool is not installed (Debian package xdotool)"};
  }
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return Error{"no pipe"};
  const std::string fd = std::to_string(ends[1]);
  std::vector<std::string> words{"Xvfb",         "-displayfd", fd,    "-screen", "0",
                                 "1600x1000x24", "-nolisten",  "tcp", "-noreset"};
  words.insert(words.end(), options.begin(), options.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t pid = fork();
  if (pid == 0) {
    close(ends[0]);
    // A test that is killed takes its server with it.
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    execv(program.c_str(), arguments.data());
    _exit(127);
  }
  close(ends[1]);
  const std::string number = pid > 0 ? read_number(ends[0]) : "";
  close(ends[0]);
  if (number.empty()) {
    if (pid > 0) {
      kill(pid, SIGTERM);
      waitpid(pid, nullptr, 0);
    }
    return Error{"Xvfb does not start"};
  }
  VirtualDisplay display(pid, ":" + number);
  setenv("DISPLAY", display.name_.c_str(), 1);
  return display;
}

VirtualDisplay::VirtualDisplay(VirtualDisplay&& other) noexcept
    : pid_(std::exchange(other.pid_, 0)), name_(std::move(other.name_)) {}

VirtualDisplay& VirtualDisplay::operator=(VirtualDisplay&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(name_, other.name_);
  return *this;
}

VirtualDisplay::~VirtualDisplay() {
  if (pid_ <= 0) return;
  kill(pid_, SIGTERM);
  waitpid(pid_, nullptr, 0);
}

bool VirtualDisplay::set_resources(const std::string& text) const {
  // Xlib is there where the window is, its headers need not be.
  void* const xlib = dlopen("libX11.so.6", RTLD_NOW);
  if (xlib == nullptr) return false;
  struct Display;
  const auto open = reinterpret_cast<Display* (*)(const char*)>(dlsym(xlib, "XOpenDisplay"));
  const auto root =
      reinterpret_cast<unsigned long (*)(Display*)>(dlsym(xlib, "XDefaultRootWindow"));
  const auto change =
      reinterpret_cast<int (*)(Display*, unsigned long, unsigned long, unsigned long, int, int,
                               const char*, int)>(dlsym(xlib, "XChangeProperty"));
  const auto close = reinterpret_cast<int (*)(Display*)>(dlsym(xlib, "XCloseDisplay"));
  Display* const display = open(name_.c_str());
  if (display == nullptr) return false;
  constexpr unsigned long kResourceManager = 23, kString = 31;  // atoms that every server has
  change(display, root(display), kResourceManager, kString, 8, 0, text.data(),
         static_cast<int>(text.size()));
  close(display);
  return true;
}

void VirtualDisplay::kill_server() {
  if (pid_ <= 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  pid_ = 0;
}

bool xdotool(const std::string& arguments) {
  return std::system(("xdotool " + arguments).c_str()) == 0;
}

}  // namespace kerf
