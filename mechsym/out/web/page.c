/* The machine of core.h for a page: one instance, reached by value references. */
#include "model.h"
#include "method.h"
#include "core.h"

#define EXPORT(NAME) __attribute__((export_name(NAME)))

static machine m;

EXPORT("reset") void page_reset(double tolerance)
{
    core_start(&m);
    m.tolerance = tolerance;
}
EXPORT("set") int page_set(unsigned reference, double value) { return core_set(&m, reference, value); }
EXPORT("get") double page_get(unsigned reference)
{
    double value = 0.0;
    return core_get(&m, reference, &value) ? value : NAN;
}
/* 1 when t was reached, 2 when a stop ended the run before, 0 when it failed */
EXPORT("advance") int page_advance(double t)
{
    if (!core_advance(&m, t))
        return 0;
    return m.stopped < 0 ? 1 : 2;
}
