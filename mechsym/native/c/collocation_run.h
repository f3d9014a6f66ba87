/* Step control of the collocation: segments of time, wanted times, surfaces that end the run. Only lane 0 of the
 * description is used; wanted times and surfaces are met by steps of their own inside an accepted one, because the
 * polynomial through the stages is of lower order than the step. */
static int ms_inside(const ms_run *run, ms_work *w, double length)
{
    const long before = w->sweeps;
    const int sweeps = ms_solve(run, w, length);
    w->sweeps = before; /* that the steps converge slowly is judged by the steps alone */
    ms_close(w, length);
    return sweeps;
}

/* The wanted times up to `end`; the step that is about to be taken stays in `next`. */
static int ms_sample(const ms_run *run, ms_work *w, double end)
{
    double next[MS_N], rest[MS_N];
    memcpy(next, w->next, sizeof next), memcpy(rest, w->rest, sizeof rest);
    for (; run->sampled[0] < run->times && run->grid[run->sampled[0]] <= end; ++*run->sampled) {
        const double due = run->grid[run->sampled[0]];
        if (due < end && !ms_inside(run, w, due - w->t))
            return 0;
        for (int i = 0; i < MS_N; i++)
            run->samples[0][run->sampled[0] * MS_N + i] = due < end ? w->next[i] : next[i];
    }
    memcpy(w->next, next, sizeof next), memcpy(w->rest, rest, sizeof rest);
    return 1;
}

/* The part of a step in which a surface is crossed first, seen at its stages; returns the surface or -1. */
static long ms_crossed(const ms_run *run, const ms_work *w, double h, double *low, double *high)
{
    long met = -1;
    *high = INFINITY;
    for (long i = 0; i < run->surfaces; i++) {
        const ms_surface *s = run->surface + i;
        /* not from w->x, which a sweep leaves out where no rate depends on the state */
        const ms_eight inside = w->y[s->state] + h * ms_weigh(ms_once, &w->k[s->state]);
        const double *stage = (const double *)&inside;
        double before = w->y[s->state], from = 0.0;
        for (int l = 0; l <= MS_S; l++) {
            const double after = l < MS_S ? stage[l] : w->next[s->state], to = l < MS_S ? ms_nodes[l] : 1.0;
            if (ms_crosses(s->direction, before, after, s->level[0]) && to < *high)
                *low = from, *high = to, met = i;
            before = after, from = to;
        }
    }
    return met;
}

/* End the step on a surface, by bisection with steps of their own: it happens once in a run. */
static double ms_meet(const ms_run *run, ms_work *w, double low, double high, long met)
{
    const ms_surface *s = run->surface + met;
    const double level = s->level[0];
    ms_inside(run, w, high);
    const int falls = w->next[s->state] < level || (w->next[s->state] == level && s->direction < 0);
    for (double middle = 0.5 * (low + high); low < middle && middle < high; middle = 0.5 * (low + high)) {
        ms_inside(run, w, middle);
        if ((w->next[s->state] < level) == falls)
            high = middle;
        else
            low = middle;
    }
    ms_inside(run, w, high);
    return high;
}

static void ms_accept(const ms_run *run, ms_work *w, double t)
{
    w->t = t;
    memcpy(w->y, w->next, sizeof w->y);
    memcpy(w->lost, w->rest, sizeof w->lost);
    run->steps[0]++;
}

/* The rates at the start of a segment, as a series of one term, and a first step (Hairer, Norsett, Wanner, II.4). */
static void ms_restart(const ms_run *run, ms_work *w)
{
    ms_eight rate[MS_N];
    double size = 0.0, slope = 0.0;
    w->x[0] = ms_all(w->t);
    for (int i = 0; i < MS_N; i++)
        w->x[1 + i] = ms_all(w->y[i]);
    ms_evaluate(run, w, rate);
    for (int i = 0; i < MS_N; i++) {
        const double scale = 1.0 / (run->atol + run->rtol * fabs(w->y[i])), f = rate[i][0];
        w->series[i] = (ms_eight){f};
        size += w->y[i] * scale * w->y[i] * scale;
        slope += f * scale * f * scale;
    }
    w->origin = w->t, w->length = 1.0;
    if (run->first_step > 0.0)
        w->h = run->first_step;
    else if (!(w->h > 0.0))
        w->h = size > 0.0 && slope > 0.0 ? 0.01 * sqrt(size / slope) : 1e-6;
    ms_take_slopes(run, w);
}

/* Try one step to `until` at most; returns a status, or -1 to go on. */
static int ms_step(const ms_run *run, ms_work *w, double until)
{
    const int last = w->h * 1.01 >= until - w->t;
    const double h = last ? until - w->t : w->h;
    for (int i = 0; i < MS_N; i++)
        w->scale[i] = 1.0 / (run->atol + run->rtol * fabs(w->y[i]));
    const double error = ms_solve(run, w, h) ? ms_judge(w, h) : INFINITY;
    if (!(error <= 1.0)) {
        run->rejected[0]++;
        w->h = h * (error < INFINITY ? ms_fmax(0.9 * pow(error, -1.0 / 16.0), 0.2) : 0.4);
        return -1;
    }
    ms_close(w, h);
    double low, high, end = last ? until : w->t + h;
    const long met = ms_crossed(run, w, h, &low, &high);
    if (met >= 0)
        end = w->t + ms_meet(run, w, low * h, high * h, met);
    if (!ms_sample(run, w, end))
        return MS_NO_SOLUTION;
    ms_accept(run, w, end);
    /* slow to grow: the error swings within a turn, and a step that grows in a valley fails at the next peak */
    const double grown = h * (error < 1e-6 ? 2.0 : 1.03 - 0.06 * sqrt(sqrt(error)));
    w->h = last ? ms_fmax(w->h, grown) : grown;
    run->met[0] = met;
    return met < 0 ? -1 : MS_MET;
}

/* Steps to the end of a segment; a status, or -1 to go on with the next segment. */
static int ms_segment(const ms_run *run, ms_work *w, double until)
{
    ms_restart(run, w);
    while (w->t < until) {
        if (run->steps[0] + run->rejected[0] >= run->max_steps)
            return MS_TOO_MANY;
        if (!(w->h > 4e-16 * fabs(w->t)))
            return MS_TOO_SMALL;
        /* a strongly damped shaft: short steps of an explicit method cost less than many sweeps */
        if (++w->tries > 256) {
            if (w->sweeps > 11 * w->tries)
                return MS_SLOW;
            w->tries = w->sweeps = 0;
        }
        if (++w->slopes_age > 256)
            ms_take_slopes(run, w);
        const int status = ms_step(run, w, until);
        if (status >= 0)
            return status;
    }
    return -1;
}

static int ms_hold_all(const ms_run *run, ms_work *w)
{
    int more = 0;
    const long segment = w->segment;
    for (int l = 0; l < MS_L; l++) {
        w->segment = segment;
        more = ms_hold(run, &w->segment, w->t, (ms_row *)w->x, l);
    }
    return more;
}

MS_EXPORT void ms_collocation(const ms_run *run)
{
    ms_work work, *w = &work;
    memset(w, 0, sizeof *w);
    for (int i = 0; i < MS_N; i++)
        w->y[i] = run->y[i * MS_L];
    w->t = run->t[0];
    run->steps[0] = run->rejected[0] = run->sampled[0] = 0;
    run->met[0] = -1;
    int status = -1;
    while (status < 0)
        status = ms_hold_all(run, w) ? ms_segment(run, w, run->until[w->segment * MS_L]) : MS_DONE;
    run->t[0] = w->t;
    run->last_step[0] = w->h;
    run->status[0] = status;
    for (int i = 0; i < MS_N; i++)
        run->y[i * MS_L] = w->y[i];
}
