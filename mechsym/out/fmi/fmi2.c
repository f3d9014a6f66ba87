/* FMI 2.0, model exchange and co-simulation, of the machine in core.h. */
#include <stdlib.h>
#include <string.h>
#include "identity.h"
#include "fmi2Functions.h"
#include "model.h"
#include "method.h"
#include "core.h"

typedef struct {
    machine m;
    fmi2CallbackFunctions call;
    char *name;
} instance;

#define M (&((instance *)c)->m)

static fmi2Status complain(void *c, fmi2Status status, const char *message)
{
    instance *own = c;
    if (own->call.logger)
        own->call.logger(own->call.componentEnvironment, own->name, status, "logStatusError", message);
    return status;
}

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }
const char *fmi2GetVersion(void) { return fmi2Version; }
fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String categories[])
{
    (void)c, (void)on, (void)n, (void)categories;
    return fmi2OK;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging)
{
    (void)type, (void)resources, (void)visible, (void)logging;
    if (!functions || !guid || strcmp(guid, TOKEN))
        return NULL;
    instance *own = calloc(1, sizeof *own);
    if (!own)
        return NULL;
    own->call = *functions;
    own->name = calloc(1, strlen(name ? name : "") + 1);
    if (!own->name) {
        free(own);
        return NULL;
    }
    strcpy(own->name, name ? name : "");
    core_start(&own->m);
    return own;
}

void fmi2FreeInstance(fmi2Component c)
{
    if (c)
        free(((instance *)c)->name);
    free(c);
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean defined, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean stop_defined, fmi2Real stop)
{
    (void)stop_defined, (void)stop;
    M->t = M->start = start;
    if (defined && tolerance > 0.0)
        M->tolerance = tolerance;
    return fmi2OK;
}
fmi2Status fmi2EnterInitializationMode(fmi2Component c) { (void)c; return fmi2OK; }
fmi2Status fmi2ExitInitializationMode(fmi2Component c) { core_update(M); return fmi2OK; }
fmi2Status fmi2Terminate(fmi2Component c) { (void)c; return fmi2OK; }
fmi2Status fmi2Reset(fmi2Component c) { core_start(M); return fmi2OK; }

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Real value[])
{
    for (size_t i = 0; i < n; i++)
        if (!core_get(M, r[i], &value[i]))
            return complain(c, fmi2Error, "fmi2GetReal: no such variable");
    return fmi2OK;
}
fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Real value[])
{
    for (size_t i = 0; i < n; i++)
        if (!core_set(M, r[i], value[i]))
            return complain(c, fmi2Error, "fmi2SetReal: not a state, an input or a parameter, or not a number");
    return fmi2OK;
}
#define NONE(NAME, TYPE)                                                                                               \
    fmi2Status fmi2Get##NAME(fmi2Component c, const fmi2ValueReference r[], size_t n, TYPE value[])                    \
    {                                                                                                                  \
        (void)r, (void)value;                                                                                          \
        return n ? complain(c, fmi2Error, "only real variables") : fmi2OK;                                             \
    }                                                                                                                  \
    fmi2Status fmi2Set##NAME(fmi2Component c, const fmi2ValueReference r[], size_t n, const TYPE value[])              \
    {                                                                                                                  \
        (void)r, (void)value;                                                                                          \
        return n ? complain(c, fmi2Error, "only real variables") : fmi2OK;                                             \
    }
NONE(Integer, fmi2Integer)
NONE(Boolean, fmi2Boolean)
NONE(String, fmi2String)

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    if (!*state)
        *state = malloc(sizeof(machine));
    if (!*state)
        return complain(c, fmi2Error, "no memory for the state");
    memcpy(*state, M, sizeof(machine));
    return fmi2OK;
}
fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) { memcpy(M, state, sizeof(machine)); return fmi2OK; }
fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    (void)c;
    free(*state);
    *state = NULL;
    return fmi2OK;
}
fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size)
{
    (void)c, (void)state;
    *size = sizeof(machine);
    return fmi2OK;
}
fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size)
{
    if (size < sizeof(machine))
        return complain(c, fmi2Error, "fmi2SerializeFMUstate: the buffer is too small");
    memcpy(bytes, state, sizeof(machine));
    return fmi2OK;
}
fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state)
{
    if (size != sizeof(machine))
        return complain(c, fmi2Error, "fmi2DeSerializeFMUstate: not a state of this machine");
    if (!*state)
        *state = malloc(sizeof(machine));
    if (!*state)
        return complain(c, fmi2Error, "no memory for the state");
    memcpy(*state, bytes, size);
    return fmi2OK;
}
fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[], size_t nu,
                                        const fmi2ValueReference known[], size_t nk, const fmi2Real seed[],
                                        fmi2Real change[])
{
    return core_directional(M, unknown, nu, known, nk, seed, change)
               ? fmi2OK
               : complain(c, fmi2Error, "fmi2GetDirectionalDerivative: not a rate or an output, or not a state, input "
                                        "or parameter");
}

fmi2Status fmi2EnterEventMode(fmi2Component c) { (void)c; return fmi2OK; }
fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info)
{
    const int met = core_met(M, M->x), moved = core_close(M, OFF);
    core_update(M);
    const double next = core_next_switch(M);
    memset(info, 0, sizeof *info);
    info->valuesOfContinuousStatesChanged = moved;
    info->terminateSimulation = met >= 0;
    info->nextEventTimeDefined = isfinite(next) ? fmi2True : fmi2False;
    info->nextEventTime = isfinite(next) ? next : 0.0;
    return fmi2OK;
}
fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) { (void)c; return fmi2OK; }
fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean keep, fmi2Boolean *event, fmi2Boolean *terminate)
{
    machine now = *M;
    (void)keep;
    *event = core_close(&now, OFF); /* the states are put back at it */
    *terminate = fmi2False;
    return fmi2OK;
}
fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time)
{
    M->t = time;
    M->fresh = 0;
    return fmi2OK;
}
fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t n)
{
    if (n != NX)
        return complain(c, fmi2Error, "fmi2SetContinuousStates: wrong number of states");
    memcpy(M->x, x, sizeof M->x);
    M->fresh = 0;
    return fmi2OK;
}
fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real d[], size_t n)
{
    if (n != NX)
        return complain(c, fmi2Error, "fmi2GetDerivatives: wrong number of states");
    core_rates(M, M->t, M->x, d);
    return fmi2OK;
}
fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real z[], size_t n)
{
    if (n != NZ)
        return complain(c, fmi2Error, "fmi2GetEventIndicators: wrong number of indicators");
    core_indicators(M, z);
    return fmi2OK;
}
fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t n)
{
    if (n != NX)
        return complain(c, fmi2Error, "fmi2GetContinuousStates: wrong number of states");
    memcpy(x, M->x, sizeof M->x);
    return fmi2OK;
}
fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real x[], size_t n)
{
    (void)c;
    for (size_t i = 0; i < n; i++)
        x[i] = 1.0;
    return fmi2OK;
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t n,
                                       const fmi2Integer order[], const fmi2Real value[])
{
    (void)r, (void)order, (void)value;
    return n ? complain(c, fmi2Error, "inputs are held over a step") : fmi2OK;
}
fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t n,
                                        const fmi2Integer order[], fmi2Real value[])
{
    (void)r, (void)order, (void)value;
    return n ? complain(c, fmi2Error, "no derivatives of outputs") : fmi2OK;
}
fmi2Status fmi2DoStep(fmi2Component c, fmi2Real t, fmi2Real step, fmi2Boolean keep)
{
    (void)keep;
    M->t = t;
    if (!core_advance(M, t + step))
        return complain(c, fmi2Error, "the step became too small; check inputs and parameters");
    return M->stopped < 0 ? fmi2OK : complain(c, fmi2Discard, stops[M->stopped].name);
}
fmi2Status fmi2CancelStep(fmi2Component c) { return complain(c, fmi2Error, "no step is pending"); }
fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value)
{
    (void)kind;
    *value = fmi2OK;
    return complain(c, fmi2Discard, "no step is pending");
}
fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value)
{
    *value = M->t;
    return kind == fmi2LastSuccessfulTime ? fmi2OK : fmi2Discard;
}
fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value)
{
    (void)c, (void)kind;
    *value = 0;
    return fmi2Discard;
}
fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value)
{
    *value = M->stopped >= 0;
    return kind == fmi2Terminated ? fmi2OK : fmi2Discard;
}
fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String *value)
{
    (void)c, (void)kind;
    *value = "";
    return fmi2Discard;
}
