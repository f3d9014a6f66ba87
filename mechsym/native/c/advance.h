/* Step control of DOP853 in all lanes.
 *
 * A step ends at each time where held values jump, and at each kink and surface that it meets: a kink is seen ahead by
 * the speed of its state, and a step that crosses a level all the same is thrown away and made again so that it ends
 * there. No step uses the equations of both sides.
 */
static void ms_finish(const ms_run *run, ms_work *w, int l, long status)
{
    run->status[l] = status;
    run->last_step[l] = w->h[l];
    w->active[l] = 0;
    w->step[l] = 0.0;
}

/* The held values at the lane's time; returns 0 when all segments are over. */
static int ms_enter(const ms_run *run, ms_work *w, int l)
{
    const int more = ms_hold(run, &w->segment[l], w->t[l], w->x, l);
    w->until[l] = more ? run->until[w->segment[l] * MS_L + l] : INFINITY;
    return more;
}

static void ms_look_ahead(const ms_run *run, ms_work *w, int l)
{
    w->due[l] = run->sampled[l] < run->times ? run->grid[l * run->times + run->sampled[l]] : INFINITY;
}

/* x^(-1/p), p = 2^n, to two hundredths below: enough for a step size, and without four roots in a row. The bits of a
 * double are nearly its logarithm; one step of Newton's method follows. Finite down to x = 0,
 * where y^16 stays just below 2^1024. */
MS_INLINE double ms_rough_root(double x, int n)
{
    const ms_bits one = 0x3ff0000000000000ULL;
    const double y = ms_from_bits(one + (one >> n) - 0x0000b00000000000ULL - (ms_to_bits(x) >> n)), p = 1 << n;
    double power = y * y * y * y;
    for (int i = 2; i < n; i++)
        power *= power;
    return y * ((p + 1.0) - x * power) * (1.0 / p);
}

/* The next step after an error: half the usual gain, for where the error swings within a turn a step that has grown
 * in its valley is rejected at its peak. */
MS_INLINE double ms_longer(double step, double error)
{
    return step * ms_fmin(6.0, 0.9 * ms_rough_root(error, 4));
}

MS_INLINE double ms_shorter(double step, double error)
{
    return step * (error < INFINITY ? ms_fmax(0.9 * ms_rough_root(error, 3), 1.0 / 3.0) : 0.1);
}

/* At one kink all states look around: another one may stand on a kink of its own. */
static void ms_look_at_kinks(const ms_run *run, ms_work *w, int l)
{
    for (long i = 0; i < run->kinked; i++) {
        const long state = run->kinked_states[i];
        ms_look_around(run, &w->window, l, state, w->y[state][l], w->q[0][state][l]);
    }
}

static int ms_begin(const ms_run *run, ms_work *w, ms_piece *pieces, ms_row *terms)
{
    int fresh[MS_L], count = 0;
    memset(w, 0, sizeof *w);
    ms_open(run, &w->window, pieces, terms);
    for (int l = 0; l < MS_L; l++) {
        for (int i = 0; i < MS_N; i++)
            w->y[i][l] = run->y[i * MS_L + l];
        w->t[l] = run->t[l];
        fresh[l] = 1;
        run->steps[l] = run->rejected[l] = run->sampled[l] = 0;
        run->met[l] = -1;
        w->active[l] = 1;
        ms_look_ahead(run, w, l);
        if (ms_enter(run, w, l))
            count++;
        else
            ms_finish(run, w, l, MS_DONE);
    }
    ms_first_rates(run, w);
    for (int l = 0; l < MS_L; l++)
        ms_look_at_kinks(run, w, l);
    /* a run that starts on a kink may leave it backwards */
    if (run->kinked)
        ms_first_rates(run, w);
    ms_guess_step(run, w, fresh);
    return count;
}

/* When a state comes to the next kink on its way, by a parabola where its rate is a state. */
static void ms_time_to_kink(const ms_work *w, long state, double *time)
{
    const long faster = ms_rate_of[state];
    MS_EACH
    {
        const double speed = w->q[0][state][l], bend = faster < 0 ? 0.0 : 0.5 * w->q[0][faster][l];
        const double ahead = (speed < 0.0 ? w->window.below[state][l] : w->window.above[state][l]) - w->y[state][l];
        const double first = ahead / speed, second = ahead / (speed + bend * first);
        const double third = ahead / (speed + bend * second);
        time[l] = (second > 0.0) & (third > 0.0) ? third : INFINITY;
    }
}

/* Steps that would come near a kink end on it, or half way to it. From kink to kink there are MS_BETWEEN steps or
 * more: the length that a step brings from the other side of a kink may be too much for its error to show. */
#define MS_BETWEEN 6.0
static void ms_aim_at_kinks(const ms_run *run, ms_work *w)
{
    ms_row time, least;
    long next[MS_L];
    MS_EACH least[l] = INFINITY;
    for (long i = 0; i < run->kinked; i++) {
        const long state = run->kinked_states[i];
        ms_time_to_kink(w, state, time);
        MS_EACH
        {
            const double between = w->window.above[state][l] - w->window.below[state][l];
            const double most = between / (MS_BETWEEN * fabs(w->q[0][state][l]));
            next[l] = time[l] < least[l] ? i : next[l];
            least[l] = ms_fmin(time[l], least[l]);
            w->step[l] = w->forced[l] > 0.0 ? w->step[l] : ms_fmin(w->step[l], most);
        }
    }
    for (int l = 0; l < MS_L; l++) {
        if (!w->active[l] || w->forced[l] > 0.0 || !(least[l] < 2.0 * w->step[l]))
            continue;
        if (least[l] > 1.05 * w->step[l]) {
            w->step[l] = ms_fmin(w->step[l], 0.5 * least[l]);
        } else if (w->t[l] + least[l] < w->until[l]) {
            const long state = run->kinked_states[next[l]];
            w->step[l] = w->forced[l] = least[l];
            w->target[l] = -1 - next[l];
            w->level[l] = w->q[0][state][l] < 0.0 ? w->window.below[state][l] : w->window.above[state][l];
            w->tries[l] = 0;
            w->guessed[l] = 1;
        }
    }
}

static void ms_choose_steps(const ms_run *run, ms_work *w)
{
    long stuck = 0;
    MS_EACH
    {
        const double left = w->until[l] - w->t[l], usual = w->h[l] * 1.01 >= left ? left : w->h[l];
        w->step[l] = !w->active[l] ? 0.0 : w->forced[l] > 0.0 ? w->forced[l] : usual;
        stuck |= !(w->h[l] > 4e-16 * fabs(w->t[l])) | (run->steps[l] + run->rejected[l] >= run->max_steps);
    }
    for (int l = 0; l < MS_L && stuck; l++) {
        if (!w->active[l])
            continue;
        if (!(w->h[l] > 4e-16 * fabs(w->t[l])))
            ms_finish(run, w, l, MS_TOO_SMALL);
        else if (run->steps[l] + run->rejected[l] >= run->max_steps)
            ms_finish(run, w, l, MS_TOO_MANY);
    }
    ms_aim_at_kinks(run, w);
}

/* Does the step just tried cross a level? With dense output also which one first, and at what share of the step. */
static int ms_crossed(const ms_run *run, const ms_work *w, int l, int dense, double *share, long *target, double *at)
{
    int found = 0;
    *share = INFINITY;
    for (long i = -run->kinked; i < run->surfaces; i++) {
        if (i < 0 && i == w->target[l])
            continue;
        const long state = i < 0 ? run->kinked_states[-1 - i] : run->surface[i].state;
        const double before = w->y[state][l], after = w->next[state][l];
        const double below = w->window.below[state][l], above = w->window.above[state][l];
        /* a run may start on a kink and come back to it within a step */
        const double level = i >= 0 ? run->surface[i].level[l] : after > above ? above : below;
        if (i < 0 ? below <= after && after <= above : !ms_crosses(run->surface[i].direction, before, after, level))
            continue;
        found = 1;
        const double u = dense ? ms_passing(w, state, l, level) : 1.0;
        if (u < *share)
            *share = u, *target = i < 0 ? i : 1 + i, *at = level;
    }
    return found;
}

/* A step to a level ends where the dense output or a parabola says; Newton's steps make it exact. */
static int ms_corrected(const ms_run *run, ms_work *w, int l)
{
    const long kink = w->target[l] < 0, other = kink ? 0 : w->target[l] - 1;
    const long state = kink ? run->kinked_states[-1 - w->target[l]] : run->surface[other].state;
    const double miss = w->next[state][l] - w->level[l], late = miss / w->q[12][state][l];
    const double size = ms_fmax(fabs(w->level[l]), 1.0), length = w->step[l] - late;
    if (fabs(miss) <= (kink ? 1e-13 : 1e-15) * size || w->tries[l] == 6 || !(length > 0.0))
        return 0;
    /* a rate that turned leads away from the level */
    if (!(length < 2.0 * w->step[l]) || w->t[l] + length > w->until[l])
        return 0;
    w->tries[l]++;
    w->forced[l] = length;
    return 1;
}

static void ms_reject(const ms_run *run, ms_work *w, int l)
{
    w->h[l] = ms_shorter(w->step[l], w->error[l]);
    w->forced[l] = 0.0;
    w->target[l] = w->guessed[l] = 0;
    run->rejected[l]++;
}

/* A level that lies on a kink: the step that ends at the kink meets it too. */
static void ms_share_kink(const ms_run *run, ms_work *w, int l)
{
    for (long i = 0; i < run->surfaces && w->target[l] < 0; i++) {
        const ms_surface *s = run->surface + i;
        if (ms_crosses(s->direction, w->y[s->state][l], w->next[s->state][l], s->level[l]))
            w->target[l] = 1 + i;
    }
}

/* Take a step over. Returns 2 when the lane enters another segment, 1 when it passes a kink, else 0. */
static int ms_accept(const ms_run *run, ms_work *w, int l, double end)
{
    const double proposed = ms_longer(w->step[l], w->error[l]);
    const int last = end == w->until[l], cut = last || w->step[l] < w->h[l];
    ms_share_kink(run, w, l);
    w->t[l] = end;
    for (int i = 0; i < MS_N; i++) {
        w->y[i][l] = w->next[i][l];
        w->q[0][i][l] = w->q[12][i][l];
    }
    w->h[l] = cut ? ms_fmax(w->h[l], proposed) : proposed;
    w->forced[l] = 0.0;
    run->steps[l]++;
    const long target = w->target[l];
    w->target[l] = w->guessed[l] = 0;
    if (target > 0) {
        run->met[l] = target - 1;
        ms_finish(run, w, l, MS_MET);
        return 0;
    }
    if (target < 0)
        ms_look_at_kinks(run, w, l);
    if (last && !ms_enter(run, w, l)) {
        ms_finish(run, w, l, MS_DONE);
        return 0;
    }
    return last ? 2 : target < 0;
}

static double ms_end(const ms_work *w, int l)
{
    const double until = w->until[l], end = w->t[l] + w->step[l];
    return w->step[l] == until - w->t[l] || end > until ? until : end;
}

/* Lanes with a wanted time up to an end. */
static long ms_due(const ms_work *w, const double *end, int *due)
{
    long any = 0;
    MS_EACH due[l] = w->due[l] <= end[l];
    for (int l = 0; l < MS_L; l++)
        any |= due[l];
    return any;
}

/* States at the wanted times up to the end of each lane's step, by its dense output. end: -INFINITY: not taken */
static void ms_sample(const ms_run *run, ms_work *w, const double *end)
{
    int due[MS_L];
    ms_row share, value[MS_N];
    while (ms_due(w, end, due)) {
        MS_EACH share[l] = (w->due[l] - w->t[l]) / w->step[l];
        ms_inside_all(w, share, value);
        for (int l = 0; l < MS_L; l++) {
            if (!due[l])
                continue;
            double *to = run->samples[l] + run->sampled[l] * MS_N;
            for (int i = 0; i < MS_N; i++)
                to[i] = share[l] < 1.0 ? value[i][l] : w->next[i][l];
            run->sampled[l]++;
            ms_look_ahead(run, w, l);
        }
    }
}

/* The step that a lane takes, for who looks into it later. */
static void ms_keep(const ms_run *run, const ms_work *w, int l)
{
    double *to = run->kept[l] + run->steps[l] % run->keep * (2 + 8 * run->kept_states);
    *to++ = w->t[l], *to++ = w->step[l];
    for (int j = 0; j < 8; j++)
        for (long i = 0; i < run->kept_states; i++)
            *to++ = w->dense[j][i][l];
}

/* The same of all lanes whose step is good. */
static void ms_sample_all(const ms_run *run, ms_work *w)
{
    int due[MS_L];
    ms_row end;
    MS_EACH end[l] = w->active[l] & (w->error[l] <= 1.0) ? w->t[l] + w->step[l] : -INFINITY;
    if (ms_due(w, end, due) || run->keep)
        ms_make_dense(run, w);
    ms_sample(run, w, end);
    for (int l = 0; l < MS_L && run->keep; l++)
        if (end[l] > -INFINITY)
            ms_keep(run, w, l);
}

/* After a try in which no lane meets anything: accept or reject in all lanes at once. Returns 0 if one does. */
static int ms_settle_plain(const ms_run *run, ms_work *w)
{
    long special = run->surfaces | run->kinks;
    MS_EACH special |= w->active[l] & (w->until[l] <= w->t[l] + 1.001 * w->step[l]);
    if (special)
        return 0;
    ms_sample_all(run, w);
    ms_row taken;
    MS_EACH
    {
        const int good = w->error[l] <= 1.0;
        const double next = good ? ms_longer(w->step[l], w->error[l]) : ms_shorter(w->step[l], w->error[l]);
        taken[l] = good ? w->step[l] : 0.0;
        w->h[l] = w->active[l] ? next : w->h[l];
        w->t[l] += taken[l];
        run->steps[l] += w->active[l] & good;
        run->rejected[l] += w->active[l] & !good;
    }
    MS_STATES
    {
        w->y[i][l] = taken[l] > 0.0 ? w->next[i][l] : w->y[i][l];
        w->q[0][i][l] = taken[l] > 0.0 ? w->q[12][i][l] : w->q[0][i][l];
    }
    return 1;
}

/* After a try: reject, force a shorter step, or accept, lane by lane. */
static void ms_settle(const ms_run *run, ms_work *w)
{
    int dense = 0, crosses[MS_L], fresh[MS_L] = {0}, again = 0, guess = 0;
    double share, level = 0.0;
    long target = 0;
    ms_row end;
    for (int l = 0; l < MS_L; l++) {
        crosses[l] = 0, end[l] = -INFINITY;
        if (!w->active[l] || !(w->error[l] <= 1.0))
            continue;
        crosses[l] = (!w->target[l] || w->guessed[l]) && ms_crossed(run, w, l, 0, &share, &target, &level);
        dense |= crosses[l] || w->due[l] <= ms_end(w, l) || run->keep;
    }
    if (dense)
        ms_make_dense(run, w);
    for (int l = 0; l < MS_L; l++) {
        if (!w->active[l])
            continue;
        if (!(w->error[l] <= 1.0)) {
            ms_reject(run, w, l);
        } else if (crosses[l] && ms_crossed(run, w, l, 1, &share, &target, &level) && share < 1.0) {
            w->forced[l] = share * w->step[l];
            w->target[l] = target;
            w->level[l] = level;
            w->tries[l] = w->guessed[l] = 0;
        } else if (!w->target[l] || !ms_corrected(run, w, l)) {
            w->target[l] = crosses[l] ? target : w->target[l];
            end[l] = ms_end(w, l);
        }
    }
    ms_sample(run, w, end);
    for (int l = 0; l < MS_L; l++) {
        if (end[l] > -INFINITY) {
            if (run->keep)
                ms_keep(run, w, l);
            const int entered = ms_accept(run, w, l, end[l]);
            fresh[l] = entered == 2;
            guess |= fresh[l];
            again |= entered > 0;
        }
    }
    if (again)
        ms_first_rates(run, w);
    if (guess)
        ms_guess_step(run, w, fresh);
}

/* One try in all lanes. Returns how many are not done. */
static int ms_turn_over(const ms_run *run, ms_work *w)
{
    int left = 0;
    ms_choose_steps(run, w);
    ms_try(run, w);
    if (!ms_settle_plain(run, w))
        ms_settle(run, w);
    for (int l = 0; l < MS_L; l++)
        left += w->active[l];
    return left;
}

static void ms_leave(const ms_run *run, const ms_work *w)
{
    for (int l = 0; l < MS_L; l++) {
        run->t[l] = w->t[l];
        for (int i = 0; i < MS_N; i++)
            run->y[i * MS_L + l] = w->y[i][l];
    }
}

MS_EXPORT void ms_dop853(const ms_run *run)
{
    ms_work work, *w = &work;
    ms_piece pieces[run->tables + 1];
    ms_row terms[ms_terms(run)];
    for (int left = ms_begin(run, w, pieces, terms); left;)
        left = ms_turn_over(run, w);
    ms_leave(run, w);
}
