/* Loads the library of an FMU on Windows and steps it: what an importer there does.
   host.exe LIBRARY GUID STEPS STEP REFERENCE..: a line of values after each step. */
#include <stdio.h>
#include <stdlib.h>
#include <windows.h>
#include "fmi2Functions.h"

static void logged(fmi2ComponentEnvironment e, fmi2String n, fmi2Status s, fmi2String c, fmi2String m, ...) {
    fprintf(stderr, "%d %s\n", (int)s, m);
}

#define CALL(name) ((name##TYPE *)(void *)GetProcAddress(library, #name))
#define CHECK(call) if ((call) > fmi2Warning) { fprintf(stderr, "failed: %s\n", #call); return 1; }

int main(int count, char **words) {
    HMODULE library = LoadLibraryA(words[1]);
    if (!library) { fprintf(stderr, "not loaded: %lu\n", GetLastError()); return 2; }
    fmi2CallbackFunctions calls = {logged, calloc, free, NULL, NULL};
    fmi2Component c = CALL(fmi2Instantiate)("unit", fmi2CoSimulation, words[2], "", &calls, fmi2False, fmi2False);
    if (!c) { fprintf(stderr, "no instance\n"); return 3; }
    int steps = atoi(words[3]), wanted = count - 5;
    double step = atof(words[4]), *values = calloc(wanted, sizeof *values);
    fmi2ValueReference *references = calloc(wanted, sizeof *references);
    for (int i = 0; i < wanted; i++) references[i] = (fmi2ValueReference)strtoul(words[5 + i], NULL, 10);
    CHECK(CALL(fmi2SetupExperiment)(c, fmi2False, 0, 0, fmi2True, steps * step))
    CHECK(CALL(fmi2EnterInitializationMode)(c))
    CHECK(CALL(fmi2ExitInitializationMode)(c))
    for (int k = 0; k < steps; k++) {
        CHECK(CALL(fmi2DoStep)(c, k * step, step, fmi2True))
        CHECK(CALL(fmi2GetReal)(c, references, (size_t)wanted, values))
        for (int i = 0; i < wanted; i++) printf("%.17g ", values[i]);
        printf("\n");
    }
    CHECK(CALL(fmi2Terminate)(c))
    CALL(fmi2FreeInstance)(c);
    return 0;
}
