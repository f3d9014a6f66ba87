/* A controller in place of core.h: from angle and speed at every communication point it sets, once in a period, the
 * pressure of the spring. Included after model.h, which has the curves inertia, unit and design over the crank angle.
 *
 * Missing work seen in a turn, up to c0 + c1 phi: w = -I (omega^2 - mean square)/2 - integral of the load. Its regression
 * on the energy of the spring for each pascal, 1 and phi gives how far the pressure is off. The mean square is known at
 * the end of the turn only, so the sums are kept for both parts of w.
 */
#include <math.h>
#include <stddef.h>

enum { NX = 0, NZ = 0, NB = 3 };
enum { R_U = 1, R_P = R_U + NU, R_Y = R_P + NP, R_END = R_Y + NY };
enum { U_PHI, U_OMEGA };
enum { P_SET, P_START, P_GAIN, P_RATE, P_TORQUE, P_SPEED, P_POWER };
enum { Y_SET, Y_ERROR, Y_PERIODS };

typedef struct {
    double t, start, tolerance, x[1], u[NU], p[NP], y[NY];
    double first, last, load, square; /* angle where the turn began, of the last sample, sums over the angle */
    double a[NB][NB], b[2][NB];       /* normal equations: the matrix, and a right side for each part of w */
    double row[NB], part[2], omega;   /* of the last sample */
    int samples, started, stopped, fresh;
} machine;

static double curve_at(const struct curve *c, double phi)
{
    const double first = c->breaks[0], period = c->breaks[c->pieces] - first;
    double value = 0.0;
    int low = 0, high = c->pieces;
    phi -= floor((phi - first) / period) * period;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (phi < c->breaks[middle])
            high = middle;
        else
            low = middle;
    }
    for (int k = 0; k < c->terms; k++)
        value = value * (phi - c->breaks[low]) + c->rows[low * c->terms + k];
    return value;
}

static void core_begin(machine *m, double phi)
{
    m->first = m->last = phi;
    m->load = m->square = 0.0;
    m->samples = 0;
    for (int i = 0; i < NB; i++) {
        for (int j = 0; j < NB; j++)
            m->a[i][j] = 0.0;
        m->b[0][i] = m->b[1][i] = 0.0;
    }
}

/* What is regressed, and the two parts of the work that is seen, at the angle and speed of the inputs. */
static void core_sample(machine *m, double row[NB], double part[2])
{
    const double phi = m->u[U_PHI], omega = m->u[U_OMEGA], inertia = curve_at(&curves[0], phi);
    row[0] = curve_at(&curves[1], phi);
    row[1] = 1.0;
    row[2] = phi - m->first;
    part[0] = -0.5 * inertia * omega * omega - m->load - curve_at(&curves[2], phi);
    part[1] = 0.5 * inertia;
}

/* Cholesky of the sums; 0 when the turn says nothing. */
static int core_solve(machine *m, double square, double *error)
{
    double l[NB][NB] = {{0}}, z[NB];
    for (int i = 0; i < NB; i++)
        for (int j = 0; j <= i; j++) {
            double sum = m->a[i][j];
            for (int k = 0; k < j; k++)
                sum -= l[i][k] * l[j][k];
            if (i == j && !(sum > 1e-13 * m->a[i][i]))
                return 0;
            l[i][j] = i == j ? sqrt(sum) : sum / l[j][j];
        }
    for (int i = 0; i < NB; i++) {
        z[i] = m->b[0][i] + square * m->b[1][i];
        for (int k = 0; k < i; k++)
            z[i] -= l[i][k] * z[k];
        z[i] /= l[i][i];
    }
    for (int i = NB - 1; i >= 0; i--) {
        for (int k = i + 1; k < NB; k++)
            z[i] -= l[k][i] * z[k];
        z[i] /= l[i][i];
    }
    *error = z[0];
    return isfinite(*error);
}

static void core_set_pressure(machine *m)
{
    double error;
    const double turned = m->last - m->first;
    if (m->samples >= 20 && core_solve(m, m->square / turned, &error)) {
        const double most = m->p[P_RATE] * m->p[P_SET], wanted = -m->p[P_GAIN] * error;
        const double change = wanted > most ? most : wanted < -most ? -most : wanted;
        m->y[Y_ERROR] = error;
        m->y[Y_SET] = m->y[Y_SET] + change > 0.01 * m->p[P_SET] ? m->y[Y_SET] + change : 0.01 * m->p[P_SET];
    }
    m->y[Y_PERIODS] += 1.0;
}

/* Take in the sample of the inputs: trapezoids over the angle; a turn that has been full ends here. */
static void core_take(machine *m)
{
    const double phi = m->u[U_PHI], omega = m->u[U_OMEGA];
    double row[NB], part[2];
    if (m->started && !(phi > m->last))
        return; /* it stands, or turns back: nothing to learn */
    if (m->started) {
        const double step = phi - m->last, now = m->p[P_TORQUE] * pow(fabs(omega) / m->p[P_SPEED], m->p[P_POWER]);
        const double was = m->p[P_TORQUE] * pow(fabs(m->omega) / m->p[P_SPEED], m->p[P_POWER]);
        m->load += 0.5 * step * (now + was);
        m->square += 0.5 * step * (omega * omega + m->omega * m->omega);
        core_sample(m, row, part);
        for (int i = 0; i < NB; i++) {
            for (int j = 0; j < NB; j++)
                m->a[i][j] += 0.5 * step * (row[i] * row[j] + m->row[i] * m->row[j]);
            for (int k = 0; k < 2; k++)
                m->b[k][i] += 0.5 * step * (row[i] * part[k] + m->row[i] * m->part[k]);
        }
        m->last = phi;
        m->samples++;
        if (m->last - m->first >= PERIOD) {
            core_set_pressure(m);
            m->started = 0;
        }
    }
    if (!m->started) {
        core_begin(m, phi);
        m->started = 1;
        core_sample(m, row, part);
    }
    for (int i = 0; i < NB; i++)
        m->row[i] = row[i];
    m->part[0] = part[0];
    m->part[1] = part[1];
    m->omega = omega;
}

static void core_update(machine *m)
{
    if (!m->y[Y_PERIODS])
        m->y[Y_SET] = m->p[P_START];
}

static void core_start(machine *m)
{
    char *bytes = (char *)m;
    for (size_t i = 0; i < sizeof *m; i++)
        bytes[i] = 0;
    for (int i = 0; i < NP; i++)
        m->p[i] = start_p[i];
    m->stopped = -1;
    core_update(m);
}

/* A step of co-simulation: the inputs are those of its beginning. */
static int core_advance(machine *m, double t_end)
{
    core_take(m);
    m->t = t_end;
    return 1;
}

static int core_get(machine *m, unsigned r, double *value)
{
    if (r >= R_END)
        return 0;
    *value = r == 0 ? m->t : r < R_P ? m->u[r - R_U] : r < R_Y ? m->p[r - R_P] : m->y[r - R_Y];
    return 1;
}

static int core_set(machine *m, unsigned r, double value)
{
    double *place = r >= R_U && r < R_P ? &m->u[r - R_U] : r >= R_P && r < R_Y ? &m->p[r - R_P] : NULL;
    if (!place || !isfinite(value))
        return 0;
    *place = value;
    core_update(m);
    return 1;
}

/* It has no continuous states, no events between steps and no derivatives. */
static int core_met(const machine *m, const double *x) { (void)m, (void)x; return -1; }
static double core_next_switch(const machine *m) { (void)m; return INFINITY; }
static void core_rates(const machine *m, double t, const double *x, double *d) { (void)m, (void)t, (void)x, (void)d; }
enum { OFF = 0 };
static int core_close(machine *m, double most) { (void)m, (void)most; return 0; }
static void core_indicators(const machine *m, double *z) { (void)m, (void)z; }
static int core_directional(const machine *m, const unsigned *unknown, size_t nu, const unsigned *known, size_t nk,
                            const double *seed, double *change)
{
    (void)m, (void)unknown, (void)nu, (void)known, (void)nk, (void)seed, (void)change;
    return 0;
}
