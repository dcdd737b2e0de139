/* A small importer in C: loads the library of an unpacked FMU, steps it and prints values, so that what is printed can be compared between
   platforms. usage: client LIBRARY VERSION TOKEN RESOURCES STEPS REFERENCE...    (references of Real, or Float64, outputs) */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#ifdef _WIN32
#include <windows.h>
static void *load(const char *path) { return (void *)LoadLibraryA(path); }
static void *find(void *library, const char *name) { return (void *)(uintptr_t)GetProcAddress((HMODULE)library, name); }
#else
#include <dlfcn.h>
static void *load(const char *path) { return dlopen(path, RTLD_NOW); }
static void *find(void *library, const char *name) { return dlsym(library, name); }
#endif

struct callbacks {
  void (*logger)(void *, const char *, int, const char *, const char *, ...);
  void *(*allocate)(size_t, size_t);
  void (*release)(void *);
  void (*finished)(void *, int);
  void *environment;
};
static void tell2(void *environment, const char *name, int status, const char *category, const char *text, ...) {
  (void)environment, (void)name;
  fprintf(stderr, "%d %s: %s\n", status, category, text);
}
static void tell3(void *environment, int status, const char *category, const char *text) {
  (void)environment;
  fprintf(stderr, "%d %s: %s\n", status, category, text);
}

static void *library;
static void *need(const char *name) {
  void *function = find(library, name);
  if (function == NULL) {
    fprintf(stderr, "no %s\n", name);
    exit(1);
  }
  return function;
}
#define CALL(type, name) (*(type *)need_as(name))
static void *need_as(const char *name) {
  static void *held[16];
  static int next = 0;
  held[next %= 16] = need(name);
  return &held[next++];
}

typedef void *(*make2)(const char *, int, const char *, const char *, const struct callbacks *, int, int);
typedef void *(*make3)(const char *, const char *, const char *, bool, bool, bool, bool, const uint32_t *, size_t, void *,
                       void (*)(void *, int, const char *, const char *), void (*)(void));
typedef int (*setup2)(void *, int, double, double, int, double);
typedef int (*enter3)(void *, bool, double, double, bool, double);
typedef int (*plain)(void *);
typedef int (*step2)(void *, double, double, int);
typedef int (*step3)(void *, double, double, bool, bool *, bool *, bool *, double *);
typedef int (*get2)(void *, const uint32_t *, size_t, double *);
typedef int (*get3)(void *, const uint32_t *, size_t, double *, size_t);
typedef void (*release)(void *);

int main(int count, char **words) {
  if (count < 7 || (library = load(words[1])) == NULL) {
    fprintf(stderr, "%s cannot be loaded\n", count < 2 ? "nothing" : words[1]);
    return 1;
  }
  const int version = atoi(words[2]), steps = atoi(words[5]);
  const struct callbacks callbacks = {tell2, calloc, free, NULL, NULL};
  void *fmu = version == 2 ? CALL(make2, "fmi2Instantiate")("one", 1, words[3], words[4], &callbacks, 0, 0)
                           : CALL(make3, "fmi3InstantiateCoSimulation")("one", words[3], words[4], false, false, false, false, NULL, 0,
                                                                        NULL, tell3, NULL);
  if (fmu == NULL) return 1;
  int bad = version == 2 ? CALL(setup2, "fmi2SetupExperiment")(fmu, 0, 0, 0, 0, 0) : 0;
  bad |= version == 2 ? CALL(plain, "fmi2EnterInitializationMode")(fmu)
                      : CALL(enter3, "fmi3EnterInitializationMode")(fmu, false, 0, 0, false, 0);
  bad |= CALL(plain, version == 2 ? "fmi2ExitInitializationMode" : "fmi3ExitInitializationMode")(fmu);
  for (int n = 0; n < steps && bad == 0; ++n) {
    bool flags[3];
    double reached;
    bad |= version == 2 ? CALL(step2, "fmi2DoStep")(fmu, n * 0.01, 0.01, 1)
                        : CALL(step3, "fmi3DoStep")(fmu, n * 0.01, 0.01, true, &flags[0], &flags[1], &flags[2], &reached);
    for (int word = 6; word < count && bad == 0; ++word) {
      const uint32_t reference = (uint32_t)atoi(words[word]);
      double value = 0;
      bad |= version == 2 ? CALL(get2, "fmi2GetReal")(fmu, &reference, 1, &value)
                          : CALL(get3, "fmi3GetFloat64")(fmu, &reference, 1, &value, 1);
      printf("%.17g%c", value, word + 1 < count ? ' ' : '\n');
    }
  }
  CALL(release, version == 2 ? "fmi2FreeInstance" : "fmi3FreeInstance")(fmu);
  return bad;
}
