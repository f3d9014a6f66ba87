/* What every integrator shares: the description of its runs, tables of periodic values, levels that end a step.
 *
 * MS_N states, MS_P held values, MS_L lanes; each lane is a run of its own. Arrays of lanes lie side by side,
 * y[state][lane]. The right-hand side MS_RATES(k, x, ydot) reads the rows x = (t, y[0].., p[0]..).
 */
enum { MS_DONE, MS_MET, MS_TOO_MANY, MS_TOO_SMALL, MS_NOT_FINITE, MS_NO_SOLUTION, MS_SLOW };
enum { MS_X = 1 + MS_N + MS_P };
#define MS_EACH MS_LANES for (int l = 0; l < MS_L; l++)
#define MS_STATES for (int i = 0; i < MS_N; i++) MS_EACH
typedef double ms_row[MS_L];

/* Held value `slot` of one lane follows state `state` as a periodic piecewise polynomial; lanes have as many terms. */
typedef struct {
    long slot, state, pieces, terms;
    const double *breaks, *coefficients; /* [pieces + 1], [piece][term] by falling powers */
} ms_table;

/* A level of a state at which a run ends; direction 1 rising, -1 falling, 0 either. */
typedef struct {
    long state, direction;
    const double *level; /* [lane] */
} ms_surface;

typedef struct {
    long segments, times, tables, surfaces, kinks, kinked, keep, kept_states, max_steps;
    double rtol, atol, first_step;
    const double *constants;   /* [constant][lane] */
    const double *until;       /* [segment][lane] */
    const double *held;        /* [segment][held value][lane] */
    const double *grid;        /* [lane][time], ascending, after the start */
    const double *kink_angles; /* [kink][lane], in [0, period) */
    const double *kink_periods; /* [kink] */
    const long *kink_states;   /* [kink] */
    const long *kinked_states; /* [kinked], each state once */
    const ms_table *table;     /* [table][lane] */
    const ms_surface *surface;
    double *t, *y;       /* [lane], [state][lane]: the start, then the end */
    double *const *samples; /* [lane]: [time][state] of its run */
    double *const *kept; /* [lane]: [step modulo keep]: start, length and dense output [8][kept state] of a last step */
    double *last_step;   /* [lane] */
    long *steps, *rejected, *sampled, *met, *status; /* [lane] */
} ms_run;

/* The piece of a table that each lane was read on last: its ends, its number and its coefficients. */
typedef struct {
    ms_row from, to, *c;
    long piece[MS_L];
} ms_piece;

/* The kinks on both sides of each state. A table is read on this side of them, also by a stage that reaches beyond. */
typedef struct {
    ms_row below[MS_N], above[MS_N], low[MS_N], high[MS_N];
    ms_piece *pieces; /* [table] */
} ms_window;

static long ms_terms(const ms_run *run)
{
    long terms = 1;
    for (long i = 0; i < run->tables; i++)
        terms += run->table[i * MS_L].terms;
    return terms;
}

static void ms_open(const ms_run *run, ms_window *window, ms_piece *pieces, ms_row *terms)
{
    for (int i = 0; i < MS_N; i++)
        for (int l = 0; l < MS_L; l++) {
            window->below[i][l] = window->low[i][l] = -INFINITY;
            window->above[i][l] = window->high[i][l] = INFINITY;
        }
    window->pieces = pieces;
    for (long i = 0; i < run->tables; terms += run->table[i++ * MS_L].terms) {
        pieces[i].c = terms;
        for (int l = 0; l < MS_L; l++) {
            pieces[i].from[l] = INFINITY, pieces[i].to[l] = -INFINITY;
            pieces[i].piece[l] = 0;
        }
    }
}

/* Goes to the piece of an angle, which mostly is the next or the one before. */
static void ms_stand(const ms_table *table, ms_piece *at, int l, double angle)
{
    const double start = table->breaks[0], period = table->breaks[table->pieces] - start;
    const double turned = period * floor((angle - start) / period), a = angle - turned, *breaks = table->breaks;
    const long last = table->pieces - 1, was = at->piece[l];
    long low = 0, high = table->pieces;
    if (breaks[was] <= a && was < last && a < breaks[was + 2 < last ? was + 2 : last])
        low = was, high = was + 2;
    else if (a < breaks[was] && was > 0 && breaks[was - 1] <= a)
        low = was - 1, high = was;
    while (high - low > 1) {
        const long middle = (low + high) / 2;
        if (breaks[middle] <= a)
            low = middle;
        else
            high = middle;
    }
    at->piece[l] = low;
    at->from[l] = turned + breaks[low];
    at->to[l] = turned + breaks[low + 1];
    const double *c = table->coefficients + low * table->terms;
    for (long i = 0; i < table->terms; i++)
        at->c[i][l] = c[i];
}

/* Held values that follow a state, in all lanes at once. */
static void ms_follow(const ms_run *run, const ms_window *window, ms_row *x)
{
    for (long i = 0; i < run->tables; i++) {
        const ms_table *table = run->table + i * MS_L;
        ms_piece *at = window->pieces + i;
        const ms_row *state = x + 1 + table->state;
        ms_row a, y;
        long left = 0;
        MS_EACH
        {
            const double above = ms_fmax((*state)[l], window->low[table->state][l]);
            a[l] = ms_fmin(above, window->high[table->state][l]);
            left |= !(at->from[l] <= a[l]) | !(a[l] < at->to[l]);
        }
        for (int l = 0; l < MS_L && left; l++)
            if (!(at->from[l] <= a[l]) || !(a[l] < at->to[l]))
                ms_stand(table + l, at, l, a[l]);
        MS_EACH y[l] = at->c[0][l];
        for (long k = 1; k < table->terms; k++)
            MS_EACH y[l] = y[l] * (a[l] - at->from[l]) + at->c[k][l];
        memcpy(x + 1 + MS_N + table->slot, &y, sizeof y);
    }
}

static __attribute__((noinline)) void ms_rates(const ms_run *run, const ms_window *window, ms_row *x, ms_row *rate)
{
    ms_follow(run, window, x);
    MS_RATES(run->constants, x[0], rate[0]);
}

/* A run that stands on a kink goes on, on the side to which it moves. */
static void ms_look_around(const ms_run *run, ms_window *window, int l, long state, double angle, double speed)
{
    const double tiny = 1e-12 * ms_fmax(fabs(angle), 1.0), here = angle + (speed < 0.0 ? -2.0 : 2.0) * tiny;
    double below = -INFINITY, above = INFINITY;
    for (long i = 0; i < run->kinks; i++) {
        if (run->kink_states[i] != state)
            continue;
        const double period = run->kink_periods[i], turn = floor(here / period);
        for (int shift = -1; shift <= 1; shift++) {
            const double kink = run->kink_angles[i * MS_L + l] + period * (turn + shift);
            if (kink > here)
                above = ms_fmin(above, kink);
            else
                below = ms_fmax(below, kink);
        }
    }
    window->below[state][l] = below, window->low[state][l] = below + tiny;
    window->above[state][l] = above, window->high[state][l] = above - tiny;
}

static int ms_crosses(long direction, double before, double after, double level)
{
    return (direction >= 0 && before < level && level <= after) || (direction <= 0 && before > level && level >= after);
}

/* The held values of the segment in which a time lies; returns 0 when all segments are over. */
static int ms_hold(const ms_run *run, long *segment, double t, ms_row *x, int l)
{
    while (*segment < run->segments && !(run->until[*segment * MS_L + l] > t))
        ++*segment;
    if (*segment == run->segments)
        return 0;
    for (int j = 0; j < MS_P; j++)
        x[1 + MS_N + j][l] = run->held[(*segment * MS_P + j) * MS_L + l];
    return 1;
}
