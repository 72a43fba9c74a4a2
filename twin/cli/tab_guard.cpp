#include "twin/cli/tab_guard.h"

#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <deque>

#include "base/exit_code.h"
#include "base/translate.h"
#include "twin/cli/console.h"

namespace kerf {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// For a child that was asked to end: it writes its report.
constexpr Seconds kFarewell{10};

bool is_crash(int signal_number) {
  constexpr std::array kCrashes{SIGSEGV, SIGABRT, SIGBUS, SIGILL, SIGFPE};
  return std::find(kCrashes.begin(), kCrashes.end(), signal_number) != kCrashes.end();
}

void say(const std::string& text) {
  print_text(stderr, text);
  flush_console();
}

class Guard {
 public:
  Guard(ScreenTab tab, const GuardPatience& patience) : tab_(std::move(tab)), patience_(patience) {
    sigemptyset(&heard_);
    for (const int number : {SIGTERM, SIGINT, SIGHUP, SIGCHLD}) sigaddset(&heard_, number);
    sigprocmask(SIG_BLOCK, &heard_, &before_);
    signals_fd_ = signalfd(-1, &heard_, SFD_CLOEXEC | SFD_NONBLOCK);
  }
  ~Guard() {
    close(signals_fd_);
    sigprocmask(SIG_SETMASK, &before_, nullptr);
  }
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;

  /// True in the child.
  bool fork_child() {
    flush_console();
    const pid_t guard = getpid();
    child_ = fork();
    if (child_ != 0) return false;
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != guard) _exit(kExitFailure);
    tab_.forget();
    return true;
  }

  /// The exit code; nothing: it has crashed, and is to be started again.
  std::optional<int> watch() {
    if (child_ < 0) {
      say(trf("kerf: error: no process for the tab: {}\n", std::strerror(errno)));
      return kExitFailure;
    }
    while (true) {
      wait_for_news(ends_at_ ? Seconds(*ends_at_ - Clock::now()) : Seconds(-1));
      if (ends_at_ && Clock::now() >= *ends_at_) kill(child_, SIGKILL);
      int status = 0;
      if (waitpid(child_, &status, WNOHANG) == child_) return verdict(status);
    }
  }

  /// False: it was asked to end meanwhile.
  bool pause() {
    child_ = 0;
    const Clock::time_point goes_on =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(Seconds(patience_.pause_s));
    while (!is_asked_ && Clock::now() < goes_on) wait_for_news(Seconds(goes_on - Clock::now()));
    return !is_asked_;
  }

 private:
  /// Signals, and what becomes of the tab. `longest` < 0: as long as it takes.
  void wait_for_news(Seconds longest) {
    std::array<pollfd, 2> waits{
        {{signals_fd_, POLLIN, 0}, {is_tab_there_ ? tab_.connection_fd() : -1, POLLIN, 0}}};
    const int patience_ms = longest.count() < 0 && !ends_at_
                                ? -1
                                : static_cast<int>(std::ceil(std::max(0.0, longest.count()) * 1e3));
    poll(waits.data(), waits.size(), patience_ms);
    if (waits[1].revents != 0 && !tab_.follow()) {
      is_tab_there_ = false;
      ask_to_end(SIGTERM);
    }
    signalfd_siginfo info{};
    while (read(signals_fd_, &info, sizeof(info)) == sizeof(info)) {
      if (info.ssi_signo == SIGCHLD) continue;
      // A terminal tells the child itself.
      const bool is_told = info.ssi_code == SI_KERNEL;
      ask_to_end(is_told ? 0 : static_cast<int>(info.ssi_signo));
    }
  }

  void ask_to_end(int signal_number) {
    is_asked_ = true;
    if (child_ > 0) kill(child_, signal_number);
    if (!is_tab_there_ && !ends_at_) {
      ends_at_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(kFarewell);
    }
  }

  std::optional<int> verdict(int status) {
    if (WIFEXITED(status)) return WEXITSTATUS(status);
    const int number = WTERMSIG(status);
    const std::string name = sigabbrev_np(number) != nullptr ? sigabbrev_np(number) : "?";
    if (!is_crash(number) || is_asked_) {
      if (!is_asked_) say(trf("kerf: error: the tab was ended by SIG{}\n", name));
      return kExitFailure;
    }
    const Clock::time_point now = Clock::now();
    while (!crashes_.empty() && Seconds(now - crashes_.front()).count() > patience_.window_s) {
      crashes_.pop_front();
    }
    if (static_cast<int>(crashes_.size()) >= patience_.restarts) {
      say(trf("kerf: error: the tab crashed again (SIG{}), {} times in {} s: given up\n", name,
              crashes_.size() + 1, patience_.window_s));
      return kExitFailure;
    }
    crashes_.push_back(now);
    say(trf("kerf: warning: the tab crashed (SIG{}): it starts again\n", name));
    return std::nullopt;
  }

  ScreenTab tab_;
  GuardPatience patience_;
  sigset_t heard_{}, before_{};
  int signals_fd_ = -1;
  pid_t child_ = 0;
  bool is_tab_there_ = true;
  bool is_asked_ = false;
  std::optional<Clock::time_point> ends_at_;
  std::deque<Clock::time_point> crashes_;
};

}  // namespace

int guard_tab(ScreenTab tab, const std::function<int()>& work, const GuardPatience& patience) {
  std::optional<Guard> guard(std::in_place, std::move(tab), patience);
  while (true) {
    if (guard->fork_child()) {
      guard.reset();  // its signals are heard as ever
      return work();
    }
    if (const std::optional<int> code = guard->watch()) return *code;
    if (!guard->pause()) return kExitFailure;
  }
}

}  // namespace kerf
