/* Elementary functions without branches, so that a loop over points or lanes becomes vector instructions.
 *
 * gcc turns sin(x) and cos(x) of one angle into a call that blocks vectorisation; these do not. Largest error against
 * 60 digits (tests/native/test_elementary.py checks these bounds): sine and cosine 2 ulp for |x| < 1e8 and 3e-16 up to
 * 1e10, tan 3 ulp, exp and log 1.5 ulp, hypot 2 ulp, pow 1.5 ulp where |y log x| < 30 and 16 ulp beyond,
 * asin 3 ulp.
 * Infinite exponents, and powers of what is not a number, give what is not a number.
 * Where digits cancel the subtraction is inside an fma, which no compiler option may reorder.
 */
#include <math.h>
#include <string.h>

#if defined(__clang__)
#define MS_LANES _Pragma("clang loop vectorize(assume_safety) interleave(disable)")
#else
#define MS_LANES _Pragma("GCC ivdep")
#endif
#define MS_INLINE static inline __attribute__((always_inline, unused))
typedef unsigned long long ms_bits;

MS_INLINE ms_bits ms_to_bits(double x)
{
    ms_bits u;
    memcpy(&u, &x, sizeof u);
    return u;
}

MS_INLINE double ms_from_bits(ms_bits u)
{
    double x;
    memcpy(&x, &u, sizeof x);
    return x;
}

/* a * b + c in a polynomial, where the rounding between does not matter */
#ifdef __FP_FAST_FMA
#define MS_MADD(a, b, c) fma(a, b, c)
#else
#define MS_MADD(a, b, c) ((a) * (b) + (c))
#endif

/* Cody and Waite: x - n pi/2 in three pieces of 33, 53 and 53 bits; kernels on [-pi/4, pi/4] from fdlibm, summed in
 * pairs, because a single run waits for this result in every stage. */
MS_INLINE void ms_sincos(double x, double *sine, double *cosine)
{
    /* adding 1.5 * 2^52 rounds to an integer and puts it into the low bits */
    const double shifted = MS_MADD(x, 0x1.45f306dc9c883p-1, 6755399441055744.0), n = shifted - 6755399441055744.0;
    const double near = fma(-n, 0x1.0b4611a626331p-34, fma(-n, 0x1.921fb544p+0, x));
    const double r = fma(-n, 0x1.1701b839a2520p-88, near), z = near * near, z2 = z * z;
    const double s12 = MS_MADD(z, 8.33333333332248946124e-03, -1.66666666666666324348e-01);
    const double s34 = MS_MADD(z, 2.75573137070700676789e-06, -1.98412698298579493134e-04);
    const double s56 = MS_MADD(z, 1.58969099521155010221e-10, -2.50507602534068634195e-08);
    const double s = MS_MADD(r * z, MS_MADD(z2, MS_MADD(z2, s56, s34), s12), r);
    const double c12 = MS_MADD(z, -1.38888888888741095749e-03, 4.16666666666666019037e-02);
    const double c34 = MS_MADD(z, -2.75573143513906633035e-07, 2.48015872894767294178e-05);
    const double c56 = MS_MADD(z, -1.13596475577881948265e-11, 2.08757232129817482790e-09);
    const double c = MS_MADD(z2, MS_MADD(z2, MS_MADD(z2, c56, c34), c12), MS_MADD(z, -0.5, 1.0));
    const ms_bits q = ms_to_bits(shifted);
    const double a = (q & 1) ? c : s, b = (q & 1) ? s : c;
    *sine = ms_from_bits(ms_to_bits(a) ^ ((q & 2) << 62));
    *cosine = ms_from_bits(ms_to_bits(b) ^ (((q + 1) & 2) << 62));
}

MS_INLINE double ms_tan(double x)
{
    double s, c;
    ms_sincos(x, &s, &c);
    return s / c;
}

/* exp(r + tail) 2^k for |r| < 0.35: Taylor series, summed in pairs; the power of two in two factors so that the ends
 * are right. */
MS_INLINE double ms_exp_scaled(double k, double r)
{
    const double r2 = r * r, r4 = r2 * r2;
    const double p01 = MS_MADD(r2, MS_MADD(r, 1.0 / 120, 1.0 / 24), MS_MADD(r, 1.0 / 6, 0.5));
    const double p23 = MS_MADD(r2, MS_MADD(r, 1.0 / 362880, 1.0 / 40320), MS_MADD(r, 1.0 / 5040, 1.0 / 720));
    const double p45 =
        MS_MADD(r2, MS_MADD(r, 1.0 / 6227020800.0, 1.0 / 479001600), MS_MADD(r, 1.0 / 39916800, 1.0 / 3628800));
    const double p = MS_MADD(r2, MS_MADD(r4, MS_MADD(r4, p45, p23), p01), r);
    const double half = floor(0.5 * k), rest = k - half;
    const double one = ms_from_bits(ms_to_bits(half + 4503599627371519.0) << 52);
    const double two = ms_from_bits(ms_to_bits(rest + 4503599627371519.0) << 52);
    return (1.0 + p) * one * two;
}

MS_INLINE double ms_exp(double x)
{
    const double upper = x > 710.0 ? 710.0 : x, clamped = upper < -746.0 ? -746.0 : upper;
    const double k = rint(clamped * 0x1.71547652b82fep+0);
    const double r = fma(-k, 0x1.62e42feep-1, clamped);
    return ms_exp_scaled(k, fma(-k, 0x1.a39ef35793c76p-33, r));
}

/* x = 2^k (1 + f) with sqrt(1/2) <= 1 + f < sqrt(2); a subnormal x is scaled up first. */
MS_INLINE void ms_split(double x, double *k, double *f)
{
    const int tiny = x < 2.2250738585072014e-308;
    const ms_bits u = ms_to_bits(tiny ? x * 18014398509481984.0 : x) + 0x00095f6200000000ull;
    const double e = ms_from_bits((u >> 52) | 0x4330000000000000ull) - 4503599627371519.0;
    *k = tiny ? e - 54.0 : e;
    *f = ms_from_bits((u & 0x000fffffffffffffull) + 0x3fe6a09e00000000ull) - 1.0;
}

MS_INLINE double ms_log_series(double z)
{
    const double z2 = z * z, l12 = MS_MADD(z, 3.999999999940941908e-01, 6.666666666666735130e-01);
    const double l34 = MS_MADD(z, 2.222219843214978396e-01, 2.857142874366239149e-01);
    const double l567 =
        MS_MADD(z2, 1.479819860511658591e-01, MS_MADD(z, 1.531383769920937332e-01, 1.818357216161805012e-01));
    return z * MS_MADD(z2, MS_MADD(z2, l567, l34), l12);
}

MS_INLINE double ms_log(double x)
{
    double k, f;
    ms_split(x, &k, &f);
    const double s = f / (2.0 + f), half = 0.5 * f * f;
    const double tail = fma(k, 1.90821492927058770002e-10, s * (half + ms_log_series(s * s)));
    const double y = fma(k, 6.93147180369123816490e-01, f - (half - tail));
    const double finite = x > 0.0 ? y : (x == 0.0 ? -INFINITY : NAN);
    return x == INFINITY ? x : finite;
}

/* What is not a number stays so, beside infinity too. */
MS_INLINE double ms_hypot(double x, double y)
{
    const double a = fabs(x), b = fabs(y), sum = a + b;
    const int first = a > b;
    const double most = first ? a : b, least = first ? b : a, share = least / (most > 0.0 ? most : 1.0);
    const double value = most * sqrt(MS_MADD(share, share, 1.0)), finite = most == INFINITY ? most : value;
    return sum != sum ? sum : finite;
}

/* log(x) as high + low with about 60 bits, for x > 0. */
MS_INLINE void ms_log_long(double x, double *high, double *low)
{
    double k, f;
    ms_split(x, &k, &f);
    const double g = 1.0 / (2.0 + f), s = f * g;
    const double s_low = g * fma(-s, f, fma(-2.0, s, f));
    *high = fma(k, 0x1.62e42feep-1, 2.0 * s);
    const double lost = 2.0 * s - fma(-k, 0x1.62e42feep-1, *high);
    *low = lost + fma(k, 0x1.a39ef35793c76p-33, 2.0 * s_low + s * ms_log_series(s * s));
}

/* exp(y (high + low)), where full = y (high + low) to one rounding, or infinite. */
MS_INLINE double ms_exp_long(double y, double high, double low, double full)
{
    const double product = y * high;
    const double upper = full > 750.0 ? 750.0 : full, clamped = upper < -750.0 ? -750.0 : upper;
    const double n = rint(clamped * 0x1.71547652b82fep+0);
    const double rest = fma(y, low, fma(y, high, -product));
    const double r = fma(-n, 0x1.a39ef35793c76p-33, fma(-n, 0x1.62e42feep-1, product)) + rest;
    return ms_exp_scaled(n, clamped == full ? r : 0.0);
}

MS_INLINE double ms_pow(double x, double y)
{
    double high, low;
    const double a = fabs(x);
    ms_log_long(a, &high, &low);
    const double inside = ms_exp_long(y, high, low, y * (high + low));
    /* what depends on the exponent alone is a number, not a condition: it may be the same for all points of a loop */
    const double at_zero = y > 0.0 ? 0.0 : y < 0.0 ? INFINITY : 1.0, at_infinity = 1.0 / at_zero;
    const double whole = rint(y), broken = whole == y ? 1.0 : NAN;
    const double odd = fma(-2.0, floor(0.5 * whole), whole) == 1.0 ? broken : 0.0, flip = odd == 1.0 ? -1.0 : 1.0;
    const double usual = a == 0.0 ? at_zero : inside, size = a == INFINITY ? at_infinity : usual;
    const double value = copysign(1.0, x) < 0.0 ? flip * size : size, real = x < 0.0 ? broken * value : value;
    return x != x ? x : real;
}

/* The same for an exponent that is finite and not whole: no condition asks for it, so a loop that shares it becomes
 * vector code. */
MS_INLINE double ms_pow_broken(double x, double y)
{
    double high, low;
    ms_log_long(x, &high, &low);
    const double finite = x > 0.0 ? high + low : x == 0.0 ? -INFINITY : NAN;
    const double inside = ms_exp_long(y, high, low, y * (x == INFINITY ? x : finite));
    return x >= 0.0 ? inside : NAN;
}

/* fdlibm's rational function on [0, 1/2]; beyond it asin x = pi/2 - 2 asin sqrt((1 - x)/2). */
MS_INLINE double ms_asin(double x)
{
    const double a = fabs(x);
    const int far = a > 0.5;
    const double z = far ? 0.5 * (1.0 - a) : a * a, s = far ? sqrt(z) : a;
    const double p = z * (1.66666666666666657415e-01 + z * (-3.25565818622400915405e-01
        + z * (2.01212532134862925881e-01 + z * (-4.00555345006794114027e-02
        + z * (7.91534994289814532176e-04 + z * 3.47933107596021167570e-05)))));
    const double q = 1.0 + z * (-2.40339491173441421878e+00 + z * (2.02094576023350569471e+00
        + z * (-6.88283971605453293030e-01 + z * 7.70381505559019352791e-02)));
    const double near = s + s * (p / q);
    const double y = far ? fma(-2.0, near, 6.12323399573676603587e-17) + 1.57079632679489655800e+00 : near;
    return copysign(y, x);
}

/* A NaN gives way to the other number, as fmin and fmax of C have it. */
MS_INLINE double ms_fmin(double a, double b)
{
    const double smaller = a < b ? a : b;
    return b != b ? a : smaller;
}

MS_INLINE double ms_fmax(double a, double b)
{
    const double larger = a > b ? a : b;
    return b != b ? a : larger;
}
