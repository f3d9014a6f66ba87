/* Equal steps of an explicit Runge-Kutta method from s = 0 to 1, MS_L runs side by side.
 *
 * MS_FOLD_STAGES and MS_FOLD_WEIGHTS are the method's numbers. Arrays of runs lie side by side; the last block of lanes
 * is filled up with copies of the last run.
 */
#define MS_Q(j) slope[j][i][l]
#define MS_STAGE(stage, node, sum)                                                                                    \
    MS_STATES x[1 + i][l] = y[i][l] + h * (sum);                                                                      \
    MS_EACH x[0][l] = (n + (node)) * h;                                                                               \
    ms_rate(k, x, slope[stage]);

/* one copy of the rates for all stages, or compiling takes as many times longer */
static __attribute__((noinline)) void ms_rate(const double *k, const ms_row *x, ms_row *rate)
{
    MS_RATES(k, x[0], rate[0]);
}

/* k[constant][lane], start[state][run], held[value][run] -> history[step][state][run] */
MS_EXPORT void ms_fold(long steps, long runs, const double *k, const double *start, const double *held, double *history)
{
    ms_row x[MS_X], y[MS_N], slope[MS_STAGES_NUMBER][MS_N];
    const double h = 1.0 / steps;
    for (long first = 0; first < runs; first += MS_L) {
        const long count = runs - first < MS_L ? runs - first : MS_L;
        for (int l = 0; l < MS_L; l++) {
            const long run = first + (l < count ? l : count - 1);
            for (int i = 0; i < MS_N; i++)
                y[i][l] = start[i * runs + run];
            for (int j = 0; j < MS_P; j++)
                x[1 + MS_N + j][l] = held[j * runs + run];
        }
        for (long n = 0; n < steps; n++) {
            MS_FOLD_STAGES(MS_STAGE)
            MS_STATES y[i][l] += h * (MS_FOLD_WEIGHTS);
            for (int i = 0; i < MS_N; i++)
                memcpy(history + (n * MS_N + i) * runs + first, y[i], count * sizeof(double));
        }
    }
}
