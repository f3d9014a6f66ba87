/* The function MS_NAME as CasADi calls it: arg[i] and res[i] point to stored elements, or are null for zeros and for
 * what is not wanted. MS_INPUTS, MS_OUTPUTS, their sizes, names and sparsities are written before. */

MS_EXPORT int MS_NAME(const double **arg, double **res, long long *iw, double *w, int mem)
{
    double x[MS_NX > 0 ? MS_NX : 1], y[MS_NY > 0 ? MS_NY : 1];
    long place = 0;
    (void)iw, (void)w, (void)mem;
    for (int i = 0; i < MS_INPUTS; i++)
        for (long j = 0; j < MS_(_size_in)[i]; j++)
            x[place++] = arg[i] ? arg[i][j] : 0.0;
    MS_(_at)(x, y);
    place = 0;
    for (int i = 0; i < MS_OUTPUTS; place += MS_(_size_out)[i++])
        if (res[i])
            memcpy(res[i], y + place, MS_(_size_out)[i] * sizeof(double));
    return 0;
}

MS_EXPORT long long MS_(_n_in)(void)
{
    return MS_INPUTS;
}

MS_EXPORT long long MS_(_n_out)(void)
{
    return MS_OUTPUTS;
}

MS_EXPORT const char *MS_(_name_in)(long long i)
{
    return MS_(_names_in)[i];
}

MS_EXPORT const char *MS_(_name_out)(long long i)
{
    return MS_(_names_out)[i];
}

MS_EXPORT const long long *MS_(_sparsity_in)(long long i)
{
    return MS_(_sparsities_in)[i];
}

MS_EXPORT const long long *MS_(_sparsity_out)(long long i)
{
    return MS_(_sparsities_out)[i];
}

MS_EXPORT int MS_(_work)(long long *arg, long long *res, long long *iw, long long *w)
{
    *arg = MS_INPUTS, *res = MS_OUTPUTS, *iw = 0, *w = 0;
    return 0;
}
