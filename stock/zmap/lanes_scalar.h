// stock/zmap/lanes_scalar.h - eight numbers one after the other, on any machine: see lanes.h.
#pragma once

#ifndef KERF_LANES_NAMESPACE
#error "define KERF_LANES_NAMESPACE before including lanes_scalar.h"
#endif

#include <cstdint>

namespace kerf::KERF_LANES_NAMESPACE {

/// Four numbers; only what a list of blocks needs.
struct F4 {
  float v[4];
  static F4 of(float a, float b, float c, float d) { return {{a, b, c, d}}; }
  static F4 load(const float* p) { return {{p[0], p[1], p[2], p[3]}}; }
};
inline F4 operator+(F4 a, F4 b) {
  for (int i = 0; i < 4; ++i) a.v[i] += b.v[i];
  return a;
}
inline void store(float* p, F4 a) {
  for (int i = 0; i < 4; ++i) p[i] = a.v[i];
}

struct MaskF {
  std::int32_t v[8];
};
struct F8 {
  using Scalar = float;
  using Mask = MaskF;
  float v[8];
  static F8 all(float x) { return {{x, x, x, x, x, x, x, x}}; }
  static F8 load(const float* p) {
    F8 r;
    for (int i = 0; i < 8; ++i) r.v[i] = p[i];
    return r;
  }
};
struct MaskD {
  std::int64_t v[8];
};
struct D8 {
  using Scalar = double;
  using Mask = MaskD;
  double v[8];
  static D8 all(double x) { return {{x, x, x, x, x, x, x, x}}; }
  static D8 load(const double* p) {
    D8 r;
    for (int i = 0; i < 8; ++i) r.v[i] = p[i];
    return r;
  }
};
inline void store(float* p, F8 a) {
  for (int i = 0; i < 8; ++i) p[i] = a.v[i];
}

/// Writes eight rows of (a, b, c, 0).
inline void store_rows(float* out, F8 a, F8 b, F8 c) {
  for (int i = 0; i < 8; ++i) {
    out[4 * i] = a.v[i];
    out[4 * i + 1] = b.v[i];
    out[4 * i + 2] = c.v[i];
    out[4 * i + 3] = 0;
  }
}
/// One bit a lane.
inline unsigned bits(MaskF a) {
  unsigned r = 0;
  for (int i = 0; i < 8; ++i) r |= a.v[i] ? 1u << i : 0u;
  return r;
}

/// Eight 32-bit sums.
struct I8 {
  std::int32_t v[8];
  static I8 zero() { return {}; }
};
inline I8 operator+(I8 a, I8 b) {
  for (int i = 0; i < 8; ++i) a.v[i] += b.v[i];
  return a;
}
/// To nearest, ties to even, for 0 <= a < 2^31: the way of the AVX2 instruction.
inline I8 round_to_int(F8 a) {
  I8 r;
  for (int i = 0; i < 8; ++i) r.v[i] = static_cast<std::int32_t>(__builtin_rintf(a.v[i]));
  return r;
}
inline void store(std::int32_t* p, I8 a) {
  for (int i = 0; i < 8; ++i) p[i] = a.v[i];
}
/// Writes `value` to the lanes of `m`.
inline void store_where(MaskF m, std::uint32_t value, std::uint32_t* p) {
  for (int i = 0; i < 8; ++i) p[i] = m.v[i] ? value : p[i];
}

// The same operations for both widths, lane by lane; the compiler makes of them what the machine
// has.
#define KERF_LANES_BINARY(T, M)                                             \
  inline T operator+(T a, T b) {                                            \
    for (int i = 0; i < 8; ++i) a.v[i] += b.v[i];                           \
    return a;                                                               \
  }                                                                         \
  inline T operator-(T a, T b) {                                            \
    for (int i = 0; i < 8; ++i) a.v[i] -= b.v[i];                           \
    return a;                                                               \
  }                                                                         \
  inline T operator*(T a, T b) {                                            \
    for (int i = 0; i < 8; ++i) a.v[i] *= b.v[i];                           \
    return a;                                                               \
  }                                                                         \
  inline T operator/(T a, T b) {                                            \
    for (int i = 0; i < 8; ++i) a.v[i] /= b.v[i];                           \
    return a;                                                               \
  }                                                                         \
  inline T min(T a, T b) {                                                  \
    for (int i = 0; i < 8; ++i) a.v[i] = a.v[i] < b.v[i] ? a.v[i] : b.v[i]; \
    return a;                                                               \
  }                                                                         \
  inline T max(T a, T b) {                                                  \
    for (int i = 0; i < 8; ++i) a.v[i] = a.v[i] > b.v[i] ? a.v[i] : b.v[i]; \
    return a;                                                               \
  }                                                                         \
  inline M operator>=(T a, T b) {                                           \
    M r;                                                                    \
    for (int i = 0; i < 8; ++i) r.v[i] = -(a.v[i] >= b.v[i]);               \
    return r;                                                               \
  }                                                                         \
  inline M operator<=(T a, T b) {                                           \
    M r;                                                                    \
    for (int i = 0; i < 8; ++i) r.v[i] = -(a.v[i] <= b.v[i]);               \
    return r;                                                               \
  }                                                                         \
  inline M operator>(T a, T b) {                                            \
    M r;                                                                    \
    for (int i = 0; i < 8; ++i) r.v[i] = -(a.v[i] > b.v[i]);                \
    return r;                                                               \
  }                                                                         \
  inline M operator<(T a, T b) {                                            \
    M r;                                                                    \
    for (int i = 0; i < 8; ++i) r.v[i] = -(a.v[i] < b.v[i]);                \
    return r;                                                               \
  }                                                                         \
  inline M operator&(M a, M b) {                                            \
    for (int i = 0; i < 8; ++i) a.v[i] &= b.v[i];                           \
    return a;                                                               \
  }                                                                         \
  inline M operator|(M a, M b) {                                            \
    for (int i = 0; i < 8; ++i) a.v[i] |= b.v[i];                           \
    return a;                                                               \
  }                                                                         \
  inline M and_not(M a, M b) {                                              \
    for (int i = 0; i < 8; ++i) a.v[i] &= ~b.v[i];                          \
    return a;                                                               \
  }                                                                         \
  inline bool any(M a) {                                                    \
    bool r = false;                                                         \
    for (int i = 0; i < 8; ++i) r |= a.v[i] != 0;                           \
    return r;                                                               \
  }                                                                         \
  inline T select(M m, T a, T b) {                                          \
    for (int i = 0; i < 8; ++i) a.v[i] = m.v[i] ? a.v[i] : b.v[i];          \
    return a;                                                               \
  }
KERF_LANES_BINARY(F8, MaskF)
KERF_LANES_BINARY(D8, MaskD)
#undef KERF_LANES_BINARY

inline F8 sqrt(F8 a) {
  for (int i = 0; i < 8; ++i) a.v[i] = __builtin_sqrtf(a.v[i]);
  return a;
}
inline D8 sqrt(D8 a) {
  for (int i = 0; i < 8; ++i) a.v[i] = __builtin_sqrt(a.v[i]);
  return a;
}
inline F8 abs(F8 a) {
  for (int i = 0; i < 8; ++i) a.v[i] = __builtin_fabsf(a.v[i]);
  return a;
}
inline D8 abs(D8 a) {
  for (int i = 0; i < 8; ++i) a.v[i] = __builtin_fabs(a.v[i]);
  return a;
}
inline F8 to_float(D8 a) {
  F8 r;
  for (int i = 0; i < 8; ++i) r.v[i] = static_cast<float>(a.v[i]);
  return r;
}

}  // namespace kerf::KERF_LANES_NAMESPACE
