// What an importer holds of an instance, and what the functions of both versions of FMI do alike: they look at their pointers and at
// the state of the instance, and let no exception out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "runtime/fmi/instance.hpp"

#ifdef _WIN32
#define IPOS_FMI_EXPORT extern "C" __declspec(dllexport)
#else
#define IPOS_FMI_EXPORT extern "C" __attribute__((visibility("default")))
#endif

namespace ipos::fmi {

struct Component {
  static constexpr uint64_t kAlive = 0x69706F73464D5543;
  uint64_t mark = kAlive;
  std::string name;
  std::unique_ptr<Instance> instance;
  bool broken = false;       // an exception came out of the plant, or memory ran out
  bool uses_events = false;  // FMI 3.0
  bool returns_early = false;
};

// Null: `log` has said why. Texts may be null.
Component* make_component(int version, const char* name, const char* token, const std::string& folder, const Log& log) noexcept;
void free_component(void* component) noexcept;

// The instance of a pointer that is one, in a state where the call is allowed; else null.
Component* entered(void* component, Call call) noexcept;
Status broke(Component& component) noexcept;

template <typename Do>
int enter(void* pointer, Call call, Do action) noexcept {
  Component* component = entered(pointer, call);
  if (component == nullptr) return static_cast<int>(Status::Error);
  try {
    return static_cast<int>(action(*component->instance, *component));
  } catch (...) {
    return static_cast<int>(broke(*component));
  }
}

// Values: `count` of them by their references. A value of the version becomes a double and comes back as it was.
template <typename Value>
int get_values(void* component, const uint32_t* references, size_t count, Value* values, size_t value_count,
               Instance::Types types) noexcept {
  return enter(component, Call::Get, [&](Instance& instance, Component&) {
    if (count != 0 && (references == nullptr || values == nullptr)) return instance.fail("a pointer is null");
    if (count != value_count) return instance.fail("there are not as many values as value references");
    return instance.get({references, count}, types, values);
  });
}
template <typename Value>
int set_values(void* component, const uint32_t* references, size_t count, const Value* values, size_t value_count,
               Instance::Types types) noexcept {
  return enter(component, Call::Set, [&](Instance& instance, Component&) {
    if (count != 0 && (references == nullptr || values == nullptr)) return instance.fail("a pointer is null");
    if (count != value_count) return instance.fail("there are not as many values as value references");
    return instance.set({references, count}, types, [&](size_t n) { return static_cast<double>(values[n]); });
  });
}

int get_state(void* component, void** state) noexcept;
int set_state(void* component, void* state) noexcept;
int free_state(void* component, void** state) noexcept;
int state_size(void* component, void* state, size_t* size) noexcept;
int serialize(void* component, void* state, uint8_t* bytes, size_t size) noexcept;
int deserialize(void* component, const uint8_t* bytes, size_t size, void** state) noexcept;
int set_logging(void* component, bool on, size_t count, const char* const* categories) noexcept;
int step(void* component, double from, double length, Step& done) noexcept;

// Values of a type that no variable has.
int no_values(void* component, Call call, size_t count) noexcept;

// A call that asks for what the FMU does not offer.
int refuse(void* component, Call call, const char* why) noexcept;

}  // namespace ipos::fmi
