// What is behind an ipos_plant, and the one way into it: who calls, from where, and what becomes of exceptions.
#pragma once

#include <atomic>
#include <memory>
#include <new>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "runtime/library/include/ipos_plant.h"
#include "runtime/library/session.hpp"

struct ipos_plant {
  std::unique_ptr<ipos::library::Session> session;  // null: it has mistakes
  ipos::library::Mistakes mistakes;
  std::string message;
  std::string text;                          // handed out last
  std::vector<uint8_t> bytes;                // of the telegram handed out last
  std::set<std::string, std::less<>> names;  // handed out to stay
  std::vector<std::string> listed;           // of the last ipos_plant_name_at(), with what it was asked for
  std::string listed_for;
  std::atomic<std::thread::id> owner{std::this_thread::get_id()};
  std::atomic<bool> inside{false};
  bool in_callback = false;
  bool broken = false;

  const char* keep(std::string_view name) {
    const auto found = names.find(name);
    return (found != names.end() ? found : names.emplace(name).first)->c_str();
  }
  ipos_plant_status fail(ipos_plant_status status, std::string why) {
    message = std::move(why);
    return status;
  }
  const char* hand_out(std::string words) {
    text = std::move(words);
    return text.c_str();
  }
};

namespace ipos::library {

enum class Allowed : uint8_t { Anywhere, NotInCallbacks };

// Runs `action(session)` where the plant may be used now.
template <typename Do>
ipos_plant_status enter(ipos_plant* plant, Allowed allowed, Do action) noexcept {
  if (plant == nullptr) return IPOS_PLANT_INVALID_ARGUMENT;
  if (plant->owner.load() != std::this_thread::get_id()) return IPOS_PLANT_OTHER_THREAD;
  const bool in_callback = plant->in_callback;
  if (in_callback && allowed == Allowed::NotInCallbacks) return IPOS_PLANT_BUSY;
  if (!in_callback && plant->inside.exchange(true)) return IPOS_PLANT_BUSY;
  ipos_plant_status status = IPOS_PLANT_BROKEN;
  if (!plant->session) {
    status = IPOS_PLANT_NOT_OPEN;
  } else if (!plant->broken) {
    try {
      status = action(*plant->session);
    } catch (const std::bad_alloc&) {
      status = IPOS_PLANT_OUT_OF_MEMORY;
      plant->broken = true;
    } catch (...) {
      plant->broken = true;
    }
  }
  if (!in_callback) plant->inside.store(false);
  return status;
}

}  // namespace ipos::library
