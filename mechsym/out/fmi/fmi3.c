/* FMI 3.0, model exchange and co-simulation, of the machine in core.h. */
#include <stdlib.h>
#include <string.h>
#include "identity.h"
#include "fmi3Functions.h"
#include "model.h"
#include "method.h"
#include "core.h"

typedef struct {
    machine m;
    fmi3InstanceEnvironment environment;
    fmi3LogMessageCallback log;
} instance;

#define M (&((instance *)c)->m)
#define REFS const fmi3ValueReference r[], size_t n

static fmi3Status complain(void *c, fmi3Status status, const char *message)
{
    instance *own = c;
    if (own->log)
        own->log(own->environment, status, "logStatusError", message);
    return status;
}

const char *fmi3GetVersion(void) { return fmi3Version; }
fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n, const fmi3String categories[])
{
    (void)c, (void)on, (void)n, (void)categories;
    return fmi3OK;
}

static fmi3Instance make(fmi3String token, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log)
{
    instance *own = token && !strcmp(token, TOKEN) ? calloc(1, sizeof *own) : NULL;
    if (!own)
        return NULL;
    own->environment = environment;
    own->log = log;
    core_start(&own->m);
    return own;
}
fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String path, fmi3Boolean visible,
                                          fmi3Boolean logging, fmi3InstanceEnvironment environment,
                                          fmi3LogMessageCallback log)
{
    (void)name, (void)path, (void)visible, (void)logging;
    return make(token, environment, log);
}
fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String path, fmi3Boolean visible,
                                         fmi3Boolean logging, fmi3Boolean events, fmi3Boolean early,
                                         const fmi3ValueReference required[], size_t n,
                                         fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
                                         fmi3IntermediateUpdateCallback update)
{
    (void)name, (void)path, (void)visible, (void)logging, (void)events, (void)early, (void)required, (void)n;
    (void)update;
    return make(token, environment, log);
}
fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String path, fmi3Boolean visible,
                                               fmi3Boolean logging, fmi3InstanceEnvironment environment,
                                               fmi3LogMessageCallback log, fmi3ClockUpdateCallback update,
                                               fmi3LockPreemptionCallback lock, fmi3UnlockPreemptionCallback unlock)
{
    (void)name, (void)token, (void)path, (void)visible, (void)logging, (void)environment, (void)log, (void)update;
    (void)lock, (void)unlock;
    return NULL;
}
void fmi3FreeInstance(fmi3Instance c) { free(c); }

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean defined, fmi3Float64 tolerance, fmi3Float64 start,
                                       fmi3Boolean stop_defined, fmi3Float64 stop)
{
    (void)stop_defined, (void)stop;
    M->t = M->start = start;
    if (defined && tolerance > 0.0)
        M->tolerance = tolerance;
    return fmi3OK;
}
fmi3Status fmi3ExitInitializationMode(fmi3Instance c) { core_update(M); return fmi3OK; }
fmi3Status fmi3EnterEventMode(fmi3Instance c) { (void)c; return fmi3OK; }
fmi3Status fmi3Terminate(fmi3Instance c) { (void)c; return fmi3OK; }
fmi3Status fmi3Reset(fmi3Instance c) { core_start(M); return fmi3OK; }

fmi3Status fmi3GetFloat64(fmi3Instance c, REFS, fmi3Float64 value[], size_t count)
{
    for (size_t i = 0; i < n; i++)
        if (count != n || !core_get(M, r[i], &value[i]))
            return complain(c, fmi3Error, "fmi3GetFloat64: no such variable");
    return fmi3OK;
}
fmi3Status fmi3SetFloat64(fmi3Instance c, REFS, const fmi3Float64 value[], size_t count)
{
    for (size_t i = 0; i < n; i++)
        if (count != n || !core_set(M, r[i], value[i]))
            return complain(c, fmi3Error, "fmi3SetFloat64: not a state, an input or a parameter, or not a number");
    return fmi3OK;
}
#define REFUSE                                                                                                         \
    (void)r, (void)value;                                                                                              \
    return n ? complain(c, fmi3Error, "only Float64 variables") : fmi3OK;
#define NONE(NAME)                                                                                                     \
    fmi3Status fmi3Get##NAME(fmi3Instance c, REFS, fmi3##NAME value[], size_t count) { (void)count; REFUSE }           \
    fmi3Status fmi3Set##NAME(fmi3Instance c, REFS, const fmi3##NAME value[], size_t count) { (void)count; REFUSE }
NONE(Float32)
NONE(Int8)
NONE(UInt8)
NONE(Int16)
NONE(UInt16)
NONE(Int32)
NONE(UInt32)
NONE(Int64)
NONE(UInt64)
NONE(Boolean)
NONE(String)
fmi3Status fmi3GetBinary(fmi3Instance c, REFS, size_t size[], fmi3Binary value[], size_t count)
{
    (void)size, (void)count;
    REFUSE
}
fmi3Status fmi3SetBinary(fmi3Instance c, REFS, const size_t size[], const fmi3Binary value[], size_t count)
{
    (void)size, (void)count;
    REFUSE
}
fmi3Status fmi3GetClock(fmi3Instance c, REFS, fmi3Clock value[]) { REFUSE }
fmi3Status fmi3SetClock(fmi3Instance c, REFS, const fmi3Clock value[]) { REFUSE }

fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance c, fmi3ValueReference r, size_t *n)
{
    (void)r, (void)n;
    return complain(c, fmi3Error, "dependencies stand in modelDescription.xml");
}
fmi3Status fmi3GetVariableDependencies(fmi3Instance c, fmi3ValueReference dependent, size_t own[],
                                       fmi3ValueReference independent[], size_t other[], fmi3DependencyKind kinds[],
                                       size_t n)
{
    (void)dependent, (void)own, (void)independent, (void)other, (void)kinds, (void)n;
    return complain(c, fmi3Error, "dependencies stand in modelDescription.xml");
}

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state)
{
    if (!*state)
        *state = malloc(sizeof(machine));
    if (!*state)
        return complain(c, fmi3Error, "no memory for the state");
    memcpy(*state, M, sizeof(machine));
    return fmi3OK;
}
fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state) { memcpy(M, state, sizeof(machine)); return fmi3OK; }
fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state)
{
    (void)c;
    free(*state);
    *state = NULL;
    return fmi3OK;
}
fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state, size_t *size)
{
    (void)c, (void)state;
    *size = sizeof(machine);
    return fmi3OK;
}
fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size)
{
    if (size < sizeof(machine))
        return complain(c, fmi3Error, "fmi3SerializeFMUState: the buffer is too small");
    memcpy(bytes, state, sizeof(machine));
    return fmi3OK;
}
fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size, fmi3FMUState *state)
{
    if (size != sizeof(machine))
        return complain(c, fmi3Error, "fmi3DeserializeFMUState: not a state of this machine");
    if (!*state)
        *state = malloc(sizeof(machine));
    if (!*state)
        return complain(c, fmi3Error, "no memory for the state");
    memcpy(*state, bytes, size);
    return fmi3OK;
}
fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, const fmi3ValueReference unknown[], size_t nu,
                                        const fmi3ValueReference known[], size_t nk, const fmi3Float64 seed[],
                                        size_t ns, fmi3Float64 change[], size_t nc)
{
    return ns == nk && nc == nu && core_directional(M, unknown, nu, known, nk, seed, change)
               ? fmi3OK
               : complain(c, fmi3Error, "fmi3GetDirectionalDerivative: not a rate or an output, or not a state, input "
                                        "or parameter");
}
fmi3Status fmi3GetAdjointDerivative(fmi3Instance c, const fmi3ValueReference unknown[], size_t nu,
                                    const fmi3ValueReference known[], size_t nk, const fmi3Float64 seed[], size_t ns,
                                    fmi3Float64 change[], size_t nc)
{
    (void)unknown, (void)nu, (void)known, (void)nk, (void)seed, (void)ns, (void)change, (void)nc;
    return complain(c, fmi3Error, "no adjoint derivatives; take the directional ones");
}

fmi3Status fmi3EnterConfigurationMode(fmi3Instance c) { (void)c; return fmi3OK; }
fmi3Status fmi3ExitConfigurationMode(fmi3Instance c) { (void)c; return fmi3OK; }
#define NO_CLOCKS return complain(c, fmi3Error, "there are no clocks");
fmi3Status fmi3GetIntervalDecimal(fmi3Instance c, REFS, fmi3Float64 a[], fmi3IntervalQualifier b[])
{
    (void)r, (void)n, (void)a, (void)b;
    NO_CLOCKS
}
fmi3Status fmi3GetIntervalFraction(fmi3Instance c, REFS, fmi3UInt64 a[], fmi3UInt64 b[], fmi3IntervalQualifier q[])
{
    (void)r, (void)n, (void)a, (void)b, (void)q;
    NO_CLOCKS
}
fmi3Status fmi3GetShiftDecimal(fmi3Instance c, REFS, fmi3Float64 a[]) { (void)r, (void)n, (void)a; NO_CLOCKS }
fmi3Status fmi3GetShiftFraction(fmi3Instance c, REFS, fmi3UInt64 a[], fmi3UInt64 b[])
{
    (void)r, (void)n, (void)a, (void)b;
    NO_CLOCKS
}
fmi3Status fmi3SetIntervalDecimal(fmi3Instance c, REFS, const fmi3Float64 a[]) { (void)r, (void)n, (void)a; NO_CLOCKS }
fmi3Status fmi3SetIntervalFraction(fmi3Instance c, REFS, const fmi3UInt64 a[], const fmi3UInt64 b[])
{
    (void)r, (void)n, (void)a, (void)b;
    NO_CLOCKS
}
fmi3Status fmi3SetShiftDecimal(fmi3Instance c, REFS, const fmi3Float64 a[]) { (void)r, (void)n, (void)a; NO_CLOCKS }
fmi3Status fmi3SetShiftFraction(fmi3Instance c, REFS, const fmi3UInt64 a[], const fmi3UInt64 b[])
{
    (void)r, (void)n, (void)a, (void)b;
    NO_CLOCKS
}
fmi3Status fmi3ActivateModelPartition(fmi3Instance c, fmi3ValueReference clock, fmi3Float64 time)
{
    (void)clock, (void)time;
    NO_CLOCKS
}
fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance c) { (void)c; return fmi3OK; }
fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *again, fmi3Boolean *terminate,
                                    fmi3Boolean *nominals, fmi3Boolean *states, fmi3Boolean *next_defined,
                                    fmi3Float64 *next_time)
{
    const int met = core_met(M, M->x);
    *states = core_close(M, OFF);
    core_update(M);
    const double next = core_next_switch(M);
    *again = *nominals = fmi3False;
    *terminate = met >= 0 || M->stopped >= 0;
    *next_defined = isfinite(next) ? fmi3True : fmi3False;
    *next_time = isfinite(next) ? next : 0.0;
    return fmi3OK;
}
fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance c) { (void)c; return fmi3OK; }
fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean keep, fmi3Boolean *event, fmi3Boolean *terminate)
{
    machine now = *M;
    (void)keep;
    *event = core_close(&now, OFF); /* the states are put back at it */
    *terminate = fmi3False;
    return fmi3OK;
}
fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 time)
{
    M->t = time;
    M->fresh = 0;
    return fmi3OK;
}
#define SIZED(NAME, COUNT)                                                                                             \
    if (n != COUNT)                                                                                                    \
        return complain(c, fmi3Error, NAME ": wrong number of values");
fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 x[], size_t n)
{
    SIZED("fmi3SetContinuousStates", NX)
    memcpy(M->x, x, sizeof M->x);
    M->fresh = 0;
    return fmi3OK;
}
fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 d[], size_t n)
{
    SIZED("fmi3GetContinuousStateDerivatives", NX)
    core_rates(M, M->t, M->x, d);
    return fmi3OK;
}
fmi3Status fmi3GetEventIndicators(fmi3Instance c, fmi3Float64 z[], size_t n)
{
    SIZED("fmi3GetEventIndicators", NZ)
    core_indicators(M, z);
    return fmi3OK;
}
fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64 x[], size_t n)
{
    SIZED("fmi3GetContinuousStates", NX)
    memcpy(x, M->x, sizeof M->x);
    return fmi3OK;
}
fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64 x[], size_t n)
{
    (void)c;
    for (size_t i = 0; i < n; i++)
        x[i] = 1.0;
    return fmi3OK;
}
fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t *n) { (void)c; *n = NZ; return fmi3OK; }
fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t *n) { (void)c; *n = NX; return fmi3OK; }

fmi3Status fmi3EnterStepMode(fmi3Instance c) { (void)c; return fmi3OK; }
fmi3Status fmi3GetOutputDerivatives(fmi3Instance c, REFS, const fmi3Int32 orders[], fmi3Float64 value[], size_t count)
{
    (void)r, (void)orders, (void)value, (void)count;
    return n ? complain(c, fmi3Error, "no derivatives of outputs") : fmi3OK;
}
fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 t, fmi3Float64 step, fmi3Boolean keep, fmi3Boolean *event,
                      fmi3Boolean *terminate, fmi3Boolean *early, fmi3Float64 *last)
{
    (void)keep;
    *event = *terminate = *early = fmi3False;
    M->t = t;
    const int done = core_advance(M, t + step);
    *last = M->t;
    if (!done)
        return complain(c, fmi3Error, "the step became too small; check inputs and parameters");
    *terminate = M->stopped >= 0;
    return fmi3OK;
}
