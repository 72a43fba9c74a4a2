// stock/zmap/lanes.h - eight numbers at a time, in float or double, by the instructions that a
// kernel is for. Same bits whichever they are.
//
// Every operation is one correctly rounded IEEE operation (add, multiply, divide, square root,
// compare): there is no fused multiply-add, so machines without it give the same result at full
// speed. min(a, b) is a < b ? a : b, max(a, b) is a > b ? a : b. Included by one source a kernel,
// inside a namespace of its own (KERF_LANES_NAMESPACE), because code compiled for one instruction
// set must never be linked into the kernel for another.
#pragma once

#ifndef KERF_LANES_NAMESPACE
#error "define KERF_LANES_NAMESPACE before including lanes.h"
#endif

#if defined(KERF_LANES_AVX2)
#include "stock/zmap/lanes_avx2.h"
#elif defined(KERF_LANES_VECTOR)
#include "stock/zmap/lanes_vector.h"
#else
#include "stock/zmap/lanes_scalar.h"
#endif

namespace kerf::KERF_LANES_NAMESPACE {

/// Largest integer not above x, |x| < 2^22.
inline F8 floor(F8 x) {
  const F8 big = F8::all(12582912.0f);  // 1.5 * 2^23: adding it rounds to an integer
  const F8 nearest = (x + big) - big;
  return nearest - select(nearest > x, F8::all(1), F8::all(0));
}
/// The same, |x| < 2^51.
inline D8 floor(D8 x) {
  const D8 big = D8::all(6755399441055744.0);
  const D8 nearest = (x + big) - big;
  return nearest - select(nearest > x, D8::all(1), D8::all(0));
}

inline F8 to_float(F8 a) { return a; }

}  // namespace kerf::KERF_LANES_NAMESPACE
