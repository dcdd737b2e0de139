// MOVLNK from structure to result.
#include "runtime/commands/movilink_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "runtime/bus/movilink/return_code.hpp"

namespace ipos::runtime {
namespace {

// Elements of MOVLNK and MLDATA (1053 1610 p. 47).
enum Element : uint32_t { kBusType, kAddress, kFormat, kService, kIndex, kDPointer, kResult };
enum Data : uint32_t { kWritePar, kReadPar, kPO1, kPI1 = 5 };

constexpr int32_t kOwnUnit = 253;
constexpr Time kEarly = 100 * kMillisecond;  // after power-on, when no real partner would be ready (ours)

struct BusRow {
  int32_t code;
  std::optional<stdlib::Trait> units;  // with this trait
  const char* text;

  bool is_of(const stdlib::UnitType& unit) const { return !units || unit.has(*units); }
};
constexpr auto kBusRows = [] {
  using enum stdlib::Trait;
  constexpr std::nullopt_t Every = std::nullopt;
  return std::to_array<BusRow>({
#define MOVILINK_BUS(name, code, units, text) {code, units, text},
#include "stdlib/movilink_buses.def"
  });
}();
constexpr auto kAbsentBuses = [] {
  using enum stdlib::Trait;
  return std::to_array<BusRow>({
#define ABSENT_BUS(code, units, text) {code, units, text},
#include "stdlib/movilink_buses.def"
  });
}();

// Variables of MLDATA that a format touches.
uint32_t data_size(TelegramFormat format) { return format.words > 0 ? kPI1 + format.words : 2U; }

MovilinkResult refused(ReturnCode code) {
  MovilinkResult result;
  result.result = code.packed();
  return result;
}

}  // namespace

MovilinkCommand::MovilinkCommand(const stdlib::UnitType& unit, ParameterServer& own,
                                 ProcessDataServer& own_data, Journal& journal, std::string_view station)
    : unit_(unit), own_(own), own_data_(own_data), journal_(journal), station_(station) {
  for (Route& route : routes_) route.command = this;
}

vm::HostReply MovilinkCommand::start(Time now, vm::Machine& machine, int context, uint32_t variable,
                                     std::string& why) {
  const std::span<int32_t> h = machine.variables();
  const auto element = [&](Element n) { return h[variable + n]; };
  Job job{&machine,
          context,
          variable,
          static_cast<uint32_t>(element(kDPointer)),
          {element(kAddress), element(kFormat), element(kService), element(kIndex), 0, {}}};

  if (!has_called(variable)) structures_.push_back(variable);
  const auto format = telegram_format(job.bus.format);
  if (!format) {
    why = fmt::format("MOVLNK: Format {} is none of 0..6 and 128..134", job.bus.format);
    store(job, refused(return_codes::kWrongManagement));
    return {};
  }
  if (job.data >= h.size() || h.size() - job.data < data_size(*format))
    return {vm::Answer::Fault, vm::kFaultIllop,
            "DPointer of MOVLNK does not lead to the variables of MLDATA"};
  job.bus.write_value = h[job.data + kWritePar];
  for (uint32_t n = 0; n < format->words; ++n) job.bus.output[n] = h[job.data + kPO1 + n];

  const auto refuse = [&](ReturnCode code, std::string reason) {
    why = std::move(reason);
    store(job, refused(code));
    return vm::HostReply{};
  };
  if (format->parameter && job.bus.index > 0xFFFF && !own_.has_subindices())
    return refuse(
        return_codes::kWrongManagement,
        fmt::format("MOVLNK: {} has no subindices, so Index {} cannot be sent", unit_.title, job.bus.index));
  if (job.bus.address == kOwnUnit) {
    store(job, serve_own(now, job.bus, *format));
    return {};
  }
  const auto row = std::find_if(std::begin(kBusRows), std::end(kBusRows), [&](const BusRow& bus) {
    return bus.code == element(kBusType) && bus.is_of(unit_);
  });
  if (row == std::end(kBusRows)) return refuse(return_codes::kWrongManagement, unknown_bus(element(kBusType)));
  Route& route = routes_[static_cast<size_t>(row - std::begin(kBusRows))];
  if (route.master == nullptr)
    return refuse(return_codes::kCommunication,
                  fmt::format("MOVLNK: the station is not connected to {}", row->text));
  route.remember_partner(job.bus.address, *format);
  if (tells_early_ && now - begun_ < kEarly)
    journal_.note(now, Weight::Why, station_,
                  "MOVLNK asks a partner within 100 ms of power-on and finds it there: a real unit takes longer until it is ready, "
                  "as start_up of its [[station]] says");
  route.jobs.push_back(job);
  if (route.jobs.size() > 1) return {vm::Answer::Wait};
  if (const auto code = route.master->start(now, job.bus)) {
    route.jobs.clear();
    return refuse(*code, fmt::format("MOVLNK: address {}, format {}, service {} cannot be sent over {}",
                                     job.bus.address, job.bus.format, job.bus.service, row->text));
  }
  return {vm::Answer::Wait};
}

std::string MovilinkCommand::unknown_bus(int32_t code) const {
  for (const BusRow& bus : kAbsentBuses)
    if (bus.code == code && bus.is_of(unit_))
      return fmt::format("MOVLNK: bus type {} is {}", code, bus.text);
  std::vector<int32_t> codes;
  for (const BusRow& bus : kBusRows)
    if (bus.is_of(unit_)) codes.push_back(bus.code);
  return fmt::format("MOVLNK: bus type {} is none of {}, which {} has", code, fmt::join(codes, ", "),
                     unit_.title);
}

bool MovilinkCommand::has_called(uint32_t variable) const {
  return std::find(structures_.begin(), structures_.end(), variable) != structures_.end();
}

void MovilinkCommand::Route::remember_partner(int32_t address, TelegramFormat format) {
  for (Partner& partner : partners) {
    if (partner.address != address) continue;
    partner.parameter |= format.parameter;
    partner.process_data |= format.words > 0;
    return;
  }
  partners.push_back({address, format.parameter, format.words > 0});
}

void MovilinkCommand::stop() {
  for (Route& route : routes_) {
    if (route.master != nullptr) route.master->abort();
    route.jobs.clear();
  }
}

void MovilinkCommand::give_up(const vm::Machine& machine, int context) {
  for (Route& route : routes_)
    for (Job& job : route.jobs)
      if (job.machine == &machine && job.context == context) job.machine = nullptr;
}

void MovilinkCommand::Route::on_exchange_done(Time now, const MovilinkResult& result) {
  const Job job = jobs.front();
  jobs.erase(jobs.begin());
  if (!result.reason.empty())
    command->journal_.note(now, Weight::Why, command->station_,
                           fmt::format("MOVLNK to address {}: {}", job.bus.address, result.reason));
  finish(job, result);
  begin_next(now);
}

void MovilinkCommand::Route::begin_next(Time now) {
  while (!jobs.empty()) {
    if (jobs.front().machine == nullptr) {
      jobs.erase(jobs.begin());
      continue;
    }
    const auto code = master->start(now, jobs.front().bus);
    if (!code) return;
    finish(jobs.front(), refused(*code));
    jobs.erase(jobs.begin());
  }
}

MovilinkResult MovilinkCommand::serve_own(Time now, const MovilinkJob& job, TelegramFormat format) {
  MovilinkResult result;
  if (format.parameter) {
    const auto service = service_from_code(static_cast<uint32_t>(job.service));
    if (!service || *service == Service::None || job.index < 0 || job.index > 0xFF'FFFF)
      return refused(return_codes::kWrongManagement);
    const auto value = own_.serve(now, {*service, static_cast<uint16_t>(job.index),
                                        static_cast<uint8_t>(job.index >> 16), job.write_value});
    if (!value) return refused(value.error());
    if (!is_write(*service)) result.read_value = *value;
  }
  if (format.words > 0) {
    ProcessWords output{};
    for (size_t n = 0; n < format.words; ++n) output[n] = static_cast<uint16_t>(job.output[n]);
    own_data_.take_output(now, OutputChannel::Single, {output.data(), format.words});
    const ProcessWords input = own_data_.input(now);
    for (size_t n = 0; n < format.words; ++n) result.input[n] = static_cast<int16_t>(input[n]);
    result.words = format.words;
  }
  return result;
}

void MovilinkCommand::finish(const Job& job, const MovilinkResult& result) {
  if (job.machine == nullptr) return;
  store(job, result);
  job.machine->resume(job.context);
}

void MovilinkCommand::store(const Job& job, const MovilinkResult& result) {
  const std::span<int32_t> h = job.machine->variables();
  h[job.variable + kResult] = static_cast<int32_t>(result.result);
  if (result.result != 0) return;  // after an error the data keep their values (1053 1610 p. 49)
  if (result.read_value) h[job.data + kReadPar] = *result.read_value;
  for (uint32_t n = 0; n < result.words; ++n) h[job.data + kPI1 + n] = result.input[n];
}

}  // namespace ipos::runtime
