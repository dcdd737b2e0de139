/* What the FMUs of these tests have in common in FMI 2.0: the functions of the specification's section 2.1 and 4.2 for a model
   whose variables stand in one array of numbers. A model defines VARIABLES and its four functions. */
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

typedef void* fmi2Component;
typedef unsigned fmi2ValueReference;
typedef int fmi2Boolean;
enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending };

typedef struct {
  void (*logger)(void*, const char*, int, const char*, const char*, ...);
  void* (*allocateMemory)(size_t, size_t);
  void (*freeMemory)(void*);
  void (*stepFinished)(void*, int);
  void* componentEnvironment;
} fmi2CallbackFunctions;

typedef struct {
  double values[VARIABLES];
  const fmi2CallbackFunctions* callbacks;
  char resources[1000];
} Model;

static void model_begin(Model* model);
static int model_initialize(Model* model);
static int model_step(Model* model, double time, double length);

fmi2Component fmi2Instantiate(const char* name, int type, const char* guid, const char* resources,
                              const fmi2CallbackFunctions* callbacks, fmi2Boolean visible, fmi2Boolean logging) {
  (void)name;
  (void)visible;
  (void)logging;
  if (type != 1 || strcmp(guid, GUID) != 0) return NULL;
  Model* model = callbacks->allocateMemory(1, sizeof *model);
  model->callbacks = callbacks;
  if (resources != NULL) strncpy(model->resources, resources, sizeof model->resources - 1);
  model_begin(model);
  return model;
}
int fmi2SetupExperiment(fmi2Component c, fmi2Boolean defined, double tolerance, double start, fmi2Boolean stops, double stop) {
  (void)c; (void)defined; (void)tolerance; (void)stops; (void)stop;
  return start == 0 ? fmi2OK : fmi2Error;
}
int fmi2EnterInitializationMode(fmi2Component c) { return c != NULL ? fmi2OK : fmi2Error; }
int fmi2ExitInitializationMode(fmi2Component c) { return model_initialize(c); }
int fmi2Terminate(fmi2Component c) { return c != NULL ? fmi2OK : fmi2Error; }
void fmi2FreeInstance(fmi2Component c) { ((Model*)c)->callbacks->freeMemory(c); }

#define ACCESS(type, name, from, to)                                                                        \
  int fmi2Get##name(fmi2Component c, const fmi2ValueReference* references, size_t count, type* values) {    \
    for (size_t n = 0; n < count; ++n) values[n] = (to)((Model*)c)->values[references[n]];                 \
    return fmi2OK;                                                                                          \
  }                                                                                                         \
  int fmi2Set##name(fmi2Component c, const fmi2ValueReference* references, size_t count, const type* values) { \
    for (size_t n = 0; n < count; ++n) ((Model*)c)->values[references[n]] = (from)values[n];                \
    return fmi2OK;                                                                                          \
  }
ACCESS(double, Real, double, double)
ACCESS(int, Integer, double, int)
ACCESS(int, Boolean, double, int)

int fmi2DoStep(fmi2Component c, double time, double length, fmi2Boolean no_state_before) {
  (void)no_state_before;
  return model_step(c, time, length);
}

#ifdef HAS_STATE
int fmi2GetFMUstate(fmi2Component c, void** state) {
  if (*state == NULL) *state = malloc(sizeof(Model));
  memcpy(*state, c, sizeof(Model));
  return fmi2OK;
}
int fmi2SetFMUstate(fmi2Component c, void* state) {
  memcpy(c, state, sizeof(Model));
  return fmi2OK;
}
int fmi2FreeFMUstate(fmi2Component c, void** state) {
  (void)c;
  free(*state);
  *state = NULL;
  return fmi2OK;
}
int fmi2SerializedFMUstateSize(fmi2Component c, void* state, size_t* size) {
  (void)c;
  (void)state;
  *size = VARIABLES * sizeof(double);
  return fmi2OK;
}
int fmi2SerializeFMUstate(fmi2Component c, void* state, char* bytes, size_t size) {
  (void)c;
  memcpy(bytes, ((Model*)state)->values, size);
  return fmi2OK;
}
int fmi2DeSerializeFMUstate(fmi2Component c, const char* bytes, size_t size, void** state) {
  *state = malloc(sizeof(Model));
  memcpy(*state, c, sizeof(Model));
  memcpy(((Model*)*state)->values, bytes, size);
  return fmi2OK;
}
#endif
