// The C functions for lines.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <span>
#include <utility>

#include "runtime/bus/log/profibus_log.hpp"
#include "runtime/bus/log/serial_log.hpp"
#include "runtime/library/handle.hpp"

using namespace ipos::library;

namespace {

ipos_plant_status no_bus(ipos_plant* plant, std::string_view what) {
  return plant->fail(IPOS_PLANT_NO_BUS, std::string(what));
}

std::string bus_names(Session& session) {
  std::vector<std::string_view> names;
  for (size_t bus = 0; bus < session.instance().line_count(); ++bus)
    session.instance().with_line(bus, [&](auto& tap) { names.push_back(tap.line().name()); });
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

// Runs `action(tap)` for the line of this number and kind.
template <typename Do>
ipos_plant_status with_can(ipos_plant* plant, uint32_t bus, Allowed allowed, Do action) {
  return enter(plant, allowed, [&](Session& session) -> ipos_plant_status {
    auto& taps = session.instance().can();
    if (bus >= taps.size()) return no_bus(plant, fmt::format("no CAN line has number {}", bus));
    return action(session, *taps[bus]);
  });
}
// For the line of this number, of one of the kinds that carry octets.
template <typename Do>
ipos_plant_status with_octets(ipos_plant* plant, uint32_t bus, Do action) {
  return enter(plant, Allowed::NotInCallbacks, [&](Session& session) -> ipos_plant_status {
    std::optional<ipos_plant_status> status;
    session.instance().with_line(bus, [&](auto& tap) {
      if constexpr (requires { tap.kLongest; }) status = action(session, tap);
    });
    return status ? *status : no_bus(plant, fmt::format("no serial line has number {}", bus));
  });
}

ipos_plant_bus_kind kind_of(const CanTap&) { return IPOS_PLANT_CAN; }
ipos_plant_bus_kind kind_of(const SerialTap&) { return IPOS_PLANT_SERIAL; }
ipos_plant_bus_kind kind_of(const ProfibusTap&) { return IPOS_PLANT_PROFIBUS; }

ipos_plant_status perform(ipos_plant* plant, Session& session, Act act, uint32_t bus, int64_t value,
                          std::vector<uint8_t> bytes) {
  Action action;
  action.act = act;
  action.number = bus;
  action.value = value;
  action.bytes = std::move(bytes);
  if (auto refused = session.perform(std::move(action)))
    return plant->fail(IPOS_PLANT_REFUSED, std::move(*refused));
  return IPOS_PLANT_OK;
}

template <typename Tap>
ipos_plant_load load_of(const Tap& tap, ipos::runtime::Time now) {
  const ipos::runtime::LineLoad load = tap.line().load(now);
  const double percent = load.elapsed_bits == 0 ? 0.0
                                                : 100.0 * static_cast<double>(load.busy_bits) /
                                                      static_cast<double>(load.elapsed_bits);
  return {load.frames, tap.heard().lost(), percent};
}

ipos_plant_frame frame_of(const Heard& heard) {
  ipos_plant_frame frame{};
  frame.time = heard.time;
  frame.id = heard.frame.id;
  frame.flags = (heard.frame.extended ? uint32_t{IPOS_PLANT_EXTENDED} : 0U) |
                (heard.frame.remote ? uint32_t{IPOS_PLANT_REMOTE} : 0U) |
                (heard.error ? uint32_t{IPOS_PLANT_ERROR} : 0U) | (heard.own ? uint32_t{IPOS_PLANT_OWN} : 0U);
  frame.sender = heard.sender == ipos::runtime::kNoNode ? UINT32_MAX : static_cast<uint32_t>(heard.sender);
  frame.tag = heard.tag;
  frame.length = heard.frame.length;
  std::copy(heard.frame.data.begin(), heard.frame.data.end(), frame.data);
  return frame;
}

std::span<const uint8_t> octets_of(const ipos::runtime::Reception& heard) { return heard.bytes.span(); }
std::span<const uint8_t> octets_of(const ipos::profibus::Reception& heard) { return heard.octets; }
bool is_whole(const ipos::runtime::Reception& heard) { return heard.telegram.has_value(); }
bool is_whole(const ipos::profibus::Reception& heard) { return heard.frame.has_value(); }

}  // namespace

ipos_plant_status ipos_plant_bus_at(ipos_plant* plant, uint32_t bus, ipos_plant_bus_info* info) {
  return enter(plant, Allowed::Anywhere, [=](Session& session) {
    if (info == nullptr) return ipos_plant_status{IPOS_PLANT_INVALID_ARGUMENT};
    const bool found = session.instance().with_line(bus, [&](auto& tap) {
      *info = {plant->keep(tap.line().name()), kind_of(tap), tap.line().baud()};
    });
    return found ? ipos_plant_status{IPOS_PLANT_OK}
                 : no_bus(plant, fmt::format("there is no bus number {}", bus));
  });
}

ipos_plant_status ipos_plant_bus(ipos_plant* plant, const char* name, uint32_t* bus) {
  return enter(plant, Allowed::Anywhere, [=](Session& session) {
    if (name == nullptr || bus == nullptr) return ipos_plant_status{IPOS_PLANT_INVALID_ARGUMENT};
    for (uint32_t number = 0; number < session.instance().line_count(); ++number) {
      bool is_it = false;
      session.instance().with_line(number, [&](auto& tap) { is_it = tap.line().name() == name; });
      if (is_it) return *bus = number, ipos_plant_status{IPOS_PLANT_OK};
    }
    return no_bus(plant, fmt::format("there is no bus '{}'; the plant has {}", name, bus_names(session)));
  });
}

ipos_plant_status ipos_plant_bus_load(ipos_plant* plant, uint32_t bus, ipos_plant_load* load) {
  return enter(plant, Allowed::Anywhere, [=](Session& session) {
    if (load == nullptr) return ipos_plant_status{IPOS_PLANT_INVALID_ARGUMENT};
    const ipos::runtime::Time now = session.plant().now();
    const bool found = session.instance().with_line(bus, [&](auto& tap) { *load = load_of(tap, now); });
    return found ? ipos_plant_status{IPOS_PLANT_OK}
                 : no_bus(plant, fmt::format("there is no bus number {}", bus));
  });
}

ipos_plant_status ipos_plant_run_to_frame(ipos_plant* plant, uint32_t bus, int64_t until) {
  return with_can(plant, bus, Allowed::NotInCallbacks, [=](Session& session, CanTap& tap) {
    ipos::runtime::Plant& running = session.plant();
    if (until < running.now() || until == ipos::runtime::kNever)
      return plant->fail(IPOS_PLANT_INVALID_ARGUMENT,
                         fmt::format("it is {} ns: time does not run back", running.now()));
    while (tap.heard().empty() && running.now() < until)
      running.run_until(std::min(until, std::max(running.next_time(), running.now() + 1)));
    return ipos_plant_status{IPOS_PLANT_OK};
  });
}

ipos_plant_status ipos_plant_join(ipos_plant* plant, uint32_t bus) {
  return with_can(plant, bus, Allowed::NotInCallbacks,
                  [=](Session& session, CanTap&) { return perform(plant, session, Act::Join, bus, 0, {}); });
}

ipos_plant_status ipos_plant_send(ipos_plant* plant, uint32_t bus, const ipos_plant_frame* frame,
                                  uint32_t* tag) {
  return with_can(plant, bus, Allowed::NotInCallbacks, [=](Session& session, CanTap& tap) {
    if (frame == nullptr) return ipos_plant_status{IPOS_PLANT_INVALID_ARGUMENT};
    ipos::runtime::Frame sent;
    sent.id = frame->id;
    sent.length = frame->length;
    sent.extended = (frame->flags & IPOS_PLANT_EXTENDED) != 0;
    sent.remote = (frame->flags & IPOS_PLANT_REMOTE) != 0;
    std::copy(std::begin(frame->data), std::end(frame->data), sent.data.begin());
    if (!is_valid(sent) || (frame->flags & ~uint32_t{IPOS_PLANT_EXTENDED | IPOS_PLANT_REMOTE}) != 0)
      return plant->fail(IPOS_PLANT_BAD_VALUE,
                         "a frame has 8 bytes at most and an identifier of 11 or, extended, 29 bits");
    // Who waits for room asks again and again: that is no action, and the record does not grow by it.
    if (tap.is_full()) return plant->fail(IPOS_PLANT_FULL, ipos_plant_status_text(IPOS_PLANT_FULL));
    const uint32_t number = session.next_tag();
    if (tag != nullptr) *tag = number;
    return perform(plant, session, Act::Send, bus, number, frame_bytes(canonical(sent)));
  });
}

ipos_plant_status ipos_plant_receive(ipos_plant* plant, uint32_t bus, ipos_plant_frame* frames,
                                     size_t capacity, size_t* count) {
  return with_can(plant, bus, Allowed::NotInCallbacks, [=](Session&, CanTap& tap) {
    if (count == nullptr || (frames == nullptr && capacity != 0)) return IPOS_PLANT_INVALID_ARGUMENT;
    *count = 0;
    while (*count < capacity) {
      const auto heard = tap.heard().take();
      if (!heard) break;
      frames[(*count)++] = frame_of(*heard);
    }
    return IPOS_PLANT_OK;
  });
}

ipos_plant_status ipos_plant_node_name(ipos_plant* plant, uint32_t bus, uint32_t node, const char** name) {
  return with_can(plant, bus, Allowed::Anywhere, [=](Session&, CanTap& tap) {
    if (name == nullptr) return ipos_plant_status{IPOS_PLANT_INVALID_ARGUMENT};
    if (node >= tap.line().node_count())
      return plant->fail(IPOS_PLANT_NO_STATION, fmt::format("no station on the line has number {}", node));
    *name = plant->keep(tap.line().node_name(static_cast<NodeId>(node)));
    return ipos_plant_status{IPOS_PLANT_OK};
  });
}

ipos_plant_status ipos_plant_serial_send(ipos_plant* plant, uint32_t bus, const uint8_t* bytes,
                                         size_t length) {
  return with_octets(plant, bus, [=](Session& session, auto& tap) {
    if (bytes == nullptr) return ipos_plant_status{IPOS_PLANT_INVALID_ARGUMENT};
    if (length == 0 || length > tap.kLongest)
      return plant->fail(IPOS_PLANT_BAD_VALUE,
                         fmt::format("1 to {} bytes can be sent at a time", tap.kLongest));
    return perform(plant, session, Act::SerialSend, bus, 0, {bytes, bytes + length});
  });
}

ipos_plant_status ipos_plant_serial_receive(ipos_plant* plant, uint32_t bus, ipos_plant_telegram* telegram) {
  return with_octets(plant, bus, [=](Session&, auto& tap) -> ipos_plant_status {
    if (telegram == nullptr) return IPOS_PLANT_INVALID_ARGUMENT;
    const auto reception = tap.heard().take();
    if (!reception) return IPOS_PLANT_NOTHING;
    const auto heard = octets_of(*reception);
    plant->bytes.assign(heard.begin(), heard.end());
    *telegram = {reception->start,     reception->end,
                 plant->bytes.data(),  plant->bytes.size(),
                 is_whole(*reception), plant->hand_out(ipos::runtime::reception_text(*reception))};
    return IPOS_PLANT_OK;
  });
}

ipos_plant_status ipos_plant_fms(ipos_plant* plant, uint32_t bus, uint8_t address, uint8_t connection, const char* service,
                                 uint16_t index, const uint8_t* data, size_t length, int64_t until,
                                 ipos_plant_fms_answer* answer) {
  namespace fms = ipos::profibus::fms;
  return enter(plant, Allowed::NotInCallbacks, [=](Session& session) -> ipos_plant_status {
    if (service == nullptr || answer == nullptr || (data == nullptr && length != 0)) return IPOS_PLANT_INVALID_ARGUMENT;
    const auto wanted = fms::service_of_key(service);
    constexpr size_t kLongest = 230;  // of the objects
    if (!wanted || length > kLongest || address > ipos::profibus::kLastStation || fms::find_connection(connection) == nullptr)
      return plant->fail(IPOS_PLANT_BAD_VALUE,
                         fmt::format("a service of FMS is {}, over connection 2 to 8 to an address of 0 to 125, and carries at most {} "
                                     "octets",
                                     fms::service_keys(), kLongest));
    ipos::runtime::Plant& running = session.plant();
    if (until < running.now() || until == ipos::runtime::kNever)
      return plant->fail(IPOS_PLANT_INVALID_ARGUMENT, fmt::format("it is {} ns: time does not run back", running.now()));
    if (session.instance().fms(bus) == nullptr) return no_bus(plant, fmt::format("no PROFIBUS line has number {}", bus));
    std::vector<uint8_t> bytes{address, connection, static_cast<uint8_t>(*wanted), static_cast<uint8_t>(index >> 8),
                               static_cast<uint8_t>(index)};
    bytes.insert(bytes.end(), data, data + length);
    // A slave that hears nobody else has to find the rate first: for a while it is asked again (ours).
    const ipos::runtime::Time joined = running.now() + 2 * ipos::runtime::kSecond;
    std::optional<fms::Done> done;
    do {
      if (const auto status = perform(plant, session, Act::Fms, bus, 0, bytes); status != IPOS_PLANT_OK) return status;
      while (!(done = session.instance().fms(bus)->take()) && running.now() < until)
        running.run_until(std::min(until, running.now() + ipos::runtime::kMillisecond));
    } while (done && done->response.end == fms::End::Aborted &&
             done->response.reason == static_cast<uint8_t>(fms::Reason::NoAnswer) && running.now() < std::min(joined, until));
    if (!done) return IPOS_PLANT_NOTHING;
    plant->bytes = done->response.data;
    *answer = {static_cast<ipos_plant_fms_end>(done->response.end), done->response.error.packed(), plant->bytes.data(),
               plant->bytes.size(), plant->hand_out(fms::describe(done->response))};
    return IPOS_PLANT_OK;
  });
}

ipos_plant_status ipos_plant_line_fault(ipos_plant* plant, const char* text) {
  return enter(plant, Allowed::NotInCallbacks, [=](Session& session) {
    if (text == nullptr) return ipos_plant_status{IPOS_PLANT_INVALID_ARGUMENT};
    const auto read = ipos::runtime::read_fault_tables(text, session.plant().file());
    if (!read.errors.empty() || read.plant.faults.empty())
      return plant->fail(IPOS_PLANT_BAD_VALUE,
                         read.errors.empty()
                             ? "the text has no [[fault]]"
                             : fmt::format("line {}, column {}: {}", read.errors.front().place.line,
                                           read.errors.front().place.column, read.errors.front().text));
    return perform(plant, session, Act::LineFault, 0, 0, {text, text + std::strlen(text)});
  });
}
