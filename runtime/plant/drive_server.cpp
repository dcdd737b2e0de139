// Bridges between the bus's, the drive's and the VM's view of one unit.
#include "runtime/plant/drive_server.hpp"

#include <fmt/format.h>

namespace ipos::runtime {

namespace codes = stdlib::return_codes;

DriveServer::DriveServer(const stdlib::UnitType& unit, const MachineData& machine, DriveOptions options)
    : parameters_(unit, options),
      state_(parameters_, machine),
      variables_(unit.variables),
      serial_{index_of("810"), index_of("811"), index_of("750"), index_of("100")},
      task1_speed_(index_of("938")),
      task2_speed_(index_of("939")) {
  parameters_.plug(IndexArea::Variables, variables_);
  parameters_.plug(IndexArea::Program, code_);
}

std::optional<std::string> DriveServer::set_parameter(std::string_view parameter, int32_t value) {
  const stdlib::Parameter* row = parameters_.table().find(parameter);
  if (row == nullptr || row->index == 0)
    return fmt::format("unit {} has no parameter {}", parameters_.unit().name, parameter);
  const ParameterReply reply = parameters_.preset(row->index, value);
  if (reply) return std::nullopt;
  return fmt::format(
      "{} = {} is refused: {}", parameter, value,
      parameters_.explain(static_cast<uint8_t>(ParameterService::Write), row->index, value, reply.error()));
}

uint16_t DriveServer::index_of(std::string_view number) const {
  const stdlib::Parameter* row = parameters_.table().find(number);
  return row == nullptr ? 0 : row->index;
}

int32_t DriveServer::value(std::string_view number) const { return parameters_.value(index_of(number)); }

vm::Rates DriveServer::rates() const {
  vm::Rates rates;
  rates.commands[0] = static_cast<uint32_t>(parameters_.value(task1_speed_)) + 1;
  rates.commands[1] = static_cast<uint32_t>(parameters_.value(task2_speed_)) + 2;
  return rates;
}

void DriveServer::connect_program(vm::Machine& machine) {
  variables_.connect(machine);
  code_.connect(machine);
}

tl::expected<int32_t, ReturnCode> DriveServer::serve(Time /*now*/, const ParameterRequest& request) {
  const auto service = static_cast<uint8_t>(request.service);
  const ParameterReply reply = parameters_.execute(service, request.index, request.value);
  if (!reply) reason_ = parameters_.explain(service, request.index, request.value, reply.error());
  return reply;
}

void DriveServer::take_output(Time /*now*/, OutputChannel /*channel*/, std::span<const uint16_t> words) {
  state_.take_po(PoSource::Sbus, words);
}

ProcessWords DriveServer::input(Time /*now*/) { return state_.pi(); }

void DriveServer::synchronize(Time /*now*/) {}

SerialParameters DriveServer::serial_parameters() const {
  return {static_cast<uint8_t>(parameters_.value(serial_.address)),
          static_cast<uint8_t>(parameters_.value(serial_.group)), parameters_.value(serial_.slave_setpoint),
          parameters_.value(serial_.setpoint_source)};
}

void DriveServer::Rs485Data::take_output(Time /*now*/, OutputChannel /*channel*/,
                                         std::span<const uint16_t> words) {
  // The monitoring is restarted by cyclic_request().
  drive_.state_.take_po(PoSource::Rs485, words, false);
}

ProcessWords DriveServer::Rs485Data::input(Time now) { return drive_.input(now); }

void DriveServer::Rs485Data::cyclic_request(Time /*now*/) { drive_.state_.take_request(PoSource::Rs485); }

ProcessWords DriveServer::setpoint_to_send(Time /*now*/) { return state_.master_words(); }

void DriveServer::setpoint_received(Time /*now*/, const ProcessWords& words) {
  state_.take_po(PoSource::Rs485, words);
}

void DriveServer::link_lost(Time /*now*/) {
  constexpr uint8_t kRs485Timeout = 43;
  state_.raise_fault(kRs485Timeout, FaultResponse::EmergencyError);  // whatever P833 says (MDX60B/61B p. 30)
}

ParameterReply DriveServer::Code::read(uint16_t offset) {
  return offset < code_.size() ? static_cast<int32_t>(code_[offset]) : 0;
}

ParameterReply DriveServer::Code::write(uint16_t /*offset*/, int32_t /*value*/, bool /*nonvolatile*/) {
  return tl::unexpected(codes::kProtected);
}

}  // namespace ipos::runtime
