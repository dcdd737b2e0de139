/* The same in FMI 3.0 (sections 2.3 and 4.2); all numbers of these models are Float64. */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef void* fmi3Instance;
typedef uint32_t fmi3ValueReference;
enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal };

typedef struct {
  double values[VARIABLES];
} Model;

static void model_begin(Model* model);
static int model_initialize(Model* model);
static int model_step(Model* model, double time, double length);

fmi3Instance fmi3InstantiateCoSimulation(const char* name, const char* token, const char* resources, bool visible, bool logging,
                                         bool event_mode, bool early, const fmi3ValueReference* needed, size_t count,
                                         void* environment, void* logger, void* update) {
  (void)name; (void)visible; (void)logging; (void)needed; (void)environment; (void)logger; (void)update;
  if (strcmp(token, GUID) != 0 || event_mode || early || count != 0) return NULL;
  if (resources == NULL || resources[strlen(resources) - 1] != '/') return NULL;
  Model* model = calloc(1, sizeof *model);
  model_begin(model);
  return model;
}
int fmi3EnterInitializationMode(fmi3Instance c, bool defined, double tolerance, double start, bool stops, double stop) {
  (void)defined; (void)tolerance; (void)stops; (void)stop;
  return c != NULL && start == 0 ? fmi3OK : fmi3Error;
}
int fmi3ExitInitializationMode(fmi3Instance c) { return model_initialize(c); }
int fmi3Terminate(fmi3Instance c) { return c != NULL ? fmi3OK : fmi3Error; }
void fmi3FreeInstance(fmi3Instance c) { free(c); }
int fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference* references, size_t count, double* values, size_t numbers) {
  for (size_t n = 0; n < count; ++n) values[n] = ((Model*)c)->values[references[n]];
  return numbers == count ? fmi3OK : fmi3Error;
}
int fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference* references, size_t count, const double* values, size_t numbers) {
  for (size_t n = 0; n < count; ++n) ((Model*)c)->values[references[n]] = values[n];
  return numbers == count ? fmi3OK : fmi3Error;
}
int fmi3DoStep(fmi3Instance c, double time, double length, bool no_state_before, bool* event, bool* terminates, bool* early,
               double* last) {
  (void)no_state_before;
  *event = *terminates = *early = false;
  *last = time + length;
  return model_step(c, time, length);
}
int fmi3GetFMUState(fmi3Instance c, void** state) {
  if (*state == NULL) *state = malloc(sizeof(Model));
  memcpy(*state, c, sizeof(Model));
  return fmi3OK;
}
int fmi3SetFMUState(fmi3Instance c, void* state) {
  memcpy(c, state, sizeof(Model));
  return fmi3OK;
}
int fmi3FreeFMUState(fmi3Instance c, void** state) {
  (void)c;
  free(*state);
  *state = NULL;
  return fmi3OK;
}
int fmi3SerializedFMUStateSize(fmi3Instance c, void* state, size_t* size) {
  (void)c;
  (void)state;
  *size = sizeof(Model);
  return fmi3OK;
}
int fmi3SerializeFMUState(fmi3Instance c, void* state, uint8_t* bytes, size_t size) {
  (void)c;
  memcpy(bytes, state, size);
  return fmi3OK;
}
int fmi3DeserializeFMUState(fmi3Instance c, const uint8_t* bytes, size_t size, void** state) {
  (void)c;
  *state = malloc(sizeof(Model));
  memcpy(*state, bytes, size);
  return fmi3OK;
}
