/* An FMU that does at 0.1 s, or as it begins, what its parameter `what` says, and turns a wheel in deg and rpm until then. It cannot
   give its state. */
#include <stdio.h>
#include <unistd.h>

enum { WHAT, COUNT, ANGLE_DEG, SPEED_RPM, ON, PLAIN, GIVEN, VARIABLES_OF_MODEL };
#define VARIABLES VARIABLES_OF_MODEL
#define GUID "trouble"
#include "fmi2_model.h"

enum { FINE, CRASH, HANG, ERROR, EXIT, SPEAK, ABORT, DISCARD, NO_NUMBER, CRASH_EARLY, DEEP, EXIT_AT_ONCE, LOG, FLOOD, READ_FILE };

static void model_begin(Model* model) { model->values[SPEED_RPM] = 60; }

static int deeper(volatile char* above) {
  volatile char here[4096];
  here[0] = above == NULL ? 1 : above[0];
  return here[0] == 0 ? 0 : deeper(here) + here[0];
}

static int model_initialize(Model* model) {
  if (model->values[WHAT] == CRASH_EARLY) *(volatile int*)NULL = 1;
  if (model->values[WHAT] == READ_FILE) { /* file:///tmp/.../resources */
    char path[1100];
    snprintf(path, sizeof path, "%s/number.txt", model->resources + strlen("file://"));
    FILE* file = fopen(path, "r");
    if (file == NULL || fscanf(file, "%lf", &model->values[PLAIN]) != 1) return fmi2Error;
    fclose(file);
  }
  return fmi2OK;
}

static int model_step(Model* model, double time, double length) {
  double* v = model->values;
  v[COUNT] += 1;
  v[ANGLE_DEG] += v[SPEED_RPM] * 6 * length;
  v[ON] = v[ANGLE_DEG] >= 90;
  if (time + length < 0.1 - 1e-9) return fmi2OK;
  switch ((int)v[WHAT]) {
    case CRASH: *(volatile int*)NULL = 1; break;
    case HANG:
      for (;;) pause();
    case ERROR:
      model->callbacks->logger(NULL, "trouble", fmi2Error, "logError", "the wheel has come off at %d %s", 100, "ms");
      return fmi2Error;
    case EXIT: exit(0);
    case EXIT_AT_ONCE: _exit(0);
    case SPEAK: printf("says \033[31msomething\n"); break;
    case FLOOD:
      for (int n = 0; n < 20000; ++n) printf("line %d of many\n", n);
      break;
    case LOG: model->callbacks->logger(NULL, "trouble", fmi2Warning, "logWarning", "the wheel squeaks"); break;
    case ABORT: abort();
    case DISCARD: return fmi2Discard;
    case NO_NUMBER: v[ANGLE_DEG] = 0.0 / (v[PLAIN] - v[PLAIN]); break;
    case DEEP: return deeper(NULL);
    default: break;
  }
  return fmi2OK;
}
