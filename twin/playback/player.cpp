#include "twin/playback/player.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "twin/motion_geometry.h"
#include "twin/motion_nearest.h"
#include "twin/playback/player_engine.h"

namespace kerf {

struct Player::Impl {
  Impl(PlayerProgram program, PlayerOptions options)
      : on_state(options.on_state), engine(std::move(program), options) {
    newest = engine.take_state(0);
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

  Ticket send(PlayerCommand command);
  void run();
  void take_commands(bool idle, std::chrono::steady_clock::time_point until);
  void publish();

  std::function<void()> on_state;
  PlayerEngine engine;  // of the thread

  std::mutex commands_mutex;  // of the three that follow
  std::condition_variable commands_come;
  std::deque<PlayerCommand> commands;
  Ticket last_ticket = 0;
  bool over = false;

  mutable std::mutex state_mutex;  // of newest; held for the copy of a pointer only
  mutable std::condition_variable state_changed;
  std::shared_ptr<const PlayerState> newest;

  std::thread thread;
};

}  // namespace kerf
