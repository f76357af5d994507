/* A linkage as a slave of FMI 2.0: the crank turns at a speed, outputs follow from its angle.

   Above stand `state`, the linkage itself, and COUNT, SPEED, START and GUID.  Variables by number:
   the COUNT outputs; crank_angle; the inputs speed and acceleration; the parameter start. */

#include <stdlib.h>
#include <string.h>

#if defined(_WIN32)
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

typedef enum { OK, WARNING, DISCARD, FAILED, FATAL, PENDING } status;
typedef void *component;
typedef struct {
    void *logger;
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void *finished;
    void *environment;
} callbacks;
typedef struct {
    double angle, speed, acceleration, start;
    double found[COUNT];
    int stale;
} machine;

static void begin(machine *m)
{
    m->angle = m->start;
    m->stale = 1;
}

static double *place(machine *m, unsigned number)
{
    switch (number) {
    case COUNT: return &m->angle;
    case COUNT + 1: return &m->speed;
    case COUNT + 2: return &m->acceleration;
    case COUNT + 3: return &m->start;
    default: return 0;
    }
}

EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }

EXPORT component fmi2Instantiate(const char *name, int kind, const char *guid, const char *folder,
                                 const callbacks *calls, int visible, int logging)
{
    machine *m;
    (void)name, (void)folder, (void)calls, (void)visible, (void)logging;
    if (kind != 1 || strcmp(guid, GUID) != 0) return 0;
    m = calloc(1, sizeof *m);
    if (m) {
        m->speed = SPEED;
        m->start = START;
        begin(m);
    }
    return m;
}

EXPORT void fmi2FreeInstance(component c) { free(c); }

EXPORT status fmi2SetupExperiment(component c, int tolerant, double tolerance, double start,
                                  int ends, double end)
{
    (void)c, (void)tolerant, (void)tolerance, (void)start, (void)ends, (void)end;
    return OK;
}

EXPORT status fmi2EnterInitializationMode(component c) { (void)c; return OK; }
EXPORT status fmi2ExitInitializationMode(component c) { begin(c); return OK; }
EXPORT status fmi2Terminate(component c) { (void)c; return OK; }

EXPORT status fmi2Reset(component c)
{
    machine *m = c;
    m->speed = SPEED;
    m->acceleration = 0.0;
    m->start = START;
    begin(m);
    return OK;
}

EXPORT status fmi2GetReal(component c, const unsigned numbers[], size_t count, double values[])
{
    machine *m = c;
    size_t k;
    if (m->stale) {
        state(m->angle, m->speed, m->acceleration, m->found);
        m->stale = 0;
    }
    for (k = 0; k < count; k++) {
        double *at = place(m, numbers[k]);
        if (!at && numbers[k] >= COUNT) return FAILED;
        values[k] = at ? *at : m->found[numbers[k]];
    }
    return OK;
}

EXPORT status fmi2SetReal(component c, const unsigned numbers[], size_t count,
                          const double values[])
{
    machine *m = c;
    size_t k;
    for (k = 0; k < count; k++) {
        double *at = place(m, numbers[k]);
        if (!at || numbers[k] == COUNT) return FAILED;
        *at = values[k];
        if (numbers[k] == COUNT + 3) m->angle = m->start;
    }
    m->stale = 1;
    return OK;
}

EXPORT status fmi2DoStep(component c, double time, double step, int keep)
{
    machine *m = c;
    (void)time, (void)keep;
    m->angle += (m->speed + 0.5 * m->acceleration * step) * step;
    m->stale = 1;
    return OK;
}

/* What FMI wants to be there, and modelDescription.xml says is not used. */

#define NONE(name, ...) EXPORT status name(__VA_ARGS__)
NONE(fmi2SetDebugLogging, component c, int on, size_t n, const char *const kinds[])
{ (void)c, (void)on, (void)n, (void)kinds; return OK; }
NONE(fmi2CancelStep, component c) { (void)c; return FAILED; }
#define READ(name, type) \
    NONE(name, component c, const unsigned numbers[], size_t count, type values[]) \
    { (void)c, (void)numbers, (void)values; return count ? FAILED : OK; }
READ(fmi2GetInteger, int)
READ(fmi2GetBoolean, int)
READ(fmi2GetString, const char *)
READ(fmi2SetInteger, const int)
READ(fmi2SetBoolean, const int)
READ(fmi2SetString, const char *const)
#define TOLD(name, type) \
    NONE(name, component c, int kind, type *value) { (void)c, (void)kind, (void)value; return DISCARD; }
TOLD(fmi2GetStatus, status)
TOLD(fmi2GetRealStatus, double)
TOLD(fmi2GetIntegerStatus, int)
TOLD(fmi2GetBooleanStatus, int)
TOLD(fmi2GetStringStatus, const char *)
#define KEPT(name, type) NONE(name, component c, type *kept) { (void)c, (void)kept; return FAILED; }
KEPT(fmi2GetFMUstate, void *)
KEPT(fmi2SetFMUstate, void)
KEPT(fmi2FreeFMUstate, void *)
NONE(fmi2SerializedFMUstateSize, component c, void *kept, size_t *size)
{ (void)c, (void)kept, (void)size; return FAILED; }
NONE(fmi2SerializeFMUstate, component c, void *kept, char data[], size_t size)
{ (void)c, (void)kept, (void)data, (void)size; return FAILED; }
NONE(fmi2DeSerializeFMUstate, component c, const char data[], size_t size, void **kept)
{ (void)c, (void)data, (void)size, (void)kept; return FAILED; }
NONE(fmi2GetDirectionalDerivative, component c, const unsigned of[], size_t n,
     const unsigned by[], size_t k, const double known[], double found[])
{ (void)c, (void)of, (void)n, (void)by, (void)k, (void)known, (void)found; return FAILED; }
NONE(fmi2SetRealInputDerivatives, component c, const unsigned numbers[], size_t count,
     const int orders[], const double values[])
{ (void)c, (void)numbers, (void)count, (void)orders, (void)values; return FAILED; }
NONE(fmi2GetRealOutputDerivatives, component c, const unsigned numbers[], size_t count,
     const int orders[], double values[])
{ (void)c, (void)numbers, (void)count, (void)orders, (void)values; return FAILED; }
