/* One step of Gauss-Legendre collocation with eight stages, order 16, for one run whose stages lie in the lanes.
 *
 * A single run leaves a processor idle: it waits for one sine, root and quotient after the other. Here eight stages
 * wait together. They are found by fixed-point sweeps that start from the continued series of an earlier step. Where
 * the rate of a state is another state (an angle and its speed) a sweep goes through both at once. What a sweep
 * changes is carried on through the slopes of the rates over the angles, which the stiffness of a shaft dominates: a
 * cheap sweep more. The slopes are differences and may be old; they change the number of sweeps only, not the result.
 *
 * ms_angle[a] is a state whose rate is the state ms_speed[a]; ms_other[o] any other state that a rate depends on.
 */
typedef double ms_eight __attribute__((vector_size(64), may_alias));
typedef long long ms_signs __attribute__((vector_size(64), may_alias));
#define MS_UNROLL _Pragma("GCC unroll 8")

typedef struct {
    ms_eight x[MS_X], k[MS_N];
    ms_eight series[MS_N]; /* Legendre coefficients of the rates over the step that began at `origin` */
    double y[MS_N], lost[MS_N], next[MS_N], rest[MS_N], scale[MS_N];
    double slope[MS_OTHERS][MS_ANGLES];
    double t, h, origin, length;
    long segment, slopes_age, tries, sweeps;
} ms_work;

MS_INLINE ms_eight ms_all(double value) { return value + (ms_eight){0}; }

MS_INLINE ms_eight ms_weigh(const double weights[MS_S][MS_S], const ms_eight *values)
{
    const double *k = (const double *)values;
    ms_eight even = {0}, odd = {0};
    for (int j = 0; j < MS_S; j += 2) {
        even += *(const ms_eight *)weights[j] * k[j];
        odd += *(const ms_eight *)weights[j + 1] * k[j + 1];
    }
    return even + odd;
}

MS_INLINE double ms_dot(const double *weights, const ms_eight *values)
{
    const double *k = (const double *)values;
    double even = 0.0, odd = 0.0;
    for (int j = 0; j < MS_S; j += 2)
        even += weights[j] * k[j], odd += weights[j + 1] * k[j + 1];
    return even + odd;
}

/* The larger of a size and of the size of a value, as bits: those of what is not a number are above all others. */
MS_INLINE ms_signs ms_larger(ms_signs most, ms_eight value)
{
    const ms_signs size = (ms_signs)value & 0x7fffffffffffffffLL, larger = size > most;
    return (size & larger) | (most & ~larger);
}

/* The rates at the stages of a step of length h, from the series of an earlier step. */
static void ms_predict(ms_work *w, double h)
{
    const ms_eight u = (w->t - w->origin + h * *(const ms_eight *)ms_nodes) / w->length, z = 2.0 * u - 1.0;
    MS_UNROLL for (int o = 0; o < ms_others; o++) {
        const double *c = (const double *)&w->series[ms_other[o]];
        ms_eight above = {0}, here = {0};
        for (int n = MS_S - 1; n >= 0; n--) {
            const ms_eight below = c[n] + (2.0 * n + 1.0) / (n + 1.0) * z * here - (n + 1.0) / (n + 2.0) * above;
            above = here, here = below;
        }
        w->k[ms_other[o]] = here;
    }
    w->x[0] = w->t + h * *(const ms_eight *)ms_nodes;
}

static __attribute__((noinline)) void ms_evaluate(const ms_run *run, const ms_work *w, ms_eight *rate)
{
    MS_RATES(run->constants, (const double *)w->x, (double *)rate);
}

/* Differences of the rates over the angles, several angles in the lanes of one evaluation. */
static void ms_take_slopes(const ms_run *run, ms_work *w)
{
    for (int first = 0; first < ms_angles; first += MS_S - 1) {
        const int last = first + MS_S - 1 < ms_angles ? first + MS_S - 1 : ms_angles;
        double size[MS_S];
        ms_eight rate[MS_N];
        w->x[0] = ms_all(w->t);
        for (int i = 0; i < MS_N; i++)
            w->x[1 + i] = ms_all(w->y[i]);
        for (int a = first, l = 1; a < last; a++, l++)
            ((double *)&w->x[1 + ms_angle[a]])[l] += size[l] = 1e-7 * ms_fmax(1.0, fabs(w->y[ms_angle[a]]));
        ms_evaluate(run, w, rate);
        for (int o = 0; o < ms_others; o++)
            for (int a = first, l = 1; a < last; a++, l++) {
                const double *f = (const double *)&rate[ms_other[o]];
                w->slope[o][a] = isfinite(f[l] - f[0]) ? (f[l] - f[0]) / size[l] : 0.0;
            }
    }
    w->slopes_age = 0;
}

/* One sweep; returns the largest change of a state over the step, in units of the tolerance, or not a number. */
static double ms_sweep(const ms_run *run, ms_work *w, double h)
{
    ms_eight change[MS_N], moved[MS_ANGLES];
    ms_signs most = {0};
    memcpy(change, w->k, sizeof change);
    MS_UNROLL for (int a = 0; a < ms_angles; a++)
        w->x[1 + ms_angle[a]] = w->y[ms_angle[a]] + (h * w->y[ms_speed[a]] * *(const ms_eight *)ms_nodes
                                                     + h * h * ms_weigh(ms_twice, &w->k[ms_speed[a]]));
    MS_UNROLL for (int o = 0; o < ms_others; o++)
        w->x[1 + ms_other[o]] = w->y[ms_other[o]] + h * ms_weigh(ms_once, &w->k[ms_other[o]]);
    MS_RATES(run->constants, (double *)w->x, (double *)w->k);
    MS_UNROLL for (int o = 0; o < ms_others; o++) {
        change[ms_other[o]] = w->k[ms_other[o]] - change[ms_other[o]];
        most = ms_larger(most, change[ms_other[o]] * w->scale[ms_other[o]]);
    }
    MS_UNROLL for (int a = 0; a < ms_angles; a++)
        moved[a] = h * h * ms_weigh(ms_twice, &change[ms_speed[a]]);
    MS_UNROLL for (int o = 0; o < ms_others; o++)
        MS_UNROLL for (int a = 0; a < ms_angles; a++)
            w->k[ms_other[o]] += w->slope[o][a] * moved[a];
    ms_bits worst = 0;
    for (int l = 0; l < MS_S; l++)
        worst = (ms_bits)most[l] > worst ? (ms_bits)most[l] : worst;
    return h * ms_from_bits(worst);
}

/* What rounding alone changes from sweep to sweep, in units of the tolerance: an angle of 1e5 rad in a stiff shaft is
 * far above 1e-16 of a speed. Sweeps that only stagnate or grow slowly stay above it. Of states that are no angles it
 * is only known that a sweep, if it converges at all, makes their rounding no larger. */
static double ms_noise(const ms_work *w, double h)
{
    double large = 0.0, most = 0.0;
    for (int o = 0; o < ms_others; o++)
        large = ms_fmax(large, fabs(w->y[ms_other[o]]));
    for (int o = 0; o < ms_others; o++) {
        double sum = large + h * fabs(w->k[ms_other[o]][0]);
        for (int a = 0; a < ms_angles; a++)
            sum += h * fabs(w->slope[o][a] * w->y[ms_angle[a]]);
        most = ms_fmax(most, sum * w->scale[ms_other[o]]);
    }
    return 2e-15 * most;
}

/* Sweeps until the step is known to a tenth of the tolerance, or to rounding; returns their number, 0 if they fail. */
static int ms_solve(const ms_run *run, ms_work *w, double h)
{
    ms_predict(w, h);
    /* an integral over the motion has seen the stages as they were before the last change */
    const double enough = ms_angles + ms_others < MS_N ? 0.3 : INFINITY;
    double before = INFINITY, best = INFINITY;
    for (int sweep = 1, idle = 0; sweep <= 25; sweep++) {
        const double change = ms_sweep(run, w, h), ratio = change / before;
        w->sweeps++;
        if (change == 0.0 || (sweep > 1 && change <= enough && change * ratio <= 0.1 * (1.0 - ratio)))
            return sweep;
        idle = change < best ? 0 : idle + 1;
        if (idle == 2 || (sweep > 4 && ratio > 0.8)) {
            const int rounding = change <= ms_noise(w, h);
            if (idle == 2)
                return rounding ? sweep : 0;
            if (!rounding)
                return 0;
        }
        before = change;
        best = ms_fmin(best, change);
    }
    return 0;
}

/* The state at the end of a step whose stages are known, summed with compensation. */
static void ms_close(ms_work *w, double h)
{
    double sum[MS_N];
    for (int i = 0; i < MS_N; i++)
        sum[i] = ms_dot(ms_weights, &w->k[i]);
    for (int a = 0; a < ms_angles; a++)
        sum[ms_angle[a]] = w->y[ms_speed[a]] + h * ms_dot(ms_double_weights, &w->k[ms_speed[a]]);
    for (int i = 0; i < MS_N; i++) {
        const double rise = h * sum[i] + w->lost[i];
        w->next[i] = w->y[i] + rise;
        w->rest[i] = rise - (w->next[i] - w->y[i]);
    }
}

/* Keep the rates of a step as a series, and estimate its error from how the series falls off.
 *
 * Coefficients that fall like q^n leave an error like q^17 at the end; one like q^15 is asked to keep the tolerance. */
static double ms_judge(ms_work *w, double h)
{
    double sum = 0.0;
    w->origin = w->t, w->length = h;
    for (int i = 0; i < MS_N; i++) {
        w->series[i] = ms_weigh(ms_to_series, &w->k[i]);
        const double *c = (const double *)&w->series[i];
        const double low = ms_fmax(fabs(c[4]), fabs(c[5])), high = ms_fmax(fabs(c[6]), fabs(c[7]));
        const double square = low > high ? high / low : high <= low ? 0.0 : 1.0;
        const double error = h * high * w->scale[i] * (square * square) * (square * square);
        sum += error * error;
    }
    return sqrt(sum / MS_N);
}
