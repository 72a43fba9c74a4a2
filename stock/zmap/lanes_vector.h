// stock/zmap/lanes_vector.h - eight numbers at a time as two vectors of 16 bytes (doubles: four),
// which every x86-64 (SSE2) and every arm64 (NEON) has: see lanes.h. What compilers' vectors do not
// say is said for each of the two.
#pragma once

#ifndef KERF_LANES_NAMESPACE
#error "define KERF_LANES_NAMESPACE before including lanes_vector.h"
#endif

#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#else
#error "vectors of 16 bytes are for x86-64 and arm64"
#endif

namespace kerf::KERF_LANES_NAMESPACE {

using V4 = float __attribute__((vector_size(16)));
using V2 = double __attribute__((vector_size(16)));
using M4 = std::int32_t __attribute__((vector_size(16)));
using M2 = std::int64_t __attribute__((vector_size(16)));

#if defined(__SSE2__)
inline V4 min_of(V4 a, V4 b) { return _mm_min_ps(a, b); }
inline V4 max_of(V4 a, V4 b) { return _mm_max_ps(a, b); }
inline V2 min_of(V2 a, V2 b) { return _mm_min_pd(a, b); }
inline V2 max_of(V2 a, V2 b) { return _mm_max_pd(a, b); }
inline V4 root_of(V4 a) { return _mm_sqrt_ps(a); }
inline V2 root_of(V2 a) { return _mm_sqrt_pd(a); }
inline unsigned bits_of(M4 a) { return static_cast<unsigned>(_mm_movemask_ps(V4(a))); }
inline bool any_of(M4 a) { return _mm_movemask_ps(V4(a)) != 0; }
inline bool any_of(M2 a) { return _mm_movemask_pd(V2(a)) != 0; }
inline M4 nearest_of(V4 a) { return M4(_mm_cvtps_epi32(a)); }
inline V4 narrow(V2 lo, V2 hi) { return _mm_movelh_ps(_mm_cvtpd_ps(lo), _mm_cvtpd_ps(hi)); }
inline V4 low_pairs(V4 a, V4 b) { return _mm_unpacklo_ps(a, b); }
inline V4 high_pairs(V4 a, V4 b) { return _mm_unpackhi_ps(a, b); }
inline V4 low_halves(V4 a, V4 b) { return _mm_movelh_ps(a, b); }
inline V4 high_halves(V4 a, V4 b) { return _mm_movehl_ps(b, a); }
#else
inline V4 min_of(V4 a, V4 b) { return vbslq_f32(vcltq_f32(a, b), a, b); }
inline V4 max_of(V4 a, V4 b) { return vbslq_f32(vcgtq_f32(a, b), a, b); }
inline V2 min_of(V2 a, V2 b) { return vbslq_f64(vcltq_f64(a, b), a, b); }
inline V2 max_of(V2 a, V2 b) { return vbslq_f64(vcgtq_f64(a, b), a, b); }
inline V4 root_of(V4 a) { return vsqrtq_f32(a); }
inline V2 root_of(V2 a) { return vsqrtq_f64(a); }
inline unsigned bits_of(M4 a) {
  const M4 places{1, 2, 4, 8};
  return static_cast<unsigned>(vaddvq_s32(a & places));
}
inline bool any_of(M4 a) { return vmaxvq_u32(uint32x4_t(a)) != 0; }
inline bool any_of(M2 a) { return vmaxvq_u32(uint32x4_t(a)) != 0; }
inline M4 nearest_of(V4 a) { return vcvtnq_s32_f32(a); }
inline V4 narrow(V2 lo, V2 hi) { return vcvt_high_f32_f64(vcvt_f32_f64(lo), hi); }
inline V4 low_pairs(V4 a, V4 b) { return vzip1q_f32(a, b); }
inline V4 high_pairs(V4 a, V4 b) { return vzip2q_f32(a, b); }
inline V4 low_halves(V4 a, V4 b) { return V4(vzip1q_f64(float64x2_t(a), float64x2_t(b))); }
inline V4 high_halves(V4 a, V4 b) { return V4(vzip2q_f64(float64x2_t(a), float64x2_t(b))); }
#endif
inline V4 select_of(M4 m, V4 a, V4 b) { return V4((m & M4(a)) | (~m & M4(b))); }
inline V2 select_of(M2 m, V2 a, V2 b) { return V2((m & M2(a)) | (~m & M2(b))); }
/// As they lie in memory, where they are single numbers for others.
using V4InMemory = float __attribute__((vector_size(16), may_alias));
using V2InMemory = double __attribute__((vector_size(16), may_alias));
using M4InMemory = std::int32_t __attribute__((vector_size(16), may_alias));
inline V4 at_address(const float* p) { return *reinterpret_cast<const V4InMemory*>(p); }
inline void to_address(float* p, V4 a) { *reinterpret_cast<V4InMemory*>(p) = a; }

/// Four numbers; only what a list of blocks needs.
struct F4 {
  V4 v;
  static F4 of(float a, float b, float c, float d) { return {V4{a, b, c, d}}; }
  static F4 load(const float* p) { return {at_address(p)}; }
};
inline F4 operator+(F4 a, F4 b) { return {a.v + b.v}; }
inline void store(float* p, F4 a) { to_address(p, a.v); }

struct MaskF {
  static constexpr int kParts = 2;
  M4 v[kParts];
};
struct F8 {
  using Scalar = float;
  using Mask = MaskF;
  static constexpr int kParts = 2;
  V4 v[kParts];
  static F8 all(float x) {
    const V4 one{x, x, x, x};
    return {{one, one}};
  }
  static F8 load(const float* p) { return {{at_address(p), at_address(p + 4)}}; }
};
struct MaskD {
  static constexpr int kParts = 4;
  M2 v[kParts];
};
struct D8 {
  using Scalar = double;
  using Mask = MaskD;
  static constexpr int kParts = 4;
  V2 v[kParts];
  static D8 all(double x) {
    const V2 one{x, x};
    return {{one, one, one, one}};
  }
  static D8 load(const double* p) {
    const V2InMemory* const from = reinterpret_cast<const V2InMemory*>(p);
    return {{from[0], from[1], from[2], from[3]}};
  }
};

// The same operations for both widths.
#define KERF_LANES_PARTS(T, M, V, NAME, PARAMETERS, VALUE) \
  inline V NAME PARAMETERS {                               \
    V r;                                                   \
    for (int i = 0; i < V::kParts; ++i) r.v[i] = VALUE;    \
    return r;                                              \
  }
#define KERF_LANES_BINARY(T, M)                                       \
  KERF_LANES_PARTS(T, M, T, operator+, (T a, T b), a.v[i] + b.v[i])   \
  KERF_LANES_PARTS(T, M, T, operator-, (T a, T b), a.v[i] - b.v[i])   \
  KERF_LANES_PARTS(T, M, T, operator*, (T a, T b), a.v[i] * b.v[i])   \
  KERF_LANES_PARTS(T, M, T, operator/, (T a, T b), a.v[i] / b.v[i])   \
  KERF_LANES_PARTS(T, M, T, min, (T a, T b), min_of(a.v[i], b.v[i]))  \
  KERF_LANES_PARTS(T, M, T, max, (T a, T b), max_of(a.v[i], b.v[i]))  \
  KERF_LANES_PARTS(T, M, T, sqrt, (T a), root_of(a.v[i]))             \
  KERF_LANES_PARTS(T, M, M, operator>=, (T a, T b), a.v[i] >= b.v[i]) \
  KERF_LANES_PARTS(T, M, M, operator<=, (T a, T b), a.v[i] <= b.v[i]) \
  KERF_LANES_PARTS(T, M, M, operator>, (T a, T b), a.v[i] > b.v[i])   \
  KERF_LANES_PARTS(T, M, M, operator<, (T a, T b), a.v[i] < b.v[i])   \
  KERF_LANES_PARTS(T, M, M, operator&, (M a, M b), a.v[i] & b.v[i])   \
  KERF_LANES_PARTS(T, M, M, operator|, (M a, M b), a.v[i] | b.v[i])   \
  KERF_LANES_PARTS(T, M, M, and_not, (M a, M b), a.v[i] & ~b.v[i])    \
  KERF_LANES_PARTS(T, M, T, select, (M m, T a, T b), select_of(m.v[i], a.v[i], b.v[i]))
KERF_LANES_BINARY(F8, MaskF)
KERF_LANES_BINARY(D8, MaskD)
#undef KERF_LANES_BINARY
#undef KERF_LANES_PARTS

inline F8 abs(F8 a) {
  constexpr std::int32_t kAllButSign = 0x7fff'ffff;
  const M4 keep{kAllButSign, kAllButSign, kAllButSign, kAllButSign};
  return {{V4(M4(a.v[0]) & keep), V4(M4(a.v[1]) & keep)}};
}
inline D8 abs(D8 a) {
  constexpr std::int64_t kAllButSign = 0x7fff'ffff'ffff'ffff;
  const M2 keep{kAllButSign, kAllButSign};
  for (V2& part : a.v) part = V2(M2(part) & keep);
  return a;
}
inline bool any(MaskF a) { return any_of(a.v[0] | a.v[1]); }
inline bool any(MaskD a) { return any_of((a.v[0] | a.v[1]) | (a.v[2] | a.v[3])); }
/// One bit a lane.
inline unsigned bits(MaskF a) { return bits_of(a.v[0]) | bits_of(a.v[1]) << 4; }
inline F8 to_float(D8 a) { return {{narrow(a.v[0], a.v[1]), narrow(a.v[2], a.v[3])}}; }
inline void store(float* p, F8 a) {
  to_address(p, a.v[0]);
  to_address(p + 4, a.v[1]);
}
/// Writes eight rows of (a, b, c, 0).
inline void store_rows(float* out, F8 a, F8 b, F8 c) {
  const V4 zero{};
  for (int i = 0; i < F8::kParts; ++i, out += 16) {
    const V4 ab_low = low_pairs(a.v[i], b.v[i]), ab_high = high_pairs(a.v[i], b.v[i]);
    const V4 c_low = low_pairs(c.v[i], zero), c_high = high_pairs(c.v[i], zero);
    to_address(out, low_halves(ab_low, c_low));
    to_address(out + 4, high_halves(ab_low, c_low));
    to_address(out + 8, low_halves(ab_high, c_high));
    to_address(out + 12, high_halves(ab_high, c_high));
  }
}

/// Eight 32-bit sums.
struct I8 {
  M4 v[2];
  static I8 zero() { return {}; }
};
inline I8 operator+(I8 a, I8 b) { return {{a.v[0] + b.v[0], a.v[1] + b.v[1]}}; }
/// To nearest, ties to even, for 0 <= a < 2^31.
inline I8 round_to_int(F8 a) { return {{nearest_of(a.v[0]), nearest_of(a.v[1])}}; }
inline void store(std::int32_t* p, I8 a) {
  M4InMemory* const to = reinterpret_cast<M4InMemory*>(p);
  to[0] = a.v[0];
  to[1] = a.v[1];
}
/// Writes `value` to the lanes of `m`.
inline void store_where(MaskF m, std::uint32_t value, std::uint32_t* p) {
  M4InMemory* const to = reinterpret_cast<M4InMemory*>(p);
  const std::int32_t number = static_cast<std::int32_t>(value);
  const M4 all{number, number, number, number};
  for (int i = 0; i < MaskF::kParts; ++i) to[i] = (m.v[i] & all) | (~m.v[i] & to[i]);
}

}  // namespace kerf::KERF_LANES_NAMESPACE
