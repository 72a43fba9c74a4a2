#include "twin/playback/player.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "twin/playback/player_engine.h"

namespace kerf {

using Clock = PlayerEngine::Clock;

struct Player::Impl {
  Impl(PlayerProgram program, PlayerOptions options)
      : on_state(std::move(options.on_state)), engine(std::move(program), options) {
    newest = engine.take_state();
    thread = std::thread([this] { run(); });
  }

  ~Impl() {
    {
      const std::lock_guard lock(commands_mutex);
      over = true;
    }
    commands_come.notify_all();
    thread.join();
  }

  Ticket send(PlayerCommand command) {
    Ticket ticket = 0;
    {
      const std::lock_guard lock(commands_mutex);
      ticket = command.ticket = ++last_ticket;
      commands.push_back(std::move(command));
    }
    commands_come.notify_all();
    return ticket;
  }

  void run() {
    Clock::time_point next = Clock::time_point::min();
    std::deque<PlayerCommand> taken;
    while (take_commands(next, taken)) {
      for (const PlayerCommand& command : taken) engine.command(command);
      next = engine.work();
      const Clock::time_point due = engine.state_due_at();
      if (due <= Clock::now()) {
        publish();
      } else {
        // Not even the last news may wait for a command.
        next = std::min(next, due);
      }
    }
  }

  /// Waits for commands until `until`. False: it is over.
  bool take_commands(Clock::time_point until, std::deque<PlayerCommand>& taken) {
    taken.clear();
    std::unique_lock lock(commands_mutex);
    const auto woken = [this] { return over || !commands.empty(); };
    if (until == Clock::time_point::max()) {
      commands_come.wait(lock, woken);
    } else if (until > Clock::now()) {
      commands_come.wait_until(lock, until, woken);
    }
    taken.swap(commands);
    return !over;
  }

  void publish() {
    std::shared_ptr<const PlayerState> state = engine.take_state();
    {
      const std::lock_guard lock(state_mutex);
      newest.swap(state);
    }
    // The old state may be the last to hold a workpiece: it goes with the lock released.
    state_changed.notify_all();
    if (on_state) on_state();
  }

  const std::function<void()> on_state;
  PlayerEngine engine;  // of the thread

  std::mutex commands_mutex;  // of the three that follow
  std::condition_variable commands_come;
  std::deque<PlayerCommand> commands;
  Ticket last_ticket = 0;
  bool over = false;

  std::mutex state_mutex;  // of `newest`; held while a pointer is copied, no longer
  std::condition_variable state_changed;
  std::shared_ptr<const PlayerState> newest;

  std::thread thread;
};

Player::Player(PlayerProgram program, PlayerOptions options)
    : track_(program.track),
      impl_(std::make_unique<Impl>(std::move(program), std::move(options))) {}

Player::~Player() = default;

std::shared_ptr<const PlayerState> Player::state() const {
  const std::lock_guard lock(impl_->state_mutex);
  return impl_->newest;
}

bool Player::wait(Ticket ticket, std::chrono::milliseconds timeout) const {
  std::unique_lock lock(impl_->state_mutex);
  return impl_->state_changed.wait_for(lock, timeout,
                                       [&] { return impl_->newest->commands_done >= ticket; });
}

using Kind = PlayerCommand::Kind;

std::vector<float> Player::removed_mm3() const { return impl_->engine.removed_mm3(); }

std::shared_ptr<const LoadRecord> Player::loads() const { return impl_->engine.loads(); }

Player::Ticket Player::play(double speed) {
  return impl_->send({.kind = Kind::kPlay, .number = speed});
}
Player::Ticket Player::pause() { return impl_->send({.kind = Kind::kPause}); }
Player::Ticket Player::stop() { return impl_->send({.kind = Kind::kStop}); }
Player::Ticket Player::step_block(int blocks) {
  return impl_->send({.kind = Kind::kStepBlock, .count = blocks});
}
Player::Ticket Player::seek_time(double time_s) {
  return impl_->send({.kind = Kind::kSeekTime, .number = time_s});
}
Player::Ticket Player::seek_motion(std::size_t motion) {
  return impl_->send({.kind = Kind::kSeekMotion, .motion = motion});
}
Player::Ticket Player::seek_line(SourceRef line, std::size_t from) {
  return impl_->send({.kind = Kind::kSeekLine, .motion = from, .line = line});
}
Player::Ticket Player::seek_tool_change(int count) {
  return impl_->send({.kind = Kind::kSeekToolChange, .count = count});
}
Player::Ticket Player::seek_finding(int count) {
  return impl_->send({.kind = Kind::kSeekFinding, .count = count});
}
Player::Ticket Player::seek_finding_number(std::size_t index) {
  return impl_->send({.kind = Kind::kSeekFindingNumber, .motion = index});
}
Player::Ticket Player::run_to_motion(std::size_t motion) {
  return impl_->send({.kind = Kind::kRunToMotion, .motion = motion});
}
Player::Ticket Player::run_to_line(SourceRef line) {
  return impl_->send({.kind = Kind::kRunToLine, .line = line});
}
Player::Ticket Player::set_breakpoints(std::vector<SourceRef> lines) {
  return impl_->send({.kind = Kind::kSetBreakpoints, .lines = std::move(lines)});
}

}  // namespace kerf
