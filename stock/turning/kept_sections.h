// stock/turning/kept_sections.h - what patches of threads are made of, worked out once.
#pragma once

#include <memory>
#include <mutex>
#include <utility>

#include "stock/turning/wound_surface.h"

namespace kerf::turning {

/// Sections that are made when they are first asked for. Several threads may ask: a piece that has
/// come off is shared by all snapshots of what it came off.
class KeptSections {
 public:
  KeptSections() = default;
  KeptSections(const KeptSections& other) : sections_(other.present()) {}
  KeptSections& operator=(const KeptSections& other) {
    std::shared_ptr<const WoundSections> sections = other.present();
    const std::lock_guard lock(mutex_);
    sections_ = std::move(sections);
    return *this;
  }

  template <class Make>
  std::shared_ptr<const WoundSections> get(const Make& make) const {
    const std::lock_guard lock(mutex_);
    if (!sections_) sections_ = std::make_shared<const WoundSections>(make());
    return sections_;
  }
  /// They are others from now on.
  void reset() {
    const std::lock_guard lock(mutex_);
    sections_.reset();
  }

 private:
  std::shared_ptr<const WoundSections> present() const {
    const std::lock_guard lock(mutex_);
    return sections_;
  }

  mutable std::mutex mutex_;
  mutable std::shared_ptr<const WoundSections> sections_;
};

}  // namespace kerf::turning
