// The functions of FMI 3.0 for co-simulation, as chapters 2.2, 2.3 and 4.2 of the specification declare them. Those of other
// interfaces are there and refuse. Clocks and what is clocked: fmi3_clocks.cpp.
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/fmi/component.hpp"

using namespace ipos::fmi;

namespace {

using Text = const char*;
using Reference = uint32_t;
using LogMessage = void (*)(void* environment, int status, Text category, Text message);
using IntermediateUpdate = void (*)();

constexpr const char* kNotOffered = "this is not offered";
constexpr const char* kNullPointer = "a pointer is null";
constexpr int kError = 3;

Log log_of(LogMessage logger, void* environment) {
  if (logger == nullptr) return [](Status, const char*, const std::string&) {};
  return [logger, environment](Status status, const char* category, const std::string& text) {
    logger(environment, static_cast<int>(status), category, text.c_str());
  };
}

void* refuse_interface(LogMessage logger, void* environment) {
  try {
    log_of(logger, environment)(Status::Error, kErrors, "this FMU is for co-simulation");
  } catch (...) {
  }
  return nullptr;
}

}  // namespace

IPOS_FMI_EXPORT Text fmi3GetVersion() { return "3.0"; }

IPOS_FMI_EXPORT int fmi3SetDebugLogging(void* instance, bool on, size_t count, const Text categories[]) {
  return set_logging(instance, on, count, categories);
}

IPOS_FMI_EXPORT void* fmi3InstantiateCoSimulation(Text name, Text token, Text resources, bool, bool logging, bool uses_events,
                                                  bool returns_early, const Reference[], size_t, void* environment,
                                                  LogMessage logger, IntermediateUpdate) {
  try {
    Component* made = make_component(3, name, token, resources == nullptr ? "" : resources, log_of(logger, environment));
    if (made == nullptr) return nullptr;
    made->instance->set_logging(logging);
    made->uses_events = uses_events;
    made->returns_early = returns_early;
    return made;
  } catch (...) {
    return nullptr;
  }
}
IPOS_FMI_EXPORT void* fmi3InstantiateModelExchange(Text, Text, Text, bool, bool, void* environment, LogMessage logger) {
  return refuse_interface(logger, environment);
}
IPOS_FMI_EXPORT void* fmi3InstantiateScheduledExecution(Text, Text, Text, bool, bool, void* environment, LogMessage logger,
                                                        void (*)(), void (*)(), void (*)()) {
  return refuse_interface(logger, environment);
}
IPOS_FMI_EXPORT void fmi3FreeInstance(void* instance) { free_component(instance); }

IPOS_FMI_EXPORT int fmi3EnterInitializationMode(void* instance, bool, double, double start, bool, double) {
  return enter(instance, Call::EnterInitialization, [&](Instance& inside, Component&) {
    const Status status = inside.set_start(start);
    return status == Status::Ok ? inside.enter_initialization() : status;
  });
}
IPOS_FMI_EXPORT int fmi3ExitInitializationMode(void* instance) {
  return enter(instance, Call::ExitInitialization,
               [](Instance& inside, Component& own) { return inside.exit_initialization(own.uses_events); });
}
IPOS_FMI_EXPORT int fmi3EnterEventMode(void* instance) {
  return enter(instance, Call::EnterEventMode, [](Instance& inside, Component& own) {
    return own.uses_events ? inside.enter_events() : inside.fail("the instance was made without event mode");
  });
}
IPOS_FMI_EXPORT int fmi3EnterStepMode(void* instance) {
  return enter(instance, Call::EnterStepMode, [](Instance& inside, Component&) { return inside.enter_steps(); });
}
IPOS_FMI_EXPORT int fmi3Terminate(void* instance) {
  return enter(instance, Call::Terminate, [](Instance& inside, Component&) { return inside.terminate(); });
}
IPOS_FMI_EXPORT int fmi3Reset(void* instance) {
  return enter(instance, Call::Reset, [](Instance& inside, Component&) { return inside.reset(); });
}

#define IPOS_FMI3_VALUES(name, type, ...)                                                                                 \
  IPOS_FMI_EXPORT int fmi3Get##name(void* instance, const Reference references[], size_t count, type values[],            \
                                    size_t value_count) {                                                                 \
    return get_values(instance, references, count, values, value_count, {__VA_ARGS__});                                   \
  }                                                                                                                       \
  IPOS_FMI_EXPORT int fmi3Set##name(void* instance, const Reference references[], size_t count, const type values[],      \
                                    size_t value_count) {                                                                 \
    return set_values(instance, references, count, values, value_count, {__VA_ARGS__});                                   \
  }
IPOS_FMI3_VALUES(Float32, float)
IPOS_FMI3_VALUES(Float64, double, Type::Real)
IPOS_FMI3_VALUES(Int8, int8_t)
IPOS_FMI3_VALUES(UInt8, uint8_t)
IPOS_FMI3_VALUES(Int16, int16_t)
IPOS_FMI3_VALUES(UInt16, uint16_t)
IPOS_FMI3_VALUES(Int32, int32_t, Type::Integer)
IPOS_FMI3_VALUES(UInt32, uint32_t)
IPOS_FMI3_VALUES(Int64, int64_t, Type::Enumeration)
IPOS_FMI3_VALUES(UInt64, uint64_t)
IPOS_FMI3_VALUES(Boolean, bool, Type::Boolean)

IPOS_FMI_EXPORT int fmi3GetString(void* instance, const Reference[], size_t count, Text[], size_t) {
  return no_values(instance, Call::Get, count);
}
IPOS_FMI_EXPORT int fmi3SetString(void* instance, const Reference[], size_t count, const Text[], size_t) {
  return no_values(instance, Call::Set, count);
}
IPOS_FMI_EXPORT int fmi3GetFMUState(void* instance, void** state) { return get_state(instance, state); }
IPOS_FMI_EXPORT int fmi3SetFMUState(void* instance, void* state) { return set_state(instance, state); }
IPOS_FMI_EXPORT int fmi3FreeFMUState(void* instance, void** state) { return free_state(instance, state); }
IPOS_FMI_EXPORT int fmi3SerializedFMUStateSize(void* instance, void* state, size_t* size) {
  return state_size(instance, state, size);
}
IPOS_FMI_EXPORT int fmi3SerializeFMUState(void* instance, void* state, uint8_t bytes[], size_t size) {
  return serialize(instance, state, bytes, size);
}
IPOS_FMI_EXPORT int fmi3DeserializeFMUState(void* instance, const uint8_t bytes[], size_t size, void** state) {
  return deserialize(instance, bytes, size, state);
}

IPOS_FMI_EXPORT int fmi3EvaluateDiscreteStates(void* instance) {
  return enter(instance, Call::EvaluateDiscreteStates, [](Instance&, Component&) { return Status::Ok; });
}
// Operations that have come are sent on their lines. Values that were set act in the millisecond that begins now.
IPOS_FMI_EXPORT int fmi3UpdateDiscreteStates(void* instance, bool* again, bool* ends, bool* nominals, bool* states,
                                             bool* next_defined, double* next) {
  return enter(instance, Call::UpdateDiscreteStates, [&](Instance& inside, Component&) {
    if (again == nullptr || ends == nullptr || nominals == nullptr || states == nullptr || next_defined == nullptr ||
        next == nullptr)
      return inside.fail(kNullPointer);
    *again = *ends = *nominals = *states = *next_defined = false;
    *next = 0;
    return inside.update();
  });
}

IPOS_FMI_EXPORT int fmi3DoStep(void* instance, double from, double length, bool, bool* event, bool* ends, bool* early,
                               double* reached) {
  return enter(instance, Call::DoStep, [&](Instance& inside, Component& own) {
    if (event == nullptr || ends == nullptr || early == nullptr || reached == nullptr) return inside.fail(kNullPointer);
    Step done;
    const Status status = inside.step(from, length, own.returns_early, done);
    if (status != Status::Ok) return status;
    *early = done.early;
    *event = (done.early || done.sends) && own.uses_events;
    *ends = false;
    *reached = inside.time();
    return Status::Ok;
  });
}

// Configuration mode is for structural parameters, and there are none.
IPOS_FMI_EXPORT int fmi3EnterConfigurationMode(void* instance) { return refuse(instance, Call::Configuration, kNotOffered); }
IPOS_FMI_EXPORT int fmi3ExitConfigurationMode(void* instance) { return refuse(instance, Call::Configuration, kNotOffered); }
IPOS_FMI_EXPORT int fmi3GetNumberOfVariableDependencies(void* instance, Reference, size_t*) {
  return refuse(instance, Call::Dependencies, kNotOffered);
}
IPOS_FMI_EXPORT int fmi3GetVariableDependencies(void* instance, Reference, size_t[], Reference[], size_t[], int[], size_t) {
  return refuse(instance, Call::Dependencies, kNotOffered);
}
IPOS_FMI_EXPORT int fmi3GetDirectionalDerivative(void* instance, const Reference[], size_t, const Reference[], size_t,
                                                 const double[], size_t, double[], size_t) {
  return refuse(instance, Call::Derivatives, kNotOffered);
}
IPOS_FMI_EXPORT int fmi3GetAdjointDerivative(void* instance, const Reference[], size_t, const Reference[], size_t,
                                             const double[], size_t, double[], size_t) {
  return refuse(instance, Call::Derivatives, kNotOffered);
}
IPOS_FMI_EXPORT int fmi3GetOutputDerivatives(void* instance, const Reference[], size_t, const int32_t[], double[], size_t) {
  return refuse(instance, Call::OutputDerivatives, kNotOffered);
}

// Of model exchange and scheduled execution: no instance of these can be made.
#define IPOS_FMI3_OTHER(name, ...) \
  IPOS_FMI_EXPORT int fmi3##name(void* __VA_OPT__(, ) __VA_ARGS__) { return kError; }
IPOS_FMI3_OTHER(EnterContinuousTimeMode)
IPOS_FMI3_OTHER(CompletedIntegratorStep, bool, bool*, bool*)
IPOS_FMI3_OTHER(SetTime, double)
IPOS_FMI3_OTHER(SetContinuousStates, const double[], size_t)
IPOS_FMI3_OTHER(GetContinuousStateDerivatives, double[], size_t)
IPOS_FMI3_OTHER(GetEventIndicators, double[], size_t)
IPOS_FMI3_OTHER(GetContinuousStates, double[], size_t)
IPOS_FMI3_OTHER(GetNominalsOfContinuousStates, double[], size_t)
IPOS_FMI3_OTHER(GetNumberOfEventIndicators, size_t*)
IPOS_FMI3_OTHER(GetNumberOfContinuousStates, size_t*)
IPOS_FMI3_OTHER(ActivateModelPartition, Reference, double)
