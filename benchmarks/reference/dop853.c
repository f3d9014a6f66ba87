/* DOP853 by hand for the two-degree start-up: one run, dense loops over four states, no lanes, no events.
 * Step control as in mechsym's integrator, so that both do the same steps. */
#include "elementary.h"
#include "numbers.h" /* the method's published coefficients */
enum { N = 4 };

static void rates(const double *y, double M, double *f)
{
    const double I0 = 0.26, over_I2 = 1.0 / 0.58, r = 0.06, l = 0.26, m0 = 1.1, k1 = 6500, lam = r / l;
    double s, c;
    ms_sincos(y[0], &s, &c);
    const double sp = lam * s, dsp = lam * c, k = 1.0 / sqrt(1.0 - sp * sp), u = dsp * k, du = sp * (u * u - 1.0) * k;
    const double dx = r * s + l * sp * u, d2x = r * c + l * (dsp * u + sp * du), twist = k1 * (y[0] - y[1]);
    f[0] = y[2];
    f[1] = y[3];
    f[2] = (M - twist - m0 * dx * d2x * y[2] * y[2]) / (I0 + m0 * dx * dx);
    f[3] = twist * over_I2;
}

#define MS_Q(j) q[j - 1][i]
#define STAGE(stage, node, sum)                                                                                       \
    for (int i = 0; i < N; i++)                                                                                       \
        x[i] = y[i] + h * (sum);                                                                                      \
    rates(x, M, q[stage - 1]);

static double first_step(const double *y, const double *f, double M, double tol)
{
    double size = 0, slope = 0, bend = 0, x[N], g[N];
    for (int i = 0; i < N; i++) {
        const double scale = 1.0 / (tol + tol * fabs(y[i]));
        size += y[i] * scale * y[i] * scale;
        slope += f[i] * scale * f[i] * scale;
    }
    const double first = size < 1e-10 * N || slope < 1e-10 * N ? 1e-6 : 0.01 * sqrt(size / slope);
    for (int i = 0; i < N; i++)
        x[i] = y[i] + first * f[i];
    rates(x, M, g);
    for (int i = 0; i < N; i++) {
        const double scale = 1.0 / (tol + tol * fabs(y[i]));
        bend += (g[i] - f[i]) * scale / first * (g[i] - f[i]) * scale / first;
    }
    const double most = sqrt(fmax(slope, bend) / N);
    return fmin(100 * first, most <= 1e-15 ? fmax(1e-6, 1e-3 * first) : pow(0.01 / most, 0.125));
}

long hand_dop853(double t_end, double M, double tol, double *y)
{
    double q[13][N], x[N], next[N], t = 0, h;
    long steps = 0;
    rates(y, M, q[0]);
    h = first_step(y, q[0], M, tol);
    while (t < t_end) {
        const double usual = h;
        const int last = t + 1.01 * h >= t_end;
        if (last)
            h = t_end - t;
        MS_STAGES(STAGE)
        for (int i = 0; i < N; i++)
            next[i] = y[i] + h * (MS_WEIGHTS);
        rates(next, M, q[12]);
        double five = 0, three = 0;
        for (int i = 0; i < N; i++) {
            const double scale = 1.0 / (tol + tol * fmax(fabs(y[i]), fabs(next[i])));
            const double e5 = (MS_ERROR_5) * scale, e3 = (MS_ERROR_3) * scale;
            five += e5 * e5;
            three += e3 * e3;
        }
        const double both = five + 0.01 * three, error = fabs(h) * five / sqrt(N * (both > 0 ? both : 1));
        const double root = sqrt(sqrt(sqrt(error)));
        if (!(error <= 1.0)) {
            h *= fmax(0.9 / root, 1.0 / 3.0);
            continue;
        }
        t = last ? t_end : t + h;
        memcpy(y, next, sizeof next);
        memcpy(q[0], q[12], sizeof q[0]);
        h = last ? fmax(usual, h) : h * fmin(0.9 / sqrt(root), 6.0);
        steps++;
    }
    return steps;
}
