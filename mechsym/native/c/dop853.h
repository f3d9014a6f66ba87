/* One step of the Runge-Kutta method of order 8 (Hairer, Norsett, Wanner, DOP853) in all lanes, and what belongs to it.
 *
 * MS_STAGES, MS_EXTRA_STAGES, MS_WEIGHTS, MS_ERROR_5, MS_ERROR_3, MS_DENSE_1..4 are written from dop853_table.py.
 */
typedef struct {
    ms_row x[MS_X], y[MS_N], next[MS_N], q[16][MS_N], dense[8][MS_N];
    ms_row t, h, step, error;
    ms_row until, due; /* end of the lane's segment, and its next wanted time */
    ms_window window;
    long segment[MS_L], active[MS_L];
    /* a step forced to meet a level, of surface i (target 1 + i) or a kink of kinked state i (-1 - i); 0 nothing */
    ms_row forced, level;
    long target[MS_L], tries[MS_L];
    int guessed[MS_L]; /* whether the target was seen ahead, not crossed: something else may come before it */
} ms_work;

#define MS_Q(j) w->q[j - 1][i][l]
#define MS_STAGE(stage, node, sum)                                                                                    \
    MS_READ_STATES w->x[1 + i][l] = w->y[i][l] + w->step[l] * (sum);                                                  \
    MS_EACH w->x[0][l] = w->t[l] + node * w->step[l];                                                                 \
    ms_rates(run, &w->window, w->x, w->q[stage - 1]);

static void ms_try(const ms_run *run, ms_work *w)
{
    ms_row five = {0}, three = {0};
    MS_STAGES(MS_STAGE)
    MS_STATES w->next[i][l] = w->x[1 + i][l] = w->y[i][l] + w->step[l] * (MS_WEIGHTS);
    MS_EACH w->x[0][l] = w->t[l] + w->step[l];
    ms_rates(run, &w->window, w->x, w->q[12]);
    MS_STATES
    {
        const double a = fabs(w->y[i][l]), b = fabs(w->next[i][l]);
        const double scale = 1.0 / (run->atol + run->rtol * (a > b ? a : b));
        const double e5 = (MS_ERROR_5) * scale, e3 = (MS_ERROR_3) * scale;
        five[l] += e5 * e5;
        three[l] += e3 * e3;
    }
    MS_EACH
    {
        const double both = five[l] + 0.01 * three[l];
        w->error[l] = fabs(w->step[l]) * five[l] / sqrt(MS_N * (both > 0.0 ? both : 1.0));
    }
}

/* Coefficients of the dense output, of order 7, of the step just tried. */
static void ms_make_dense(const ms_run *run, ms_work *w)
{
    MS_EXTRA_STAGES(MS_STAGE)
    MS_STATES
    {
        const double h = w->step[l], rise = w->next[i][l] - w->y[i][l];
        w->dense[0][i][l] = w->y[i][l];
        w->dense[1][i][l] = rise;
        w->dense[2][i][l] = h * MS_Q(1) - rise;
        w->dense[3][i][l] = 2.0 * rise - h * (MS_Q(1) + MS_Q(13));
        w->dense[4][i][l] = h * (MS_DENSE_1);
        w->dense[5][i][l] = h * (MS_DENSE_2);
        w->dense[6][i][l] = h * (MS_DENSE_3);
        w->dense[7][i][l] = h * (MS_DENSE_4);
    }
}

static double ms_inside(const ms_work *w, int i, int l, double u)
{
    double y = w->dense[7][i][l];
    for (int j = 6; j >= 1; j--)
        y = w->dense[j][i][l] + (j % 2 ? 1.0 - u : u) * y;
    return w->dense[0][i][l] + u * y;
}

/* The same in all lanes, each at a share u of its own. */
static void ms_inside_all(const ms_work *w, const double *u, ms_row *value)
{
    memcpy(value, w->dense[7], sizeof w->dense[7]);
    for (int j = 6; j >= 0; j--) {
        ms_row by;
        MS_EACH by[l] = j % 2 ? 1.0 - u[l] : u[l];
        MS_STATES value[i][l] = w->dense[j][i][l] + by[l] * value[i][l];
    }
}

/* Share of the step at which a state passes a level, by bisection of the dense output. */
static double ms_passing(const ms_work *w, int i, int l, double level)
{
    const int falls = w->next[i][l] < level;
    double low = 0.0, high = 1.0;
    for (double middle = 0.5; low < middle && middle < high; middle = 0.5 * (low + high))
        if ((ms_inside(w, i, l, middle) < level) != falls)
            low = middle;
        else
            high = middle;
    return high;
}

static void ms_first_rates(const ms_run *run, ms_work *w)
{
    MS_STATES w->x[1 + i][l] = w->y[i][l];
    MS_EACH w->x[0][l] = w->t[l];
    ms_rates(run, &w->window, w->x, w->q[0]);
}

/* A first step for the lanes that enter a segment (Hairer, Norsett, Wanner, section II.4). */
static void ms_guess_step(const ms_run *run, ms_work *w, const int *fresh)
{
    if (run->first_step > 0.0) {
        MS_EACH w->h[l] = fresh[l] ? run->first_step : w->h[l];
        return;
    }
    ms_row size = {0}, slope = {0}, bend = {0}, first, rate[MS_N], scale[MS_N];
    MS_STATES
    {
        scale[i][l] = 1.0 / (run->atol + run->rtol * fabs(w->y[i][l]));
        size[l] += w->y[i][l] * scale[i][l] * w->y[i][l] * scale[i][l];
        slope[l] += w->q[0][i][l] * scale[i][l] * w->q[0][i][l] * scale[i][l];
    }
    MS_EACH first[l] = (size[l] < 1e-10 * MS_N) | (slope[l] < 1e-10 * MS_N) ? 1e-6 : 0.01 * sqrt(size[l] / slope[l]);
    MS_STATES w->x[1 + i][l] = w->y[i][l] + first[l] * w->q[0][i][l];
    MS_EACH w->x[0][l] = w->t[l] + first[l];
    ms_rates(run, &w->window, w->x, rate);
    MS_STATES
    {
        const double change = (rate[i][l] - w->q[0][i][l]) * scale[i][l] / first[l];
        bend[l] += change * change;
    }
    for (int l = 0; l < MS_L; l++) {
        const double most = sqrt(ms_fmax(slope[l], bend[l]) / MS_N);
        const double second = most <= 1e-15 ? ms_fmax(1e-6, 1e-3 * first[l]) : pow(0.01 / most, 1.0 / 8.0);
        if (fresh[l])
            w->h[l] = ms_fmin(100.0 * first[l], second);
    }
}
