// Pointers, states and the end of exceptions.
#include "runtime/fmi/component.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string_view>
#include <utility>

namespace ipos::fmi {
namespace {

constexpr const char* kCategories[] = {kErrors, kWarnings, kJournal};

SavedInstance* saved_of(void* state) {
  auto* saved = static_cast<SavedInstance*>(state);
  return saved != nullptr && saved->mark == SavedInstance::kAlive ? saved : nullptr;
}

}  // namespace

Component* make_component(int version, const char* name, const char* token, const std::string& folder, const Log& log) noexcept {
  try {
    const auto refuse = [&](const std::string& why) {
      log(Status::Error, kErrors, why);
      return nullptr;
    };
    if (name == nullptr || *name == 0) return refuse("the instance has no name");
    if (token == nullptr) return refuse("the instance has no token");
    if (folder.empty()) return refuse("the place of the resources is not told");
    auto component = std::make_unique<Component>();
    component->name = name;
    component->instance = Instance::make(version, token, folder, log);
    return component->instance ? component.release() : nullptr;
  } catch (...) {
    return nullptr;
  }
}

void free_component(void* pointer) noexcept {
  auto* component = static_cast<Component*>(pointer);
  if (component == nullptr || component->mark != Component::kAlive) return;
  component->mark = 0;
  delete component;
}

Component* entered(void* pointer, Call call) noexcept {
  auto* component = static_cast<Component*>(pointer);
  if (component == nullptr || component->mark != Component::kAlive) return nullptr;
  try {
    if (!component->broken) return component->instance->allows(call) ? component : nullptr;
    component->instance->fail("the plant broke in an earlier call; the instance can only be freed");
  } catch (...) {
    component->broken = true;
  }
  return nullptr;
}

Status broke(Component& component) noexcept {
  component.broken = true;
  try {
    return component.instance->fail("the plant broke: perhaps there is no memory any more");
  } catch (...) {
    return Status::Error;
  }
}

int get_state(void* component, void** state) noexcept {
  return enter(component, Call::GetState, [&](Instance& instance, Component&) {
    if (state == nullptr) return instance.fail("a pointer is null");
    auto saved = instance.save();
    SavedInstance* old = saved_of(*state);  // may be used again
    if (old != nullptr)
      *old = std::move(*saved);
    else
      *state = saved.release();
    return Status::Ok;
  });
}

int set_state(void* component, void* state) noexcept {
  return enter(component, Call::SetState, [&](Instance& instance, Component&) {
    const SavedInstance* saved = saved_of(state);
    return saved == nullptr ? instance.fail("this is no state of an FMU of ipos") : instance.restore(*saved);
  });
}

int free_state(void* component, void** state) noexcept {
  return enter(component, Call::FreeState, [&](Instance& instance, Component&) {
    if (state == nullptr || *state == nullptr) return Status::Ok;
    SavedInstance* saved = saved_of(*state);
    if (saved == nullptr) return instance.fail("this is no state of an FMU of ipos");
    saved->mark = 0;
    delete saved;
    *state = nullptr;
    return Status::Ok;
  });
}

int state_size(void* component, void* state, size_t* size) noexcept {
  return enter(component, Call::StateSize, [&](Instance& instance, Component&) {
    const SavedInstance* saved = saved_of(state);
    if (saved == nullptr || size == nullptr) return instance.fail("a pointer is null, or no state of an FMU of ipos");
    *size = instance.to_bytes(*saved).size();
    return Status::Ok;
  });
}

int serialize(void* component, void* state, uint8_t* bytes, size_t size) noexcept {
  return enter(component, Call::Serialize, [&](Instance& instance, Component&) {
    const SavedInstance* saved = saved_of(state);
    if (saved == nullptr || bytes == nullptr) return instance.fail("a pointer is null, or no state of an FMU of ipos");
    const std::string made = instance.to_bytes(*saved);
    if (size < made.size()) return instance.fail(fmt::format("the state has {} bytes, there is room for {}", made.size(), size));
    std::memcpy(bytes, made.data(), made.size());
    return Status::Ok;
  });
}

int deserialize(void* component, const uint8_t* bytes, size_t size, void** state) noexcept {
  return enter(component, Call::Deserialize, [&](Instance& instance, Component&) {
    if (bytes == nullptr || state == nullptr) return instance.fail("a pointer is null");
    auto saved = instance.from_bytes({reinterpret_cast<const char*>(bytes), size});
    if (!saved) return Status::Error;
    *state = saved.release();
    return Status::Ok;
  });
}

int set_logging(void* component, bool on, size_t count, const char* const* categories) noexcept {
  return enter(component, Call::SetDebugLogging, [&](Instance& instance, Component&) {
    if (count != 0 && categories == nullptr) return instance.fail("a pointer is null");
    bool journal = count == 0;
    for (size_t n = 0; n < count; ++n) {
      const std::string_view asked = categories[n] == nullptr ? "" : categories[n];
      if (std::find(std::begin(kCategories), std::end(kCategories), asked) == std::end(kCategories))
        return instance.fail(fmt::format("there is no log category '{}'", asked));
      journal |= asked == kJournal;
    }
    if (journal) instance.set_logging(on);
    return Status::Ok;
  });
}

int step(void* component, double from, double length, Step& done) noexcept {
  return enter(component, Call::DoStep, [&](Instance& instance, Component& own) {
    return instance.step(from, length, own.returns_early, done);
  });
}

int no_values(void* component, Call call, size_t count) noexcept {
  return enter(component, call, [&](Instance& instance, Component&) {
    return count == 0 ? Status::Ok : instance.fail("the variable is of another type");
  });
}

int refuse(void* component, Call call, const char* why) noexcept {
  return enter(component, call, [&](Instance& instance, Component&) { return instance.fail(why); });
}

}  // namespace ipos::fmi
