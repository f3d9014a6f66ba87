/* Steps that look back, in all lanes: a predictor and a corrector through the last MS_BACK rates, each lane with a step
 * of its own. DOP853 starts a stretch of them and goes on where one ends: before an end of a segment, a surface, and
 * where steps become short. Between them the angles are arc lengths x (see arc.py), free of the square of their speed.
 *
 * MS_STRIDES steps are made without a condition; then errors, ends, surfaces and wanted times are looked at, and a lane
 * with too large an error goes back.
 */
enum { MS_F = MS_A + MS_RO + MS_UO, MS_O = MS_RO + MS_UO, MS_KEPT = MS_LONGER + MS_STRIDES, MS_RING = MS_KEPT + 3 * MS_STRIDES };
enum { MS_CALM = 12, MS_WORTH = 4000, MS_PATIENCE = 16 * MS_STRIDES };
static const double MS_TOO_LARGE = 0.05, MS_SMALL = 1.5e-4; /* squared errors */
static const double ms_turn = 6.283185307179586, ms_turn_rest = 2.4492935982947064e-16; /* 2 pi in two pieces */

typedef struct {
    ms_row angle[MS_A], speed[MS_A], other[MS_O + 1]; /* arc lengths, their speeds, other states */
} ms_place;

typedef struct {
    ms_row past[MS_RING][MS_F]; /* rates, one row after another */
    ms_place now, before[MS_STRIDES + 1];
    ms_row q[MS_STRIDES + 1][2 * MS_A]; /* angles and speeds themselves, for surfaces */
    ms_row slope[MS_A], weight[MS_F], worst, t, h;
    ms_row peak, limit; /* largest error since a change; a step that was too long */
    ms_row turned; /* whole turns that are put aside */
    long at, poor, slow, joined[MS_L], took[MS_L], fresh[MS_L], failed[MS_L], patience[MS_L];
} ms_adams_work;

MS_INLINE double ms_whole(double angle, double turns)
{
    return fma(turns, ms_turn, angle + turns * ms_turn_rest);
}

static const double *ms_series(const ms_run *run)
{
    return run->constants + MS_SERIES * MS_L;
}

/* The rates where the rows x and the slopes say. */
static __attribute__((noinline)) void ms_rates_of(const ms_run *run, const ms_place *at, ms_row *x, const ms_row *slope, ms_row *f)
{
    for (int i = 0; i < MS_RO; i++)
        MS_EACH x[1 + ms_other[i]][l] = at->other[i][l];
    MS_FORCES(run->constants + MS_FORCES_AT * MS_L, x[0], f[0]);
    ms_bend(ms_series(run), slope, f);
}

/* One step in all lanes. MS_PAST(j) is the rate j steps ago. */
#define MS_PAST(j) m->past[at - 1 - (j)][i][l]
static __attribute__((noinline)) void ms_stride(const ms_run *run, ms_work *w, ms_adams_work *m, long number)
{
    const long at = m->at + number;
    ms_place guess;
    ms_row ahead[MS_F], f[MS_F], error = {0}, bend[MS_A];
    for (int i = 0; i < MS_A; i++)
        MS_EACH
        {
            const double h = m->h[l];
            guess.angle[i][l] = m->now.angle[i][l] + h * (m->now.speed[i][l] + h * (MS_TWICE));
            guess.speed[i][l] = m->now.speed[i][l] + h * (MS_ONCE);
            ahead[i][l] = MS_AHEAD;
        }
    for (int i = MS_A; i < MS_F; i++)
        MS_EACH
        {
            guess.other[i - MS_A][l] = m->now.other[i - MS_A][l] + m->h[l] * (MS_ONCE);
            ahead[i][l] = MS_AHEAD;
        }
    MS_EACH w->x[0][l] = m->t[l] + (number + 1) * m->h[l];
    ms_unbend(ms_series(run), guess.angle, guess.speed, w->x, m->slope, bend);
    ms_rates_of(run, &guess, w->x, m->slope, f);
    for (int i = 0; i < MS_A; i++)
        MS_EACH
        {
            const double h = m->h[l], off = f[i][l] - ahead[i][l];
            /* so near that what the square of the way adds is below round-off */
            const double way = h * h * (MS_NEW_TWICE * off), slope = m->slope[i][l];
            m->now.angle[i][l] = guess.angle[i][l] + way;
            m->now.speed[i][l] = guess.speed[i][l] + h * (MS_NEW_ONCE * off);
            m->slope[i][l] = slope + bend[i][l] * way;
            w->x[1 + ms_angle[i]][l] += slope * way;
            w->x[1 + ms_speed[i]][l] = m->slope[i][l] * m->now.speed[i][l];
            error[l] += off * off * m->weight[i][l];
        }
    for (int i = MS_A; i < MS_A + MS_RO; i++)
        MS_EACH
        {
            const double off = f[i][l] - ahead[i][l];
            m->now.other[i - MS_A][l] = guess.other[i - MS_A][l] + m->h[l] * (MS_NEW_ONCE * off);
            error[l] += off * off * m->weight[i][l];
        }
    ms_rates_of(run, &m->now, w->x, m->slope, m->past[at]);
    if (MS_UO > 0)
        MS_WORKS(run->constants + MS_WORKS_AT * MS_L, w->x[0], m->past[at][MS_A + MS_RO]);
    for (int i = MS_A + MS_RO; i < MS_F; i++)
        MS_EACH
        {
            const double off = m->past[at][i][l] - ahead[i][l];
            m->now.other[i - MS_A][l] = guess.other[i - MS_A][l] + m->h[l] * (MS_NEW_ONCE * off);
            error[l] += off * off * m->weight[i][l];
        }
    MS_EACH m->worst[l] = error[l] <= m->worst[l] ? m->worst[l] : error[l];
    memcpy(m->before + number + 1, &m->now, sizeof m->now);
    for (int i = 0; i < MS_A && run->surfaces; i++)
        MS_EACH
        {
            m->q[number + 1][i][l] = ms_whole(w->x[1 + ms_angle[i]][l], m->turned[l]);
            m->q[number + 1][MS_A + i][l] = w->x[1 + ms_speed[i]][l];
        }
}

/* The place of the states of DOP853: Newton's method for the arc lengths. Whole turns are put aside where they change
 * nothing, so that what is left keeps its digits. */
static void ms_settle_in(const ms_run *run, ms_work *w, ms_adams_work *m)
{
    ms_row rest[MS_A], bend[MS_A];
    MS_EACH m->turned[l] = MS_TURNS ? floor(w->y[ms_angle[0]][l] / ms_turn) : 0.0;
    for (int i = 0; i < MS_A; i++)
        MS_EACH rest[i][l] = m->now.angle[i][l] = ms_whole(w->y[ms_angle[i]][l], -m->turned[l]);
    for (int turn = 0; turn < 8; turn++) {
        ms_unbend(ms_series(run), m->now.angle, m->now.speed, w->x, m->slope, bend);
        for (int i = 0; i < MS_A; i++)
            MS_EACH m->now.angle[i][l] += (rest[i][l] - w->x[1 + ms_angle[i]][l]) / m->slope[i][l];
    }
    for (int i = 0; i < MS_A; i++)
        MS_EACH m->now.speed[i][l] = w->y[ms_speed[i]][l] / m->slope[i][l];
    for (int i = 0; i < MS_O; i++)
        MS_EACH m->now.other[i][l] = w->y[ms_other[i]][l];
}

static void ms_note(const ms_run *run, ms_work *w, ms_adams_work *m)
{
    ms_row bend[MS_A];
    ms_settle_in(run, w, m);
    MS_EACH w->x[0][l] = w->t[l];
    ms_unbend(ms_series(run), m->now.angle, m->now.speed, w->x, m->slope, bend);
    ms_rates_of(run, &m->now, w->x, m->slope, m->past[m->at]);
    if (MS_UO > 0)
        MS_WORKS(run->constants + MS_WORKS_AT * MS_L, w->x[0], m->past[m->at][MS_A + MS_RO]);
    m->at++;
}

/* Equal steps of DOP853, much shorter than it needs, whose rates are the past of the first step that looks back.
 * Returns how many lanes go on. */
static long ms_lead_in(const ms_run *run, ms_work *w, ms_adams_work *m)
{
    double share, level;
    long target, left = 0;
    m->at = 0;
    MS_EACH m->h[l] = ms_fmin(0.25 * w->h[l], m->limit[l] / MS_GROWTH);
    MS_EACH m->joined[l] = w->active[l] & (w->until[l] - w->t[l] > MS_WORTH * m->h[l]) & (w->forced[l] == 0.0);
    ms_note(run, w, m);
    for (int j = 1; j < MS_BACK; j++) {
        MS_EACH w->step[l] = m->joined[l] ? m->h[l] : 0.0;
        ms_try(run, w);
        for (int l = 0; l < MS_L; l++)
            if (m->joined[l] && (!(w->error[l] <= 1.0) || ms_crossed(run, w, l, 0, &share, &target, &level)))
                m->joined[l] = 0, w->step[l] = 0.0;
        for (int l = 0; l < MS_L; l++)
            if (!m->joined[l])
                w->error[l] = INFINITY;
        ms_sample_all(run, w);
        MS_STATES
        {
            w->y[i][l] = m->joined[l] ? w->next[i][l] : w->y[i][l];
            w->q[0][i][l] = m->joined[l] ? w->q[12][i][l] : w->q[0][i][l];
        }
        MS_EACH w->t[l] += m->joined[l] ? m->h[l] : 0.0;
        MS_EACH run->steps[l] += m->joined[l];
        ms_note(run, w, m);
    }
    for (int l = 0; l < MS_L; l++) {
        m->t[l] = w->t[l];
        m->h[l] = m->joined[l] ? m->h[l] : 0.0;
        m->fresh[l] = m->failed[l] = 0;
        m->patience[l] = 2 * MS_STRIDES;
        m->peak[l] = 0.0;
        for (int i = 0; i < MS_A; i++) {
            m->q[MS_STRIDES][i][l] = w->y[ms_angle[i]][l];
            m->q[MS_STRIDES][MS_A + i][l] = w->y[ms_speed[i]][l];
        }
        m->took[l] = m->joined[l];
        left += m->joined[l];
    }
    return left;
}

/* Weights of the squared differences of predicted and evaluated rates in the error of a step. */
static void ms_weigh(const ms_run *run, const ms_work *w, ms_adams_work *m)
{
    for (int i = 0; i < MS_F; i++)
        MS_EACH
        {
            const double h = m->h[l], once = MS_STRICT * h * MS_NEW_ONCE, twice = MS_STRICT * h * h * MS_NEW_TWICE;
            if (i < MS_A) {
                const double g = m->slope[i][l], x = ms_whole(m->now.angle[i][l], m->turned[l]);
                const double first = twice * g / (run->atol + run->rtol * fabs(x));
                const double second = once * g / (run->atol + run->rtol * fabs(g * m->now.speed[i][l]));
                m->weight[i][l] = (first * first + second * second) / MS_N;
            } else {
                const double other = once / (run->atol + run->rtol * fabs(m->now.other[i - MS_A][l]));
                m->weight[i][l] = other * other / MS_N;
            }
        }
    (void)w;
}

/* The past of a lane in other steps: row `to` - 1 - j as it was `table` says how far behind row `from` - 1. */
static void ms_relay(ms_adams_work *m, int l, long from, long to, const double *table, int terms)
{
    double old[MS_LONGER];
    for (int i = 0; i < MS_F; i++) {
        for (int j = 0; j < terms; j++)
            old[j] = m->past[from - 1 - j][i][l];
        for (int j = 0; j < MS_BACK; j++) {
            double sum = 0.0;
            for (int k = 0; k < terms; k++)
                sum += table[j * terms + k] * old[k];
            m->past[to - 1 - j][i][l] = sum;
        }
    }
    m->fresh[l] = 0;
    m->peak[l] = 0.0;
}

static void ms_shrink(ms_adams_work *m, int l, long from, double error)
{
    int times = error > 1e4 ? 3 : error > 10.0 ? 2 : 1;
    m->limit[l] = m->h[l];
    m->patience[l] = MS_PATIENCE;
    for (; times > 0; times--, from = m->at) {
        ms_relay(m, l, from, m->at, ms_shrunk[0], MS_BACK);
        m->h[l] *= 1.0 / MS_GROWTH;
    }
}

static void ms_go_back(ms_adams_work *m, int l)
{
    for (int i = 0; i < MS_A; i++) {
        m->now.angle[i][l] = m->before[0].angle[i][l];
        m->now.speed[i][l] = m->before[0].speed[i][l];
    }
    for (int i = 0; i < MS_O; i++)
        m->now.other[i][l] = m->before[0].other[i][l];
}

/* Polynomials in the share, row after row of a table; three at once, for each waits for its own last product. */
static void ms_weights(const double *share, const double *table, int terms, ms_row *weight)
{
    for (int j = 0; j <= MS_BACK; j += 3) {
        ms_row a = {0}, b = {0}, c = {0};
        for (int k = terms - 1; k >= 0; k--)
            MS_EACH
            {
                a[l] = a[l] * share[l] + table[j * terms + k];
                b[l] = b[l] * share[l] + table[(j + 1) * terms + k];
                c[l] = c[l] * share[l] + table[(j + 2) * terms + k];
            }
        MS_EACH weight[j][l] = a[l], weight[j + 1][l] = b[l], weight[j + 2][l] = c[l];
    }
}

/* The place at a share of the step after stride `number` of each lane: the polynomial through the rates on both sides
 * is integrated that far. */
static void ms_inside_step(const ms_adams_work *m, long start, const long *number, const double *share, ms_place *then)
{
    ms_row once[MS_F] = {0}, twice[MS_A] = {0}, weight[2][MS_BACK + 1];
    ms_weights(share, ms_inside_once[0], MS_BACK + 2, weight[0]);
    ms_weights(share, ms_inside_twice[0], MS_BACK + 3, weight[1]);
    for (int j = 0; j <= MS_BACK; j++) {
        ms_row rate[MS_F];
        for (int l = 0; l < MS_L; l++)
            for (int i = 0; i < MS_F; i++)
                rate[i][l] = m->past[start + number[l] - j][i][l];
        for (int i = 0; i < MS_F; i++)
            MS_EACH once[i][l] += weight[0][j][l] * rate[i][l];
        for (int i = 0; i < MS_A; i++)
            MS_EACH twice[i][l] += weight[1][j][l] * rate[i][l];
    }
    for (int l = 0; l < MS_L; l++) {
        const ms_place *from = m->before + number[l];
        const double h = m->h[l];
        for (int i = 0; i < MS_A; i++) {
            then->angle[i][l] = from->angle[i][l] + h * (share[l] * from->speed[i][l] + h * twice[i][l]);
            then->speed[i][l] = from->speed[i][l] + h * once[i][l];
        }
        for (int i = 0; i < MS_O; i++)
            then->other[i][l] = from->other[i][l] + h * once[MS_A + i][l];
    }
}

/* States at wanted times within the last strides, in all lanes at once. */
static void ms_sample_back(const ms_run *run, ms_work *w, ms_adams_work *m, const long *good)
{
    const long start = m->at - MS_STRIDES;
    for (;;) {
        long due[MS_L], any = 0, number[MS_L];
        ms_row share, x[MS_X], slope[MS_A], bend[MS_A];
        ms_place then;
        MS_EACH due[l] = good[l] & (w->due[l] <= m->t[l] + MS_STRIDES * m->h[l]);
        for (int l = 0; l < MS_L; l++) {
            const double steps = due[l] ? (w->due[l] - m->t[l]) / m->h[l] : 0.0;
            any |= due[l];
            number[l] = steps < MS_STRIDES - 1 ? (long)steps : MS_STRIDES - 1;
            share[l] = steps - number[l];
        }
        if (!any)
            return;
        ms_inside_step(m, start, number, share, &then);
        ms_unbend(ms_series(run), then.angle, then.speed, x, slope, bend);
        for (int l = 0; l < MS_L; l++) {
            if (!due[l])
                continue;
            double *to = run->samples[l] + run->sampled[l] * MS_N;
            for (int i = 0; i < MS_A; i++) {
                to[ms_angle[i]] = ms_whole(x[1 + ms_angle[i]][l], m->turned[l]);
                to[ms_speed[i]] = x[1 + ms_speed[i]][l];
            }
            for (int i = 0; i < MS_O; i++)
                to[ms_other[i]] = then.other[i][l];
            run->sampled[l]++;
            ms_look_ahead(run, w, l);
        }
    }
}

/* Does a lane pass a surface in its last strides? */
static int ms_passes(const ms_run *run, const ms_adams_work *m, int l)
{
    for (long s = 0; s < run->surfaces; s++)
        for (int i = 0; i < MS_A; i++) {
            const long state = run->surface[s].state;
            const int row = state == ms_angle[i] ? i : state == ms_speed[i] ? MS_A + i : -1;
            for (int k = 0; row >= 0 && k < MS_STRIDES; k++)
                if (ms_crosses(run->surface[s].direction, m->q[k][row][l], m->q[k + 1][row][l], run->surface[s].level[l]))
                    return 1;
        }
    return 0;
}

/* After strides that were good: the next ones, longer or shorter. */
static void ms_go_on(ms_adams_work *m, int l)
{
    m->t[l] += MS_STRIDES * m->h[l];
    m->fresh[l] += MS_STRIDES;
    m->failed[l] = 0;
    m->peak[l] = ms_fmax(m->peak[l], m->worst[l]);
    if (m->worst[l] > MS_TOO_LARGE) {
        ms_shrink(m, l, m->at, 1.0);
    } else if (m->fresh[l] >= m->patience[l]) {
        const int longer = m->peak[l] < MS_SMALL && m->h[l] * MS_GROWTH < m->limit[l];
        if (longer) {
            ms_relay(m, l, m->at, m->at, ms_grown[0], MS_LONGER);
            m->h[l] *= MS_GROWTH;
        }
        m->patience[l] = MS_PATIENCE;
        m->limit[l] *= longer ? 1.0 : 1.02;
        m->fresh[l] = 0;
        m->peak[l] = 0.0;
    }
}

/* Strides in all lanes that have joined. Returns how many go on. */
static long ms_strides(const ms_run *run, ms_work *w, ms_adams_work *m)
{
    long good[MS_L], leaves[MS_L] = {0}, left = 0;
    if (m->at + MS_STRIDES > MS_RING) {
        memmove(m->past, m->past + m->at - MS_KEPT, MS_KEPT * sizeof m->past[0]);
        m->at = MS_KEPT;
    }
    m->before[0] = m->now;
    memcpy(m->q[0], m->q[MS_STRIDES], sizeof m->q[0]);
    ms_weigh(run, w, m);
    MS_EACH m->worst[l] = 0.0;
    for (long k = 0; k < MS_STRIDES; k++)
        ms_stride(run, w, m, k);
    m->at += MS_STRIDES;
    for (int l = 0; l < MS_L; l++) {
        good[l] = m->joined[l] && m->worst[l] <= 1.0;
        leaves[l] = good[l] && ms_passes(run, m, l);
        good[l] &= !leaves[l];
    }
    ms_sample_back(run, w, m, good);
    for (int l = 0; l < MS_L; l++) {
        if (!m->joined[l])
            continue;
        if (good[l]) {
            run->steps[l] += MS_STRIDES;
            ms_go_on(m, l);
        } else {
            ms_go_back(m, l);
            for (int i = 0; i < 2 * MS_A; i++)
                m->q[MS_STRIDES][i][l] = m->q[0][i][l];
            if (!leaves[l]) {
                run->rejected[l] += MS_STRIDES;
                if (m->worst[l] < 1e30 && ++m->failed[l] < 3)
                    ms_shrink(m, l, m->at - MS_STRIDES, m->worst[l]);
                else
                    leaves[l] = m->poor = 1;
            }
        }
        if (m->h[l] < 0.08 * w->h[l])
            leaves[l] = m->poor = m->slow = 1;
        leaves[l] |= m->t[l] + MS_STRIDES * m->h[l] > w->until[l];
        leaves[l] |= run->steps[l] + run->rejected[l] + MS_STRIDES > run->max_steps;
        if (MS_TURNS) {
            const double turns = floor(m->now.angle[0][l] / ms_turn);
            m->turned[l] += turns;
            for (int i = 0; i < MS_A && turns != 0.0; i++)
                m->now.angle[i][l] = ms_whole(m->now.angle[i][l], -turns);
        }
        left += !leaves[l];
        m->joined[l] = !leaves[l];
        m->h[l] = leaves[l] ? 0.0 : m->h[l];
    }
    return left;
}

/* The states of DOP853 of all lanes that took part. */
static void ms_return(const ms_run *run, ms_work *w, ms_adams_work *m)
{
    ms_row bend[MS_A];
    ms_unbend(ms_series(run), m->now.angle, m->now.speed, w->x, m->slope, bend);
    for (int l = 0; l < MS_L; l++) {
        if (!m->took[l])
            continue;
        w->t[l] = m->t[l];
        for (int i = 0; i < MS_A; i++) {
            w->y[ms_angle[i]][l] = ms_whole(w->x[1 + ms_angle[i]][l], m->turned[l]);
            w->y[ms_speed[i]][l] = w->x[1 + ms_speed[i]][l];
        }
        for (int i = 0; i < MS_O; i++)
            w->y[ms_other[i]][l] = m->now.other[i][l];
    }
}

/* As long as it is worth it. */
static void ms_look_back(const ms_run *run, ms_work *w, ms_adams_work *m)
{
    long any = 0;
    m->poor = m->slow = 0;
    MS_EACH m->took[l] = 0;
    MS_EACH any |= w->active[l] & (w->until[l] - w->t[l] > MS_WORTH * 0.25 * w->h[l]);
    if (!any)
        return;
    for (long left = ms_lead_in(run, w, m); left && !m->poor;)
        left = ms_strides(run, w, m);
    ms_return(run, w, m);
    ms_first_rates(run, w);
}

MS_EXPORT void ms_adams(const ms_run *run)
{
    ms_work work, *w = &work;
    ms_adams_work *m = aligned_alloc(64, (sizeof *m + 63) / 64 * 64);
    long calm = 0, patience = MS_CALM;
    if (!m) {
        ms_dop853(run);
        return;
    }
    memset(m, 0, sizeof *m);
    MS_EACH m->limit[l] = INFINITY;
    ms_piece pieces[run->tables + 1];
    ms_row terms[ms_terms(run)];
    for (int left = ms_begin(run, w, pieces, terms); left; left = ms_turn_over(run, w))
        if (++calm > patience) {
            ms_look_back(run, w, m);
            patience = m->slow ? 8 * patience : MS_CALM;
            calm = 0;
        }
    ms_leave(run, w);
    free(m);
}
