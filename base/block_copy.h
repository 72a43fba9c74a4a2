// base/block_copy.h - copies of large values, fast.
#pragma once

#include <cstddef>
#include <cstring>
#include <type_traits>

namespace kerf {

/// As `to = from`, for values of some hundred bytes on paths that are run a million times: what
/// compilers make of an assignment that large (rep movs) takes several times as long, and who reads
/// the copy next waits for all of it.
template <class T>
void copy_block(T& to, const T& from) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::size_t bytes = sizeof(T);
  asm("" : "+r"(bytes));  // not known: so it is the C library's, which has vectors
  std::memcpy(static_cast<void*>(&to), &from, bytes);
}

}  // namespace kerf
