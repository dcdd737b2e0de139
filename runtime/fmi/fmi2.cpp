// The functions of FMI 2.0 for co-simulation, as chapters 2.1 and 4.2 of the specification (2.0.5) declare them.
#include <string>
#include <utility>

#include "runtime/fmi/component.hpp"
#include "runtime/fmi/resources.hpp"

using namespace ipos::fmi;

namespace {

using Real = double;
using Integer = int;
using Boolean = int;
using Text = const char*;
using Reference = unsigned int;
static_assert(sizeof(Reference) == sizeof(uint32_t));

struct Callbacks {
  void (*logger)(void* environment, Text instance, int status, Text category, Text message, ...);
  void* (*allocate)(size_t count, size_t size);
  void (*free)(void* memory);
  void (*step_finished)(void* environment, int status);
  void* environment;
};

constexpr int kOk = 0;
constexpr int kCoSimulation = 1;
constexpr int kDoStepStatus = 0, kPendingStatus = 1, kLastSuccessfulTime = 2, kTerminated = 3;

// The message is a format of printf, and # begins a reference to a variable.
std::string as_format(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '%' ? "%%" : c == '#' ? "##" : std::string(1, c);
  return out;
}

Log log_of(const Callbacks* callbacks, std::string name) {
  if (callbacks == nullptr || callbacks->logger == nullptr) return [](Status, const char*, const std::string&) {};
  return [logger = callbacks->logger, environment = callbacks->environment, name = std::move(name)](
             Status status, const char* category, const std::string& text) {
    logger(environment, name.c_str(), static_cast<int>(status), category, as_format(text).c_str());
  };
}

}  // namespace

IPOS_FMI_EXPORT Text fmi2GetTypesPlatform() { return "default"; }
IPOS_FMI_EXPORT Text fmi2GetVersion() { return "2.0"; }

IPOS_FMI_EXPORT int fmi2SetDebugLogging(void* c, Boolean on, size_t count, const Text categories[]) {
  return set_logging(c, on != 0, count, categories);
}

IPOS_FMI_EXPORT void* fmi2Instantiate(Text name, int type, Text guid, Text resources, const Callbacks* callbacks, Boolean,
                                      Boolean logging) {
  try {
    const Log log = log_of(callbacks, name == nullptr ? "" : name);
    if (type != kCoSimulation) {
      log(Status::Error, kErrors, "this FMU is for co-simulation");
      return nullptr;
    }
    Component* made = make_component(2, name, guid, folder_of_uri(resources == nullptr ? "" : resources), log);
    if (made != nullptr) made->instance->set_logging(logging != 0);
    return made;
  } catch (...) {
    return nullptr;
  }
}

IPOS_FMI_EXPORT void fmi2FreeInstance(void* c) { free_component(c); }

IPOS_FMI_EXPORT int fmi2SetupExperiment(void* c, Boolean, Real, Real start, Boolean, Real) {
  return enter(c, Call::SetupExperiment, [&](Instance& instance, Component&) { return instance.set_start(start); });
}
IPOS_FMI_EXPORT int fmi2EnterInitializationMode(void* c) {
  return enter(c, Call::EnterInitialization, [](Instance& instance, Component&) { return instance.enter_initialization(); });
}
IPOS_FMI_EXPORT int fmi2ExitInitializationMode(void* c) {
  return enter(c, Call::ExitInitialization, [](Instance& instance, Component&) { return instance.exit_initialization(false); });
}
IPOS_FMI_EXPORT int fmi2Terminate(void* c) {
  return enter(c, Call::Terminate, [](Instance& instance, Component&) { return instance.terminate(); });
}
IPOS_FMI_EXPORT int fmi2Reset(void* c) {
  return enter(c, Call::Reset, [](Instance& instance, Component&) { return instance.reset(); });
}

IPOS_FMI_EXPORT int fmi2GetReal(void* c, const Reference vr[], size_t n, Real value[]) {
  return get_values(c, vr, n, value, n, {Type::Real});
}
IPOS_FMI_EXPORT int fmi2GetInteger(void* c, const Reference vr[], size_t n, Integer value[]) {
  return get_values(c, vr, n, value, n, {Type::Integer, Type::Enumeration});
}
IPOS_FMI_EXPORT int fmi2GetBoolean(void* c, const Reference vr[], size_t n, Boolean value[]) {
  return get_values(c, vr, n, value, n, {Type::Boolean});
}
IPOS_FMI_EXPORT int fmi2GetString(void* c, const Reference vr[], size_t n, Text value[]) {
  return n == 0 ? get_values<Real>(c, vr, 0, nullptr, 0, {}) : value == nullptr ? refuse(c, Call::Get, "a pointer is null")
                                                                                 : refuse(c, Call::Get, "no variable is a text");
}
IPOS_FMI_EXPORT int fmi2SetReal(void* c, const Reference vr[], size_t n, const Real value[]) {
  return set_values(c, vr, n, value, n, {Type::Real});
}
IPOS_FMI_EXPORT int fmi2SetInteger(void* c, const Reference vr[], size_t n, const Integer value[]) {
  return set_values(c, vr, n, value, n, {Type::Integer, Type::Enumeration});
}
IPOS_FMI_EXPORT int fmi2SetBoolean(void* c, const Reference vr[], size_t n, const Boolean value[]) {
  return set_values(c, vr, n, value, n, {Type::Boolean});
}
IPOS_FMI_EXPORT int fmi2SetString(void* c, const Reference vr[], size_t n, const Text[]) {
  return n == 0 ? set_values<Real>(c, vr, 0, nullptr, 0, {}) : refuse(c, Call::Set, "no variable is a text");
}

IPOS_FMI_EXPORT int fmi2GetFMUstate(void* c, void** state) { return get_state(c, state); }
IPOS_FMI_EXPORT int fmi2SetFMUstate(void* c, void* state) { return set_state(c, state); }
IPOS_FMI_EXPORT int fmi2FreeFMUstate(void* c, void** state) { return free_state(c, state); }
IPOS_FMI_EXPORT int fmi2SerializedFMUstateSize(void* c, void* state, size_t* size) { return state_size(c, state, size); }
IPOS_FMI_EXPORT int fmi2SerializeFMUstate(void* c, void* state, char bytes[], size_t size) {
  return serialize(c, state, reinterpret_cast<uint8_t*>(bytes), size);
}
IPOS_FMI_EXPORT int fmi2DeSerializeFMUstate(void* c, const char bytes[], size_t size, void** state) {
  return deserialize(c, reinterpret_cast<const uint8_t*>(bytes), size, state);
}

IPOS_FMI_EXPORT int fmi2GetDirectionalDerivative(void* c, const Reference[], size_t, const Reference[], size_t, const Real[], Real[]) {
  return refuse(c, Call::Derivatives, "derivatives are not offered");
}
IPOS_FMI_EXPORT int fmi2SetRealInputDerivatives(void* c, const Reference[], size_t, const Integer[], const Real[]) {
  return refuse(c, Call::InputDerivatives, "derivatives are not offered");
}
IPOS_FMI_EXPORT int fmi2GetRealOutputDerivatives(void* c, const Reference[], size_t, const Integer[], Real[]) {
  return refuse(c, Call::OutputDerivatives, "derivatives are not offered");
}

IPOS_FMI_EXPORT int fmi2DoStep(void* c, Real from, Real length, Boolean) {
  Step done;
  return step(c, from, length, done);
}
// A step is over when fmi2DoStep returns.
IPOS_FMI_EXPORT int fmi2CancelStep(void* c) { return refuse(c, Call::CancelStep, "no step is under way"); }

IPOS_FMI_EXPORT int fmi2GetStatus(void* c, int kind, int* value) {
  return enter(c, Call::GetStatus, [&](Instance& instance, Component&) {
    if (value == nullptr) return instance.fail("a pointer is null");
    if (kind != kDoStepStatus) return Status::Discard;
    *value = kOk;
    return Status::Ok;
  });
}
IPOS_FMI_EXPORT int fmi2GetRealStatus(void* c, int kind, Real* value) {
  return enter(c, Call::GetStatus, [&](Instance& instance, Component&) {
    if (value == nullptr) return instance.fail("a pointer is null");
    if (kind != kLastSuccessfulTime) return Status::Discard;
    *value = instance.time();
    return Status::Ok;
  });
}
IPOS_FMI_EXPORT int fmi2GetIntegerStatus(void* c, int, Integer*) {
  return enter(c, Call::GetStatus, [](Instance&, Component&) { return Status::Discard; });
}
IPOS_FMI_EXPORT int fmi2GetBooleanStatus(void* c, int kind, Boolean* value) {
  return enter(c, Call::GetStatus, [&](Instance& instance, Component&) {
    if (value == nullptr) return instance.fail("a pointer is null");
    if (kind != kTerminated) return Status::Discard;
    *value = 0;
    return Status::Ok;
  });
}
IPOS_FMI_EXPORT int fmi2GetStringStatus(void* c, int kind, Text* value) {
  return enter(c, Call::GetStatus, [&](Instance& instance, Component&) {
    if (value == nullptr) return instance.fail("a pointer is null");
    if (kind != kPendingStatus) return Status::Discard;
    *value = "";
    return Status::Ok;
  });
}
