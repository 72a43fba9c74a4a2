// twin/process/cut_progress.h - how far cutting has come, and whether it is to stop.
#pragma once

#include <atomic>
#include <stop_token>
#include <utility>

namespace kerf {

/// One thread; the sum may be read by any.
class CutProgress {
 public:
  void stop_by(std::stop_token stop) { stop_ = std::move(stop); }
  /// True from the first call on that has seen the request.
  bool stop_now() {
    stopped_ = stopped_ || stop_.stop_requested();
    return stopped_;
  }
  bool is_stopped() const { return stopped_; }

  /// Outlives this; the sum of what end_step() has been told of.
  void count_work(std::atomic<double>& done) { done_ = &done; }
  /// `whole`: false: what is told of parts of the step does not count.
  void begin_step(double work, bool whole) {
    work_ = work;
    searched_ = 0;
    whole_ = whole;
  }
  void end_step() {
    before_ += work_;
    show(before_);
  }
  /// Of the present step, a share of the search for its contacts: half of what is to be done.
  void note_search(double share) {
    if (!done_ || !whole_) return;
    searched_ = kSearchShare * share * work_;
    show(before_ + searched_);
  }
  /// A share of the cuts of the present step.
  void note_cut(double share) {
    if (whole_) show(before_ + searched_ + share * (work_ - searched_));
  }

 private:
  static constexpr double kSearchShare = 0.5;

  /// Nothing else hangs on it: who looks may see it a little later.
  void show(double done) {
    if (done_) done_->store(done, std::memory_order_relaxed);
  }

  std::stop_token stop_;
  bool stopped_ = false;
  std::atomic<double>* done_ = nullptr;  ///< may be null
  double before_ = 0;                    ///< of the steps before the present one
  double work_ = 0;
  double searched_ = 0;
  bool whole_ = true;
};

}  // namespace kerf
