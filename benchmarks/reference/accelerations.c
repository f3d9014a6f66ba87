/* The three systems by hand, as one would write them for speed: one sine, one cosine and one root per crank, every
 * quotient shared, loops over points that the compiler turns into vector code. */
#include "elementary.h"

/* Crank, rod and crosshead lying down; l is the rod, psi its angle, sin psi = lam sin phi. */
void hand_one_dof(long n, const double *restrict phi, const double *restrict w, const double *restrict F,
                  const double *restrict M_r, const double *restrict M_h, double *restrict a)
{
    const double m1 = 80, m2 = 150, m = 150 + 200 + 110, I01 = 30, IC2 = 50, r1 = 0.2, r = 0.5, l1 = 0.8, l2 = 0.75;
    const double l = l1 + l2, g = 9.81, lam = r / l;
    MS_LANES
    for (long i = 0; i < n; i++) {
        double s, c;
        ms_sincos(phi[i], &s, &c);
        const double sp = lam * s, dsp = lam * c, k = 1.0 / sqrt(1.0 - sp * sp), u = dsp * k, du = sp * (u * u - 1.0) * k;
        const double e = sp * u, de = dsp * u + sp * du;
        const double dx = r * s + l * e, d2x = r * c + l * de;
        const double dxr = r * s + l1 * e, d2xr = r * c + l1 * de, dyr = l2 * dsp, d2yr = -l2 * sp;
        const double I = I01 + IC2 * u * u + m * dx * dx + m2 * (dxr * dxr + dyr * dyr);
        const double h = IC2 * u * du + m * dx * d2x + m2 * (dxr * d2xr + dyr * d2yr);
        a[i] = (F[i] * dx - M_r[i] + M_h[i] - g * (m1 * r1 * c + m2 * dyr) - h * w[i] * w[i]) / I;
    }
}

/* Crank with slider on an elastic shaft with a flywheel. */
void hand_two_dof(long n, const double *restrict p0, const double *restrict p2, const double *restrict w0,
                  const double *restrict w2, const double *restrict M, const double *restrict F, double *restrict a0,
                  double *restrict a2)
{
    const double I0 = 0.26, over_I2 = 1.0 / 0.58, r = 0.06, l = 0.26, m0 = 1.1, k1 = 6500, lam = r / l;
    (void)w2;
    MS_LANES
    for (long i = 0; i < n; i++) {
        double s, c;
        ms_sincos(p0[i], &s, &c);
        const double sp = lam * s, dsp = lam * c, k = 1.0 / sqrt(1.0 - sp * sp), u = dsp * k, du = sp * (u * u - 1.0) * k;
        const double dx = r * s + l * sp * u, d2x = r * c + l * (dsp * u + sp * du), twist = k1 * (p0[i] - p2[i]);
        a0[i] = (M[i] + F[i] * dx - twist - m0 * dx * d2x * w0[i] * w0[i]) / (I0 + m0 * dx * dx);
        a2[i] = twist * over_I2;
    }
}

/* Six throws: the columns are phi1..phi6, phi_f, their speeds, F1..F6, M; the phases are known. */
void hand_six_throws(long n, const double *const *x, double *const *y)
{
    enum { N = 6, W = 256 };
    const double r = 0.06, l1 = 0.1, l2 = 0.16, l = l1 + l2, m_rod = 0.8, m = 1.1, I_rod = 0.01, I0 = 0.05, I_f = 0.58;
    const double k = 6500, d = 0.1, lam = r / l;
    double before[W];
    for (long start = 0; start < n; start += W) {
        const long w = n - start < W ? n - start : W;
        for (long i = 0; i < w; i++)
            before[i] = 0.0;
        for (int j = 0; j < N; j++) {
            const double *restrict q = x[j] + start, *restrict q1 = x[j + 1] + start, *restrict v = x[N + 1 + j] + start;
            const double *restrict v1 = x[N + 2 + j] + start, *restrict F = x[2 * N + 2 + j] + start;
            double *restrict a = y[j] + start;
            const double phase = 2 * M_PI * j / N;
            MS_LANES
            for (long i = 0; i < w; i++) {
                double s, c;
                ms_sincos(q[i] + phase, &s, &c);
                const double sp = lam * s, dsp = lam * c, kk = 1.0 / sqrt(1.0 - sp * sp), u = dsp * kk;
                const double du = sp * (u * u - 1.0) * kk, e = sp * u, de = dsp * u + sp * du;
                const double dx = r * s + l * e, d2x = r * c + l * de, dxr = r * s + l1 * e, d2xr = r * c + l1 * de;
                const double dyr = l2 * dsp, d2yr = -l2 * sp;
                const double I = I0 + I_rod * u * u + m * dx * dx + m_rod * (dxr * dxr + dyr * dyr);
                const double h = I_rod * u * du + m * dx * d2x + m_rod * (dxr * d2xr + dyr * d2yr);
                const double torque = k * (q[i] - q1[i]) + d * (v[i] - v1[i]);
                a[i] = (F[i] * dx - h * v[i] * v[i] + before[i] - torque) / I;
                before[i] = torque;
            }
        }
        const double *restrict M = x[3 * N + 2] + start;
        double *restrict a = y[N] + start;
        for (long i = 0; i < w; i++)
            a[i] = (before[i] - M[i]) * (1.0 / I_f);
    }
}
