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

/* Held value `slot` of one lane follows state `state` as a periodic piecewise polynomial. */
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
    long segments, times, tables, surfaces, kinks, kinked, max_steps;
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
    double *const *samples; /* [lane]: [state][time] of its run */
    double *last_step;   /* [lane] */
    long *steps, *rejected, *sampled, *met, *status; /* [lane] */
} ms_run;

/* The kinks on both sides of each state. A table is read on this side of them, also by a stage that reaches beyond. */
typedef struct {
    ms_row below[MS_N], above[MS_N], low[MS_N], high[MS_N];
} ms_window;

static void ms_open(ms_window *window)
{
    for (int i = 0; i < MS_N; i++)
        for (int l = 0; l < MS_L; l++) {
            window->below[i][l] = window->low[i][l] = -INFINITY;
            window->above[i][l] = window->high[i][l] = INFINITY;
        }
}

static double ms_periodic(const ms_table *table, double angle)
{
    const double start = table->breaks[0], period = table->breaks[table->pieces] - start;
    const double a = angle - period * floor((angle - start) / period);
    long piece = 0;
    for (long high = table->pieces; high - piece > 1;) {
        const long middle = (piece + high) / 2;
        if (table->breaks[middle] <= a)
            piece = middle;
        else
            high = middle;
    }
    const double u = a - table->breaks[piece], *c = table->coefficients + piece * table->terms;
    double y = 0.0;
    for (long i = 0; i < table->terms; i++)
        y = y * u + c[i];
    return y;
}

static __attribute__((noinline)) void ms_rates(const ms_run *run, const ms_window *window, ms_row *x, ms_row *rate)
{
    for (long i = 0; i < run->tables * MS_L; i++) {
        const ms_table *table = run->table + i;
        const int l = i % MS_L;
        const double low = window->low[table->state][l], high = window->high[table->state][l];
        const double a = ms_fmin(ms_fmax(x[1 + table->state][l], low), high);
        x[1 + MS_N + table->slot][l] = ms_periodic(table, a);
    }
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
