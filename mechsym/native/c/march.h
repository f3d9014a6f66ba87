/* A recurrence over stages in many lanes at once: state = step(state, stage, lane).
 *
 * Lanes go through all stages in blocks of MS_W, whose state stays in the first cache. Needs MS_NAME and MS_NS, MS_NK,
 * MS_NL, MS_NR: numbers of states, stage values, lane values and recorded values.
 */
/* stage[step][MS_NK], lane[MS_NL][lanes], state[MS_NS][lanes] (start, then end), record[step][MS_NR][lanes] */
MS_EXPORT void ms_march(long steps, long lanes, const double *k, const double *stage, const double *lane, double *state,
                        double *record)
{
    double now[MS_NS][MS_W];
    for (long start = 0; start < lanes; start += MS_W) {
        const long m = lanes - start < MS_W ? lanes - start : MS_W;
        for (int i = 0; i < MS_NS; i++)
            memcpy(now[i], state + i * lanes + start, m * sizeof(double));
        for (long n = 0; n < steps; n++)
            MS_(_stage)(m, k, now[0], stage + n * MS_NK, lane + start, lanes, record + n * MS_NR * lanes + start);
        for (int i = 0; i < MS_NS; i++)
            memcpy(state + i * lanes + start, now[i], m * sizeof(double));
    }
}
