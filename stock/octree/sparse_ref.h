// stock/octree/sparse_ref.h - a counted pointer that can also say "all empty" or "all solid".
#pragma once

#include <atomic>
#include <cstdint>
#include <utility>

namespace kerf::octree {

/// Base of what SparseRef points to. Starts with one owner.
struct Counted {
  std::atomic<std::uint32_t> owners{1};
  Counted() = default;
  Counted(const Counted&) : owners(1) {}
  Counted& operator=(const Counted&) = delete;
};

/// One word: nothing solid, everything solid, or a T that may be shared. T::destroy(T*) frees it.
/// Copies may go to other threads; one SparseRef belongs to one thread at a time.
template <class T>
class SparseRef {
 public:
  SparseRef() = default;
  static SparseRef solid() { return SparseRef(kSolid); }
  /// Takes over one ownership.
  static SparseRef adopt(T* object) { return SparseRef(reinterpret_cast<std::uintptr_t>(object)); }
  SparseRef(const SparseRef& other) : bits_(other.bits_) {
    if (T* t = get()) t->owners.fetch_add(1, std::memory_order_relaxed);
  }
  SparseRef(SparseRef&& other) noexcept : bits_(std::exchange(other.bits_, kEmpty)) {}
  SparseRef& operator=(SparseRef other) noexcept {
    std::swap(bits_, other.bits_);
    return *this;
  }
  ~SparseRef() {
    T* t = get();
    if (t && t->owners.fetch_sub(1, std::memory_order_acq_rel) == 1) T::destroy(t);
  }

  bool is_empty() const { return bits_ == kEmpty; }
  bool is_solid() const { return bits_ == kSolid; }
  T* get() const { return bits_ <= kSolid ? nullptr : reinterpret_cast<T*>(bits_); }
  T* operator->() const { return get(); }
  /// True if no other SparseRef has the same T: it may be written.
  bool is_sole() const {
    const T* t = get();
    return t && t->owners.load(std::memory_order_acquire) == 1;
  }
  /// The same object, or the same uniform state.
  bool operator==(const SparseRef& other) const { return bits_ == other.bits_; }

 private:
  static constexpr std::uintptr_t kEmpty = 0, kSolid = 1;
  explicit SparseRef(std::uintptr_t bits) : bits_(bits) {}
  std::uintptr_t bits_ = kEmpty;
};

}  // namespace kerf::octree
