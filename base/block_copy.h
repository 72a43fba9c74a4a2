// base/block_copy.h - copies of large values, fast.
#pragma once

#include <cstddef>
#include <cstring>
#include <type_traits>
#include <vector>

namespace kerf {

/// std::memcpy(), of the C library in any case, which has vectors: compilers make a string
/// instruction of it (rep movs) where they know that it is some hundred bytes, or words.
inline void copy_bytes(void* to, const void* from, std::size_t bytes) {
  asm("" : "+r"(bytes));  // not known any more
  std::memcpy(to, from, bytes);
}

/// As `to = from`, for values of some hundred bytes on paths that are run a million times: as a
/// string instruction it takes several times as long, and who reads the copy next waits for all of
/// it.
template <class T>
void copy_block(T& to, const T& from) {
  static_assert(std::is_trivially_copyable_v<T>);
  copy_bytes(&to, &from, sizeof(T));
}

/// Appends a copy, which `to` has room for nearly always.
template <class T>
T& append_block(std::vector<T>& to, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::size_t one = 1;
  asm("" : "+r"(one));  // not known any more: see copy_bytes()
  to.insert(to.end(), &value, &value + one);
  return to.back();
}

}  // namespace kerf
