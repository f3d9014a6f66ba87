/* Gauss-Legendre collocation with MS_S stages, order 2 MS_S, constant steps: symmetric, so that the energy of a
 * conservative motion does not drift. Fixed-point iteration down to rounding; the state is summed with compensation.
 *
 * Steps end at the wanted times and at the ends of segments; between those they are equal and at most first_step long.
 */
typedef struct {
    ms_row x[MS_X], y[MS_N], lost[MS_N], k[MS_S][MS_N], last[MS_S][MS_N];
    ms_row t;
    ms_window window;
    double h;
    long segment[MS_L];
} ms_work;

/* One sweep of k_i = f(t + c_i h, y + h sum_j a_ij k_j); the largest change, relative to the largest k, of any lane. */
static double ms_sweep(const ms_run *run, ms_work *w)
{
    double change = 0.0, size = 0.0;
    ms_row fresh[MS_N];
    for (int s = 0; s < MS_S; s++) {
        MS_STATES
        {
            double sum = 0.0;
            for (int j = 0; j < MS_S; j++)
                sum += ms_gauss_a[s][j] * w->k[j][i][l];
            w->x[1 + i][l] = w->y[i][l] + (w->h * sum + w->lost[i][l]);
        }
        MS_EACH w->x[0][l] = w->t[l] + ms_gauss_c[s] * w->h;
        ms_rates(run, &w->window, w->x, fresh);
        for (int i = 0; i < MS_N; i++)
            for (int l = 0; l < MS_L; l++) {
                change = ms_fmax(change, fabs(fresh[i][l] - w->k[s][i][l]));
                size = ms_fmax(size, fabs(fresh[i][l]));
                w->k[s][i][l] = fresh[i][l];
            }
    }
    return size > 0.0 ? change / size : change == 0.0 ? 0.0 : NAN;
}

/* Start from the last step's polynomial, continued; sweep until rounding stops the progress. */
static int ms_solve(const ms_run *run, ms_work *w)
{
    memcpy(w->last, w->k, sizeof w->k);
    for (int s = 0; s < MS_S; s++)
        MS_STATES
        {
            double sum = 0.0;
            for (int j = 0; j < MS_S; j++)
                sum += ms_gauss_ahead[s][j] * w->last[j][i][l];
            w->k[s][i][l] = sum;
        }
    /* twice without progress: rounding, which for angles of 1e5 rad and stiff shafts is far above 1e-16 */
    double best = INFINITY;
    for (int sweep = 0, idle = 0; sweep < 200; sweep++) {
        const double change = ms_sweep(run, w);
        idle = change < best ? 0 : idle + 1;
        if (change == 0.0 || (change < 1e-6 && idle == 2))
            return 1;
        best = ms_fmin(best, change);
    }
    return 0;
}

static void ms_take(ms_work *w)
{
    MS_STATES
    {
        double sum = 0.0;
        for (int j = 0; j < MS_S; j++)
            sum += ms_gauss_b[j] * w->k[j][i][l];
        const double rise = w->h * sum + w->lost[i][l], next = w->y[i][l] + rise;
        w->lost[i][l] = rise - (next - w->y[i][l]);
        w->y[i][l] = next;
    }
}

/* All lanes from one time to another in equal steps. */
static int ms_stretch(const ms_run *run, ms_work *w, double from, double to)
{
    const long count = (long)ceil((to - from) / run->first_step * (1.0 - 1e-12));
    w->h = (to - from) / (count > 0 ? count : 1);
    for (long n = 0; n < count; n++) {
        MS_EACH w->t[l] = from + n * w->h;
        if (run->steps[0] >= run->max_steps)
            return MS_TOO_MANY;
        if (!ms_solve(run, w))
            return MS_NO_SOLUTION;
        ms_take(w);
        for (int l = 0; l < MS_L; l++)
            run->steps[l]++;
    }
    return MS_DONE;
}

static int ms_all(const ms_run *run, ms_work *w, double *t)
{
    long *const sample = run->sampled;
    for (long segment = 0; segment < run->segments; segment++) {
        const double until = run->until[segment * MS_L];
        for (int l = 0; l < MS_L; l++)
            for (int j = 0; j < MS_P; j++)
                w->x[1 + MS_N + j][l] = run->held[(segment * MS_P + j) * MS_L + l];
        while (*t < until) {
            const int wanted = *sample < run->times && run->grid[*sample] <= until;
            const double end = wanted ? run->grid[*sample] : until;
            const int status = ms_stretch(run, w, *t, end);
            if (status != MS_DONE)
                return status;
            *t = end;
            for (int i = 0; i < MS_N && wanted; i++)
                for (int l = 0; l < MS_L; l++)
                    run->samples[l][*sample * MS_N + i] = w->y[i][l];
            *sample += wanted;
        }
    }
    return MS_DONE;
}

MS_EXPORT void ms_gauss(const ms_run *run)
{
    ms_work work, *w = &work;
    ms_piece pieces[run->tables + 1];
    ms_row terms[ms_terms(run)];
    double t = run->t[0];
    memset(w, 0, sizeof *w);
    ms_open(run, &w->window, pieces, terms);
    memcpy(w->y, run->y, sizeof w->y);
    for (int l = 0; l < MS_L; l++)
        run->steps[l] = run->rejected[l] = run->sampled[l] = 0, run->met[l] = -1;
    const int status = ms_all(run, w, &t);
    memcpy(run->y, w->y, sizeof w->y);
    for (int l = 0; l < MS_L; l++) {
        run->t[l] = t;
        run->status[l] = status;
        run->sampled[l] = run->sampled[0];
        run->last_step[l] = w->h;
    }
}
