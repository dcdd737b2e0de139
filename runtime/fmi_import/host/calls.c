/* The life of an instance in the order of the specifications: instantiate, initialize, step, terminate (FMI 2.0 section 4.2.4,
   FMI 3.0 section 4.2.1). Both versions take and give values by type; here every number is a double. */
#define _GNU_SOURCE
#include "calls.h"

#include <dlfcn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "fmi.h"
#include "protocol.h"
#include "words.h"

static void* library;
static unsigned version;
static unsigned seconds = 10;
static fmi_instance instance;
static struct fmi2 two;
static struct fmi3 three;
static struct fmi_states states;
static struct ipos_fmu_variable *parameters, *inputs, *outputs;
static uint32_t parameter_count, input_count, output_count;
static double* given;
static uint8_t* state_bytes;
static int running;

unsigned ipos_fmu_seconds(void) { return seconds; }

static const char* status_word(int status) {
  static const char* const kWords[] = {"OK", "Warning", "Discard", "Error", "Fatal", "Pending"};
  return status >= 0 && status <= FMI2_PENDING ? kWords[status] : "an unknown status";
}

/* Discard is no result: what was asked for has not been done. */
static int is_good(int status, const char* function) {
  if (status == FMI_OK || status == FMI_WARNING) return 1;
  ipos_fmu_why("fmi%u%s gives %s", version, function, status_word(status));
  return 0;
}

/* Of FMI 2 the message is a format; #r12# in it, which stands for a variable, stays as it is. */
static void on_log_two(void* environment, const char* name, int status, const char* category, const char* message, ...) {
  (void)environment;
  (void)name;
  (void)category;
  va_list arguments;
  va_start(arguments, message);
  if (message != NULL) ipos_fmu_log(status == FMI_OK ? IPOS_FMU_TELLS : IPOS_FMU_WARNS, message, arguments);
  va_end(arguments);
}

static void log_plain(char kind, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  ipos_fmu_log(kind, format, arguments);
  va_end(arguments);
}

static void on_log_three(void* environment, int status, const char* category, const char* message) {
  (void)environment;
  (void)category;
  if (message != NULL) log_plain(status == FMI_OK ? IPOS_FMU_TELLS : IPOS_FMU_WARNS, "%s", message);
}

static void* function(const char* name, int needed) {
  char whole[80];
  snprintf(whole, sizeof whole, "fmi%u%s", version, name);
  void* found = dlsym(library, whole);
  if (found == NULL && needed) ipos_fmu_why("the library has no function %s", whole);
  return found;
}

#define TAKE(table, name, needed) \
  *(void**)&(table).name = function(#name, needed); \
  if (needed && (table).name == NULL) return 0

static int find_two(void) {
  TAKE(two, Instantiate, 1);
  TAKE(two, SetupExperiment, 1);
  TAKE(two, EnterInitializationMode, 1);
  TAKE(two, ExitInitializationMode, 1);
  TAKE(two, Terminate, 1);
  TAKE(two, FreeInstance, 1);
  TAKE(two, DoStep, 1);
  TAKE(two, GetStatus, 0);
  TAKE(two, GetReal, 1);
  TAKE(two, SetReal, 1);
  TAKE(two, GetInteger, 1);
  TAKE(two, SetInteger, 1);
  TAKE(two, GetBoolean, 1);
  TAKE(two, SetBoolean, 1);
  return 1;
}

static int find_three(void) {
  TAKE(three, InstantiateCoSimulation, 1);
  TAKE(three, EnterInitializationMode, 1);
  TAKE(three, ExitInitializationMode, 1);
  TAKE(three, Terminate, 1);
  TAKE(three, FreeInstance, 1);
  TAKE(three, DoStep, 1);
  return 1;
}

static void find_states(void) {
  const int second = version == 2;
  *(void**)&states.Get = function(second ? "GetFMUstate" : "GetFMUState", 0);
  *(void**)&states.Set = function(second ? "SetFMUstate" : "SetFMUState", 0);
  *(void**)&states.Free = function(second ? "FreeFMUstate" : "FreeFMUState", 0);
  *(void**)&states.Size = function(second ? "SerializedFMUstateSize" : "SerializedFMUStateSize", 0);
  *(void**)&states.Serialize = function(second ? "SerializeFMUstate" : "SerializeFMUState", 0);
  *(void**)&states.Deserialize = function(second ? "DeSerializeFMUstate" : "DeserializeFMUState", 0);
}

static int has_states(void) {
  if (states.Get != NULL && states.Set != NULL && states.Free != NULL && states.Size != NULL && states.Serialize != NULL &&
      states.Deserialize != NULL)
    return 1;
  ipos_fmu_why("the library has not all functions for its state");
  return 0;
}

static int set_two(const struct ipos_fmu_variable* variable, double value) {
  const int whole = (int)value;
  if (variable->type == IPOS_FMU_FLOAT64) return is_good(two.SetReal(instance, &variable->reference, 1, &value), "SetReal");
  if (variable->type == IPOS_FMU_BOOLEAN) {
    const int truth = value != 0;
    return is_good(two.SetBoolean(instance, &variable->reference, 1, &truth), "SetBoolean");
  }
  return is_good(two.SetInteger(instance, &variable->reference, 1, &whole), "SetInteger");
}

static int get_two(const struct ipos_fmu_variable* variable, double* value) {
  int whole = 0, good = 0;
  if (variable->type == IPOS_FMU_FLOAT64) return is_good(two.GetReal(instance, &variable->reference, 1, value), "GetReal");
  if (variable->type == IPOS_FMU_BOOLEAN)
    good = is_good(two.GetBoolean(instance, &variable->reference, 1, &whole), "GetBoolean");
  else
    good = is_good(two.GetInteger(instance, &variable->reference, 1, &whole), "GetInteger");
  *value = whole;
  return good;
}

/* A row a type: its C type, and what its functions are called. */
#define TYPES(ROW)                      \
  ROW(IPOS_FMU_FLOAT64, double, Float64)  \
  ROW(IPOS_FMU_FLOAT32, float, Float32)   \
  ROW(IPOS_FMU_INT8, int8_t, Int8)        \
  ROW(IPOS_FMU_UINT8, uint8_t, UInt8)     \
  ROW(IPOS_FMU_INT16, int16_t, Int16)     \
  ROW(IPOS_FMU_UINT16, uint16_t, UInt16)  \
  ROW(IPOS_FMU_INT32, int32_t, Int32)     \
  ROW(IPOS_FMU_UINT32, uint32_t, UInt32)  \
  ROW(IPOS_FMU_INT64, int64_t, Int64)     \
  ROW(IPOS_FMU_UINT64, uint64_t, UInt64)  \
  ROW(IPOS_FMU_BOOLEAN, bool, Boolean)

static int set_three(const struct ipos_fmu_variable* variable, double value) {
  switch (variable->type) {
#define ROW(kind, type, name)                                                                                   \
  case kind: {                                                                                                  \
    static int (*set)(fmi_instance, const fmi_reference*, size_t, const type*, size_t);                         \
    if (set == NULL) *(void**)&set = function("Set" #name, 1);                                                  \
    const type held = (type)value;                                                                              \
    return set != NULL && is_good(set(instance, &variable->reference, 1, &held, 1), "Set" #name);               \
  }
    TYPES(ROW)
#undef ROW
    default: return 0;
  }
}

static int get_three(const struct ipos_fmu_variable* variable, double* value) {
  switch (variable->type) {
#define ROW(kind, type, name)                                                                                   \
  case kind: {                                                                                                  \
    static int (*get)(fmi_instance, const fmi_reference*, size_t, type*, size_t);                               \
    if (get == NULL) *(void**)&get = function("Get" #name, 1);                                                  \
    type held = 0;                                                                                              \
    const int good = get != NULL && is_good(get(instance, &variable->reference, 1, &held, 1), "Get" #name);     \
    *value = (double)held;                                                                                      \
    return good;                                                                                                \
  }
    TYPES(ROW)
#undef ROW
    default: return 0;
  }
}

static int set(const struct ipos_fmu_variable* variable, double value) {
  return version == 2 ? set_two(variable, value) : set_three(variable, value);
}

static int set_all(const double* values) {
  for (uint32_t n = 0; n < input_count; ++n)
    if (!set(&inputs[n], values[n])) return 0;
  return 1;
}

static int get_all(const void** values, size_t* size) {
  for (uint32_t n = 0; n < output_count; ++n)
    if (!(version == 2 ? get_two(&outputs[n], &given[n]) : get_three(&outputs[n], &given[n]))) return 0;
  *values = given;
  *size = output_count * sizeof *given;
  return 1;
}

static struct ipos_fmu_variable* copy(const char** at, uint32_t count) {
  struct ipos_fmu_variable* all = calloc(count + 1, sizeof *all);
  if (all != NULL) memcpy(all, *at, count * sizeof *all);
  *at += count * sizeof *all;
  return all;
}

static const char* text(const char** at) {
  const char* begin = *at;
  *at += strlen(begin) + 1;
  return begin;
}

static int begin(const char* at) {
  struct ipos_fmu_begin head;
  memcpy(&head, at, sizeof head);
  at += sizeof head;
  version = head.version;
  seconds = head.seconds;
  parameters = copy(&at, parameter_count = head.parameters);
  inputs = copy(&at, input_count = head.inputs);
  outputs = copy(&at, output_count = head.outputs);
  given = calloc(output_count + 1, sizeof *given);
  if (parameters == NULL || inputs == NULL || outputs == NULL || given == NULL) return 0;
  const char* path = text(&at);
  char* name = strdup(text(&at));  /* an FMU may keep the pointers */
  char* token = strdup(text(&at));
  char* resources = strdup(text(&at));
  library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  if (library == NULL) {
    ipos_fmu_why("its library cannot be loaded: %s", dlerror());
    return 0;
  }
  find_states();
  if (version == 2) {
    static struct fmi2_callbacks callbacks = {on_log_two, calloc, free, NULL, NULL};
    if (!find_two()) return 0;
    instance = two.Instantiate(name, 1, token, resources, &callbacks, 0, 0);
  } else {
    if (!find_three()) return 0;
    instance = three.InstantiateCoSimulation(name, token, resources, false, false, false, false, NULL, 0, NULL, on_log_three, NULL);
  }
  if (instance == NULL) ipos_fmu_why("it makes no instance of itself");
  return instance != NULL;
}

static int start(const double* values) {
  for (uint32_t n = 0; n < parameter_count; ++n)
    if (!set(&parameters[n], parameters[n].value)) return 0;
  if (version == 2) {
    if (!is_good(two.SetupExperiment(instance, 0, 0, 0, 0, 0), "SetupExperiment") ||
        !is_good(two.EnterInitializationMode(instance), "EnterInitializationMode") || !set_all(values) ||
        !is_good(two.ExitInitializationMode(instance), "ExitInitializationMode"))
      return 0;
  } else if (!is_good(three.EnterInitializationMode(instance, false, 0, 0, false, 0), "EnterInitializationMode") ||
             !set_all(values) || !is_good(three.ExitInitializationMode(instance), "ExitInitializationMode")) {
    return 0;
  }
  running = 1;
  return 1;
}

/* One that answers later is waited for; whoever asked gives up when it takes too long. */
static int step_two(double now, double length) {
  int status = two.DoStep(instance, now, length, 0);  /* ipos may go back */
  while (status == FMI2_PENDING && two.GetStatus != NULL) {
    const struct timespec moment = {0, 200000};
    nanosleep(&moment, NULL);
    if (two.GetStatus(instance, 0, &status) != FMI_OK) break;
  }
  return is_good(status, "DoStep");
}

static int step_three(double now, double length) {
  bool event = false, terminates = false, early = false;
  double last = now + length;
  if (!is_good(three.DoStep(instance, now, length, false, &event, &terminates, &early, &last), "DoStep")) return 0;
  if (terminates) ipos_fmu_why("it asks for the end of the simulation");
  if (!terminates && early) ipos_fmu_why("it came only to %.9g s of %.9g s", last, now + length);
  return !terminates && !early;
}

static int save(const void** values, size_t* size) {
  fmi_state state = NULL;
  size_t length = 0;
  if (!has_states() || !is_good(states.Get(instance, &state), "GetFMUState")) return 0;
  int good = is_good(states.Size(instance, state, &length), "SerializedFMUStateSize");
  free(state_bytes);
  state_bytes = malloc(length + 1);
  good = good && state_bytes != NULL && is_good(states.Serialize(instance, state, state_bytes, length), "SerializeFMUState");
  states.Free(instance, &state);
  *values = state_bytes;
  *size = length;
  return good;
}

static int restore(const char* bytes, size_t size) {
  fmi_state state = NULL;
  if (!has_states() || !is_good(states.Deserialize(instance, (const uint8_t*)bytes, size, &state), "DeserializeFMUState"))
    return 0;
  const int good = is_good(states.Set(instance, state), "SetFMUState");
  states.Free(instance, &state);
  return good;
}

static int call(uint32_t order, const char* bytes, size_t size, const void** values, size_t* values_size) {
  const double* numbers = (const double*)(const void*)bytes;
  switch (order) {
    case IPOS_FMU_BEGIN: return begin(bytes);
    case IPOS_FMU_START: return start(numbers) && get_all(values, values_size);
    case IPOS_FMU_STEP:
      return set_all(numbers + 2) && (version == 2 ? step_two(numbers[0], numbers[1]) : step_three(numbers[0], numbers[1])) &&
             get_all(values, values_size);
    case IPOS_FMU_SAVE: return save(values, values_size);
    case IPOS_FMU_RESTORE: return restore(bytes, size);
    default: return 0;
  }
}

int ipos_fmu_call(uint32_t order, const char* bytes, size_t size, const void** values, size_t* values_size) {
  const int good = call(order, bytes, size, values, values_size);
  if (!good) instance = NULL;  /* of one that has failed nothing more is asked (FMI 2.0 section 2.1.3) */
  return good;
}

void ipos_fmu_end(void) {
  if (instance == NULL) return;
  if (version == 2) {
    if (running) two.Terminate(instance);
    two.FreeInstance(instance);
  } else {
    if (running) three.Terminate(instance);
    three.FreeInstance(instance);
  }
}
