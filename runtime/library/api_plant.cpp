// The C functions for opening, time, stations, journal and state.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <limits>
#include <utility>

#include "runtime/library/handle.hpp"

using namespace ipos::library;
using ipos::runtime::Time;

namespace {

ipos::library::Source source_of(const ipos_plant_source& source) {
  ipos::library::Source read;
  if (source.path != nullptr) read.path = source.path;
  if (source.text != nullptr) read.text = source.text;
  if (source.folder != nullptr) read.folder = source.folder;
  for (size_t n = 0; n < source.include_dir_count; ++n)
    read.include_dirs.emplace_back(source.include_dirs[n]);
  for (size_t n = 0; n < source.define_count; ++n) read.defines.emplace_back(source.defines[n]);
  read.write_memory = (source.flags & IPOS_PLANT_WRITE_MEMORY) != 0;
  read.commands_a_ms = source.commands_a_ms;
  read.seed = source.seed;
  return read;
}

bool has_null(const char* const* texts, size_t count) {
  if (count != 0 && texts == nullptr) return true;
  for (size_t n = 0; n < count; ++n)
    if (texts[n] == nullptr) return true;
  return false;
}

constexpr uint32_t kMostCommands = 1'000'000;

bool is_whole(const ipos_plant_source& source) {
  constexpr uint32_t kFlags = IPOS_PLANT_WRITE_MEMORY | IPOS_PLANT_NO_RECORD;
  return (source.path != nullptr || source.text != nullptr) && (source.flags & ~kFlags) == 0 &&
         source.commands_a_ms <= kMostCommands && !has_null(source.include_dirs, source.include_dir_count) &&
         !has_null(source.defines, source.define_count);
}

ipos_plant_status open(const ipos_plant_source& source, ipos_plant& plant) {
  auto contents = Contents::read(source_of(source));
  if (!contents) {
    plant.mistakes = std::move(contents).error();
  } else {
    auto session = Session::open(*std::move(contents),
                                 (source.flags & (IPOS_PLANT_NO_RECORD | IPOS_PLANT_WRITE_MEMORY)) == 0);
    if (session)
      plant.session = *std::move(session);
    else
      plant.mistakes = std::move(session).error();
  }
  if (plant.session) return IPOS_PLANT_OK;
  if (!plant.mistakes.empty()) plant.message = plant.mistakes.front().text;
  return IPOS_PLANT_BAD_PLANT;
}

// Does something to a station.
ipos_plant_status order(ipos_plant* plant, uint32_t station, Act act, int64_t value) {
  return enter(plant, Allowed::NotInCallbacks, [=](Session& session) {
    if (station >= station_count(session.plant()))
      return plant->fail(IPOS_PLANT_NO_STATION, fmt::format("there is no station number {}", station));
    Action action;
    action.act = act;
    action.signal.station = station;
    action.value = value;
    if (auto refused = session.perform(std::move(action)))
      return plant->fail(IPOS_PLANT_REFUSED, std::move(*refused));
    return ipos_plant_status{IPOS_PLANT_OK};
  });
}

ipos_plant_status out_of_time(ipos_plant* plant, Time now) {
  return plant->fail(IPOS_PLANT_INVALID_ARGUMENT, fmt::format("it is {} ns: time does not run back", now));
}

}  // namespace

uint32_t ipos_plant_version(void) { return IPOS_PLANT_VERSION; }

const char* ipos_plant_status_text(ipos_plant_status status) {
  switch (status) {
#define IPOS_PLANT_STATUS_ROW(name, number, text) \
  case name: return text;
    IPOS_PLANT_STATUSES(IPOS_PLANT_STATUS_ROW)
#undef IPOS_PLANT_STATUS_ROW
  }
  return "";
}

ipos_plant_status ipos_plant_open(const ipos_plant_source* source, ipos_plant** plant) {
  if (plant == nullptr) return IPOS_PLANT_INVALID_ARGUMENT;
  *plant = nullptr;
  if (source == nullptr || !is_whole(*source)) return IPOS_PLANT_INVALID_ARGUMENT;
  try {
    auto made = std::make_unique<ipos_plant>();
    const ipos_plant_status status = open(*source, *made);
    *plant = made.release();
    return status;
  } catch (const std::exception&) {  // the library throws only when memory runs out
    return IPOS_PLANT_OUT_OF_MEMORY;
  }
}

ipos_plant_status ipos_plant_close(ipos_plant* plant) {
  if (plant == nullptr) return IPOS_PLANT_OK;
  if (plant->inside.exchange(true)) return IPOS_PLANT_BUSY;
  ipos_plant_status status = IPOS_PLANT_OK;
  try {
    if (plant->session && !plant->broken && !plant->session->plant().store_memories())
      status = IPOS_PLANT_REFUSED;
  } catch (const std::exception&) {
    status = IPOS_PLANT_OUT_OF_MEMORY;
  }
  delete plant;
  return status;
}

ipos_plant_status ipos_plant_adopt(ipos_plant* plant) {
  if (plant == nullptr) return IPOS_PLANT_INVALID_ARGUMENT;
  if (plant->inside.exchange(true)) return IPOS_PLANT_BUSY;
  plant->owner.store(std::this_thread::get_id());
  plant->inside.store(false);
  return IPOS_PLANT_OK;
}

const char* ipos_plant_message(const ipos_plant* plant) {
  return plant == nullptr || plant->owner.load() != std::this_thread::get_id() ? "" : plant->message.c_str();
}

size_t ipos_plant_mistakes(const ipos_plant* plant) { return plant == nullptr ? 0 : plant->mistakes.size(); }

ipos_plant_status ipos_plant_mistake_at(const ipos_plant* plant, size_t number, ipos_plant_mistake* mistake) {
  if (plant == nullptr || mistake == nullptr) return IPOS_PLANT_INVALID_ARGUMENT;
  if (number >= plant->mistakes.size()) return IPOS_PLANT_NOTHING;
  const Mistake& row = plant->mistakes[number];
  *mistake = {row.file.c_str(), row.text.c_str(), row.line, row.column};
  return IPOS_PLANT_OK;
}

ipos_plant_status ipos_plant_duration(const char* text, int64_t* ns) {
  if (text == nullptr || ns == nullptr) return IPOS_PLANT_INVALID_ARGUMENT;
  const int64_t duration = ipos::runtime::parse_duration(text);
  if (duration < 0) return IPOS_PLANT_BAD_VALUE;
  *ns = duration;
  return IPOS_PLANT_OK;
}

ipos_plant_status ipos_plant_time(ipos_plant* plant, int64_t* ns) {
  return enter(plant, Allowed::Anywhere, [=](Session& session) {
    if (ns == nullptr) return IPOS_PLANT_INVALID_ARGUMENT;
    *ns = session.plant().now();
    return IPOS_PLANT_OK;
  });
}

ipos_plant_status ipos_plant_run(ipos_plant* plant, int64_t until) {
  return enter(plant, Allowed::NotInCallbacks, [=](Session& session) {
    const Time now = session.plant().now();
    if (until < now || until == ipos::runtime::kNever) return out_of_time(plant, now);
    session.run(until);
    return ipos_plant_status{IPOS_PLANT_OK};
  });
}

ipos_plant_status ipos_plant_run_until(ipos_plant* plant, int64_t limit, ipos_plant_condition condition,
                                       void* user) {
  return enter(plant, Allowed::NotInCallbacks, [=](Session& session) {
    const Time now = session.plant().now();
    if (condition == nullptr) return ipos_plant_status{IPOS_PLANT_INVALID_ARGUMENT};
    if (limit < now || limit == ipos::runtime::kNever) return out_of_time(plant, now);
    const bool met = session.run_until(limit, [=] {
      plant->in_callback = true;
      const bool holds = condition(user, plant);
      plant->in_callback = false;
      return holds;
    });
    if (met) return ipos_plant_status{IPOS_PLANT_OK};
    return plant->fail(IPOS_PLANT_NOT_REACHED, "the time limit came before the condition");
  });
}

ipos_plant_status ipos_plant_station_at(ipos_plant* plant, uint32_t station, ipos_plant_station_info* info) {
  return enter(plant, Allowed::Anywhere, [=](Session& session) {
    if (info == nullptr) return ipos_plant_status{IPOS_PLANT_INVALID_ARGUMENT};
    if (const ipos::runtime::Gateway* gateway = gateway_of(session.plant(), station)) {
      *info = {plant->keep(gateway->config().name), plant->keep("gateway"), plant->keep("gateway from PROFIBUS to SBus"),
               plant->keep("")};
      return ipos_plant_status{IPOS_PLANT_OK};
    }
    const auto& stations = session.plant().stations();
    if (station >= stations.size())
      return plant->fail(IPOS_PLANT_NO_STATION, fmt::format("there is no station number {}", station));
    const ipos::runtime::StationConfig& config = stations[station]->config();
    *info = {plant->keep(config.name), plant->keep(config.unit->name), plant->keep(config.unit->title),
             plant->keep(config.program)};
    return ipos_plant_status{IPOS_PLANT_OK};
  });
}

ipos_plant_status ipos_plant_station(ipos_plant* plant, const char* name, uint32_t* station) {
  return enter(plant, Allowed::Anywhere, [=](Session& session) {
    if (name == nullptr || station == nullptr) return ipos_plant_status{IPOS_PLANT_INVALID_ARGUMENT};
    const auto& stations = session.plant().stations();
    const auto found = std::find_if(stations.begin(), stations.end(),
                                    [=](const auto& each) { return each->config().name == name; });
    for (auto number = static_cast<uint32_t>(stations.size()); number < station_count(session.plant()); ++number)
      if (gateway_of(session.plant(), number)->config().name == name) return *station = number, ipos_plant_status{IPOS_PLANT_OK};
    if (found == stations.end())
      return plant->fail(IPOS_PLANT_NO_STATION, fmt::format("there is no station '{}'; the plant has {}",
                                                            name, station_names(session.plant())));
    *station = static_cast<uint32_t>(found - stations.begin());
    return ipos_plant_status{IPOS_PLANT_OK};
  });
}

ipos_plant_status ipos_plant_ideal_motor(ipos_plant* plant, uint32_t station, bool* ideal) {
  return enter(plant, Allowed::Anywhere, [=](Session& session) {
    if (ideal == nullptr) return ipos_plant_status{IPOS_PLANT_INVALID_ARGUMENT};
    const auto& stations = session.plant().stations();
    if (station >= station_count(session.plant()))
      return plant->fail(IPOS_PLANT_NO_STATION, fmt::format("there is no station number {}", station));
    *ideal = station < stations.size() && !stations[station]->config().options.own_motor;
    return ipos_plant_status{IPOS_PLANT_OK};
  });
}

ipos_plant_status ipos_plant_power(ipos_plant* plant, uint32_t station, bool on) {
  return order(plant, station, on ? Act::PowerOn : Act::PowerOff, 0);
}

ipos_plant_status ipos_plant_program(ipos_plant* plant, uint32_t station, int32_t what) {
  if (what < IPOS_PLANT_PROGRAM_START || what > IPOS_PLANT_PROGRAM_RESTART)
    return IPOS_PLANT_INVALID_ARGUMENT;
  return order(plant, station, Act::Program, what);
}

ipos_plant_status ipos_plant_drive_fault(ipos_plant* plant, uint32_t station, uint8_t number) {
  return number == 0 ? IPOS_PLANT_INVALID_ARGUMENT : order(plant, station, Act::DriveFault, number);
}

ipos_plant_status ipos_plant_reset_fault(ipos_plant* plant, uint32_t station) {
  return order(plant, station, Act::ResetFault, 0);
}

ipos_plant_status ipos_plant_why(ipos_plant* plant, uint32_t station, const char** text) {
  return enter(plant, Allowed::Anywhere, [=](Session& session) {
    if (text == nullptr) return ipos_plant_status{IPOS_PLANT_INVALID_ARGUMENT};
    if (const ipos::runtime::Gateway* gateway = gateway_of(session.plant(), station)) {
      *text = plant->hand_out(!gateway->powered()    ? "the power is off"
                              : gateway->exchanges() ? "enabled"
                                                     : "no DP master exchanges data with it");
      return ipos_plant_status{IPOS_PLANT_OK};
    }
    const auto& stations = std::as_const(session.plant()).stations();
    if (station >= stations.size())
      return plant->fail(IPOS_PLANT_NO_STATION, fmt::format("there is no station number {}", station));
    const Station& asked = *stations[station];
    *text = plant->hand_out(asked.powered() ? block_text(asked.drive().state().verdict().reason, *asked.config().unit)
                                            : "the power is off");
    return ipos_plant_status{IPOS_PLANT_OK};
  });
}

ipos_plant_status ipos_plant_journal_at(ipos_plant* plant, size_t number, ipos_plant_entry* entry) {
  return enter(plant, Allowed::Anywhere, [=](Session& session) {
    if (entry == nullptr) return IPOS_PLANT_INVALID_ARGUMENT;
    const auto& entries = session.plant().journal().entries();
    if (number >= entries.size()) return IPOS_PLANT_NOTHING;
    const ipos::runtime::JournalEntry& row = entries[number];
    *entry = {row.time, static_cast<ipos_plant_weight>(row.weight), row.station.c_str(), row.text.c_str()};
    return IPOS_PLANT_OK;
  });
}

ipos_plant_status ipos_plant_save(ipos_plant* plant, void* bytes, size_t* size) {
  return enter(plant, Allowed::NotInCallbacks, [=](Session& session) {
    if (size == nullptr || (bytes == nullptr && *size != 0)) return IPOS_PLANT_INVALID_ARGUMENT;
    if (!session.recorded()) return IPOS_PLANT_NOT_RECORDED;
    const std::vector<uint8_t> saved = session.save();
    const size_t room = std::exchange(*size, saved.size());
    if (room < saved.size()) return IPOS_PLANT_TOO_SMALL;
    std::memcpy(bytes, saved.data(), saved.size());
    return IPOS_PLANT_OK;
  });
}

ipos_plant_status ipos_plant_restore(ipos_plant* plant, const void* bytes, size_t size) {
  return enter(plant, Allowed::NotInCallbacks, [=](Session& session) {
    if (bytes == nullptr) return ipos_plant_status{IPOS_PLANT_INVALID_ARGUMENT};
    if (!session.recorded()) return ipos_plant_status{IPOS_PLANT_NOT_RECORDED};
    std::string why;
    switch (session.restore({static_cast<const uint8_t*>(bytes), size}, why)) {
      case Session::Restored::Done: return ipos_plant_status{IPOS_PLANT_OK};
      case Session::Restored::Damaged: return plant->fail(IPOS_PLANT_BAD_STATE, std::move(why));
      case Session::Restored::OtherPlant: break;
    }
    return plant->fail(IPOS_PLANT_OTHER_PLANT, std::move(why));
  });
}

ipos_plant_status ipos_plant_restart(ipos_plant* plant) {
  return enter(plant, Allowed::NotInCallbacks, [=](Session& session) {
    if (auto refused = session.restart()) return plant->fail(IPOS_PLANT_REFUSED, std::move(*refused));
    return ipos_plant_status{IPOS_PLANT_OK};
  });
}

ipos_plant_status ipos_plant_replay(ipos_plant* plant, ipos_plant_condition look, void* user) {
  return enter(plant, Allowed::NotInCallbacks, [=](Session& session) {
    if (look == nullptr) return ipos_plant_status{IPOS_PLANT_INVALID_ARGUMENT};
    if (!session.recorded()) return ipos_plant_status{IPOS_PLANT_NOT_RECORDED};
    std::string why;
    const auto done = session.restore(session.save(), why, [=] {
      plant->in_callback = true;
      look(user, plant);
      plant->in_callback = false;
    });
    if (done == Session::Restored::Done) return ipos_plant_status{IPOS_PLANT_OK};
    return plant->fail(IPOS_PLANT_BAD_STATE, std::move(why));
  });
}

ipos_plant_status ipos_plant_trace_hash(ipos_plant* plant, uint64_t* hash) {
  return enter(plant, Allowed::NotInCallbacks, [=](Session& session) {
    if (hash == nullptr) return IPOS_PLANT_INVALID_ARGUMENT;
    if (!session.recorded()) return IPOS_PLANT_NOT_RECORDED;
    *hash = session.trace_hash();
    return IPOS_PLANT_OK;
  });
}
