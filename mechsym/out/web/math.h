#pragma once
/* What the page needs of math.h: the machine's own instructions, and the browser's Math for the rest. */
#define INFINITY __builtin_inf()
#define NAN __builtin_nan("")
#define isfinite(x) __builtin_isfinite(x)
#define fabs __builtin_fabs
#define sqrt __builtin_sqrt
#define floor __builtin_floor
#define ceil __builtin_ceil
#define copysign __builtin_copysign
#define MATH(NAME, ...) __attribute__((import_module("Math"), import_name(#NAME))) double NAME(__VA_ARGS__);
#define ONE(NAME) MATH(NAME, double)
#define TWO(NAME) MATH(NAME, double, double)
ONE(sin) ONE(cos) ONE(tan) ONE(asin) ONE(acos) ONE(atan) ONE(sinh) ONE(cosh) ONE(tanh) ONE(asinh) ONE(acosh) ONE(atanh)
ONE(exp) ONE(log) ONE(expm1) ONE(log1p) TWO(pow) TWO(atan2) TWO(hypot)
static inline double fmin(double a, double b) { return b != b || a < b ? a : b; }
static inline double fmax(double a, double b) { return b != b || a > b ? a : b; }
