/* The functions of FMI 2.0 and 3.0 that co-simulation needs, declared anew from the specifications. They are looked up by name
   in the FMU's library. */
#ifndef IPOS_FMU_FMI_H
#define IPOS_FMU_FMI_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Both versions have these, FMI 2.0 section 2.1.3, 3.0 section 2.2.3; 2.0 has Pending beside them. */
enum fmi_status { FMI_OK, FMI_WARNING, FMI_DISCARD, FMI_ERROR, FMI_FATAL, FMI2_PENDING };

typedef void* fmi_instance;
typedef void* fmi_state;
typedef uint32_t fmi_reference;

/* FMI 2.0, section 2.1.5 */
struct fmi2_callbacks {
  void (*logger)(void* environment, const char* name, int status, const char* category, const char* message, ...);
  void* (*allocate)(size_t count, size_t size);
  void (*release)(void* memory);
  void (*step_finished)(void* environment, int status);
  void* environment;
};

struct fmi2 {
  fmi_instance (*Instantiate)(const char* name, int type, const char* guid, const char* resources,
                              const struct fmi2_callbacks* callbacks, int visible, int logging);
  int (*SetupExperiment)(fmi_instance, int tolerance_defined, double tolerance, double start, int stop_defined, double stop);
  int (*EnterInitializationMode)(fmi_instance);
  int (*ExitInitializationMode)(fmi_instance);
  int (*Terminate)(fmi_instance);
  void (*FreeInstance)(fmi_instance);
  int (*DoStep)(fmi_instance, double time, double length, int no_set_state_before);
  int (*GetStatus)(fmi_instance, int kind, int* value);
  int (*GetReal)(fmi_instance, const fmi_reference*, size_t, double*);
  int (*SetReal)(fmi_instance, const fmi_reference*, size_t, const double*);
  int (*GetInteger)(fmi_instance, const fmi_reference*, size_t, int*);
  int (*SetInteger)(fmi_instance, const fmi_reference*, size_t, const int*);
  int (*GetBoolean)(fmi_instance, const fmi_reference*, size_t, int*);
  int (*SetBoolean)(fmi_instance, const fmi_reference*, size_t, const int*);
};

/* FMI 3.0, sections 2.3 and 4.2 */
typedef void (*fmi3_logger)(void* environment, int status, const char* category, const char* message);

struct fmi3 {
  fmi_instance (*InstantiateCoSimulation)(const char* name, const char* token, const char* resources, bool visible,
                                          bool logging, bool event_mode, bool early_return,
                                          const fmi_reference* intermediate, size_t count, void* environment,
                                          fmi3_logger, void (*intermediate_update)(void));
  int (*EnterInitializationMode)(fmi_instance, bool tolerance_defined, double tolerance, double start, bool stop_defined,
                                 double stop);
  int (*ExitInitializationMode)(fmi_instance);
  int (*Terminate)(fmi_instance);
  void (*FreeInstance)(fmi_instance);
  int (*DoStep)(fmi_instance, double time, double length, bool no_set_state_before, bool* event, bool* terminates,
                bool* early, double* last_time);
};

/* The same in both but for the case of a letter in the names. */
struct fmi_states {
  int (*Get)(fmi_instance, fmi_state*);
  int (*Set)(fmi_instance, fmi_state);
  int (*Free)(fmi_instance, fmi_state*);
  int (*Size)(fmi_instance, fmi_state, size_t*);
  int (*Serialize)(fmi_instance, fmi_state, uint8_t*, size_t);
  int (*Deserialize)(fmi_instance, const uint8_t*, size_t, fmi_state*);
};

#endif
