// base/portable_math.h - sine and its like with the same bits on every processor.
#pragma once

/// The C library picks its variant of sin() by the processor that it runs on, and those differ in
/// the last bit now and then. What decides the contents of a workpiece takes these instead, so that
/// its digest is the same everywhere: sums, products, quotients and square roots alone, each of
/// which IEEE 754 rounds in one way (and -ffp-contract=off keeps them apart).
///
/// Errors, in units of the last place, at most (portable_math_test): sin, cos 0.8; hypot 1.2; atan2
/// 1.6; tan, asin, acos 2.5. About as fast as the C library's.
namespace kerf::portable {

struct SinCos {
  double sin, cos;
};

/// Radians. Beyond 1e6 (a rotary axis at 160 000 turns) as the C library has it.
double sin(double angle_rad);
double cos(double angle_rad);
SinCos sin_cos(double angle_rad);
double tan(double angle_rad);

/// Radians, from -pi to pi; zeros with their signs, and infinite values, as in IEEE 754.
double atan2(double y, double x);
double atan(double x);
/// Not a number beyond -1 .. 1.
double asin(double x);
double acos(double x);

/// sqrt(x^2 + y^2 (+ z^2)), for lengths whose squares are numbers (below 1e150, above 1e-150).
double hypot(double x, double y);
double hypot(double x, double y, double z);

}  // namespace kerf::portable
