/* A machine in time: curves, events and DOP853 with error control. Included after model.h and method.h.
 *
 * All of the state is one plain struct, so that keeping and restoring it is a copy. Between events the pieces of the
 * curves are fixed by the span [low, high] of each kinked coordinate; a step that leaves its span is shortened until
 * it ends on the edge.
 */
#include <math.h>
#include <stddef.h>

/* value references, in this order: time, states, rates, inputs, parameters, outputs, event indicators */
enum { R_X = 1, R_D = R_X + NX, R_U = R_D + NX, R_P = R_U + NU, R_Y = R_P + NP, R_Z = R_Y + NY, R_END = R_Z + NA + NE };
enum { NZ = NA + NE };

typedef struct {
    double t, x[NX], u[NU + 1], p[NP + 1], s[NS + 1];
    double low[NK + 1], high[NK + 1]; /* span of each kinked coordinate */
    double d[NX], y[NY + 1];          /* rates and outputs, valid while fresh */
    double h, tolerance, start;
    int side[NE + 1];  /* whether a stop's state is above its level */
    int stopped, fresh; /* index of the stop that was met, or -1 */
} machine;

static const double CLOSE = 1e-9; /* of a period: what counts as standing on a kink */
static const double NOISE = 10.0; /* error of a step, in tolerances, that is not for its length */
enum { TRIES = 12 };              /* of lengths that step over it */
enum { OFF = 100 };               /* tolerances that a state may be off its loops between two events */

static int piece_of(const struct curve *c, double at)
{
    int low = 0, high = c->pieces;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (at < c->breaks[middle])
            high = middle;
        else
            low = middle;
    }
    return low;
}

/* Value, slope and curvature of a curve over its argument; `inside` says which piece counts. */
static void curve_at(const struct curve *c, double arg, double inside, double out[3])
{
    const double first = c->breaks[0], last = c->breaks[c->pieces];
    double value = 0.0, slope = 0.0, bend = 0.0;
    if (c->periodic) {
        const double turn = floor((inside - first) / (last - first)) * (last - first);
        arg -= turn;
        inside -= turn;
    } else {
        inside = arg < first ? first : arg > last ? last : arg;
    }
    int i = piece_of(c, inside);
    if (c->periodic && fabs(arg - inside) > 0.5 * (c->breaks[i + 1] - c->breaks[i])) {
        inside = arg < first ? arg + (last - first) : arg >= last ? arg - (last - first) : arg;
        arg = inside;
        i = piece_of(c, inside);
    }
    const double z = (c->periodic ? arg : inside) - c->breaks[i];
    for (int k = 0; k < c->terms; k++) {
        bend = bend * z + 2.0 * slope;
        slope = slope * z + value;
        value = value * z + c->rows[i * c->terms + k];
    }
    const double held = c->periodic || arg == inside ? 1.0 : 0.0;
    out[0] = value;
    out[1] = held * slope;
    out[2] = held * bend;
}

static void curve_values(const machine *m, const struct curve *c, double q, double out[3])
{
    double inside = q;
    for (int n = 0; n < NK; n++)
        if (kinks[n].state == c->state && kinks[n].count) {
            const double near = CLOSE * kinks[n].period;
            inside = q < m->low[n] + near ? m->low[n] + near : q > m->high[n] - near ? m->high[n] - near : q;
        }
    curve_at(c, c->ratio * q - c->shift, c->ratio * inside - c->shift, out);
}

static void core_values(const machine *m, double t, const double *x, double *v)
{
    v[0] = t;
    for (int i = 0; i < NX; i++)
        v[VX + i] = x[i];
    for (int i = 0; i < NU; i++)
        v[VU + i] = m->u[i];
    for (int i = 0; i < NP; i++)
        v[VP + i] = m->p[i];
#if LOOPS
    double on[NX];
    closed(v, on);
    for (int i = 0; i < NX; i++)
        v[VX + i] = on[i];
#endif
    for (int i = 0; i < NC; i++) {
        double found[3];
        curve_values(m, &curves[i], v[VX + curves[i].state], found);
        v[VW + 2 * i] = found[0];
        v[VW + 2 * i + 1] = found[1];
    }
    for (int i = 0; i < NS; i++)
        v[VS + i] = m->s[i];
}

static void core_rates(const machine *m, double t, const double *x, double *d)
{
    double v[NV];
    core_values(m, t, x, v);
    rates(v, d);
}

/* Span, switches and sides that belong to the state now; the only place where they change. */
static void core_update(machine *m)
{
    for (int n = 0; n < NK; n++) {
        const int i = kinks[n].state, count = kinks[n].count;
        const double period = kinks[n].period, *angles = kinks[n].angles;
        if (!count)
            continue;
        const double q = m->x[i] + (m->x[NQ + i] < 0.0 ? -CLOSE : CLOSE) * period;
        const double turn = floor(q / period) * period;
        int k = 0;
        while (k < count && angles[k] <= q - turn)
            k++;
        m->low[n] = k ? angles[k - 1] + turn : angles[count - 1] + turn - period;
        m->high[n] = k < count ? angles[k] + turn : angles[0] + turn + period;
    }
    for (int i = 0; i < NS; i++)
        m->s[i] = m->t >= m->p[switch_time[i]] ? 1.0 : 0.0;
    for (int i = 0; i < NE; i++)
        m->side[i] = m->x[stops[i].state] > stops[i].level;
    m->fresh = 0;
}

static void core_start(machine *m)
{
    char *bytes = (char *)m;
    for (size_t i = 0; i < sizeof *m; i++)
        bytes[i] = 0;
    for (int i = 0; i < NX; i++)
        m->x[i] = start_x[i];
    for (int i = 0; i < NP; i++)
        m->p[i] = start_p[i];
    m->tolerance = 1e-10;
    m->stopped = -1;
    core_update(m);
}

static double core_next_switch(const machine *m)
{
    double next = INFINITY;
    for (int i = 0; i < NS; i++)
        if (m->p[switch_time[i]] > m->t && m->p[switch_time[i]] < next)
            next = m->p[switch_time[i]];
    return next;
}

static void core_indicators(const machine *m, double *z)
{
    int k = 0;
    for (int n = 0; n < NK; n++)
        for (int i = 0; i < kinks[n].count; i++)
            z[k++] = sin((m->x[kinks[n].state] - kinks[n].angles[i]) * 3.14159265358979323846 / kinks[n].period);
    for (int i = 0; i < NE; i++)
        z[k++] = m->x[stops[i].state] - stops[i].level;
}

/* A stop that the state has passed in its sense since the last update, or -1. */
static int core_met(const machine *m, const double *x)
{
    for (int i = 0; i < NE; i++) {
        const int above = x[stops[i].state] > stops[i].level;
        if (above != m->side[i] && (stops[i].sense == 0 || (stops[i].sense > 0) == above))
            return i;
    }
    return -1;
}

/* Put a state back that is off the loops that close by constraint by more than so many tolerances; whether it was. Left
 * as it is, what it is off would turn into the motion where two motions meet. */
static int core_close(machine *m, double most)
{
    double off = 0.0, v[NV];
    if (!LOOPS)
        return 0;
    core_values(m, m->t, m->x, v);
    for (int i = 0; i < NX; i++) {
        const double gap = fabs(v[VX + i] - m->x[i]) / (m->tolerance * (1.0 + fabs(v[VX + i])));
        off = gap > off ? gap : off;
    }
    for (int i = 0; off > most && i < NX; i++)
        m->x[i] = v[VX + i];
    return off > most;
}

/* What of an error rate over h is left when the state is put on its loops: near where two motions meet the rest is large
 * by rounding. */
static void core_along(const machine *m, const double *x, double h, double *error)
{
    double moved[NX], here[NV], there[NV];
    for (int i = 0; i < NX; i++)
        moved[i] = x[i] + h * error[i];
    core_values(m, m->t, x, here);
    core_values(m, m->t, moved, there);
    for (int i = 0; i < NX; i++)
        error[i] = (there[VX + i] - here[VX + i]) / h;
}

#define MS_Q(j) k[j - 1][i]
#define CORE_STAGE(stage, node, sum)                                                                                   \
    for (int i = 0; i < NX; i++)                                                                                       \
        z[i] = m->x[i] + h * (sum);                                                                                    \
    core_rates(m, m->t + node * h, z, k[stage - 1]);

/* One step of DOP853 over h; its error in units of the tolerance, of `along` what is left on the loops. */
static double core_try(const machine *m, double h, double *next, int along)
{
    double k[16][NX], z[NX], e5[NX], e3[NX], five = 0.0, three = 0.0;
    core_rates(m, m->t, m->x, k[0]);
    MS_STAGES(CORE_STAGE)
    for (int i = 0; i < NX; i++) {
        next[i] = m->x[i] + h * (MS_WEIGHTS);
        e5[i] = MS_ERROR_5;
        e3[i] = MS_ERROR_3;
    }
    if (along) {
        core_along(m, next, h, e5);
        core_along(m, next, h, e3);
    }
    for (int i = 0; i < NX; i++) {
        const double a = fabs(m->x[i]), b = fabs(next[i]), scale = 1.0 / (m->tolerance * (1.0 + (a > b ? a : b)));
        five += e5[i] * e5[i] * scale * scale;
        three += e3[i] * e3[i] * scale * scale;
    }
    const double both = five + 0.01 * three;
    return h * five / sqrt(NX * (both > 0.0 ? both : 1.0));
}

/* A surface that a step would cross: state and level of a span's edge or a stop; 0 when there is none. */
static int core_crossed(const machine *m, const double *next, int *state, double *level)
{
    for (int n = 0; n < NK; n++) {
        const double q = next[kinks[n].state];
        if (kinks[n].count && (q > m->high[n] || q < m->low[n])) {
            *state = kinks[n].state;
            *level = q > m->high[n] ? m->high[n] : m->low[n];
            return 1;
        }
    }
    const int met = core_met(m, next);
    if (met >= 0 && next[stops[met].state] != stops[met].level) {
        *state = stops[met].state;
        *level = stops[met].level;
        return 1;
    }
    return 0;
}

/* Shorten a step so that it ends where the state meets the level (Illinois rule). */
static double core_shorten(const machine *m, double h, int state, double level, double *next)
{
    double a = 0.0, b = h, fa = m->x[state] - level, fb = next[state] - level;
    if (fa == 0.0)
        return h; /* stood on it already */
    for (int n = 0; n < 100 && b - a > 1e-16 * (fabs(m->t) + h) && fb != 0.0; n++) {
        double c = b - fb * (b - a) / (fb - fa);
        if (!(c > a && c < b) || n % 8 == 7)
            c = 0.5 * (a + b);
        core_try(m, c, next, 0);
        const double fc = next[state] - level;
        if ((fc > 0.0) == (fb > 0.0) || fc == 0.0) {
            b = c;
            fb = fc;
            fa *= 0.5;
        } else {
            a = c;
            fa = fc;
        }
        if (fabs(fc) <= 4e-16 * (fabs(level) + fabs(fb))) {
            b = c;
            break;
        }
    }
    core_try(m, b, next, 0);
    next[state] = level;
    return b;
}

/* Where two motions meet a stage may fall so near that it is all rounding: a length that steps over it, else one whose
 * error is not in the motion. The error of the step, whose length is changed. */
static double core_other(const machine *m, double *h, double error, double *next)
{
    for (int along = 0; along < 2; along++)
        for (int k = along ? 0 : 1; k < TRIES; k++) {
            const double other = *h * (1.0 - 0.6 * k / TRIES), now = core_try(m, other, next, along);
            if (now <= 1.0) {
                *h = other;
                return now;
            }
        }
    return error;
}

/* Integrate to t_end or to a stop; 0 when the step became too small or the state is no number. */
static int core_advance(machine *m, double t_end)
{
    core_update(m);
    if (!(m->h > 0.0))
        m->h = 1e-3 * (t_end - m->t);
    for (long n = 0; m->t < t_end && m->stopped < 0; n++) {
        const double jump = core_next_switch(m), target = jump < t_end ? jump : t_end;
        double next[NX], level = 0.0, h = m->h < target - m->t ? m->h : target - m->t;
        int state = 0, cut = 0;
        if (n > 10000000 || m->t + h <= m->t)
            return 0;
        double error = core_try(m, h, next, 0);
        if (LOOPS && !(error <= NOISE))
            error = core_other(m, &h, error, next);
        const double grow = 0.9 * pow(error > 1e-12 ? error : 1e-12, -0.125);
        if (!(error <= 1.0)) {
            /* an error that is no number: the step left the range of the functions */
            m->h = h * (error > 1.0 && grow > 0.2 ? grow : 0.2);
            continue;
        }
        const int last = h == target - m->t;
        const double proposed = h * (grow < 6.0 ? grow : 6.0);
        for (; cut < 2 * NK + NE + 1 && core_crossed(m, next, &state, &level); cut++)
            h = core_shorten(m, h, state, level, next);
        if (!cut)
            m->h = last && proposed < m->h ? m->h : proposed;
        m->t = last && !cut ? target : m->t + h;
        for (int i = 0; i < NX; i++)
            m->x[i] = next[i];
        if (!cut)
            core_close(m, 0.0);
        m->stopped = core_met(m, m->x);
        core_update(m);
    }
    m->fresh = 0;
    return 1;
}

static void core_refresh(machine *m)
{
    double v[NV];
    if (m->fresh)
        return;
    core_values(m, m->t, m->x, v);
    rates(v, m->d);
    observed(v, m->y);
    m->fresh = 1;
}

static int core_get(machine *m, unsigned r, double *value)
{
    if (r >= R_END)
        return 0;
    if (r == 0)
        *value = m->t;
    else if (r < R_D)
        *value = m->x[r - R_X];
    else if (r >= R_U && r < R_P)
        *value = m->u[r - R_U];
    else if (r >= R_P && r < R_Y)
        *value = m->p[r - R_P];
    else if (r >= R_Z) {
        double z[NZ + 1];
        core_indicators(m, z);
        *value = z[r - R_Z];
    } else {
        core_refresh(m);
        *value = r < R_U ? m->d[r - R_D] : m->y[r - R_Y];
    }
    return 1;
}

/* States, inputs and parameters can be set. */
static int core_set(machine *m, unsigned r, double value)
{
    double *place = r >= R_X && r < R_D   ? &m->x[r - R_X]
                    : r >= R_U && r < R_P ? &m->u[r - R_U]
                    : r >= R_P && r < R_Y ? &m->p[r - R_P]
                                          : NULL;
    if (!place || !isfinite(value))
        return 0;
    *place = value;
    m->fresh = 0;
    return 1;
}

/* Change of an unknown for changes `seed` of knowns, by exact derivatives. */
static int core_directional(const machine *m, const unsigned *unknown, size_t nu, const unsigned *known, size_t nk,
                            const double *seed, double *change)
{
    double v[2 * NV] = {0}, dx[NX], dd[NX], dy[NY + 1];
    double *const dv = v + NV;
    core_values(m, m->t, m->x, v);
    for (size_t i = 0; i < nk; i++) {
        const unsigned r = known[i];
        if (r >= R_X && r < R_D)
            dv[VX + r - R_X] += seed[i];
        else if (r >= R_U && r < R_Y)
            dv[VU + r - R_U] += seed[i];
        else if (r != 0)
            return 0;
    }
    for (int i = 0; i < NX; i++)
        dx[i] = dv[VX + i];
#if LOOPS
    double on[NX];
    closed_forward(v, on);
    for (int i = 0; i < NX; i++)
        dv[VX + i] = on[i];
#endif
    for (int i = 0; i < NC; i++) {
        double found[3];
        const double step = curves[i].ratio * dv[VX + curves[i].state];
        curve_values(m, &curves[i], v[VX + curves[i].state], found);
        dv[VW + 2 * i] = found[1] * step;
        dv[VW + 2 * i + 1] = found[2] * step;
    }
    rates_forward(v, dd);
    observed_forward(v, dy);
    for (size_t i = 0; i < nu; i++) {
        const unsigned r = unknown[i];
        if (r >= R_D && r < R_U)
            change[i] = dd[r - R_D];
        else if (r >= R_Y && r < R_Z)
            change[i] = dy[r - R_Y];
        else if (r >= R_X && r < R_D)
            change[i] = dx[r - R_X];
        else
            return 0;
    }
    return 1;
}
