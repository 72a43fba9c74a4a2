#include "tests/machine_io/can/can_bus.h"

#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <sstream>

extern char** environ;

namespace kerf {

bool has_bus() { return std::filesystem::exists(std::string("/sys/class/net/") + kBusName); }

bool has_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (::access((folder + "/" + name).c_str(), X_OK) == 0) return true;
  }
  return false;
}

Program::Program(const std::vector<std::string>& arguments, const std::string& output) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (!output.empty()) {
    posix_spawn_file_actions_addopen(&actions, 1, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                     0600);
  }
  if (::posix_spawnp(&pid_, argv[0], &actions, nullptr, argv.data(), environ) != 0) pid_ = -1;
  posix_spawn_file_actions_destroy(&actions);
}

Program::~Program() { stop(); }

int Program::wait() {
  if (pid_ > 0) {
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  }
  return status_;
}

void Program::stop() {
  if (pid_ > 0) ::kill(pid_, SIGINT);
  wait();
}

bool run_program(const std::vector<std::string>& arguments) {
  return Program(arguments).wait() == 0;
}

BusNode::BusNode(const std::string& interface) {
  const int socket = ::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
  const int on = 1;
  const can_err_mask_t errors = CAN_ERR_MASK;
  setsockopt(socket, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on);
  setsockopt(socket, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors);
  if (address.can_ifindex != 0 &&
      ::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    socket_ = socket;
  } else if (socket >= 0) {
    ::close(socket);
  }
}

BusNode::~BusNode() {
  if (socket_ >= 0) ::close(socket_);
}

bool BusNode::send(const CanFrame& frame) {
  canfd_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U) |
               (frame.remote ? CAN_RTR_FLAG : 0U) | (frame.error ? CAN_ERR_FLAG : 0U);
  raw.len = frame.length;
  std::copy_n(frame.data.begin(), frame.length, std::begin(raw.data));
  const std::size_t size = frame.fd ? CANFD_MTU : CAN_MTU;
  for (;;) {
    const ssize_t sent = ::write(socket_, &raw, size);
    if (sent == static_cast<ssize_t>(size)) return true;
    if (errno != ENOBUFS && errno != EINTR) return false;
    pollfd room{socket_, POLLOUT, 0};
    ::poll(&room, 1, 10);
  }
}

int BusNode::heard() {
  int count = 0;
  canfd_frame raw{};
  for (;;) {
    // An interface that was down is told once; behind that there may be frames.
    if (::recv(socket_, &raw, sizeof raw, MSG_DONTWAIT) > 0) {
      ++count;
    } else if (errno != ENETDOWN) {
      return count;
    }
  }
}

}  // namespace kerf
