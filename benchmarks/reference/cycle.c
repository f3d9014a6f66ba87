/* The engine cycle of the fifth problem by hand, speeds side by side; combustion is looked at only while some speed of
 * the block burns, and the broken power is exp(0.7 log). */
#include "elementary.h"
enum { W = 64 };

/* stage[step] = end of the step in degrees, volumes at start and end, lever and second derivative of the travel at the
 * end; result = peak pressure, mean torque of both pistons, largest torque of one, each [n]. */
void hand_cycle(long steps, long n, const double *stage, const double *omega, const double *constants, double *result)
{
    const double p0 = constants[0], T0 = constants[1], gas = constants[2], fuel = constants[3], heat = constants[4];
    const double bore = constants[5], area = constants[6], mass = constants[7], speed = constants[8], R = 287.0;
    const double pi = 3.14159265358979323846, Tw = 350.0;
    for (long start = 0; start < n; start += W) {
        const long w = n - start < W ? n - start : W;
        double p[W], T[W], m[W], burnt[W], top[W], sum[W], most[W], begin[W], over[W], vapour[W], first = 1e9, last = 0;
        for (long i = 0; i < w; i++) {
            const double rpm = omega[start + i] * 30 / pi;
            p[i] = top[i] = p0, T[i] = T0, m[i] = gas, burnt[i] = sum[i] = most[i] = 0;
            begin[i] = 350.93 - 0.0004 * rpm, over[i] = 1 / (30.663 + 0.0027 * rpm), vapour[i] = fuel / (begin[i] - 180);
            first = begin[i] < first ? begin[i] : first;
            last = begin[i] + 1 / over[i] > last ? begin[i] + 1 / over[i] : last;
        }
        for (long j = 0; j < steps; j++) {
            const double end = stage[5 * j], V1 = stage[5 * j + 1], V2 = stage[5 * j + 2], lever = stage[5 * j + 3];
            const double bend = mass * stage[5 * j + 4] * lever, over_V = 1 / (6 * V2 - V1), V6 = (6 * V1 - V2) * over_V;
            const double walls = (2 * area + 4 * V2 / bore) * pi / 180, push = area * lever, V_over_R = V2 / R;
            double released[W];
            for (long i = 0; i < w; i++)
                released[i] = 0;
            if (end > first && end <= last) {
                MS_LANES
                for (long i = 0; i < w; i++) {
                    const double y = (end - begin[i]) * over[i], z = y > 0 ? y : 0, X = 1 - ms_exp(-5 * z * z * z);
                    const double next = y <= 1 && X > burnt[i] ? X : burnt[i];
                    released[i] = heat * (next - burnt[i]);
                    burnt[i] = next;
                }
            }
            const double *restrict om = omega + start;
            MS_LANES
            for (long i = 0; i < w; i++) {
                const double t = T[i], mu = 7.457e-6 + t * (4.1547e-8 - 7.4793e-12 * t);
                const double k = 6.1944e-3 + t * (7.3814e-5 - 1.2491e-8 * t), over_om = 1 / om[i];
                const double Re = p[i] * om[i] * speed * bore / (R * t * mu);
                const double h = k / bore * 0.49 * ms_exp(0.7 * ms_log(Re)), t2 = t * t;
                const double flux = h * (t - Tw) + 4.25e-9 * (t2 * t2 - Tw * Tw * Tw * Tw);
                const double drop = end <= begin[i] ? vapour[i] : 0;
                const double q = released[i] - flux * walls * over_om - 4e5 * drop;
                const double next = 2 * q * over_V + p[i] * V6;
                m[i] += drop;
                T[i] = next * V_over_R / m[i];
                p[i] = next;
                top[i] = next > top[i] ? next : top[i];
                const double torque = next * push - bend * om[i] * om[i];
                sum[i] += torque;
                most[i] = torque > most[i] ? torque : most[i];
            }
        }
        for (long i = 0; i < w; i++) {
            result[start + i] = top[i];
            result[n + start + i] = 2 * sum[i] / 721;
            result[2 * n + start + i] = most[i];
        }
    }
}
