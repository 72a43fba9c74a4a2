// Of the window's work: from one setup of a part to another.
#include <algorithm>
#include <chrono>
#include <utility>

#include "base/translate.h"
#include "twin/cli/console.h"
#include "twin/cli/view_work.h"

namespace kerf {
namespace {

/// Between two looks at how far a seek has come.
constexpr std::chrono::milliseconds kSeekPatience{100};

}  // namespace

bool ViewWork::open_setups() {
  diagnostics_.clear();
  is_setup_shown_ = false;
  setups_ = ViewSetups::open(*arguments_, diagnostics_);
  print_diagnostics(diagnostics_, request_.run.quiet);
  if (setups_) arguments_ = setups_->arguments();
  return setups_ != nullptr;
}

bool ViewWork::goes_on_to_next() const {
  return is_setup_shown_ && setups_->shown() + 1 < setups_->count() && view_->has_played_out();
}

/// False: what is wrong is in the diagnostics; a setup is shown all the same.
bool ViewWork::go_to_setup(std::size_t setup, bool plays_on) {
  diagnostics_.clear();
  job_.faults.clear();
  if (!setups_ || setup >= setups_->count()) return true;
  if (plays_on) speed_ = view_->speed();
  while (!stop_.stop_requested()) {
    const std::size_t ready = setups_->last_ready(setup);
    const bool is_there = is_setup_shown_ && ready == setups_->shown();
    if (!is_there && !show_setup(ready)) return false;
    if (ready == setup) return true;
    if (!cut_to_end()) return false;
    if (!setups_->carry(*view_->player().state()->stock, diagnostics_)) {
      print_diagnostics(diagnostics_, request_.run.quiet);
      return false;
    }
  }
  return false;
}

bool ViewWork::show_setup(std::size_t setup) {
  const std::size_t before = setups_->shown();
  const Arguments arguments = *arguments_;
  setups_->choose(setup, arguments, watch_);
  arguments_ = setups_->arguments();
  is_same_program_ = false;
  told_changed_.reset();
  if (understand_again() && load()) return true;
  // What is shown is still the one before.
  const FileWatch files = watch_;
  setups_->choose(before, *arguments_, files);
  arguments_ = arguments;
  return false;
}

/// The program that is shown, to what it leaves. False: why it does not come to its end.
bool ViewWork::cut_to_end() {
  if (!partial_reason_.empty()) {
    diagnostics_.push_back(
        fault_of(trf("{} does not come to its end: {}", setups_->title(), partial_reason_)));
    return false;
  }
  Player& player = view_->player();
  const Player::Ticket ticket = player.seek_end();
  while (!player.wait(ticket, kSeekPatience)) {
    watch_commands();
    if (stop_.stop_requested()) return false;
    tell(trf("cutting {} to its end: {:.0f} %", setups_->title(),
             100 * player.state()->seek_progress));
  }
  return true;
}

void ViewWork::tell_changed_setup() {
  if (!setups_) return;
  const std::optional<std::size_t> changed = setups_->changed_before();
  if (changed == told_changed_) return;
  told_changed_ = changed;
  if (changed)
    tell(trf("setup {} has been changed on the disk: go to it to cut it anew", *changed + 1));
}

}  // namespace kerf
