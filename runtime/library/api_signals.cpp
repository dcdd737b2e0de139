// The C functions for signals.
#include <fmt/format.h>

#include <utility>

#include "runtime/library/handle.hpp"

using namespace ipos::library;

namespace {

ipos_plant_status no_signal(ipos_plant* plant, uint32_t signal) {
  return plant->fail(IPOS_PLANT_NO_SIGNAL, fmt::format("no signal has number {}", signal));
}

ipos_plant_status act(ipos_plant* plant, Session& session, const Session::Signal& signal, Act what,
                      uint32_t number, int64_t value) {
  if (!signal.is_writable())
    return plant->fail(IPOS_PLANT_READ_ONLY, fmt::format("{} can only be read", signal.name));
  if (auto wrong = signal.shown.check(value))
    return plant->fail(IPOS_PLANT_BAD_VALUE, fmt::format("{}: {}", signal.name, *wrong));
  Action action;
  action.act = what;
  action.signal = {signal.id.station, signal.id.kind, number};
  action.value = value;
  if (auto refused = session.perform(std::move(action)))
    return plant->fail(IPOS_PLANT_REFUSED, std::move(*refused));
  return IPOS_PLANT_OK;
}

ipos_plant_status act(ipos_plant* plant, uint32_t number, Act what, int64_t value) {
  return enter(plant, Allowed::NotInCallbacks, [=](Session& session) {
    const Session::Signal* signal = session.signal(number);
    if (signal == nullptr) return no_signal(plant, number);
    return act(plant, session, *signal, what, signal->id.number, value);
  });
}

ipos_plant_status act(ipos_plant* plant, uint32_t number, Act what, const char* text) {
  return enter(plant, Allowed::NotInCallbacks, [=](Session& session) {
    if (text == nullptr) return ipos_plant_status{IPOS_PLANT_INVALID_ARGUMENT};
    const Session::Signal* signal = session.signal(number);
    if (signal == nullptr) return no_signal(plant, number);
    if (!signal->is_writable())
      return plant->fail(IPOS_PLANT_READ_ONLY, fmt::format("{} can only be read", signal->name));
    auto value = signal->shown.parse(text);
    if (!value) return plant->fail(IPOS_PLANT_BAD_VALUE, std::move(value).error());
    return act(plant, session, *signal, what, value->number, value->sample);
  });
}

bool is_kind(ipos_plant_kind kind) { return kind >= IPOS_PLANT_ANY && kind <= IPOS_PLANT_SHAFT; }

ipos_plant_status no_station(ipos_plant* plant, uint32_t station) {
  return plant->fail(IPOS_PLANT_NO_STATION, fmt::format("there is no station number {}", station));
}

}  // namespace

ipos_plant_status ipos_plant_find(ipos_plant* plant, uint32_t station, ipos_plant_kind kind, const char* name,
                                  uint32_t* signal) {
  return enter(plant, Allowed::Anywhere, [=](Session& session) {
    if (name == nullptr || signal == nullptr || !is_kind(kind))
      return ipos_plant_status{IPOS_PLANT_INVALID_ARGUMENT};
    if (!has_signals(session.plant(), station)) return no_station(plant, station);
    auto id = find_id(session.plant(), station, static_cast<Kind>(kind), name);
    if (!id) return plant->fail(IPOS_PLANT_NO_SIGNAL, std::move(id).error());
    *signal = session.add_signal(*id, name);
    return ipos_plant_status{IPOS_PLANT_OK};
  });
}

ipos_plant_status ipos_plant_signal_info_of(ipos_plant* plant, uint32_t number,
                                            ipos_plant_signal_info* info) {
  return enter(plant, Allowed::Anywhere, [=](Session& session) {
    if (info == nullptr) return ipos_plant_status{IPOS_PLANT_INVALID_ARGUMENT};
    const Session::Signal* signal = session.signal(number);
    if (signal == nullptr) return no_signal(plant, number);
    const ipos::signals::Signal now = Session::now(*signal);
    const bool writable = signal->is_writable() && now.is_writable();
    *info = {plant->keep(signal->name),
             plant->keep(now.unit),
             now.factor,
             now.decimals,
             static_cast<ipos_plant_kind>(signal->id.kind),
             signal->id.station,
             signal->id.number,
             writable ? uint32_t{IPOS_PLANT_WRITABLE} : 0U};
    return ipos_plant_status{IPOS_PLANT_OK};
  });
}

ipos_plant_status ipos_plant_name_at(ipos_plant* plant, uint32_t station, ipos_plant_kind kind,
                                     const char* part, uint32_t number, const char** name) {
  return enter(plant, Allowed::Anywhere, [=](Session& session) {
    if (name == nullptr || !is_kind(kind) || kind == IPOS_PLANT_ANY)
      return ipos_plant_status{IPOS_PLANT_INVALID_ARGUMENT};
    if (!has_signals(session.plant(), station)) return no_station(plant, station);
    const auto whole = part == nullptr ? std::nullopt : std::optional<std::string_view>(part);
    const std::string asked = fmt::format("{} {} {}{}", station, kind, whole ? "of " : "", whole.value_or(""));
    if (plant->listed_for != asked) {
      plant->listed_for.clear();
      plant->listed = signal_names(session.plant(), station, static_cast<Kind>(kind), whole);
      plant->listed_for = asked;
    }
    if (number >= plant->listed.size()) return ipos_plant_status{IPOS_PLANT_NOTHING};
    *name = plant->listed[number].c_str();
    return ipos_plant_status{IPOS_PLANT_OK};
  });
}

ipos_plant_status ipos_plant_read(ipos_plant* plant, uint32_t signal, int64_t* value) {
  return ipos_plant_read_many(plant, &signal, 1, value);
}

ipos_plant_status ipos_plant_read_many(ipos_plant* plant, const uint32_t* signals, size_t count,
                                       int64_t* values) {
  return enter(plant, Allowed::Anywhere, [=](Session& session) {
    if (count != 0 && (signals == nullptr || values == nullptr))
      return ipos_plant_status{IPOS_PLANT_INVALID_ARGUMENT};
    for (size_t n = 0; n < count; ++n)
      if (session.signal(signals[n]) == nullptr) return no_signal(plant, signals[n]);
    for (size_t n = 0; n < count; ++n) values[n] = Session::read(*session.signal(signals[n]));
    return ipos_plant_status{IPOS_PLANT_OK};
  });
}

ipos_plant_status ipos_plant_read_text(ipos_plant* plant, uint32_t number, const char** text) {
  return enter(plant, Allowed::Anywhere, [=](Session& session) {
    if (text == nullptr) return ipos_plant_status{IPOS_PLANT_INVALID_ARGUMENT};
    const Session::Signal* signal = session.signal(number);
    if (signal == nullptr) return no_signal(plant, number);
    const ipos::signals::Signal now = Session::now(*signal);
    *text = plant->hand_out(now.words(now.read()));
    return ipos_plant_status{IPOS_PLANT_OK};
  });
}

ipos_plant_status ipos_plant_write(ipos_plant* plant, uint32_t signal, int64_t value) {
  return act(plant, signal, Act::Write, value);
}
ipos_plant_status ipos_plant_write_text(ipos_plant* plant, uint32_t signal, const char* text) {
  return act(plant, signal, Act::Write, text);
}
ipos_plant_status ipos_plant_force(ipos_plant* plant, uint32_t signal, int64_t value) {
  return act(plant, signal, Act::Force, value);
}
ipos_plant_status ipos_plant_force_text(ipos_plant* plant, uint32_t signal, const char* text) {
  return act(plant, signal, Act::Force, text);
}
ipos_plant_status ipos_plant_release(ipos_plant* plant, uint32_t signal) {
  return act(plant, signal, Act::Release, int64_t{0});
}
